# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A reader of serialised messages (CDR), one value after the other, without an object for each part.

Law: nothing beyond the end of the message is read; a value that is not whole is `Truncated`.
"""

from __future__ import annotations

import struct
from typing import Literal

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Malformed

# Greatest number of elements of a sequence: the default of parameter `max_bodies`. rclpy takes
# 60 µs for each marker of an array, during which the node does nothing else.
MOST_ELEMENTS = 20_000
# Size of the header of CDR, from whose end on values are aligned to their size [bytes].
_HEADER = 4
# Size of a double [bytes].
_DOUBLE = 8


class Truncated(ValueError):
    """A message that ends within a value."""


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

    def count(self, sequence: str, most: int = MOST_ELEMENTS) -> int:
        """
        Return the number of elements of a sequence.

        :param sequence: its name in the message
        :param most: elements that it may have
        :raises Truncated: there are more of them than bytes
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
