# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The content of a file of another program: mappings whose values are checked as they are read.

Laws: a mistake in a file is a `BadContent`, which names its place; any other error is one of ours.
A key of a file has been read, or `unread` tells its place.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from physsim_ros.files import kind_of, MOST_BYTES, read_bytes
from physsim_ros.model.checks import shown, Whole, Within
from physsim_ros.model.errors import Refusal
from physsim_ros.model.transform import Point, Pose
from physsim_ros.model.translation import verbatim
import yaml

# Greatest number, of either sign: its square is finite.
_GREATEST = 1e30
# Least number that divides another.
_LEAST_DIVISOR = 1e-9
_ANY = Within(-_GREATEST, _GREATEST)
_POSITIVE = Within(_LEAST_DIVISOR, _GREATEST)
_WHOLE = Whole(-(2**31), 2**31 - 1)


class BadContent(Refusal):
    """A value of a file of another program is missing, or of a wrong kind; no page tells it."""

    def __init__(self, message: str) -> None:
        super().__init__(verbatim(message))


class _Reads:
    """
    The values that have been read.

    :ivar files: content of each file, with its place
    :ivar keys: that were read of each mapping, by its `id`; the files keep all mappings alive
    :ivar settled: mappings of which everything has been told or used
    """

    def __init__(self) -> None:
        self.files: list[tuple[object, str]] = []
        self.keys: defaultdict[int, set[str]] = defaultdict(set)
        self.settled: set[int] = set()


class Content:
    """
    A mapping.

    :param value: that is to be one
    :param place: of it in the file, for messages
    :param reads: of the content that it is a part of; None for that of a file
    :raises BadContent: it is none
    """

    def __init__(self, value: object, place: str = '', reads: _Reads | None = None) -> None:
        if not isinstance(value, Mapping):
            raise BadContent(f'{place or "it"} must be a mapping, not {shown(value)}')
        self._values = value
        self._place = place
        if reads is None:
            reads = _Reads()
            reads.files.append((value, place))
        self._reads = reads
        self._read = reads.keys[id(value)]

    @property
    def kind(self) -> str:
        """Return the kind of file that has these keys; '' for any other."""
        return kind_of(self._values)

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def place(self, key: str) -> str:
        """Return the place of a key in the file, for messages."""
        return f'{self._place}.{key}' if self._place else key

    def skip(self, *keys: str) -> None:
        """Count keys as read that say nothing about bodies, joints and their motion."""
        self._read.update(keys)
        self._reads.settled.update(id(self._values.get(key)) for key in keys)

    def settle(self) -> None:
        """Count everything in it as read."""
        self._reads.settled.add(id(self._values))

    def unread(self) -> Iterator[str]:
        """Yield the places of all values of its file, and of files `load`ed, that nobody read."""
        for value, place in self._reads.files:
            yield from _unread(value, place, self._reads)

    def get(self, key: str, default: object = None) -> object:
        """Return a value as it is."""
        self._read.add(key)
        return self._values.get(key, default)

    def number(self, key: str, default: float | None = None, check: Within = _ANY) -> float:
        """Return a number; without a default it must be there."""
        return _number(self.get(key, default), self.place(key), check)

    def divisor(self, key: str) -> float:
        """Return a number > 0, by which others are divided."""
        return self.number(key, check=_POSITIVE)

    def whole(self, key: str, default: int | None = None) -> int:
        """Return a whole number."""
        return _WHOLE(self.get(key, default), self.place(key))

    def text(self, key: str, default: str | None = None) -> str:
        """Return a text; a number, as a name may be, is its text."""
        value = self.get(key, default)
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise BadContent(f'{self.place(key)} must be text, not {shown(value)}')
        return str(value)

    def is_set(self, key: str) -> bool:
        """Return whether a flag is there, and true."""
        return bool(self.get(key))

    def numbers(self, key: str, default: Sequence[float] | None = None) -> list[float]:
        """Return a list of numbers."""
        return numbers(self.get(key, default), self.place(key))

    def point(self, key: str, default: Point | None = None) -> Point:
        """Return x and y, without a yaw."""
        x, y, _ = self.pose(key, default)
        return x, y

    def pose(self, key: str, default: Sequence[float] | None = None) -> Pose:
        """Return x, y and yaw, which may be missing."""
        return pose_of(self.get(key, default), self.place(key))

    def entry(self, key: str) -> Content:
        """Return a mapping."""
        return self.part(self.get(key), self.place(key))

    def part(self, value: object, place: str) -> Content:
        """Return a mapping within this one."""
        return Content(value, place, self._reads)

    def load(self, path: Path) -> Content:
        """
        Return the content of another file that this one names.

        These programs take what a world file does not, as a key that is there twice.

        :raises OSError: it cannot be read
        :raises BadContent: it is no YAML, or no mapping
        """
        value = parsed(read_bytes(path, MOST_BYTES), path.name)
        self._reads.files.append((value, path.name))
        return self.part(value, path.name)

    def entries(self, key: str) -> list[Content]:
        """Return a list of mappings; nothing, or null, is an empty one."""
        value = self.get(key)
        if value is None:
            return []
        each = enumerate(_list(value, self.place(key)))
        return [self.part(entry, f'{self.place(key)}[{number}]') for number, entry in each]

    def points(self, key: str) -> list[Point]:
        """Return a list of points."""
        each = enumerate(_list(self.get(key), self.place(key)))
        return [pose_of(point, f'{self.place(key)}[{number}]')[:2] for number, point in each]


def parsed(text: bytes, name: str) -> object:
    """
    Return the value that a text in YAML or JSON stands for.

    :param name: of its file, for messages
    :raises BadContent: it is no YAML
    """
    try:
        value: object = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise BadContent(f'{name} is no valid YAML: {error}') from error
    return value


def numbers(value: object, place: str) -> list[float]:
    """Return a list of numbers."""
    return [_number(each, place, _ANY) for each in _list(value, place)]


def pose_of(value: object, place: str) -> Pose:
    """Return x, y and yaw of two numbers or more."""
    found = numbers(value, place)
    if len(found) < 2:
        raise BadContent(f'{place} must be x and y, or x, y and yaw, not {shown(value)}')
    x, y, yaw = (*found, 0.0)[:3]
    return x, y, yaw


def _number(value: object, place: str, check: Within) -> float:
    # PyYAML reads 1e6 as text.
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            raise BadContent(f'{place} must be a number, not {shown(value)}') from None
    return check(value, place)


def _list(value: object, place: str) -> Sequence[object]:
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise BadContent(f'{place} must be a list, not {shown(value)}')
    return value


def _unread(value: object, place: str, reads: _Reads) -> Iterator[str]:
    """Yield the places in a value that nobody read, without numbers of entries of lists."""
    if id(value) in reads.settled:
        return
    if isinstance(value, list):
        for each in value:
            yield from _unread(each, f'{place}[]', reads)
    if not isinstance(value, Mapping):
        return
    if id(value) not in reads.keys:
        yield place
        return
    for key, each in value.items():
        here = f'{place}.{key}' if place else str(key)
        if key in reads.keys[id(value)]:
            yield from _unread(each, here, reads)
        elif each not in (None, ''):
            yield here
