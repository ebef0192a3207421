# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The answer to a seek, or to a call that has sent the world elsewhere.

Law: it is told once: when the moment can be shown, or when the world is sent elsewhere before.
"""

from __future__ import annotations

from collections.abc import Callable

from physsim_ros.model.translation import NOTHING, Text
from physsim_ros.simulation.entries import superseded
from physsim_ros.simulation.playback import Playback


class Arrival:
    """
    The answer that waits until the moment that was sought last can be shown.

    :param playback: the moment that is shown
    """

    def __init__(self, playback: Playback) -> None:
        self._playback = playback
        self._tell: Callable[[Text], object] | None = None

    def expect(self, tell: Callable[[Text], object]) -> None:
        """
        Have an answer wait.

        :param tell: called once, with the message that it was superseded, or '' where it was not
        """
        self._tell = tell

    def tell_if_there(self) -> None:
        """Tell the answer that waits, if its moment is reached."""
        if self._tell is not None and self._playback.has_arrived:
            self._end()

    def supersede(self, by: str) -> None:
        """
        Tell the answer that waits as superseded: the world has been sent elsewhere.

        :param by: what has done so
        """
        self._end(superseded(by, self._playback.time))

    def _end(self, message: Text = NOTHING) -> None:
        tell, self._tell = self._tell, None
        if tell is not None:
            tell(message)
