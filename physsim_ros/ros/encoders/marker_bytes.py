# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bytes of a visualization_msgs/Marker, and of a MarkerArray that is joined of such.

A marker is serialised without its time and pose, which each frame has. Its padding depends on
where it begins, so that it is kept for both alignments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import struct

from physsim_ros.ros.encoders.bare_markers import BareMarker, Key
from physsim_ros.ros.encoders.cdr import CdrWriter, START

# A marker from its pose on: pose, scale, color, lifetime, frame_locked, number of points.
_POSED = struct.Struct('<7d3d4f8xx3xi')
# Offsets of the color and of the points from the pose [bytes].
COLOR_OFFSET, POINTS_OFFSET = struct.calcsize('<7d3d'), _POSED.size
_IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
# No colors, texture_resource, texture (stamp, frame_id, format, data), uv_coordinates.
_UNTEXTURED = struct.pack('<ii4s8xi4si4sii', 0, 1, b'', 1, b'', 1, b'', 0, 0)
# No mesh_resource, mesh_file (filename, data), mesh_use_embedded_materials.
_UNMESHED = struct.pack('<i4si4six', 1, b'', 1, b'', 0)
# From the end of a marker to the next one [bytes].
_PADDING = -len(_UNMESHED) % 4


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerBytes:
    """
    A serialised marker, padded up to the next one; its padding depends on its offset.

    :param key: namespace and id
    :param at_8: at an offset that is a multiple of 8
    :param at_4: at another multiple of 4
    :param size_of_rest: from the pose on, which is at a multiple of 8 [bytes]
    """

    key: Key
    at_8: bytes
    at_4: bytes
    size_of_rest: int


def serialised(marker: BareMarker, frame_id: str) -> MarkerBytes:
    """Return the bytes of a marker without its time and pose, which each frame has."""
    head = CdrWriter()
    head.header(frame_id)
    head.text(marker.key[0])
    head.ints(marker.key[1], marker.kind, marker.action)
    count = len(marker.points)
    rest = CdrWriter(_POSED.pack(*_IDENTITY, *marker.scale, *marker.color, count))
    rest.doubles(*(number for x, y in marker.points for number in (x, y, marker.height)))
    rest.data += _UNTEXTURED
    rest.text(marker.text)
    rest.align(4)
    rest.data += _UNMESHED
    rest.data += bytes(_PADDING)
    head.align(4)
    gap = -len(head.data) % 8
    return MarkerBytes(
        key=marker.key,
        at_8=bytes(head.data + bytes(gap) + rest.data),
        at_4=bytes(head.data + bytes(4 - gap) + rest.data),
        size_of_rest=len(rest.data),
    )


def joined(markers: Sequence[MarkerBytes]) -> tuple[CdrWriter, list[int]]:
    """Return a writer with all of a message, and the offsets of the poses of markers [bytes]."""
    writer = CdrWriter(START)
    writer.ints(len(markers))
    offsets: list[int] = []
    parts: list[bytes] = []
    size = len(writer.data)
    for marker in markers:
        writer.stamps.append(size)
        # All begin at a multiple of 4 bytes, some of 8.
        part = marker.at_8 if size % 8 == 0 else marker.at_4
        parts.append(part)
        size += len(part)
        offsets.append(size - marker.size_of_rest)
    writer.data += b''.join(parts)
    if parts:
        del writer.data[-_PADDING:]
    return writer, offsets
