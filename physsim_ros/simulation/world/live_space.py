# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The space that a world steps, and the spaces that replace it at checkpoints.

Law: a world that continues from its checkpoint and one that resumes it later make the same bits.
The engine has a state that cannot be read, such as the order in which it found contacts; a space
that is built from a checkpoint has no such state. So at each checkpoint the world itself moves
into a space that is built from it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator
from dataclasses import replace
from functools import partial
import math
from typing import NamedTuple

from physsim_ros.engine.checkpoint import (
    BodyPool,
    slices_of_freeing,
    slices_of_restore,
    take_checkpoint,
)
from physsim_ros.engine.core import sub_step_of
from physsim_ros.engine.saved_state import begin_at, checkpoint_of, saved_state
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.latency import delay
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.transform import Point
from physsim_ros.runtime.garbage_collection import suspended_collection
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.world.capacity import Capacity, check_state

# Difference within which a number of steps, the product of a time and a rate, is whole [1], and
# that within which a time is the same, by its size [1]: the rounding of doubles.
_WHOLE, _ROUNDING = 1e-9, 1e-15
# Greatest number of spaces that wait to be freed: as many as an impatient person replaces by undo
# and redo in the time in which one is freed.
_MOST_FREEING = 3
# In place of a slice, where none is left.
_FREED = object()


class LiveSpace:
    """
    The space that a world steps, and the number of its steps: what a handler of requests may use.

    :param settings: of the world
    :param physics_rate: steps a second of simulation time [Hz]

    :ivar dt: duration of a step [s]
    :ivar step_count: number of steps since the world began
    :ivar space: the present space
    :ivar capacity: checks what is added to that space
    """

    def __init__(self, settings: WorldSettings, physics_rate: float) -> None:
        self.physics_rate = physics_rate
        self.dt = 1.0 / physics_rate
        self._sub_step = sub_step_of(physics_rate)
        self.step_count = 0
        # The beginning that was built last, which only its state can use.
        self._built: Beginning | None = None
        self._fresh: Beginning | None = None
        self._pool = BodyPool()
        # Each frees a space that was replaced, the first one first.
        self._freeing: deque[Iterator[None]] = deque()
        self._replace(Space(settings, self._sub_step), self._pool)

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self.space.settings

    def begin_of_command(self, name: str, latency: Point, command_rate: float) -> int:
        """
        Return the step at which a drive or a motor obeys a command that is given now.

        :param name: of its body or joint
        :param latency: least and greatest time that the command is on its way [s]
        :param command_rate: looks for a command in a second [Hz]; 0 is each step
        """
        begun, rate = self.step_count, self.physics_rate
        seconds = delay(latency, self.space.settings.seed, f'command of {name}', begun)
        if seconds > 0.0:
            begun += steps_covering(seconds, rate)
        if command_rate > 0.0:
            # The first look at or after that step.
            look = math.ceil(begun * command_rate / rate - _WHOLE)
            begun = math.ceil(look * rate / command_rate - _WHOLE)
        return begun

    def step_after(self, seconds: float) -> int | None:
        """Return the step at which a time from now on has passed [s]; None for 0: never."""
        if seconds <= 0.0:
            return None
        return self.step_count + steps_covering(seconds, self.physics_rate)

    def saver(self) -> Callable[[], WorldState]:
        """Return a function that returns, on any thread, the saved state of this moment."""
        checkpoint, rate = take_checkpoint(self.space, self.step_count), self.physics_rate
        state = partial(saved_state, checkpoint, dt=self._sub_step)
        return lambda: replace(state(), physics_rate=rate)

    @suspended_collection()
    def renew(self) -> Checkpoint:
        """
        Move into a space that is built from a checkpoint of this moment; return that checkpoint.

        A world that resumes it later continues with the same bits.
        """
        return finish(self.slices_of_renewal())

    def slices_of_renewal(self) -> Generator[None, None, Checkpoint]:
        """Do as `renew` in slices, before whose end nothing else is done; yield after each."""
        if self._fresh is not None and self._fresh.is_unchanged(self.space, self.step_count):
            return self._fresh.checkpoint
        checkpoint = take_checkpoint(self.space, self.step_count)
        # A seek may replace this work: the bodies then stay in the unfinished space.
        pool, self._pool = self._pool.bodies, BodyPool()
        space = yield from slices_of_restore(checkpoint, self._sub_step, pool=pool)
        space.copy_reports(self.space)
        self._replace(space, BodyPool(self.space))
        return checkpoint

    @suspended_collection()
    def resume(self, checkpoint: Checkpoint) -> None:
        """Go back, or forward, to a checkpoint."""
        finish(self.slices_of_resumption(checkpoint))

    def slices_of_resumption(
        self, checkpoint: Checkpoint, *, going_over: bool = False
    ) -> Generator[None]:
        """
        Do as `resume` in slices; yield after each.

        :param going_over: whether the world is at that moment now, with the same bodies; the
            contacts of the unfinished frame are kept then
        """
        space = yield from slices_of_restore(checkpoint, self._sub_step)
        old, pool = self.space, self._pool
        if going_over:
            space.copy_reports(old)
        self._replace(space, BodyPool())
        self.step_count = checkpoint.step
        self._retire(old, pool)

    def keep_built(self, beginning: Beginning) -> None:
        """Have the world, when it next begins with the state of a beginning, use that."""
        self._built = beginning

    def slices_of_beginning(self, state: WorldState) -> Generator[None]:
        """Build ahead the beginning with a state at this step; yield after each slice."""
        self._built = yield from _slices_of_beginning(state, self.step_count, self._sub_step)

    def begin(self, state: WorldState, step: int) -> None:
        """
        Replace the space by one that begins with a saved state, as it was built ahead.

        :param step: number of steps that the world has made then
        :raises WorldFull: the state is too large; nothing is changed
        """
        built, self._built = self._built, None
        if built is not None and built.state is state:
            beginning = built.at(step)
        else:
            if self.capacity.checking:
                check_state(state)
            beginning = finish(_slices_of_beginning(state, step, self._sub_step))
        old, pool = self.space, self._pool
        self._replace(beginning.space, BodyPool(), beginning)
        self.step_count = step
        self._retire(old, pool)

    def _retire(self, space: Space, pool: BodyPool) -> None:
        """Have a space that was replaced be freed in slices."""
        if len(self._freeing) == _MOST_FREEING:
            # At once: it goes with the last reference to it.
            self._freeing.popleft()
        self._freeing.append(slices_of_freeing(space, pool))
        self.free_slice()

    def free_slice(self) -> None:
        """Free a slice of the spaces that were replaced."""
        while self._freeing and next(self._freeing[0], _FREED) is _FREED:
            self._freeing.popleft()

    @property
    def is_built_ahead(self) -> bool:
        """Return whether all bodies for the next `renew` are built, of the scene of now."""
        return self._pool.is_complete(self.space.table.scene)

    def build_bodies(self, count: int) -> None:
        """Build bodies for the next `renew`, of about a number of pieces."""
        self._pool.build_bodies(self.space.table.scene, count)

    def _replace(self, space: Space, pool: BodyPool, fresh: Beginning | None = None) -> None:
        self.space, self.capacity = space, Capacity(space)
        self._pool, self._fresh = pool, fresh


class Beginning(NamedTuple):
    """
    The checkpoint of a loaded state, and the space that was built from it.

    :ivar state: that was loaded
    :ivar changes: count of changes of that space when it was built
    """

    state: WorldState
    checkpoint: Checkpoint
    space: Space
    changes: int

    def at(self, step: int) -> Beginning:
        """Have the space, which has made no step, begin at one; return that beginning."""
        if step == self.checkpoint.step:
            return self
        return self._replace(checkpoint=begin_at(self.space, self.checkpoint, self.state, step))

    def is_unchanged(self, space: Space, step: int) -> bool:
        """Return whether a space at a step is this one, unchanged."""
        as_built = self.space is space and space.age == 0 and space.changes == self.changes
        return as_built and self.checkpoint.step == step


def beginning_of(state: WorldState, physics_rate: float) -> Beginning:
    """
    Return the beginning of a world at time 0, on any thread.

    :param physics_rate: of the world [Hz]
    :raises WorldFull: the state is too large
    """
    check_state(state)
    with suspended_collection():
        return finish(_slices_of_beginning(state, 0, sub_step_of(physics_rate)))


def _slices_of_beginning(
    state: WorldState, step: int, sub_step: float
) -> Generator[None, None, Beginning]:
    checkpoint = checkpoint_of(state, step, sub_step)
    # The digest of the first keyframe has it.
    _ = checkpoint.scene.key
    space = yield from slices_of_restore(checkpoint, sub_step)
    return Beginning(state, checkpoint, space, space.changes)


def steps_covering(seconds: float, physics_rate: float) -> int:
    """
    Return the number of steps that cover a time [s], at least one.

    :param physics_rate: of the world [Hz]
    """
    # Subtract a tolerance, so that 0.1 s at 240 Hz gives 24 steps, not 25.
    return max(1, math.ceil(seconds * physics_rate * (1.0 - _ROUNDING) - _WHOLE))
