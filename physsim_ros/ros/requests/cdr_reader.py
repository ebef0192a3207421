# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Values of a serialised message (CDR) one after the other, without a message object for each part.

Laws: what lies beyond the end of the message is `Truncated`, never read; the elements of a
sequence are counted before the first is read. rclpy makes objects of
100,000 poses, or of a command of 10,000 bodies, in tenths of seconds and more, during which the
node does nothing else.
"""

from __future__ import annotations

import struct
from typing import Literal

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Malformed

# Bodies that one message may be about: as many as a world has at most by default (`max_bodies`).
# rclpy takes 60 µs for each marker of an array, during which the node does nothing else.
MOST_OF_MANY = 20_000
# Size of the header of CDR, from whose end on values are aligned to their size [bytes].
_HEADER = 4
# Size of a double [bytes].
_DOUBLE = 8


class Truncated(ValueError):
    """A message that breaks off."""


class CdrReader:
    """
    Reads the values of a message.

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

    def count(self, sequence: str, most: int = MOST_OF_MANY) -> int:
        """
        Return the number of elements of a sequence.

        :param sequence: its name in the message
        :param most: elements that it may have
        :raises Truncated: there are more than bytes
        :raises Malformed: there are more than it may have
        """
        count = self._read_number()
        if count > len(self._data) - self._at:
            raise Truncated
        if count > most:
            raise Malformed(f'{sequence} has at most {most} elements, not {count}', field=sequence)
        return count

    def text(self) -> str:
        """Return a string; what is not UTF-8 is replaced, as rclpy does."""
        length = self._read_number()
        begin = self._begin(1, length)
        # Without the NUL at its end.
        last = max(begin, begin + length - 1)
        return bytes(self._data[begin:last]).decode(errors='replace')

    def doubles(self, rows: int, columns: int) -> Floats:
        """Return (rows, columns) float64: as many doubles, read-only."""
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
        Return where a value of so many bytes begins, and skip it.

        :raises Truncated: it is not all there
        """
        begin = self._at + -self._at % alignment
        self._at = begin + size
        if self._at > len(self._data):
            raise Truncated
        return begin
