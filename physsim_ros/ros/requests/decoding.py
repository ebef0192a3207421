# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Decoding of messages: by rclpy, within a bound in bytes; commands by numpy.

Law: a message beyond its bound is not decoded; nothing beyond the end of a message is read.

rclpy makes an object for each part of a message: a command of 100 twists takes it 0.54 ms, and
0.10 ms here. Commands of crowds come at the rate of frames, all other messages now and then.
"""

from __future__ import annotations

import struct
from typing import Any, Literal, NamedTuple

from nav_msgs.msg import OccupancyGrid, Path
import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Malformed
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Bound of a message about one thing [bytes]: a marker of 10,000 points, which is told that it has
# too many. Larger ones take longer to decode than to send.
MOST_BYTES_OF_ONE = 2**18
# Bounds of messages about many things [bytes]: 20,000 markers without points have 4.3 MiB, of
# which rclpy makes ten times as much, in 1 s; a stroke of 10,000 samples has 0.8 MB, in 0.24 s.
MOST_BYTES = {
    MarkerArray: 5 * 2**20,
    MultiDOFJointState: 5 * 2**20,
    OccupancyGrid: 5 * 2**20,
    Path: 2**20,
}
# Size of the header of CDR, from whose end on values are aligned to their size [bytes].
_HEADER = 4
# Size of a double [bytes]; numbers of a geometry_msgs/Transform: translation and quaternion.
_DOUBLE, _POSE = 8, 7


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


def decoded(data: bytes, kind: type) -> Any:
    """
    Return a message of a type; a command as a `CommandMessage`.

    :raises Malformed: it is too large
    :raises Truncated: it breaks off
    :raises RMWError: rclpy cannot decode it
    """
    most = MOST_BYTES.get(kind, MOST_BYTES_OF_ONE)
    if len(data) > most:
        raise Malformed(f'such a message has at most {most / 2**10:g} KiB')
    return command_from(data) if kind is MultiDOFJointState else deserialize_message(data, kind)


def command_from(message: bytes) -> CommandMessage:
    """
    Return the fields of a serialised sensor_msgs/MultiDOFJointState.

    :raises Truncated: it breaks off
    """
    reader = CdrReader(message)
    reader.stamp()
    return CommandMessage(
        frame_id=reader.text(),
        joint_names=tuple(reader.text() for _ in range(reader.count())),
        transforms=reader.doubles(reader.count(), _POSE),
        twist=reader.doubles(reader.count(), 6),
        wrench=reader.doubles(reader.count(), 6),
    )


class Truncated(ValueError):
    """A message that ends within a value."""


class CdrReader:
    """
    Reads the values of a serialised message (CDR), one after the other.

    :param message: serialised, of either byte order
    :raises Truncated: it has no header
    """

    def __init__(self, message: bytes) -> None:
        self._data = memoryview(message)[_HEADER:]
        self._at = 0
        if len(message) < _HEADER:
            raise Truncated
        order: Literal['<', '>'] = '<' if message[1] & 1 else '>'
        self._stamp = struct.Struct(order + 'iI')
        self._number = struct.Struct(order + 'I')
        self._double = np.dtype(np.float64).newbyteorder(order)

    def stamp(self) -> int:
        """Return a builtin_interfaces/Time [ns]."""
        begin = self._begin(4, self._stamp.size)
        seconds, nanoseconds = self._stamp.unpack_from(self._data, begin)
        return int(seconds * 1_000_000_000 + nanoseconds)

    def count(self) -> int:
        """
        Return the number of elements of a sequence.

        :raises Truncated: there are more of them than bytes
        """
        count = self._read_number()
        if count > len(self._data) - self._at:
            raise Truncated
        return count

    def text(self) -> str:
        """Return a string; what is not UTF-8 is replaced, as rclpy does."""
        length = self._read_number()
        begin = self._begin(1, length)
        # Without the NUL at its end.
        last = max(begin, begin + length - 1)
        return bytes(self._data[begin:last]).decode(errors='replace')

    def doubles(self, rows: int, columns: int) -> Floats:
        """Return the next doubles, (rows, columns) float64, read-only."""
        if not rows:
            # Without a double there is nothing to align.
            return np.empty((0, columns))
        begin = self._begin(_DOUBLE, rows * columns * _DOUBLE)
        found = np.frombuffer(self._data, self._double, rows * columns, begin)
        return found.reshape(rows, columns).astype(np.float64, copy=False)

    def _read_number(self) -> int:
        """Return a uint32."""
        begin = self._begin(4, self._number.size)
        return int(self._number.unpack_from(self._data, begin)[0])

    def _begin(self, alignment: int, size: int) -> int:
        """
        Return the offset of the next value, and skip the value.

        :param alignment: of the value [bytes]
        :param size: of the value [bytes]
        :raises Truncated: the message ends before the value does
        """
        begin = self._at + -self._at % alignment
        self._at = begin + size
        if self._at > len(self._data):
            raise Truncated
        return begin
