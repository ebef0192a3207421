# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Deserialisation of strokes: nav_msgs/Path to an array, without a message object for each pose.

Law: the number of poses is checked first. rclpy deserialises 100,000 poses in 2 s, during which
the node could not publish; the number alone is read in a microsecond.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Malformed
from physsim_ros.model.names import LONGEST_NAME
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.ros.requests.cdr_reader import CdrReader

# Numbers of a geometry_msgs/Pose: position and quaternion.
_POSE = 7


class StrokeMessage(NamedTuple):
    """
    The fields of a stroke.

    :ivar frame_id: of its header, or of its poses
    :ivar samples: (n, 3) float64: x, y [m] and time from the first sample [s]
    :ivar began: stamp of the first sample [s]; None where all have the same
    """

    frame_id: str
    samples: Floats
    began: float | None


def stroke_from(message: bytes) -> StrokeMessage:
    """
    Return the fields of a serialised nav_msgs/Path.

    :raises Truncated: it breaks off
    :raises Malformed: there are too many samples, they are in different frames, or the name of one
        is too long
    """
    reader = CdrReader(message)
    _, frame = _header(reader)
    count = reader.count('poses', MOST_SAMPLES)
    frames = {frame}
    samples = np.empty((count, 3))
    first: int | None = None
    for sample in range(count):
        stamp, frame = _header(reader)
        first = stamp if first is None else first
        frames.add(frame)
        samples[sample, :2] = reader.doubles(1, _POSE)[0, :2]
        samples[sample, 2] = (stamp - first) * 1e-9
    # A pose without a frame is in that of the path, and a path without one in that of its poses.
    named = sorted(frames - {''})
    if len(named) > 1:
        raise Malformed(
            f'a stroke is drawn in one frame, not in {named[0]!r} and {named[1]!r}',
            field='header.frame_id',
        )
    began = first * 1e-9 if first is not None and samples[:, 2].any() else None
    return StrokeMessage(named[0] if named else '', samples, began)


def _header(reader: CdrReader) -> tuple[int, str]:
    """
    Return stamp [ns] and frame of a header.

    :raises Malformed: the name of the frame is too long
    """
    stamp, frame = reader.stamp(), reader.text()
    if len(frame) > LONGEST_NAME:
        raise Malformed(
            f'the name of a frame has at most {LONGEST_NAME} characters', field='header.frame_id'
        )
    return stamp, frame
