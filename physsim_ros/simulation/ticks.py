# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The time of a world: it advances by a steady time, in calls that end in time, or by frames.

Laws: requests are applied in the order of their arrival and only between frames, in a paused world
too. While a seek or an amendment is under way, no frame is made. A frame without a step shows what
requests have changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum

from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.applier import Applier
from physsim_ros.simulation.frame_maker import FrameMaker
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback

# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2


class FrameEnd(Enum):
    """
    The step with which a frame ends.

    :cvar DUE: the last step that is due, or that of a publish period where the call is overdue
    :cvar STEP: the last step that is due, or any where the call is overdue; a later call makes the
        other steps
    :cvar PERIOD: that of a publish period, however many steps are due, since controllers answer
        each such frame
    """

    DUE = 'due'
    STEP = 'step'
    PERIOD = 'period'


@dataclass(frozen=True, slots=True, kw_only=True)
class TickLimits:
    """
    The limits of a call.

    :param is_overdue: whether the call has taken too long; a later one goes on with its work, be
        it within a step
    :param is_spent: whether there is no time for a further request in this call
    :param frame_end: the step with which its frames end
    """

    is_overdue: Callable[[], bool] = lambda: False
    is_spent: Callable[[], bool] = lambda: False
    frame_end: FrameEnd = FrameEnd.DUE

    def ends_frame(self) -> bool:
        """Return whether a frame ends with this publish period."""
        return self.frame_end is FrameEnd.PERIOD or self.is_overdue()


# The limits of a call that does all that is due.
NO_LIMITS = TickLimits()


class Ticks:
    """
    Advances the time of a world.

    :param past: of the world
    :param playback: the moment that is shown
    :param applier: applies the requests that wait
    :param frames: of that moment
    """

    def __init__(
        self, past: Past, playback: Playback, applier: Applier, frames: FrameMaker
    ) -> None:
        self._past = past
        self._playback = playback
        self._applier = applier
        self._frames = frames
        # Whether steps are under way after which a frame may be made.
        self._is_unfinished = False

    def continue_work(self, is_overdue: Callable[[], bool]) -> bool:
        """
        Go on with the work that is under way: a seek, an amendment of the past, or steps.

        Until it is done, nothing else is due. A seek is done once its frame is shown.

        :param is_overdue: whether the work is to continue in another call
        :return: whether it is done
        """
        is_done = self._carry_out(self._playback.slices_of_work(), is_overdue)
        self._applier.tell_arrival()
        return is_done

    def _carry_out(self, slices: Iterator[None], is_overdue: Callable[[], bool]) -> bool:
        """Carry out slices for which time waits, until time is up; return whether all are done."""
        if _finished(slices, is_overdue):
            return True
        # Their time is not made up for.
        self._playback.clock.restart()
        return False

    def pass_frames(self, count: int) -> Frame | None:
        """
        Advance by publish periods whose frames nobody reads, as `advance` does.

        :return: the last frame where one is due all the same
        """
        self.run(count)
        if self._frames.is_due:
            return self._frames.make()
        self._frames.begin(keeps_before=True)
        return None

    def run(self, count: int) -> None:
        """Apply the requests that wait, and advance by a number of publish periods."""
        playback, frame_steps = self._playback, self._past.frame_steps
        while count > 0:
            # Robots that drive on are told so in each period.
            some = 1 if self._applier.drives.commands else count
            self._applier.drives.drive_on()
            self._applier.apply_all()
            playback.arrive()
            self._applier.release_grips()
            playback.clock.restart()
            playback.run(playback.steps_to_period + (some - 1) * frame_steps)
            count -= some

    def advance(self, now_ns: int, limits: TickLimits) -> tuple[Frame, ...]:
        """
        Apply the requests that wait, and advance, or rewind, by the steps that are due.

        Where the time for requests is spent within a gesture, as in an array of thousands of
        bodies, time stands until a later call has applied the rest of the gesture.

        :param now_ns: steady time, never going back [ns]
        :return: the frames, in the order in which they are shown; empty where nothing is due and
            nothing has changed
        """
        playback, applier, is_overdue = self._playback, self._applier, limits.is_overdue
        self._past.free_slice()
        if playback.is_world_due or applier.has_requests:
            playback.send_cursor()
        if not self.continue_work(is_overdue):
            return ()
        if frame := self._finished_frame():
            return (frame,)
        if playback.speed > 0.0:
            applier.drives.drive_on()
        applier.apply_ready(limits.is_spent)
        if not self.continue_work(is_overdue):
            return ()
        if applier.is_in_gesture or (playback.single_frames and applier.is_busy):
            playback.clock.restart()
            return ()
        if playback.take_frame():
            self.run(1)
            return (self._frames.make(),)
        applier.hands.drop_silent(now_ns, paused=playback.speed == 0)
        if playback.speed > 0:
            applier.release_grips()
        frames = tuple(self._due_frames(now_ns, limits))
        if not frames and playback.changed and not self._is_unfinished:
            return (self._frames.make(),)
        return frames

    def _due_frames(self, now_ns: int, limits: TickLimits) -> Iterator[Frame]:
        """Make the steps that are due at a steady time [ns], and yield frames that are due."""
        playback = self._playback
        for _ in range(_FRAMES_A_CALL):
            steps = playback.clock.due(now_ns, playback.step)
            if steps == 0:
                return
            if steps > 0:
                self._frames.begin()
                slices = playback.play(steps, by_steps=limits.frame_end is FrameEnd.STEP)
                if any(limits.ends_frame() if ends else limits.is_overdue() for ends in slices):
                    self._is_unfinished = not playback.is_there
                if self._is_unfinished:
                    playback.clock.restart()
                    return
                if self._frames.is_due:
                    yield self._frames.make()
            elif frame := self._rewind_frame(-steps, limits.is_overdue):
                yield frame
            else:
                return
            if playback.speed == 0 or limits.ends_frame():
                return

    def _finished_frame(self) -> Frame | None:
        """Return the frame of steps that have ended in this call, if they began in another one."""
        was_unfinished, self._is_unfinished = self._is_unfinished, False
        if was_unfinished and self._frames.is_due:
            return self._frames.make()
        return None

    def _rewind_frame(self, steps: int, is_overdue: Callable[[], bool]) -> Frame | None:
        """Return the frame some steps back; None while its replay goes on."""
        if not self._carry_out(self._playback.rewind(steps), is_overdue):
            return None
        _finished(self._playback.replay_ahead(steps), is_overdue)
        if self._playback.step <= self._past.line.oldest:
            self._playback.speed = 0.0
            self._past.report_oldest(self._playback.step, '; paused')
        return self._frames.make()


def _finished(slices: Iterator[None], is_overdue: Callable[[], bool]) -> bool:
    """Carry out slices of work until time is up, and return whether all are done."""
    return not any(is_overdue() for _ in slices)
