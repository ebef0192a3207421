# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
History memory: the budget of the past in bytes.

Law: when the budget is spent, the oldest entries are dropped, in this order of kinds: frames of
the course in force, which a replay makes again; ghosts; courses that were left; lines that were
undone; lines before resets; last, the oldest checkpoint of the course in force, with the requests
up to the next one. The last checkpoint, the requests after it, and the frames beside the one that
is shown always remain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from physsim_ros.model.checks import Within
from physsim_ros.model.snapshot import Answer

# Bytes of a megabyte.
MEGABYTE = 10**6
# Least and greatest budget [MB]: a second of a few hundred commands; a large machine.
LEAST_MEMORY, MOST_MEMORY = 1.0, 1e6
# Default budget [MB].
DEFAULT_MEMORY = 256.0
# Share of the budget from which the requests after a checkpoint make the next one due [1], so that
# the history has at least eight parts that can be dropped.
_LOG_SHARE = 1 / 8
# Share of the budget for frames [1]: 64 MB of 256, three minutes of 100 bodies. More saves little,
# since a rewind replays ahead of the frame that is shown.
_FRAME_SHARE = 1 / 4
# Share of the budget below which the next loss is reported again [1].
_RELIEF = 1 / 2


class HistoryMemory:
    """
    The budget of the past.

    :param megabytes: the budget [MB]
    :raises BadProperty: it is out of range
    :raises Malformed: it is not a finite number

    :ivar used: memory of the past at the last count [bytes]
    """

    def __init__(self, megabytes: float) -> None:
        self.used = 0
        self.megabytes = megabytes

    @property
    def megabytes(self) -> float:
        """Return the budget [MB]."""
        return self._megabytes

    @megabytes.setter
    def megabytes(self, megabytes: float) -> None:
        self._megabytes = Within(LEAST_MEMORY, MOST_MEMORY, 'MB')(megabytes, 'history_memory')
        self._told = False

    @property
    def size(self) -> int:
        """Return the budget [bytes]."""
        return round(self._megabytes * MEGABYTE)

    @property
    def in_megabytes(self) -> tuple[float, float]:
        """Return the memory of the past at the last count, and the budget [MB]."""
        return self.used / MEGABYTE, self._megabytes

    @property
    def log_limit(self) -> int:
        """Return the memory of requests from which a checkpoint is due [bytes]."""
        return round(self.size * _LOG_SHARE)

    @property
    def frame_limit(self) -> int:
        """Return the budget of frames [bytes]."""
        return round(self.size * _FRAME_SHARE)

    def fit(self, used: Callable[[], int], kinds: Sequence[Callable[[], object]]) -> bool:
        """
        Drop the oldest entries until everything fits.

        :param used: returns the memory of the past [bytes]
        :param kinds: functions that drop the oldest entry of a kind, and return whether there was
            one; in their order, the first for frames that a replay makes again
        :return: whether other entries than frames were lost; once, until less than half of the
            budget is used
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
        Return the event that the past was shortened.

        :param oldest: oldest time of the course in force that is kept [s]
        """
        message = (
            f'the past would take more than {self._megabytes:g} MB (history_memory): the oldest '
            f'goes, {oldest:.3f} s is the oldest that is kept'
        )
        return Answer(topic='history', message=message, code='history')
