# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A replay that goes to any moment of its history, bit by bit.

Laws: a seek that is under way counts as done: moment and settings are those of its goal, and who
asks for the world finishes it; another seek takes its place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.requests import Configure, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.tree import Moment
from physsim_ros.simulation.world import World


class _Seek(NamedTuple):
    """
    A way through the past that is not finished.

    :ivar begin: moment from which on contacts are those of the goal's frame; None: it is reached
    :ivar goal: moment that is shown
    :ivar with_contacts: whether the contacts of that frame are yet to be shown
    """

    begin: Moment | None
    goal: Moment
    with_contacts: bool


class SeekableReplay(Replay):
    """
    A world that goes to moments of its history, no further than that reaches.

    :param world: at the moment of one of its checkpoints, or to be sent there by `resume`
    :param history: that is replayed
    """

    def __init__(self, world: World, history: History) -> None:
        super().__init__(world, history)
        self._seek: _Seek | None = None

    @property
    def world(self) -> World:
        """Return the world, at this moment."""
        self.continue_seek()
        return self._world

    @property
    def is_seeking(self) -> bool:
        """Whether a seek is under way."""
        return self._seek is not None

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at this moment."""
        if self._seek is None:
            return self._world.settings
        goal = self._seek.goal
        keyframe = self.history.keyframe_before(*goal)
        settings = keyframe.checkpoint.scene.settings
        for node in self.history.nodes_between(keyframe.serial, goal[1]):
            match node.request:
                case Configure(changes=changes):
                    settings = replace(settings, **changes)
                case Restore(state=state):
                    settings = state.settings
        return settings

    @property
    def moment(self) -> Moment:
        """Return step and serial, those of the goal while a seek is under way."""
        return super().moment if self._seek is None else self._seek.goal

    def seek(self, step: int, *, with_contacts: bool = True) -> None:
        """
        Go to a step of the history, as it was shown.

        :param with_contacts: whether the contacts of its frame are yet to be shown

        :raises OutOfHistory: it is kept no more, or has not come yet
        """
        history, dt = self.history, self._world.dt
        if not history.oldest <= step <= history.head:
            raise OutOfHistory(
                f'{step * dt:.3f} s is not in the history, which reaches from '
                f'{history.oldest * dt:.3f} to {history.head * dt:.3f} s',
                field='clock',
            )
        moment = step, history.serial_shown_at(step)
        self.seek_moment(*moment, with_contacts=with_contacts)

    def seek_moment(
        self, step: int, serial: int, *, with_contacts: bool = True, elsewhere: bool = False
    ) -> None:
        """
        Go to a moment of the past, from the nearest checkpoint or from here.

        :param elsewhere: whether the world is on another line now
        """
        history, frame = self.history, self._world.frame_steps
        # Its contacts are those of one frame, as they were the first time.
        begin = max(history.oldest, step - (step % frame or frame))
        start = begin, history.serial_shown_at(begin)
        first = (step, serial)
        if self._world.reports_contacts:
            first = min(first, start)
        keyframe = history.keyframe_before(*first)
        # A seek that this one takes the place of has come to a moment of the history, too.
        if elsewhere or not keyframe.moment <= super().moment <= first:
            self.resume(keyframe)
        self._seek = _Seek(min(start, (step, serial)), (step, serial), with_contacts)

    def continue_seek(self, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Replay towards the moment that was sought.

        :param is_overdue: whether to go on another time
        :return: whether the world is there
        """
        seek, self._seek = self._seek, None
        if seek is None:
            return True
        done = seek.begin is None or self.replay_to(*seek.begin, is_overdue)
        if done and seek.begin is not None:
            self._world.clear_contacts()
            seek = seek._replace(begin=None)
        if not done or not self.replay_to(*seek.goal, is_overdue):
            self._seek = seek
            return False
        if not seek.with_contacts:
            self._world.clear_contacts()
        return True
