# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Playback: the moment that is shown, forward and back, and the steps that are due.

Laws: a rewind or a seek shows a cached frame while the world is at another step. The world goes to
the step that is shown before a request is applied, a step is made or `arrive` returns the world,
and while playback is paused. After a jump to another course the state of the world is shown, not a
cached frame. Where contacts are reported, the frame of a paused world has those of its last steps.
"""

from __future__ import annotations

from collections.abc import Iterator

from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import NO_CONTACTS
from physsim_ros.model.timeline import CourseSpan, RunState, stamp_of, TimelineStatus
from physsim_ros.model.translation import Text
from physsim_ros.simulation.clock import Clock
from physsim_ros.simulation.past import CachedFrame, Moment, Past
from physsim_ros.simulation.world import World


class Playback:
    """
    The moment that is shown.

    :param past: of the world
    :param speed: simulation seconds a second; 0 is paused, negative goes back

    :ivar clock: the speed, and the steps that are due
    :ivar changed: whether the next frame differs from the last one without a step
    :ivar stepped: whether steps, forward or back, have led from the last frame to this moment
    :ivar starts: count of the times that time has begun to run
    :ivar single_frames: count of single frames to be made in a paused world, one in each call
    """

    def __init__(self, past: Past, *, speed: float) -> None:
        self.clock = Clock(
            physics_rate=past.physics_rate, frame_steps=past.frame_steps, speed=speed
        )
        self.changed = True
        self.stepped = False
        self.starts = 0
        self.single_frames = 0
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
        before, self.clock.speed = self.clock.speed, speed
        self.changed |= self.clock.speed != before
        self.starts += before == 0 != self.clock.speed
        if self.clock.speed:
            self.drop_frames()
        self._complete_frame()

    def report_contacts(self, reports_contacts: bool) -> None:  # noqa: FBT001 - a state
        """Have frames have contacts from the next step on, and that of a paused world, or none."""
        self._past.reports_contacts = self._lacks_contacts = reports_contacts
        self._complete_frame()

    def _complete_frame(self) -> None:
        """Make the frame that a paused world shows again, with contacts, if it lacks them."""
        if self._lacks_contacts and self.speed == 0 and not self.single_frames:
            self._seek_step(self.step)

    def begin_frame(self) -> None:
        """Compare the next frame with that of this moment, which was made."""
        self.changed = self.stepped = False

    # The moment that is shown

    @property
    def is_frame_cached(self) -> bool:
        """Return whether a cached frame is shown, while the world is at another step."""
        return self._shown is not None

    @property
    def is_there(self) -> bool:
        """Return whether the world is at the moment that is shown, without a replay."""
        return self._shown is None and not self._past.cursor.is_working

    @property
    def has_arrived(self) -> bool:
        """Whether the moment that was sought last can be shown without a replay."""
        return self._shown is not None or not self._past.cursor.is_seeking

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.step
        return self._past.cursor.moment.step

    @property
    def moment(self) -> Moment:
        """Return step and serial that are shown."""
        if self._shown is None:
            return self._past.cursor.moment
        return Moment(self.step, self._past.line.serial_shown_at(self.step))

    @property
    def is_newest(self) -> bool:
        """Whether nothing lies ahead of the moment that is shown."""
        return self.moment == self._past.line.end

    @property
    def time(self) -> str:
        """Return the simulation time that is shown, with its unit."""
        return f'{self.step / self._past.physics_rate:.3f} s'

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at the moment that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.scene.settings
        return self._past.cursor.settings

    @property
    def status(self) -> TimelineStatus:
        """Return the status of the timeline at the moment that is shown."""
        past, rate, shown = self._past, self._past.physics_rate, self.moment
        is_past = self.speed >= 0.0 and not self.is_newest
        undo, redo = past.words(shown)
        courses = sorted(past.tree.courses_left(), key=lambda each: each[0].course)
        return TimelineStatus(
            state=RunState.PAST if is_past else RunState.of(self.speed),
            speed=self.speed,
            oldest=past.line.oldest / rate,
            now=shown.step / rate,
            newest=past.line.head / rate,
            course=past.tree.course,
            line=past.frames.line_number,
            differs_from=past.frames.differs_from / rate,
            undo=undo and Text('undo {gesture}', gesture=undo),
            redo=redo and Text('redo {gesture}', gesture=redo),
            courses=tuple(
                CourseSpan(line.course, min(step, line.head) / rate, line.head / rate)
                for line, step in courses
            ),
        )

    def arrive(self) -> World:
        """Send the world to the moment that is shown, finish the way there, and return it."""
        self.send_cursor()
        return self._past.cursor.arrive()

    @property
    def is_world_due(self) -> bool:
        """Return whether the world has to go to the moment that is shown."""
        stands_still = self.speed == 0 and not self.changed
        return self.speed > 0 or stands_still or self.single_frames > 0

    def observe_frame(self) -> CachedFrame:
        """Return the frame that is shown, and note that it was."""
        shown = self._shown
        if shown is None:
            return self._observe_world()
        # Contacts belong to the first frame of a step.
        self._shown = shown._replace(contacts=NO_CONTACTS)
        return shown

    def _observe_world(self) -> CachedFrame:
        """Return the state of the world, and cache it for rewinds."""
        cursor, cache = self._past.cursor, self._past.frames
        world = cursor.arrive()
        snapshot = world.snapshot()
        contacts = world.contacts(snapshot) if world.reports_contacts else None
        frame = CachedFrame(snapshot, contacts)
        # The first frame of this step has the contacts.
        cache.add_frame(frame if self.stepped else cache.with_first_contacts(frame))
        self._past.line.mark_shown(*cursor.moment)
        return frame

    # To another moment

    def seek(self, stamp: int) -> None:
        """
        Go to a simulation time [ns]; its frame is shown at once where it is cached.

        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        self._seek_step(self._past.steps_in(stamp * 1e-9))
        self.drop_frames()

    def _seek_step(self, step: int) -> None:
        self._past.cursor.finish_amendment()
        self._show_requests()
        frame = self._past.frames.cached_frame(step)
        if frame is None:
            self._past.cursor.seek_step(step)
        self.show_cursor()
        self._shown, self._lacks_contacts = frame, False

    def _show_requests(self) -> None:
        """Note requests since the last frame as shown at this step."""
        step, serial = self._past.cursor.moment
        if serial > self._past.line.serial_shown_at(step):
            self._observe_world()

    def send_cursor(self) -> None:
        """Send the world to the moment that is shown."""
        if self._shown is not None:
            step, self._shown = self._shown.snapshot.step, None
            self._past.cursor.seek_step(step, with_contacts=False)

    def slices_of_work(self) -> Iterator[None]:
        """
        Carry out the work that is under way; yield after each slice but the last.

        Nothing is done while a cached frame is shown in place of the goal.
        """
        while self._shown is None and self._past.cursor.carry_out_slice():
            yield

    def show_cursor(self) -> None:
        """Show the moment of the cursor, which is another than the one that was shown."""
        self._shown = None
        self.clock.restart()
        self.changed, self.stepped = True, False

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
        step = self.step + self.steps_to_period + self.single_frames * self._past.frame_steps
        self.single_frames += 1
        return stamp_of(step, self._past.physics_rate)

    def take_frame(self) -> bool:
        """Take one of the single frames that are due, and return whether there was one."""
        is_due = self.single_frames > 0
        self.single_frames -= is_due
        return is_due

    def drop_frames(self) -> None:
        """Have no single frame be due."""
        self.single_frames = 0

    def run(self, steps: int) -> None:
        """Advance the world, which is at the moment that is shown, by steps."""
        self._lacks_contacts, self.stepped = False, True
        cursor = self._past.cursor
        cursor.begin_advance(steps)
        cursor.arrive()
        cursor.build_ahead(steps)

    def play(self, steps: int, *, by_steps: bool = False) -> Iterator[bool]:
        """
        Advance by steps; yield where a frame may be shown, and where steps take long.

        :param by_steps: whether a frame may be shown after each step, as of a world whose steps
            take long; else at each multiple of the publish period, and at the end
        :return: whether a frame may be shown; else the rest of the steps up to the next one is
            work under way
        """
        self.send_cursor()
        self._lacks_contacts, self.stepped = False, True
        cursor = self._past.cursor
        while steps > 0:
            some = 1 if by_steps else min(steps, self.steps_to_period)
            cursor.begin_advance(some)
            cursor.build_ahead(some)
            while cursor.carry_out_slice():
                yield False
            steps -= some
            yield True

    def rewind(self, steps: int) -> Iterator[None]:
        """
        Show the frame of an earlier step, no earlier than the oldest.

        Yield after each slice of its replay, before which another frame is shown.
        """
        step = max(self._past.line.oldest, self.step - steps)
        if step < self.step:
            while (shown := self._past.frames.replay_to_frame(step)) is None:
                yield
            self._shown, self._lacks_contacts, self.stepped = shown, False, True

    def replay_ahead(self, steps: int) -> Iterator[None]:
        """
        Replay some of the frames that a rewind shows later; yield after each.

        :param steps: from one frame that is shown to the next
        """
        fine = not self.speed.is_integer()
        return self._past.frames.replay_ahead(self.step, steps, fine=fine)
