# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Replay: steps from a checkpoint of the line in force, with the logged requests at their steps.

Laws: a replay makes the same bits as the first time, from the same checkpoints and with the same
requests; a difference is reported as `divergence`. At each checkpoint on its way, the world moves
into a space that is built from it, as it did the first time.
"""

from __future__ import annotations

from collections.abc import Iterator

from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.node import Keyframe, Moment
from physsim_ros.simulation.past.tree import Tree
from physsim_ros.simulation.world import World


class Replay:
    """
    A world that is sent to moments of the line in force.

    :param world: at a moment of the line, or sent there by `resume`
    :param tree: of all lines
    :param reports: of events without a request, to which it adds

    :ivar serial: number of the last request that was applied
    """

    def __init__(self, world: World, tree: Tree, reports: list[Answer]) -> None:
        self.serial = 0
        self._world = world
        self._tree = tree
        self._reports = reports
        # The checkpoint from which the present space was built.
        self._resumed: Moment | None = None

    @property
    def _here(self) -> Moment:
        """Step and serial of the world as it is."""
        return self._world.step_count, self.serial

    def resume(self, keyframe: Keyframe, *, going_over: bool = False) -> None:
        """
        Go to a keyframe.

        :param going_over: whether the world is at that moment now, with the same bits
        """
        self._world.resume(keyframe.checkpoint, going_over=going_over)
        self.serial = keyframe.serial
        self._resumed = keyframe.moment

    def replay_shown(self, step: int) -> None:
        """Replay up to a step of the line, with the requests with which it was shown."""
        finish(self._replay_to(step, self._tree.serial_shown_at(step)))

    def replay_to(self, moment: Moment) -> None:
        """Replay up to a moment of the line, no earlier than now."""
        finish(self._replay_to(*moment))

    def _replay_to(self, step: int, serial: int) -> Iterator[None]:
        """Replay up to a moment of the line, no earlier than now; yield after each part."""
        world = self._world
        while world.step_count < step:
            yield from self._replay_to_stop(min(step, world.step_count + world.frame_steps))
            yield
        yield from self._apply_logged(serial)

    def _replay_to_stop(self, end: int) -> Iterator[None]:
        """Replay up to the next step with a request or a checkpoint, or to the end."""
        tree, world = self._tree, self._world
        yield from self._apply_logged(tree.serial_at(world.step_count))
        self.enter_checkpoint()
        stop = tree.next_stop(world.step_count, end)
        yield from self._make_steps(stop, is_new=stop > tree.head)
        yield from self._apply_logged(tree.serial_shown_at(world.step_count))

    def _make_steps(self, end: int, *, is_new: bool) -> Iterator[None]:
        """
        Make the steps up to one with a request or a checkpoint; yield where they take long.

        :param is_new: whether the line has not reached them before; else their events were
            reported the first time
        """
        world, tree = self._world, self._tree
        for _ in world.parts_of_steps(end - world.step_count):
            if is_new:
                tree.note_step(world.step_count)
            yield
        lost, broken = world.take_lost(), world.take_broken()
        if is_new:
            tree.note_step(end)
            for name in lost:
                self._report(
                    'divergence', f'{name} left the range of numbers and was removed', name
                )
            for name, force in broken:
                self._report(
                    'joint_broken', f'{name} broke at {force:.3g} N and was removed', name
                )

    def _apply_logged(self, serial: int) -> Iterator[None]:
        """Apply the logged requests of this step up to a serial; yield after each."""
        for node in self._tree.nodes_between(self.serial, serial):
            self.enter_checkpoint()
            try:
                self._world.replay(node.request)
            except Refusal as refusal:
                self._report('divergence', f'a request of the log is refused now: {refusal}')
            self.serial += 1
            yield

    def enter_checkpoint(self) -> None:
        """Move into a space that is built from the checkpoint of this moment, if there is one."""
        keyframe = self._tree.keyframe_at(*self._here)
        if keyframe is not None and self._resumed != keyframe.moment:
            self.resume(keyframe, going_over=self.check_digest())

    def check_digest(self) -> bool:
        """Return whether the world has the digest of the keyframe here; report a difference."""
        keyframe = self._tree.keyframe_at(*self._here)
        same = keyframe is None or self._world.digest() == keyframe.digest
        if not same:
            seconds = self._world.step_count * self._world.dt
            self._report('divergence', f'{seconds:.3f} s was reached with other bits than before')
        return same

    def _report(self, code: str, message: str, subject: str = '') -> None:
        self._reports.append(Answer(topic=code, subject=subject, message=message, code=code))


def finish(parts: Iterator[None]) -> None:
    """Carry out all parts of a work."""
    for _ in parts:
        pass
