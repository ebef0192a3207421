# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frame loop: requests that wait are applied, the steps that are due are made, frames come out.

Law: answers go out with the first frame after their requests; a frame without a step shows what
requests have changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_handler import RequestHandler

# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2


class FrameLoop:
    """
    The frames of a world, forward and back.

    :param past: with the budget of memory that each frame is fitted into
    :param playback: the moment that is shown
    :param handler: of the requests that wait
    """

    def __init__(self, past: Past, playback: Playback, handler: RequestHandler) -> None:
        self._past = past
        self._playback = playback
        self._handler = handler

    def advance(self, now_ns: int, is_overdue: Callable[[], bool]) -> tuple[Frame, ...]:
        """
        Return the frames that are due at a steady time [ns], see `Simulation.advance`.

        :param is_overdue: whether the call has taken too long
        """
        playback = self._playback
        if playback.is_world_due or self._handler.changes_world:
            playback.seek_shown()
        if not playback.continue_seek(is_overdue):
            return ()
        self._handler.apply_up_to_seek()
        if not playback.continue_seek(is_overdue):
            return ()
        if playback.frames_due:
            playback.frames_due -= 1
            return (self.advance_period(),)
        self._handler.hands.note_time(now_ns, paused=playback.speed == 0)
        if playback.speed > 0:
            self._handler.release_grips()
        frames = list(self._due_frames(now_ns, is_overdue))
        if not frames and playback.changed:
            frames.append(self._observe_frame(moved=False))
        return tuple(frames)

    def advance_period(self) -> Frame:
        """Apply the requests that wait, and advance by one publish period, at any speed."""
        self._handler.apply_waiting()
        self._handler.release_grips()
        self._playback.clock.restart()
        return self._play_frame(self._playback.steps_to_period)

    def apply_requests(self) -> Frame | None:
        """Apply the requests that wait, without a step; return a frame if there were any."""
        self._handler.apply_waiting()
        return self._observe_frame(moved=False) if self._playback.changed else None

    def _due_frames(self, now_ns: int, is_overdue: Callable[[], bool]) -> Iterator[Frame]:
        """Make and yield the frames that are due at a steady time [ns]."""
        playback = self._playback
        for _ in range(_FRAMES_A_CALL):
            steps = playback.clock.due(now_ns, playback.step)
            if steps == 0:
                return
            if steps > 0:
                yield self._play_frame(steps, is_overdue)
            elif frame := self._rewind_frame(-steps, is_overdue):
                yield frame
            else:
                return
            if playback.speed == 0 or is_overdue():
                return

    def _play_frame(self, steps: int, is_overdue: Callable[[], bool] = lambda: False) -> Frame:
        self._playback.play(steps, is_overdue)
        return self._observe_frame(moved=True)

    def _rewind_frame(self, steps: int, is_overdue: Callable[[], bool]) -> Frame | None:
        """Return a frame further back; None where it has to be replayed for longer."""
        before = self._playback.step
        if not self._playback.rewind(steps, is_overdue):
            return None
        if self._playback.step <= self._past.timeline.history.oldest:
            self._playback.speed = 0.0
            self._handler.report_oldest('; paused')
        return self._observe_frame(moved=self._playback.step < before)

    def _observe_frame(self, *, moved: bool) -> Frame:
        """Return the frame that is shown, with all answers that wait, within the budget."""
        snapshot, contacts = self._playback.observe_frame(moved=moved)
        answers = self._handler.answers
        answers += self._past.fit_memory(self._playback.moment)
        answers += self._past.take_answers()
        self._playback.changed = False
        return Frame(
            snapshot=snapshot,
            contacts=contacts if self._past.reports_contacts else None,
            answers=self._handler.take_answers(),
            speed=self._playback.speed,
            moved=moved,
            past=snapshot.step < self._past.timeline.history.head,
            course=self._past.course,
        )
