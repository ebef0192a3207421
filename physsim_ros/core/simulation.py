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
The one door to the core: requests and steady time go in, frames come out.

Laws: requests are carried out in the order of their arrival and only between frames; every one is
answered; a paused world carries them out too.
"""

from __future__ import annotations

from collections import deque

from physsim_ros.core.clock import Clock
from physsim_ros.core.errors import BadProperty, Refusal
from physsim_ros.core.requests import Command, Delete, Join, Request, Restore, Spawn, Unjoin
from physsim_ros.core.settings import WorldSettings
from physsim_ros.core.snapshot import Answer, Frame, WorldState
from physsim_ros.core.world import World

# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2


class Simulation:
    """
    A world and its time.

    :param physics_rate: steps a second of simulation time [Hz], a multiple of publish_rate
    :param publish_rate: frames a second of simulation time at speed 1 [Hz]
    :param settings: of the empty world at the start
    :param speed: simulation seconds a second; 0 is paused
    :raises BadProperty: publish_rate does not divide physics_rate
    """

    def __init__(
        self,
        *,
        physics_rate: float = 240.0,
        publish_rate: float = 60.0,
        settings: WorldSettings | None = None,
        speed: float = 1.0,
    ) -> None:
        steps = physics_rate / publish_rate
        if steps < 1 or abs(steps - round(steps)) > 1e-9:
            raise BadProperty(
                f'publish_rate {publish_rate:g} Hz does not divide physics_rate '
                f'{physics_rate:g} Hz',
                field='publish_rate',
            )
        self.frame_steps = round(steps)
        self.world = World(physics_rate=physics_rate, settings=settings)
        self._beginning = self.world.save()
        self._clock = Clock(physics_rate=physics_rate, frame_steps=self.frame_steps, speed=speed)
        self._requests: deque[tuple[Request | Refusal, str, str]] = deque()
        self._answers: list[Answer] = []
        self._changed = True

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused."""
        return self._clock.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self._clock.speed = speed

    @property
    def late_frames(self) -> int:
        """Count of frames that the machine could not make in time."""
        return self._clock.late_frames

    def watch_contacts(self, watching: bool) -> None:  # noqa: FBT001 - a state, not a mode
        """Have the frames tell what touches, or save the cost of it."""
        self.world.watching = watching

    def submit(self, request: Request, *, topic: str) -> None:
        """Queue a request; nothing moves until the next frame, which carries the answer."""
        subject = ''
        match request:
            case (
                Spawn(name=subject)
                | Delete(name=subject)
                | Join(name=subject)
                | Unjoin(name=subject)
                | Command(names=(subject,))
            ):
                pass
        self._requests.append((request, topic, subject))

    def refuse(self, refusal: Refusal, *, topic: str, subject: str) -> None:
        """Queue the answer to what could not even be a request, so that answers keep the order."""
        self._requests.append((refusal, topic, subject))

    def perform(self, request: Request) -> str:
        """
        Carry out a request now, after those that wait, and say what was done.

        :raises Refusal: and nothing is changed
        """
        self._apply_all()
        message = self.world.apply(request)[1]
        self._changed = True
        return message

    def load(self, state: WorldState) -> str:
        """Replace the world by a state, to which `reset` will return; time goes on."""
        message = self.perform(Restore(state=state))
        self._beginning = state
        return message

    def reset(self) -> str:
        """Return to the state that was loaded last, at time 0."""
        self._apply_all()
        watching = self.world.watching
        self.world = World(physics_rate=self.world.physics_rate)
        self.world.watching = watching
        self.world.apply(Restore(state=self._beginning))
        self._clock.restart()
        self._changed = True
        return 'back at the beginning, time 0'

    def advance(self, now_ns: int) -> tuple[Frame, ...]:
        """
        Carry out what was asked, and go on by what is due.

        :param now_ns: steady time, never going back [ns]
        :return: the frames, oldest first; none where nothing is due and nothing has changed
        """
        self._apply_all()
        frames = []
        for _ in range(_FRAMES_A_CALL):
            steps = self._clock.due(now_ns, self.world.step_count)
            if steps == 0:
                break
            frames.append(self._go(steps))
        if not frames and self._changed:
            frames.append(self._frame(moved=False))
        return tuple(frames)

    def settle(self) -> Frame | None:
        """Carry out what was asked without going on; return a frame if there was anything."""
        self._apply_all()
        return self._frame(moved=False) if self._changed else None

    def advance_frame(self) -> Frame:
        """Carry out what was asked, and go on by one publish period, whatever the speed."""
        self._apply_all()
        self._clock.restart()
        return self._go(self.frame_steps - self.world.step_count % self.frame_steps)

    def _apply_all(self) -> None:
        while self._requests:
            request, topic, subject = self._requests.popleft()
            self._changed = True
            try:
                if isinstance(request, Refusal):
                    raise request
                subject, message = self.world.apply(request)
            except Refusal as refusal:
                answer = Answer.refused(refusal, topic=topic, subject=subject)
            else:
                answer = Answer(topic=topic, subject=subject, message=message)
            self._answers.append(answer)

    def _tell_broken(self) -> None:
        for name, force in self.world.take_broken():
            self._answers.append(
                Answer(
                    topic='joint_broken',
                    subject=name,
                    message=f'{name} broke at {force:.3g} N and was removed',
                    code='joint_broken',
                )
            )

    def _go(self, steps: int) -> Frame:
        for name in self.world.step(steps):
            self._answers.append(
                Answer(
                    topic='divergence',
                    subject=name,
                    message=f'{name} left the range of numbers and was removed',
                    code='divergence',
                )
            )
        self._tell_broken()
        return self._frame(moved=True)

    def _frame(self, *, moved: bool) -> Frame:
        snapshot = self.world.snapshot()
        frame = Frame(
            snapshot=snapshot,
            contacts=self.world.contacts(snapshot) if self.world.watching else None,
            answers=tuple(self._answers),
            speed=self.speed,
            moved=moved,
        )
        self._answers.clear()
        self._changed = False
        return frame
