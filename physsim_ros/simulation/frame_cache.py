# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What has been shown: kept as far as memory allows, and worked out again beyond that.

Law: a step of the past is shown as it was the first time, to the bit; contacts to a rounding,
since the engine lists them by address and they are summed in its order.

Rewinding through what is kept costs nothing. Beyond it, the steps between two checkpoints are made
again, forward, while those after them are shown, backward.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from physsim_ros.model.snapshot import Answer, Contacts, Snapshot
from physsim_ros.simulation.history import History, Mark
from physsim_ros.simulation.replay import Course
from physsim_ros.simulation.world import World

# Python's own share of a shot [bytes].
_OVERHEAD = 1000
# The memory that a body may take in a shot on average [bytes]: a pose.
_BODY = 24


class Shot(NamedTuple):
    """
    What there was to see after a step.

    :ivar snapshot: where everything was
    :ivar contacts: what touched since the shot before; None where nobody looked
    """

    snapshot: Snapshot
    contacts: Contacts | None

    @property
    def size(self) -> int:
        """Return the memory it takes [bytes]."""
        contacts = 0 if self.contacts is None else self.contacts.nbytes
        return _OVERHEAD + self.snapshot.nbytes + contacts

    def copy(self) -> Shot:
        """Return one without what has been worked out from its snapshot, which stays with that."""
        return self._replace(snapshot=replace(self.snapshot))


class _Reel:
    """The shots between two checkpoints, by step."""

    def __init__(self) -> None:
        self.shots: dict[int, Shot] = {}
        self.size = 0

    def add(self, shot: Shot) -> None:
        old = self.shots.get(shot.snapshot.step)
        self.size += shot.size - (0 if old is None else old.size)
        self.shots[shot.snapshot.step] = shot.copy()

    def has(self, step: int, *, watching: bool) -> bool:
        """Tell whether it has the shot of a step, with contacts if they are wanted."""
        shot = self.shots.get(step)
        return shot is not None and (shot.contacts is not None or not watching)

    def distance(self, step: int) -> int:
        """Return how far a step is from the nearest shot."""
        return max(min(self.shots) - step, step - max(self.shots), 0) if self.shots else step


class Past:
    """
    The shots of a history.

    :param history: of what
    :param physics_rate: of its world [Hz]
    :param frame_steps: steps from one shot to the next, unless finer ones are asked for
    :param budget: memory that may be taken, at most [bytes]; for few bodies it is less, a pose of
        each body for each shot that the history is long
    """

    def __init__(
        self, history: History, *, physics_rate: float, frame_steps: int, budget: int
    ) -> None:
        self._history = history
        self._frame_steps = frame_steps
        self.budget = budget
        self._reels: dict[Mark, _Reel] = {}
        # In the last shot that was kept.
        self._bodies = 0
        # A world that makes the steps again which come next in going back.
        self._course = Course(World(physics_rate=physics_rate, frame_steps=frame_steps), history)
        self._making: _Making | None = None

    @property
    def size(self) -> int:
        """Return the memory that the shots take [bytes]."""
        return sum(reel.size for reel in self._reels.values())

    def take_answers(self) -> list[Answer]:
        """Return what was noticed since the last call."""
        return self._course.take_answers()

    def snapshots(self, end: int, count: int) -> list[Snapshot]:
        """
        Return kept snapshots in the order of time.

        :param end: step of the last one, at most
        :param count: of the last ones, at most
        """
        shots: dict[int, Shot] = {}
        for mark in sorted(self._reels, key=lambda mark: mark.moment):
            shots |= self._reels[mark].shots
        steps = sorted(step for step in shots if step <= end)[-count:]
        return [shots[step].snapshot for step in steps]

    def keep(self, shot: Shot) -> None:
        """Keep a shot of what has just been shown."""
        self._bodies = len(shot.snapshot.poses)
        mark, _ = self._history.segment(shot.snapshot.step)
        self._reels.setdefault(mark, _Reel()).add(shot)
        self._drop(shot.snapshot.step)

    def completed(self, shot: Shot) -> Shot:
        """Return a shot with what touched when the same was shown first, where that is known."""
        step = shot.snapshot.step
        mark, _ = self._history.segment(step)
        old = self._reels[mark].shots.get(step) if mark in self._reels else None
        if old is None or old.contacts is None or not _same(old.snapshot, shot.snapshot):
            return shot
        return Shot(shot.snapshot, old.contacts)

    def forget(self, step: int) -> list[Shot]:
        """Drop the shots from a step on, and return them: it goes on differently from there."""
        self._making = None
        dropped: list[Shot] = []
        for mark in [mark for mark in self._reels if mark.step >= step]:
            dropped += self._reels.pop(mark).shots.values()
        for reel in self._reels.values():
            for number in [number for number in reel.shots if number >= step]:
                shot = reel.shots.pop(number)
                reel.size -= shot.size
                dropped.append(shot)
        return dropped

    def shot(self, step: int, *, watching: bool) -> Shot:
        """
        Return the shot of a step.

        :param watching: whether contacts are wanted
        """
        mark, end = self._history.segment(step)
        reel = self._reels.get(mark)
        if reel is None or not reel.has(step, watching=watching):
            stride = self._frame_steps if step == end or step % self._frame_steps == 0 else 1
            making = self._begin(mark, end, stride, watching=watching)
            making.go_on(end - mark.step)
            reel = self._reels[mark] = making.reel
            self._making = None
            self._drop(step)
        return reel.shots[step].copy()

    def make_ahead(self, step: int, steps: int, *, fine: bool, watching: bool) -> None:
        """
        Make again what comes next in going back, in time for it.

        :param step: that is shown now
        :param steps: to the one that is shown next
        :param fine: whether every step will be wanted
        """
        stride = 1 if fine else self._frame_steps
        # At whole speeds all frames but the first, which may be shorter, go by as many steps.
        apart = 1 if fine else -(-steps // stride) * stride
        gap = self._gap(step, apart, watching=watching)
        if gap is None:
            return
        mark, end = self._history.segment(gap)
        making = self._begin(mark, end, stride, watching=watching)
        frames_left = max(1, (step - gap) // max(1, steps))
        making.go_on(-(-making.left // frames_left))
        if making.left == 0:
            self._reels[mark] = making.reel
            self._making = None
            self._drop(step)

    def _gap(self, step: int, apart: int, *, watching: bool) -> int | None:
        """
        Return the first step that is missing in this reel and the one before; None where none is.

        :param step: from which on to look back
        :param apart: from one wanted step to the next
        """
        mark, _ = self._history.segment(step)
        before, _ = self._history.segment(mark.step)
        for number in range(step - apart, before.step, -apart):
            reel = self._reels.get(mark if number > mark.step else before)
            if reel is None or not reel.has(number, watching=watching):
                return number
        return None

    def _begin(self, mark: Mark, end: int, stride: int, *, watching: bool) -> _Making:
        """Begin to make a reel, or go on with the one that is being made if it suits."""
        making = self._making
        if making is None or not making.suits(mark, end, stride, watching=watching):
            self._course.world.watching = watching
            making = self._making = _Making(self._course, mark, end, stride)
        return making

    def _drop(self, step: int) -> None:
        """Drop the reels that are farthest away, until the rest fits."""
        size = self.size
        poses = self._history.length // self._frame_steps * self._bodies
        budget = min(self.budget, poses * _BODY)
        # Never the one that is shown, nor those before and after it.
        while size > budget and len(self._reels) > 3:
            farthest = max(self._reels, key=lambda mark: self._reels[mark].distance(step))
            size -= self._reels.pop(farthest).size


class _Making:
    """
    A reel that is being made again.

    :param course: that makes it
    :param mark: the checkpoint it begins with
    :param end: its last step
    :param stride: steps from one shot to the next
    """

    def __init__(self, course: Course, mark: Mark, end: int, stride: int) -> None:
        self.mark = mark
        self.reel = _Reel()
        self._course = course
        self._end = end
        self._stride = stride
        self._watching = course.world.watching
        course.resume(mark)
        course.show(mark.step)
        self._shoot()

    def suits(self, mark: Mark, end: int, stride: int, *, watching: bool) -> bool:
        """Tell whether it goes from a checkpoint to a step, with all the shots that are wanted."""
        same = self.mark == mark and self._end == end
        return same and self._stride <= stride and (self._watching or not watching)

    @property
    def left(self) -> int:
        """Return how many steps are to be made yet."""
        return self._end - self._course.world.step_count

    def go_on(self, steps: int) -> None:
        """Make so many more steps, or what is left of them."""
        course = self._course
        goal = min(self._end, course.world.step_count + steps)
        while (at := course.world.step_count) < goal:
            stop = min(self._end, at - at % self._stride + self._stride)
            course.show(stop)
            self._shoot()
        if self.left == 0:
            course.verify()

    def _shoot(self) -> None:
        world = self._course.world
        snapshot = world.snapshot()
        self.reel.add(Shot(snapshot, world.contacts(snapshot) if world.watching else None))


def _same(one: Snapshot, other: Snapshot) -> bool:
    """Tell whether the same bodies are in the same places."""
    return one.scene.names == other.scene.names and np.array_equal(one.poses, other.poses)
