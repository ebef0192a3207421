# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`/diagnostics` once a second: cost of a frame, late frames, real-time factor, energies."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from physsim_ros.model.snapshot import run_state, Snapshot
from rclpy.time import Time

# Time constant of the smoothed real-time factor, in wall time [s]: legible to a person.
_SMOOTHING = 1.0
# Wait of messages above which the diagnostics warn [s].
LONG_DELAY = 1.0
# CPU time of a message above which they do [s]: six frames at 60 Hz.
LONG_MESSAGE = 0.1
# Real-time factor over speed, below which late frames are an error and not a warning [1].
FAR_BEHIND = 0.5


class FrameStatistics:
    """Measures the cost of frames and the real-time factor; it reads no clock."""

    def __init__(self) -> None:
        # None before the first frame.
        self.real_time_factor: float | None = None
        self._last: tuple[int, int] | None = None
        self._frames = 0
        self._step_ns = 0
        self._frame_ns = 0
        # Time between frames of the present second: steady, and simulated [ns].
        self._elapsed_ns = 0
        self._simulated_ns = 0
        self._late_reported = 0
        self._undecodable_reported = 0
        self._failures_reported = 0

    def add(self, *, now_ns: int, stamp: int, step_ns: int, frame_ns: int) -> None:
        """
        Add a frame.

        :param now_ns: steady time of the frame [ns]
        :param stamp: simulation time of the frame [ns]
        :param step_ns: cost of its steps [ns]
        :param frame_ns: cost of its steps and of publishing [ns]
        """
        self._frames += 1
        self._step_ns += step_ns
        self._frame_ns += frame_ns
        known = self.real_time_factor = self.real_time_factor or 0.0
        if self._last is not None and now_ns > self._last[0]:
            elapsed = now_ns - self._last[0]
            self._elapsed_ns += elapsed
            self._simulated_ns += stamp - self._last[1]
            # The first factor is not smoothed.
            share = min(1.0, elapsed * 1e-9 / _SMOOTHING) if known else 1.0
            factor = (stamp - self._last[1]) / elapsed
            self.real_time_factor = known + share * (factor - known)
        self._last = (now_ns, stamp)

    def reset_pace(self) -> None:
        """Reset the real-time factor: the world is paused, or time has jumped."""
        self._last = None
        if self.real_time_factor is not None:
            self.real_time_factor = 0.0

    def report(
        self,
        snapshot: Snapshot,
        *,
        node: str,
        speed: float,
        late_frames: int,
        viewer: str,
        viewer_failure: str = '',
        message_delay: float = 0.0,
        waiting_requests: int = 0,
        undecodable: int = 0,
        waiting_answers: int = 0,
        stopped_subscriber: bool = False,
        memory: tuple[float, float] = (0.0, 0.0),
        failures: int = 0,
        longest: tuple[str, float] = ('', 0.0),
    ) -> DiagnosticArray:
        """
        Return the message of the last second, and begin the next.

        :param node: fully qualified name of the node
        :param speed: simulation seconds a second
        :param late_frames: since the node started
        :param viewer: state of the viewer, in one sentence
        :param viewer_failure: why the viewer or the recording gets no frames; '' if it does
        :param message_delay: time that messages wait before they are handled [s]
        :param waiting_requests: number of requests that wait for the next frame
        :param undecodable: number of messages that could not be decoded, since the node started
        :param waiting_answers: number of answers that wait for acknowledgements
        :param stopped_subscriber: whether a subscriber of `~/events` has stopped
        :param memory: memory of the past, and its budget [MB]
        :param failures: number of unexpected errors, since the node started
        :param longest: the message that took the longest, and its CPU time [s]
        """
        late, self._late_reported = late_frames - self._late_reported, late_frames
        lost = undecodable - self._undecodable_reported
        self._undecodable_reported = undecodable
        failed, self._failures_reported = failures - self._failures_reported, failures
        factor = self._simulated_ns / self._elapsed_ns if self._elapsed_ns else 0.0
        count = self._frames
        frames = max(1, count)
        px, py = snapshot.momentum
        values = {
            'bodies': len(snapshot.scene.bodies),
            'simulation time [s]': f'{snapshot.stamp * 1e-9:.3f}',
            'speed': f'{speed:g}',
            'real-time factor': f'{factor:.3f}',
            'frames': count,
            'late frames': late_frames,
            'late frames in this second': late,
            'step cost [ms]': f'{self._step_ns / frames * 1e-6:.3f}',
            'frame cost [ms]': f'{self._frame_ns / frames * 1e-6:.3f}',
            'wait of requests [s]': f'{message_delay:.3f}',
            'requests that wait': waiting_requests,
            'longest message [ms]': f'{longest[1] * 1e3:.1f} {longest[0]}'.rstrip(),
            'undecodable messages': undecodable,
            'unexpected errors': failures,
            'answers that wait': waiting_answers,
            'memory of the past [MB]': '{:.1f} of {:g}'.format(*memory),
            'kinetic energy [J]': f'{snapshot.kinetic_energy:.6g}',
            'potential energy [J]': f'{snapshot.potential_energy:.6g}',
            'elastic energy [J]': f'{snapshot.elastic_energy:.6g}',
            'momentum [kg m/s]': f'{px:.6g}, {py:.6g}',
            'viewer': viewer,
        }
        self._frames = self._step_ns = self._frame_ns = 0
        self._elapsed_ns = self._simulated_ns = 0
        level, concerns = DiagnosticStatus.OK, []
        if late > 0:
            far = abs(factor) < FAR_BEHIND * abs(speed)
            level = DiagnosticStatus.ERROR if far else DiagnosticStatus.WARN
            concerns.append(
                f'{late} frames late, real-time factor {factor:.2f}: '
                'fewer bodies, joints or viewers, or a lower speed'
            )
        if message_delay > LONG_DELAY:
            concerns.append(f'requests wait {message_delay:.1f} s: send fewer of them')
        if longest[1] > LONG_MESSAGE:
            name, took = longest
            concerns.append(f'{name} took {took:.1f} s, in which time stood: send less at once')
        if lost > 0:
            concerns.append(f'{lost} messages cannot be decoded: check their publishers')
        if failed > 0:
            concerns.append(f'{failed} unexpected errors: report them with the log of the node')
        if stopped_subscriber:
            concerns.append('a subscriber of ~/events has stopped and loses answers: end it')
        if viewer_failure:
            concerns.append(f'{viewer_failure}: set parameter viewer to open it again')
        if concerns:
            level = max(level, DiagnosticStatus.WARN)
        status = DiagnosticStatus(
            level=level,
            name='physsim: world',
            message='; '.join(concerns) or (run_state(speed) if speed <= 0 else f'{count} frames'),
            hardware_id=node,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = Time(nanoseconds=snapshot.stamp).to_msg()
        return array
