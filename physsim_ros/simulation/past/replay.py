# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Replay: a world makes the steps of its history again.

Law: a replay makes the same steps, from the same checkpoints and with the same requests, and so
the same bits; a difference is reported.
"""

from __future__ import annotations

from collections.abc import Callable

from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.tree import Keyframe, Moment
from physsim_ros.simulation.world import World


class Replay:
    """
    A world that replays a history; it makes no checkpoints and takes no new requests.

    :param world: at the moment of a checkpoint, or sent there by `resume`
    :param history: that is replayed
    :param reports: of events without a request, to which it adds
    """

    def __init__(self, world: World, history: History, reports: list[Answer]) -> None:
        self._world = world
        self.history = history
        # Serial of the last request that was applied.
        self.serial = 0
        self._resumed: Moment | None = None
        self._reports = reports

    @property
    def world(self) -> World:
        """Return the world."""
        return self._world

    @property
    def moment(self) -> Moment:
        """Return step and serial."""
        return self._world.step_count, self.serial

    def resume(self, keyframe: Keyframe, *, going_over: bool = False) -> None:
        """
        Go to a keyframe.

        :param going_over: whether the world is at that moment now, with the same bits
        """
        self._world.resume(keyframe.checkpoint, going_over=going_over)
        self.serial = keyframe.serial
        self._resumed = keyframe.moment

    def replay_to(
        self, step: int, serial: int, is_overdue: Callable[[], bool] = lambda: False
    ) -> bool:
        """
        Replay up to a moment of the past, no earlier than now.

        :param is_overdue: whether to continue in another call; asked after each frame and request
        :return: whether the moment is reached
        """
        world = self._world
        while world.step_count < step:
            end = min(step, world.step_count + world.frame_steps)
            if not self._replay_to_stop(end, is_overdue) or is_overdue():
                return False
        return self._apply_logged(serial, is_overdue)

    def replay_shown(self, step: int) -> None:
        """Replay up to a step of the past, with the requests with which it was shown."""
        self.replay_to(step, self.history.serial_shown_at(step))

    def _replay_to_stop(self, end: int, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Replay up to the next step with a request or a checkpoint, or to the end.

        :return: whether all requests with which that step was shown are applied
        """
        history, world = self.history, self._world
        if not self._apply_logged(history.serial_at(world.step_count), is_overdue):
            return False
        self._enter_checkpoint()
        self._make_steps(end)
        return self._apply_logged(history.serial_shown_at(world.step_count), is_overdue)

    def _make_steps(self, end: int) -> None:
        step = self._world.step_count
        stop = self.history.next_stop(step, end)
        lost, broken = self._world.step(stop - step), self._world.take_broken()
        # In a replay, events were reported the first time.
        if stop > self.history.head:
            for name in lost:
                self._report(
                    'divergence', f'{name} left the range of numbers and was removed', name
                )
            for name, force in broken:
                self._report(
                    'joint_broken', f'{name} broke at {force:.3g} N and was removed', name
                )

    def _apply_logged(self, serial: int, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """Apply the logged requests of this step up to a serial; return whether it is reached."""
        for node in self.history.nodes_between(self.serial, serial):
            self._enter_checkpoint()
            try:
                self._world.replay(node.request)
            except Refusal as refusal:
                self._report('divergence', f'a request of the log is refused now: {refusal}')
            self.serial += 1
            if is_overdue() and self.serial < serial:
                return False
        return True

    def _enter_checkpoint(self) -> None:
        """Move into a space that is built from the checkpoint of this moment, if there is one."""
        keyframe = self.history.keyframe_at(*self.moment)
        if keyframe is not None and self._resumed != keyframe.moment:
            self.resume(keyframe, going_over=self.check_digest())

    def check_digest(self) -> bool:
        """Return whether the world has the digest of the keyframe here; report a difference."""
        keyframe = self.history.keyframe_at(*self.moment)
        same = keyframe is None or self._world.digest() == keyframe.digest
        if not same:
            seconds = self._world.step_count * self._world.dt
            self._report('divergence', f'{seconds:.3f} s was reached with other bits than before')
        return same

    def _report(self, code: str, message: str, subject: str = '') -> None:
        self._reports.append(Answer(topic=code, subject=subject, message=message, code=code))
