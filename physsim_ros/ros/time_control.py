# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The control of time by topics, services and pages: speed, seeks, single frames."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from physsim_ros.model.errors import Running
from physsim_ros.model.snapshot import Answer, run_state
from physsim_ros.ros import parameters
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.publishers.frame_statistics import FrameStatistics
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.simulation.simulation import Simulation
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64


class TimeControl:
    """
    The control of time.

    Each method returns a message about what was done.

    :param node: whose parameter `speed` is the speed
    :param simulation: of the node
    :param values: of the parameters of the node, by name, always up to date
    :param loop: makes single frames
    :param statistics: of frames
    """

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        values: Mapping[str, Any],
        loop: FrameLoop,
        statistics: FrameStatistics,
    ) -> None:
        self._node = node
        self._simulation = simulation
        self._values = values
        self._loop = loop
        self._statistics = statistics

    @property
    def actions(self) -> Mapping[str, Callable[[], str]]:
        """Return the actions of the services for time, by name."""
        return {
            'play': lambda: self._run_at(1.0),
            'pause': lambda: self._run_at(0.0),
            'rewind': lambda: self._run_at(-1.0),
            'fast_forward': lambda: self._run_at(self._values['fast_speed']),
            'fast_rewind': lambda: self._run_at(-self._values['fast_speed']),
            'step': self.step,
        }

    def subscribe(self, topics: RequestTopics) -> None:
        """Subscribe to `~/speed` and `~/seek`."""
        requests = self._simulation.requests

        def set_speed(message: Float64) -> None:
            requests.tell(Answer(topic='~/speed', message=self.set_speed(message.data)))

        def seek(message: Clock) -> None:
            stamp = message.clock.sec * 10**9 + message.clock.nanosec
            self._statistics.reset_pace()
            requests.submit_seek(stamp, topic='~/seek')

        topics.subscribe(Float64, '~/speed', set_speed)
        topics.subscribe(Clock, '~/seek', seek)

    def set_speed(self, speed: float) -> str:
        """
        Set the speed, simulation seconds a second.

        :raises Refusal: it is out of range
        """
        # + 0.0 removes the sign of a negative zero.
        speed = float(speed) + 0.0
        parameters.set_value(self._node, 'speed', speed)
        return f'speed {speed:g}'

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns].

        :raises Refusal: it is not in the history
        """
        self._statistics.reset_pace()
        return self._simulation.seek(stamp)

    def step(self) -> str:
        """
        Advance a paused world by one frame; during a seek, queue that frame.

        :raises Running: time is running
        """
        if self._simulation.speed != 0:
            raise Running('time is running; pause first')
        if not self._loop.apply_up_to_seek():
            return f'at {self._simulation.playback.queue_frame() * 1e-9:.6f} s'
        self._loop.advance_frame()
        return f'at {self._simulation.world.stamp * 1e-9:.6f} s'

    def _run_at(self, speed: float) -> str:
        self.set_speed(speed)
        return run_state(speed)
