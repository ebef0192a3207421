# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
History memory: the budget of the past in bytes, one for all of its stores.

Law: when it is spent the oldest goes, and the least of it first: what can be computed again, what
is only shown, what is not in force, and last the past of the course in force.

In this order: frames of that course, which a replay makes again; ghosts; courses that were left,
the one first that was left first; what was undone; what was before resets; the oldest checkpoint
of the course in force with the requests up to the next one. What always remains: the last
checkpoint, the requests after it, and the frames beside the one that is shown.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from physsim_ros.model.checks import Within
from physsim_ros.model.snapshot import Answer

# Bytes of a megabyte.
MEGABYTE = 10**6
# Least and greatest memory of the past [MB]: a second of a few hundred commands; a large machine.
LEAST_MEMORY, MOST_MEMORY = 1.0, 1e6
# Memory of the past when nothing is said [MB].
DEFAULT_MEMORY = 256.0
# Share of the budget for the requests after a checkpoint, from which on the next one is due:
# eight or more parts can be dropped one by one.
_LOG_SHARE = 1 / 8
# Share of the budget for frames: 64 MB of 256, three minutes of 100 bodies; more than that saves
# little, since a rewind beyond it replays ahead of what it shows.
_FRAME_SHARE = 1 / 4
# Share of the budget below which the next loss is news again.
_RELIEF = 1 / 2


class HistoryMemory:
    """
    The budget of the past.

    :param megabytes: memory that it may take [MB]
    :raises BadProperty: that is out of range
    :raises Malformed: it is not a finite number

    :ivar used: memory that was taken at the last count [bytes]
    """

    def __init__(self, megabytes: float) -> None:
        self.used = 0
        self.megabytes = megabytes

    @property
    def megabytes(self) -> float:
        """Return the memory that it may take [MB]."""
        return self._megabytes

    @megabytes.setter
    def megabytes(self, megabytes: float) -> None:
        self._megabytes = Within(LEAST_MEMORY, MOST_MEMORY, 'MB')(megabytes, 'history_memory')
        self._told = False

    @property
    def size(self) -> int:
        """Return the memory that it may take [bytes]."""
        return round(self._megabytes * MEGABYTE)

    @property
    def in_megabytes(self) -> tuple[float, float]:
        """Return the memory that the past took at the last count, and its budget [MB]."""
        return self.used / MEGABYTE, self._megabytes

    @property
    def log_limit(self) -> int:
        """Return the memory of requests from which on a checkpoint is due [bytes]."""
        return round(self.size * _LOG_SHARE)

    @property
    def frame_limit(self) -> int:
        """Return the memory that frames may take [bytes]."""
        return round(self.size * _FRAME_SHARE)

    def fit(self, used: Callable[[], int], kinds: Sequence[Callable[[], object]]) -> bool:
        """
        Drop the oldest until everything fits.

        :param used: returns the memory that is taken [bytes]
        :param kinds: each drops the oldest of its kind, and returns whether there was any; in the
            order in which they go, the first being frames that a replay makes again
        :return: whether anything but these was lost, once until less than half is taken again
        """
        self.used = used()
        self._told = self._told and self.used > _RELIEF * self.size
        lost = False
        for drop in kinds:
            while self.used > self.size and drop():
                self.used = used()
                lost |= drop != kinds[0]
        news = lost and not self._told
        self._told |= lost
        return news

    def report(self, oldest: float) -> Answer:
        """
        Return the event that something was lost.

        :param oldest: time that is kept of the course in force [s]
        """
        message = (
            f'the past would take more than {self._megabytes:g} MB (history_memory): the oldest '
            f'goes, {oldest:.3f} s is the oldest that is kept'
        )
        return Answer(topic='history', message=message, code='history')
