# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frame loop: requests are applied, time goes on, and each frame is shown.

Laws: a tick applies requests for a limited time, and each message or call that needs them applied
has as much; what is left of them waits for the next tick. No tick advances the world before all
robots of its last frame have their topics. Before the node has started nothing is applied by
itself. A tick begins with the messages of pages; a frame that a message or a call makes does not,
so that no message is carried out within another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import time

from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.robots import Fleet
from physsim_ros.runtime.slices import Sliced
from physsim_ros.simulation.entries import Origin, UNKNOWN, Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.ticks import FrameEnd, TickLimits

# Time in which a tick is to end [ns]: requests, services and signals wait at most so long, which a
# person hardly notices, or for one slice of work, and for the outputs of a frame. At speed 64 a
# frame has 64 periods.
MOST_TICK_NS = 100_000_000
# Time after which no further request is applied in a tick [ns]; or as long as the rest of the last
# tick took, since in a crowded world each tick with a request makes the scene anew.
MOST_REQUESTS_NS = 10_000_000


class _RequestTime:
    """
    The time for requests, from now on.

    :param rest_ns: duration of the last tick without its requests [ns]

    :ivar ended: steady time at which the last request was applied [ns]
    """

    def __init__(self, rest_ns: int) -> None:
        self.ended = time.perf_counter_ns()
        self._until = self.ended + max(MOST_REQUESTS_NS, rest_ns)

    def is_spent(self) -> bool:
        """Return whether there is no time for a further request; called after each."""
        self.ended = time.perf_counter_ns()
        return self.ended > self._until


class _TickTime:
    """The time for the slices of work of a tick, from now on."""

    def __init__(self) -> None:
        self._began = self._ended = time.perf_counter_ns()
        self._longest = 0

    def is_overdue(self) -> bool:
        """Return whether one more slice like the longest would end late; asked after each."""
        now = time.perf_counter_ns()
        self._longest = max(self._longest, now - self._ended)
        self._ended = now
        return now - self._began + self._longest > MOST_TICK_NS


class FrameLoop:
    """
    Has a simulation make frames, and shows them.

    :param simulation: the world and its time
    :param outputs: to which frames are shown
    :param fleet: the topics of robots

    :ivar started: whether time goes on by itself
    """

    def __init__(self, simulation: Simulation, outputs: Outputs, fleet: Fleet) -> None:
        self.started = False
        self._simulation = simulation
        self._outputs = outputs
        self._fleet = fleet
        # Duration of the last tick with a frame, without its requests [ns], and whether it had no
        # time left.
        self._rest_ns, self._was_overdue = 0, False

    def tick(self, now_ns: int) -> None:
        """
        Advance the world to a steady time, and show the frames.

        :param now_ns: steady time, monotonic [ns]
        """
        began, tick_time = time.perf_counter_ns(), _TickTime()
        self.handle_messages()
        self._serve_readers()
        self._submit_commands()
        if not self._fleet.scene_robots.update(tick_time.is_overdue):
            self._simulation.playback.clock.restart()
            return
        step, request_time = self._simulation.step, _RequestTime(self._rest_ns)
        frames = self._advance(now_ns, tick_time, request_time)
        stepped = time.perf_counter_ns()
        for frame in frames:
            self._outputs.show(frame)
        if not frames:
            self._show_without_frame()
            if self._simulation.step == step:
                self._outputs.show_late()
                return
        self._rest_ns = time.perf_counter_ns() - request_time.ended
        self._was_overdue = tick_time.is_overdue()
        statistics = self._outputs.statistics
        if frames and not frames[-1].stepped:
            statistics.reset_pace()
            return
        statistics.add(
            now_ns=now_ns,
            stamp=self._simulation.stamp,
            step_ns=stepped - request_time.ended,
            frame_ns=time.perf_counter_ns() - began,
        )

    def _advance(
        self, now_ns: int, tick_time: _TickTime, request_time: _RequestTime
    ) -> tuple[Frame, ...]:
        """Advance the world to a steady time [ns], unless controllers are awaited."""
        simulation, lockstep = self._simulation, self._fleet.lockstep
        # In a rewind commands are ignored, and no controller is awaited.
        if simulation.speed < 0.0 or not lockstep.waits():
            frame_end = FrameEnd.STEP if self._was_overdue else FrameEnd.DUE
            # Controllers answer whole frames.
            frame_end = FrameEnd.PERIOD if lockstep.is_on else frame_end
            return simulation.advance(
                now_ns,
                TickLimits(
                    is_overdue=tick_time.is_overdue,
                    is_spent=request_time.is_spent,
                    frame_end=frame_end,
                ),
            )
        # By a service, as a reset, after which a robot may be gone, or its scan.
        return (simulation.frame,) if simulation.frames.is_changed else ()

    def handle_messages(self) -> None:
        """Carry out messages of pages, within none of them."""
        if self._outputs.sketchpad is not None:
            self._outputs.sketchpad.handle_messages()

    def advance_frame(self) -> None:
        """Advance the world by one publish period, at any time, and show the frame."""
        self._serve_readers()
        self._submit_commands()
        self._show(self._simulation.advance_frame())

    def pass_frames(self, count: int) -> int:
        """
        Advance the world by publish periods if nobody reads their frames.

        :return: count of the periods; 0 where somebody reads
        """
        if not count:
            return 0
        self._serve_readers()
        self._submit_commands()
        if self._simulation.frames.is_read:
            return 0
        frame = self._simulation.ticks.pass_frames(count)
        if frame is not None:
            self._show(frame)
        return count

    def apply_requests(self) -> tuple[Answer, ...]:
        """Apply the waiting requests without advancing time; show and return the answers."""
        self._serve_readers()
        frame = self._simulation.apply_requests()
        if frame is not None:
            self._show(frame)
            return frame.answers
        return self._show_without_frame()

    def _show(self, frame: Frame) -> None:
        """Show a frame, at any time, and have all its robots have their topics."""
        self._outputs.show(frame)
        self._fleet.scene_robots.update()

    def apply_ready(self) -> bool:
        """
        Apply the requests that need not wait, for a limited time.

        :return: whether the world may be read now; before the start, when nothing is applied by
            itself, it may be at any time
        """
        if not self.started:
            return True
        return self._simulation.applier.apply_ready(_RequestTime(self._rest_ns).is_spent)

    def make_call(
        self,
        call: Sliced[Sequence[Answer]],
        wait: Wait,
        on_told: Callable[[], object] = lambda: None,
        origin: Origin = UNKNOWN,
    ) -> None:
        """
        Make a call at its time among the requests, now if they leave the time for it.

        :param on_told: called when its answers are told
        :param origin: the message from which it comes
        :raises Busy: too many requests wait
        """
        if not self.started and wait is Wait.TO_READ:
            # No tick goes on with the call.
            wait = Wait.FOR_SEEK
        self._simulation.applier.make_call(call, wait, on_told, origin)
        if self.started:
            self.apply_ready()
        elif wait is not Wait.NONE:
            self._simulation.applier.apply_all()
            # Nor with a replay that the call began.
            self._simulation.ticks.continue_work(lambda: False)

    def bring_up_to_date(self) -> Snapshot:
        """Apply the requests that there is time for, and return the snapshot that is shown."""
        if self.apply_ready():
            self.apply_requests()
        shown = self._outputs.frame
        return self._simulation.world.snapshot() if shown is None else shown.snapshot

    def finish_short_seek(self) -> None:
        """Have a seek be done at once if it is short; else the next ticks go on with it."""
        self._simulation.ticks.continue_work(_TickTime().is_overdue)

    def _submit_commands(self) -> None:
        """Submit commands of robots, which the past refuses."""
        self._fleet.commands.submit(
            in_past=self._simulation.speed < 0.0 or self._simulation.is_past
        )

    def _serve_readers(self) -> None:
        """
        Have frames be made, and contacts be recorded, while somebody reads them.

        A paused world whose frame lacks contacts that are read now makes its last steps again.
        """
        outputs, fleet = self._outputs, self._fleet
        self._simulation.frames.is_read = outputs.is_read or fleet.is_read
        self._simulation.reports_contacts = outputs.wants_contacts or fleet.wants_contacts

    def _show_without_frame(self) -> tuple[Answer, ...]:
        """Show the answers and the preview that no frame carries; return the answers."""
        answers = self._simulation.applier.take_answers()
        self._outputs.report_answers(answers)
        self._outputs.show_preview()
        return answers
