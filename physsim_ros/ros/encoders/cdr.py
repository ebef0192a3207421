# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
CDR, little endian: a writer of messages, and templates of which a frame writes the numbers.

A message is four bytes of header, then its values, each aligned to its own size counted from the
end of the header; a string is its length with the NUL, its characters and the NUL. The parts of a
message that change only with the scene (lengths, names, colours, outlines) are written once into a
template; a frame writes its stamp and its floats at known offsets.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import struct

import numpy as np
from physsim_ros.model.arrays import Floats, Singles

# Doubles of a planar pose or transform that are not always 0: x, y; z and w of the quaternion.
POSE_COLUMNS = (0, 1, 5, 6)
# Four bytes of padding, which align the values in memory, and the header of the message.
START = b'\0\0\0\0\0\1\0\0'


class CdrWriter:
    """
    Writes values one after the other, each aligned to its size.

    :param start: bytes to begin with; none, or a multiple of 8 bytes

    :ivar data: the bytes so far
    :ivar stamps: offset of each stamp [bytes]
    :ivar poses: offset of each pose [bytes]
    :ivar blocks: offset [bytes], count and width of each block of doubles
    """

    def __init__(self, start: bytes = b'') -> None:
        self.data = bytearray(start)
        self.stamps: list[int] = []
        self.poses: list[int] = []
        self.blocks: list[tuple[int, int, int]] = []

    def align(self, size: int) -> None:
        """Write padding up to a multiple of a size [bytes]."""
        self.data += b'\0\0\0\0\0\0\0'[: -len(self.data) % size]

    def ints(self, *values: int) -> None:
        """Write 32-bit integers."""
        self.align(4)
        self.data += struct.pack(f'<{len(values)}i', *values)

    def doubles(self, *values: float) -> None:
        """Write 64-bit floats."""
        if values:
            self.align(8)
            self.data += struct.pack(f'<{len(values)}d', *values)

    def text(self, text: str) -> None:
        """Write a string."""
        self.align(4)
        self.data += _string(text)

    def stamp(self) -> None:
        """Write a builtin_interfaces/Time of 0."""
        self.align(4)
        self.stamps.append(len(self.data))
        self.ints(0, 0)

    def header(self, frame_id: str) -> None:
        """Write a std_msgs/Header with stamp 0."""
        self.stamp()
        self.text(frame_id)

    def pose(self, count: int = 1) -> None:
        """Write one or more geometry_msgs/Pose or Transform, all zero."""
        if count:
            self.align(8)
        start = len(self.data)
        self.data += bytes(56 * count)
        self.poses += range(start, len(self.data), 56)

    def block(self, count: int, width: int) -> None:
        """Write a sequence of `count` values of `width` doubles each, all zero."""
        self.ints(count)
        if count:
            self.align(8)
        self.blocks.append((len(self.data), count, width))
        self.data += bytes(8 * count * width)


class MessageTemplate:
    """
    A serialised message whose stamps and floats can be overwritten.

    :param writer: with all of the message, from `START` on

    :ivar doubles: (k,) float64: view of the whole message as doubles
    :ivar floats: (k,) float32: view of the whole message as floats
    :ivar blocks: (count, width) float64 each: views of the blocks of doubles
    """

    def __init__(self, writer: CdrWriter) -> None:
        self._message = memoryview(writer.data)[4:]
        self._words = np.frombuffer(writer.data, '<u4', len(writer.data) // 4)
        self._seconds = np.array(writer.stamps, np.intp) // 4
        self._nanoseconds = self._seconds + 1
        # Offsets of each column in all poses, in numbers of 8 bytes.
        self._poses = np.array(writer.poses, np.intp) // 8 + np.array(POSE_COLUMNS)[:, None]
        self.doubles: Floats = np.frombuffer(writer.data, '<f8', len(writer.data) // 8)
        self.floats: Singles = np.frombuffer(writer.data, '<f4', len(writer.data) // 4)
        self.blocks = [
            np.frombuffer(writer.data, '<f8', count * width, start).reshape(count, width)
            for start, count, width in writer.blocks
        ]

    def write_poses(self, columns: Sequence[Floats]) -> None:
        """Write x, y [m], and z and w of the quaternion about z, (n,) float64 each, into poses."""
        for offsets, values in zip(self._poses, columns, strict=True):
            self.doubles[offsets] = values

    def stamped(self, stamp: int) -> bytes:
        """Return a copy of the message with a stamp [ns]."""
        self._words[self._seconds], self._words[self._nanoseconds] = divmod(stamp, 10**9)
        return bytes(self._message)


def padded_string(text: str) -> bytes:
    """Return a serialised string with the padding that a following string needs."""
    data = _string(text)
    return data + bytes(-len(data) % 4)


def fill_columns(block: Floats, columns: Iterable[int], values: Iterable[Floats]) -> None:
    """Copy arrays into columns of a block."""
    # By column: numpy copies (n, 2) into (n, 7) five times slower than (n,) twice.
    for column, value in zip(columns, values, strict=True):
        block[:, column] = value


def _string(text: str) -> bytes:
    # Characters without UTF-8, such as half surrogates of file names, become '?'.
    data = text.encode(errors='replace') + b'\0'
    return struct.pack('<I', len(data)) + data
