# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frames of a world: requests and steady time go in, frames come out.

Laws: requests are applied in the order of their arrival and only between frames, in a paused world
too. Every request is answered, with the first frame after it; a frame without a step shows what
requests have changed. While a seek or an amendment is under way, no frame is made. A frame that
nobody reads is not made; the past has what is asked for later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
import math

from physsim_ros.model.checks import number
from physsim_ros.model.errors import BadProperty, UnknownBody
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.timeline import stamp_of
from physsim_ros.sensing import SensedFrame
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import RequestQueue
from physsim_ros.simulation.world import World
from physsim_ros.simulation.world.robot_requests import is_driving

# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2
# Publish periods after which a frame is made even if nobody reads them: one second at 60 Hz.
UNREAD_PERIODS = 60


class FrameMaker:
    """
    Applies requests to a world, advances it, and makes its frames.

    :param past: of the world, with the world itself
    :param speed: simulation seconds a second; 0 is paused, negative goes back

    :ivar physics_rate: steps a second of simulation time [Hz]
    :ivar frame_steps: number of steps in a frame at speed 1
    :ivar past: the lines of events, cached frames, and their budget of memory
    :ivar playback: the moment that is shown
    :ivar requests: queue of the requests that wait for the next frame, and what applies them
    :ivar driving: the commands with which robots drive on, by the names of their bodies
    :ivar is_read: whether somebody reads each frame of `advance`; else one is made where something
        but the time has changed, and every `UNREAD_PERIODS`
    """

    def __init__(self, past: Past, speed: float) -> None:
        self.physics_rate = past.physics_rate
        self.frame_steps = past.frame_steps
        self.past = past
        self.playback = Playback(past, speed=speed)
        self.requests = RequestQueue(past, self.playback)
        self.driving: dict[str, DriveRobot] = {}
        self.is_read = True
        self._sensed: SensedFrame | None = None
        # The last state before the next frame, where no frame of it was made.
        self._passed: Snapshot | None = None
        # Whether steps are under way after which a frame may be made.
        self._is_unfinished = False

    @property
    def world(self) -> World:
        """Return the world at the moment that is shown."""
        return self.playback.world

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        return self.playback.step

    @property
    def stamp(self) -> int:
        """Return the simulation time that is shown [ns]."""
        return stamp_of(self.step, self.physics_rate)

    @property
    def is_past(self) -> bool:
        """Whether something lies ahead of the moment that is shown, on its course."""
        return not self.playback.is_newest

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused, negative goes back."""
        return self.playback.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self.playback.speed = speed
        if self.playback.speed < 0.0:
            self.requests.hands.clear()
            self.stop_driving()

    def keep_driving(self, command: DriveRobot) -> None:
        """Have a robot drive on by a command, until it gets another one or is gone."""
        self.driving[command.name] = command

    def stop_driving(self) -> None:
        """End what `keep_driving` has robots do; their last commands end with their timeouts."""
        self.driving.clear()

    @property
    def sensed(self) -> SensedFrame:
        """
        Return the frame of now as sensors see it.

        A frame is made when it is first read after steps or requests, so that steps whose frame
        nobody reads make none.
        """
        sensed = self._sensed
        return self._observe() if sensed is None or self.is_changed else sensed

    @property
    def frame(self) -> Frame:
        """Return the frame of now, which is made when it is first read."""
        return self.sensed.frame

    @property
    def is_changed(self) -> bool:
        """Whether the frame of now differs from the last one that was made."""
        sensed, playback = self._sensed, self.playback
        return playback.changed or sensed is None or sensed.snapshot.step != playback.step

    def _forget_frames(self) -> None:
        """Have the next frame be the first one of its world: there is none before it."""
        self._sensed = self._passed = None

    def _show_again(self, frame: Frame, before: Snapshot | None) -> None:
        """
        Show a frame that was made before, of the same moment.

        :param before: snapshot of another time that was shown before it; None if there is none
        """
        self._sensed = SensedFrame(frame, before)
        self.playback.note_frame()

    def at_shown_moment(self) -> Past:
        """
        Apply the requests that wait, and return the past, its cursor at the moment that is shown.

        A cached frame may be shown while the cursor is elsewhere: what acts on the past, or reads
        the world, comes by here.
        """
        self.requests.apply_waiting()
        self.playback.seek_shown()
        return self.past

    def finish_work(self, is_overdue: Callable[[], bool]) -> bool:
        """
        Go on with the work that is under way: a seek, an amendment of the past, or steps.

        Until it is done, nothing else is due. A seek is done once its frame is shown.

        :param is_overdue: whether the work is to continue in another call
        :return: whether it is done
        """
        is_done = self._carry_out(self.playback.slices_of_work(), is_overdue)
        self.requests.note_arrival()
        return is_done

    def _carry_out(self, slices: Iterator[None], is_overdue: Callable[[], bool]) -> bool:
        """Carry out slices for which time waits, until time is up; return whether all are done."""
        if _finished(slices, is_overdue):
            return True
        # Their time is not made up for.
        self.playback.clock.restart()
        return False

    def apply_requests(self) -> Frame | None:
        """Apply the requests that wait, without a step; return a frame if anything changed."""
        self.requests.apply_waiting()
        return self._observe_frame() if self.is_changed else None

    def advance_frame(self) -> Frame:
        """Apply the requests that wait, and advance by one publish period, at any speed."""
        self._run_periods(1)
        return self._observe_frame()

    def pass_frames(self, count: int) -> Frame | None:
        """
        Advance by publish periods whose frames nobody reads, as `advance` does.

        :return: the last frame where one is due all the same
        """
        self._run_periods(count)
        if self._is_frame_due:
            return self._observe_frame()
        self._begin_frame(is_read=True)
        return None

    def run(self, seconds: float) -> None:
        """
        Advance by simulated seconds, to the nearest publish period, at any speed.

        No frame is made but the last one, when it is read; its contacts are those of all steps
        since the one that was read before.

        :raises BadProperty: they are no number, below 0, or more than can be counted
        :raises Malformed: they are not finite
        """
        seconds = number(seconds, 'seconds')
        periods = seconds * self.physics_rate / self.frame_steps
        if not 0.0 <= periods < math.inf:
            raise BadProperty(f'seconds must be finite and >= 0, not {seconds:g}', field='seconds')
        self._run_periods(round(periods))

    def _run_periods(self, count: int) -> None:
        """Apply the requests that wait, and advance by a number of publish periods."""
        while count > 0:
            # Robots that drive on are told so in each period.
            some = 1 if self.driving else count
            self._drive_on()
            self.at_shown_moment()
            self.requests.release_grips()
            self.playback.clock.restart()
            self.playback.run(self.playback.steps_to_period + (some - 1) * self.frame_steps)
            count -= some

    def advance(
        self,
        now_ns: int,
        *,
        is_overdue: Callable[[], bool] = lambda: False,
        is_spent: Callable[[], bool] = lambda: False,
        ends_frame: Callable[[], bool] | None = None,
        by_steps: bool = False,
    ) -> tuple[Frame, ...]:
        """
        Apply the requests that wait, and advance, or rewind, by the steps that are due.

        Where the time for requests is spent within a gesture, as in an array of thousands of
        bodies, time stands until a later call has applied the rest of the gesture.

        :param now_ns: steady time, never going back [ns]
        :param is_overdue: whether the call has taken too long; a later one goes on with its work,
            be it within a step
        :param is_spent: whether there is no time for a further request in this call
        :param ends_frame: whether a frame ends at a publish period, however many steps are due, so
            that requests do not wait; None is `is_overdue`
        :param by_steps: whether a frame that takes too long ends after any step, not at a publish
            period only; a later call makes the other steps
        :return: the frames, in the order in which they are shown; empty where nothing is due and
            nothing has changed
        """
        playback = self.playback
        self.past.free_slice()
        if playback.is_world_due or self.requests.has_requests:
            playback.seek_shown()
        if not self.finish_work(is_overdue):
            return ()
        if frame := self._finished_frame():
            return (frame,)
        if playback.speed > 0.0:
            self._drive_on()
        self.requests.apply_up_to_seek(is_spent)
        if not self.finish_work(is_overdue):
            return ()
        if self.requests.is_in_gesture or (playback.frames_due and self.requests.is_busy):
            playback.clock.restart()
            return ()
        if playback.take_frame():
            return (self.advance_frame(),)
        self.requests.hands.note_time(now_ns, paused=playback.speed == 0)
        if playback.speed > 0:
            self.requests.release_grips()
        ends_frame = is_overdue if ends_frame is None else ends_frame
        due = self._due_frames(now_ns, is_overdue, ends_frame, by_steps=by_steps)
        frames = tuple(due)
        if not frames and playback.changed and not self._is_unfinished:
            return (self._observe_frame(),)
        return frames

    def _due_frames(
        self,
        now_ns: int,
        is_overdue: Callable[[], bool],
        ends_frame: Callable[[], bool],
        *,
        by_steps: bool,
    ) -> Iterator[Frame]:
        """Make the steps that are due at a steady time [ns], and yield frames that are due."""
        playback = self.playback
        for _ in range(_FRAMES_A_CALL):
            steps = playback.clock.due(now_ns, playback.step)
            if steps == 0:
                return
            if steps > 0:
                self._begin_frame(is_read=self.is_read)
                slices = playback.play(steps, by_steps=by_steps)
                if any(ends_frame() if ends else is_overdue() for ends in slices):
                    self._is_unfinished = not playback.is_there
                if self._is_unfinished:
                    playback.clock.restart()
                    return
                if self._is_frame_due:
                    yield self._observe_frame()
            elif frame := self._rewind_frame(-steps, is_overdue):
                yield frame
            else:
                return
            if playback.speed == 0 or ends_frame():
                return

    def _finished_frame(self) -> Frame | None:
        """Return the frame of steps that have ended in this call, if they began in another one."""
        was_unfinished, self._is_unfinished = self._is_unfinished, False
        return self._observe_frame() if was_unfinished and self._is_frame_due else None

    @property
    def _is_frame_due(self) -> bool:
        """Whether a frame of now is to be made, after steps."""
        sensed = self._sensed
        is_told = self.playback.changed or self.requests.has_answers or self.past.reports
        if self.is_read or is_told or sensed is None:
            return True
        most = UNREAD_PERIODS * self.frame_steps * max(1.0, abs(self.speed))
        passed = abs(self.step - sensed.snapshot.step)
        return passed >= most or self.world.scene is not sensed.snapshot.scene

    def _begin_frame(self, *, is_read: bool) -> None:
        """
        Begin the contacts of the next frame, where no frame of now was made.

        :param is_read: whether somebody reads it, for whom the state before it is kept
        """
        if self._sensed is not None and self._sensed.snapshot.step != self.step:
            self.world.clear_contacts()
            if is_read:
                self._passed = self.world.snapshot()

    def _drive_on(self) -> None:
        """Have robots drive on as `Robot.drive` told them, unless they do up to the next frame."""
        for name, drive in [*self.driving.items()]:
            try:
                if not is_driving(self.world, drive, self.frame_steps):
                    # Nobody undoes a tick.
                    self.past.apply_unasked(drive)
            except (UnknownBody, BadProperty):
                # Its robot is gone, or has no drive any more.
                del self.driving[name]

    def _rewind_frame(self, steps: int, is_overdue: Callable[[], bool]) -> Frame | None:
        """Return the frame some steps back; None while its replay goes on."""
        if not self._carry_out(self.playback.rewind(steps), is_overdue):
            return None
        _finished(self.playback.replay_ahead(steps), is_overdue)
        if self.playback.step <= self.past.line.oldest:
            self.playback.speed = 0.0
            self.requests.report_oldest('; paused')
        return self._observe_frame()

    def _observe_frame(self) -> Frame:
        """Return the frame that is shown, with all answers."""
        return self._observe().frame

    def _observe(self) -> SensedFrame:
        """Return the frame that is shown as sensors see it; fit the past into its budget."""
        past, playback, requests = self.past, self.playback, self.requests
        snapshot, contacts = playback.observe_frame()
        past.fit_memory(playback.moment)
        frame = Frame(
            snapshot=snapshot,
            contacts=contacts if past.reports_contacts else None,
            answers=(*requests.take_answers(), *past.take_reports()),
            speed=playback.speed,
            stepped=playback.stepped,
            past=self.is_past,
            course=past.tree.course,
        )
        playback.note_frame()
        before, last = self._passed, self._sensed
        if last is not None and (before is None or before.step == snapshot.step):
            before = last.snapshot if last.snapshot.step != snapshot.step else last.before
        self._passed, self._sensed = None, SensedFrame(frame, before)
        return self._sensed


def _finished(slices: Iterator[None], is_overdue: Callable[[], bool]) -> bool:
    """Carry out slices of work until time is up, and return whether all are done."""
    return not any(is_overdue() for _ in slices)
