# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Decoders of messages about many things: arrays of markers, commands, strokes.

Law: the elements of a sequence are counted before the first is read. rclpy decodes a path of
100,000 poses in 2 s, and a command of 10,000 twists in 57 ms (12 ms here), during which the node
does nothing else; the number alone is read in a microsecond. All other messages are decoded by
rclpy. A new message about many things is a function here and a line in `DECODERS`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from nav_msgs.msg import OccupancyGrid, Path
import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Malformed
from physsim_ros.model.names import LONGEST_NAME
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.ros.requests.cdr_reader import CdrReader
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Numbers of a geometry_msgs/Pose: position and quaternion.
_POSE = 7


class CommandMessage(NamedTuple):
    """
    The fields of a command.

    :ivar frame_id: of its header
    :ivar joint_names: of the bodies
    :ivar transforms: (n, 7) float64: translation [m] and quaternion, x, y, z, w
    :ivar twist: (n, 6) float64: linear [m/s] and angular [rad/s]
    :ivar wrench: (n, 6) float64: force [N] and torque [N m]
    """

    frame_id: str
    joint_names: tuple[str, ...]
    transforms: Floats
    twist: Floats
    wrench: Floats


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


def markers_from(message: bytes) -> MarkerArray:
    """
    Return the markers of a serialised visualization_msgs/MarkerArray.

    :raises Truncated: it has no header
    :raises Malformed: there are too many
    :raises RMWError: it cannot be decoded
    """
    CdrReader(message).count('markers')
    return deserialize_message(message, MarkerArray)


def command_from(message: bytes) -> CommandMessage:
    """
    Return the fields of a serialised sensor_msgs/MultiDOFJointState.

    :raises Truncated: it breaks off
    :raises Malformed: it has more elements than a command may have
    """
    reader = CdrReader(message)
    reader.stamp()
    return CommandMessage(
        frame_id=reader.text(),
        joint_names=tuple(reader.text() for _ in range(reader.count('joint_names'))),
        transforms=reader.doubles(reader.count('transforms'), _POSE),
        twist=reader.doubles(reader.count('twist'), 6),
        wrench=reader.doubles(reader.count('wrench'), 6),
    )


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


DECODERS: dict[type, Callable[[bytes], Any]] = {
    MarkerArray: markers_from,
    MultiDOFJointState: command_from,
    # rclpy copies its cells at once.
    OccupancyGrid: partial(deserialize_message, message_type=OccupancyGrid),
    Path: stroke_from,
}
