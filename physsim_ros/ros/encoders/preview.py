# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/preview`: visualization_msgs/MarkerArray, the unfinished gesture or the last stroke.

Law: every message is complete, since late subscribers receive only the last one.
"""

from __future__ import annotations

from collections.abc import Iterable
import math

from geometry_msgs.msg import Point as PointMessage
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.transform import Point
from rclpy.time import Time
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

NAMESPACE = 'preview'
# Height above bodies and their symbols [m].
_HEIGHT = 0.1
# Width of lines, diameter of points and height of letters: share of the extent, least, most [m].
_LINE, _DOT, _LETTER = (0.01, 0.01, 0.05), (0.03, 0.03, 0.15), (0.1, 0.08, 0.4)
_COLOR = ColorRGBA(r=0.9, g=0.2, b=0.5, a=0.9)


class PreviewEncoder:
    """
    Encodes the preview of a frame; nothing while it is the one before.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._preview: Preview = NO_PREVIEW

    def encode(self, frame: Frame) -> MarkerArray | None:
        """Return the message that replaces the preview before; None where it is the same."""
        if frame.preview == self._preview:
            return None
        self._preview = frame.preview
        stamp = Time(nanoseconds=frame.snapshot.stamp).to_msg()
        return _message(frame.preview, Header(frame_id=self._frame_id, stamp=stamp))


def _message(preview: Preview, header: Header) -> MarkerArray:
    extent = _extent([*preview.points, *(point for line in preview.lines for point in line)])
    markers = [Marker(action=Marker.DELETEALL)]
    width = _sized(_LINE, extent)
    markers += [_marker(Marker.LINE_STRIP, line, width) for line in preview.lines]
    if preview.points:
        dot = _sized(_DOT, extent)
        markers.append(_marker(Marker.SPHERE_LIST, preview.points, dot, dot))
    if preview.label:
        letter = _sized(_LETTER, extent)
        label = _marker(Marker.TEXT_VIEW_FACING, (), 0.0)
        label.text, label.scale.z = preview.label, letter
        x, y = preview.top
        label.pose.position = PointMessage(x=x, y=y + letter, z=_HEIGHT)
        markers.append(label)
    for number, marker in enumerate(markers):
        marker.header = header
        marker.ns, marker.id = NAMESPACE, number
    return MarkerArray(markers=markers)


def _marker(kind: int, points: Iterable[Point], width: float, depth: float = 0.0) -> Marker:
    marker = Marker(type=kind, color=_COLOR)
    marker.pose.orientation.w = 1.0
    marker.scale.x, marker.scale.y, marker.scale.z = width, depth, depth
    marker.points = [PointMessage(x=x, y=y, z=_HEIGHT) for x, y in points]
    return marker


def _extent(points: list[Point]) -> float:
    if not points:
        return 0.0
    xs, ys = zip(*points, strict=True)
    return math.hypot(max(xs) - min(xs), max(ys) - min(ys))


def _sized(size: tuple[float, float, float], extent: float) -> float:
    share, least, most = size
    return min(max(share * extent, least), most)
