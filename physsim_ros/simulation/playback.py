# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Playback: the moment that is shown, forward and back.

Laws: a rewind or a seek shows a cached frame while the world is at another step. The world goes to
the step that is shown before a request is applied, a step is made or the world is read, and while
playback is paused. After a jump to another course the state of the world is shown, not a cached
frame. Where contacts are reported, the frame of a paused world has those of its last steps.
"""

from __future__ import annotations

from collections.abc import Callable

from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import NO_CONTACTS
from physsim_ros.simulation.clock import Clock
from physsim_ros.simulation.past.frame_cache import CachedFrame
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.past.tree import Moment
from physsim_ros.simulation.world import World


class Playback:
    """
    The moment that is shown.

    :param past: with the timeline
    :param speed: simulation seconds a second; 0 is paused, negative goes back

    :ivar clock: the speed, and the steps that are due
    :ivar changed: whether the next frame differs from the last one without a step
    :ivar frames_due: count of single frames to be made in a paused world, one in each call
    """

    def __init__(self, past: Past, *, speed: float) -> None:
        self.clock = Clock(
            physics_rate=past.physics_rate, frame_steps=past.frame_steps, speed=speed
        )
        self.changed = True
        self.frames_due = 0
        self._past = past
        # Whether the steps of the frame that is shown were made before contacts were reported.
        self._lacks_contacts = False
        # The cached frame that is shown, while the world is at another step; else None.
        self._shown: CachedFrame | None = None

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused, negative goes back."""
        return self.clock.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self.changed |= speed != self.clock.speed
        if speed:
            self.frames_due = 0
        self.clock.speed = speed
        self._complete_frame()

    def note_reporting(self, reports_contacts: bool) -> None:  # noqa: FBT001 - a state
        """Note that contacts are reported from the next step on, or no longer."""
        self._lacks_contacts = reports_contacts
        self._complete_frame()

    def _complete_frame(self) -> None:
        """Make the frame that a paused world shows again, with contacts, if it lacks them."""
        if self._lacks_contacts and self.speed == 0 and not self.frames_due:
            self._seek_step(self.step)

    # The moment that is shown

    @property
    def is_frame_cached(self) -> bool:
        """Return whether a cached frame is shown, while the world is at another step."""
        return self._shown is not None

    @property
    def is_there(self) -> bool:
        """Return whether the world is at the moment that is shown, without a replay."""
        return self._shown is None and not self._past.timeline.is_seeking

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.step
        return self._past.timeline.moment[0]

    @property
    def moment(self) -> Moment:
        """Return step and serial that are shown."""
        timeline = self._past.timeline
        if self._shown is None:
            return timeline.moment
        return self.step, timeline.history.serial_shown_at(self.step)

    @property
    def time(self) -> str:
        """Return the simulation time that is shown, with its unit."""
        return f'{self.step / self._past.physics_rate:.3f} s'

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at the moment that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.scene.settings
        return self._past.timeline.settings

    @property
    def world(self) -> World:
        """Return the world, at the moment that is shown."""
        self.seek_shown()
        return self._past.timeline.world

    @property
    def is_world_due(self) -> bool:
        """Return whether the world has to go to the moment that is shown."""
        stands_still = self.speed == 0 and not self.changed
        return self.speed > 0 or stands_still or self.frames_due > 0

    def observe_frame(self, *, moved: bool) -> CachedFrame:
        """
        Return the frame that is shown, and note that it was.

        :param moved: whether its step differs from that of the frame before
        """
        shown = self._shown
        if shown is None:
            return self._observe_world(moved=moved)
        # Contacts belong to the first frame of a step.
        self._shown = shown._replace(contacts=NO_CONTACTS)
        return shown

    def _observe_world(self, *, moved: bool) -> CachedFrame:
        """Return the state of the world, and cache it for rewinds."""
        timeline, cache = self._past.timeline, self._past.frame_cache
        world = timeline.world
        snapshot = world.snapshot()
        contacts = world.contacts(snapshot) if world.reports_contacts else None
        frame = CachedFrame(snapshot, contacts)
        # The first frame of this step has the contacts.
        cache.add_frame(frame if moved else cache.with_first_contacts(frame))
        timeline.note_shown()
        return frame

    # To another moment

    def seek(self, stamp: int) -> None:
        """
        Go to a simulation time [ns]; its frame is shown at once where it is cached.

        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        self.frames_due = 0
        self._seek_step(self._past.steps_in(stamp * 1e-9))

    def _seek_step(self, step: int) -> None:
        self._show_requests()
        frame = self._past.frame_cache.cached_frame(step)
        if frame is None:
            self._past.timeline.seek(step)
        self.note_jump()
        self._shown, self._lacks_contacts = frame, False

    def _show_requests(self) -> None:
        """Note requests since the last frame as shown at this step."""
        timeline = self._past.timeline
        step, serial = timeline.moment
        if serial > timeline.history.serial_shown_at(step):
            self._observe_world(moved=False)

    def seek_shown(self) -> None:
        """Send the world to the moment that is shown."""
        if self._shown is not None:
            step, self._shown = self._shown.snapshot.step, None
            self._past.timeline.seek(step, with_contacts=False)

    def continue_seek(self, is_overdue: Callable[[], bool]) -> bool:
        """
        Replay towards the goal of a seek; until then no step is due.

        :param is_overdue: whether the replay is to continue in another call
        :return: whether the goal is reached
        """
        if self._shown is not None or self._past.timeline.continue_seek(is_overdue):
            return True
        self.clock.restart()
        return False

    def note_jump(self) -> None:
        """Show the moment of the timeline, which is another than the one that was shown."""
        self._shown = None
        self.clock.restart()
        self.changed = True

    # By steps

    @property
    def steps_to_period(self) -> int:
        """Return the number of steps to the next multiple of the publish period."""
        return self._past.frame_steps - self.step % self._past.frame_steps

    def queue_frame(self) -> int:
        """
        Have a paused world advance by one publish period in a later call.

        :return: the simulation time then [ns]
        """
        step = self.step + self.steps_to_period + self.frames_due * self._past.frame_steps
        self.frames_due += 1
        return round(step * 1e9 / self._past.physics_rate)

    def play(self, steps: int, is_overdue: Callable[[], bool]) -> None:
        """
        Advance by steps.

        :param is_overdue: whether to end at the next multiple of the publish period
        """
        self.seek_shown()
        self._lacks_contacts = False
        timeline = self._past.timeline
        while steps > 0:
            some = min(steps, self.steps_to_period)
            timeline.advance(some)
            timeline.build_ahead(some)
            steps = 0 if is_overdue() else steps - some

    def rewind(self, steps: int, is_overdue: Callable[[], bool]) -> bool:
        """
        Show the frame of an earlier step, no earlier than the oldest.

        :param is_overdue: whether its replay is to continue in another call; until then no step
            is due
        :return: whether it is shown
        """
        cache = self._past.frame_cache
        step = max(self._past.timeline.history.oldest, self.step - steps)
        if step >= self.step:
            return True
        shown = cache.frame_at(step, is_overdue)
        if shown is None:
            # The time of this replay is not made up for.
            self.clock.restart()
            return False
        self._shown, self._lacks_contacts = shown, False
        cache.replay_ahead(step, steps, is_overdue, fine=not self.speed.is_integer())
        return True
