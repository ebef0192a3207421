# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The records of a history: logged requests, checkpoints, and tails of both.

Law: each knows the memory that it takes; it is estimated once, when the record is made.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from physsim_ros.model.checkpoint import Checkpoint
from physsim_ros.model.requests import Request

# A step, and the number of requests made until then.
Moment = tuple[int, int]


def is_beyond(moment: Moment, end: Moment) -> bool:
    """
    Return whether a history up to an end does not have a moment.

    Tuples do not tell: after an undo a world reaches later steps with fewer requests.
    """
    return moment[0] > end[0] or moment[1] > end[1]


@dataclass(slots=True, eq=False)
class Entry:
    """
    A request that changed the world.

    :param step: at which it did
    :param request: that was applied
    :param gesture: requests of one gesture are undone together
    :param shown: whether that step has been shown with it; a request to a running world shows only
        in the next frame
    :param subject: name of the body or joint concerned, or ''
    :param size: memory that the log takes for it [bytes]
    """

    step: int
    request: Request
    gesture: int
    shown: bool = False
    subject: str = ''
    size: int = 0


class Mark(NamedTuple):
    """
    A checkpoint and its moment.

    :ivar step: of the checkpoint
    :ivar serial: number of requests made until then
    :ivar key: the checkpoint
    :ivar digest: of the world then
    :ivar size: memory that it takes [bytes]
    """

    step: int
    serial: int
    key: Checkpoint
    digest: str
    size: int = 0

    @property
    def moment(self) -> Moment:
        """Return step and serial."""
        return self.step, self.serial


class Tail(NamedTuple):
    """
    The part of a history after a moment, cut off by an undo or by a branch.

    :ivar after: moment of the last checkpoint before it
    :ivar entries: the requests, the undone ones first
    :ivar marks: checkpoints after them
    :ivar head: the last step that the world had reached
    :ivar step: at which it was cut off, and
    :ivar serial: number of requests made until then
    """

    after: Moment
    entries: tuple[Entry, ...]
    marks: tuple[Mark, ...]
    head: int
    step: int
    serial: int

    @property
    def size(self) -> int:
        """Return the memory that it takes [bytes]."""
        return total_size(self.entries) + total_size(self.marks)


def total_size(parts: Iterable[Entry] | Iterable[Mark]) -> int:
    """Return the memory that requests or checkpoints take [bytes]."""
    return sum(part.size for part in parts)
