# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A topic of commands for a robot: of what comes between two frames the last one counts.

Law: of commands that are refused for one reason in a row, the first is told.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from physsim_ros.model.requests import Request

# Bound of a message [bytes]: a trajectory of 1,000 points of 30 joints.
MOST_BYTES = 2**20

# Commands in a row that are carried out before a refusal of a code that was told is told again:
# some seconds at the usual 10 to 30 Hz, so that a publisher that errs now and then does not flood.
_STEADY = 50


class CommandTopic(ABC):
    """
    A topic of commands.

    :param topic: its name

    :ivar topic: its name
    """

    def __init__(self, topic: str) -> None:
        self.topic = topic
        # Codes of refusals that were told, and number of commands carried out since the last one.
        self._told: set[str] = set()
        self._carried_out = 0

    @abstractmethod
    def take(self) -> Request | None:
        """
        Return the request of the last command since the last call; None where none came.

        :raises Refusal: it cannot be decoded, or asks for what cannot be
        """

    @abstractmethod
    def close(self) -> None:
        """Unsubscribe."""

    def note_refused(self, code: str) -> bool:
        """Note a refused command; return whether it is to be told: the first of its code."""
        self._carried_out = 0
        told = code in self._told
        self._told.add(code)
        return not told

    def note_carried_out(self) -> None:
        """Note a command that was carried out."""
        self._carried_out += 1
        if self._carried_out == _STEADY:
            self._told.clear()
