# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The control of time: speed, seeks, single frames, and the way back to the beginning.

Law: the simulation has the speed; the parameter `speed` mirrors it, as others do the settings.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from physsim_ros.files import on_thread
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Running
from physsim_ros.model.timeline import run_state
from physsim_ros.model.translation import Text
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.frame_statistics import FrameStatistics
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.ros.requests.services import Service
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import Beginning, beginning_of
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64


class NodeTimeControl:
    """
    The control of the time of a world; a returned text is a message about what was done.

    :param simulation: whose time it is
    :param loop: of the node, which makes single frames
    :param statistics: of the frames
    :param values: of the parameters of the node, by name, always up to date
    """

    def __init__(
        self,
        simulation: Simulation,
        loop: FrameLoop,
        statistics: FrameStatistics,
        values: Mapping[str, Any],
    ) -> None:
        self._simulation = simulation
        self._loop = loop
        self._statistics = statistics
        self._values = values

    @property
    def services(self) -> dict[str, Service]:
        """Return the services of time, by their names."""
        simulation, values = self._simulation, self._values
        return {
            'play': Service(self.play),
            'pause': Service(self.pause),
            'rewind': Service(lambda: self._run_at(-1.0)),
            'fast_forward': Service(lambda: self._run_at(values['fast_speed'])),
            'fast_rewind': Service(lambda: self._run_at(-values['fast_speed'])),
            'step': Service(self._step),
            'undo': Service(simulation.undo, Wait.BEHIND_REQUESTS),
            'redo': Service(simulation.redo, Wait.BEHIND_REQUESTS),
            'reset': Service(self.reset, Wait.BEHIND_REQUESTS),
        }

    def subscribe(self, topics: RequestTopics) -> None:
        """Subscribe to `~/speed` and `~/seek`."""
        topics.subscribe(Float64, '~/speed', self._receive_speed)
        topics.subscribe(Clock, '~/seek', self._receive_seek)

    def _receive_speed(self, message: Float64) -> None:
        told = self.set_speed(message.data)
        self._simulation.requests.tell(Answer(topic='~/speed', message=told))

    def _receive_seek(self, message: Clock) -> None:
        stamp = message.clock.sec * 10**9 + message.clock.nanosec
        self.submit_seek(stamp, Origin('~/seek'))

    def set_speed(self, speed: float) -> Text:
        """
        Set the speed [simulation seconds a second].

        :raises Refusal: it is out of range
        """
        # + 0.0 removes the sign of a negative zero.
        self._simulation.speed = speed + 0.0
        return Text('speed {speed:g}', speed=self._simulation.speed)

    def _run_at(self, speed: float) -> Text:
        self.set_speed(speed)
        return run_state(speed)

    def play(self) -> Text:
        """Run at speed 1."""
        return self._run_at(1.0)

    def pause(self) -> Text:
        """Stop time."""
        return self._run_at(0.0)

    def submit_seek(self, stamp: int, origin: Origin) -> None:
        """Go to a simulation time [ns], in place of a seek under way; its end is answered."""
        self._statistics.reset_pace()
        self._simulation.requests.submit_seek(stamp, origin)
        self._loop.apply_ready()

    def _step(self) -> Text:
        """
        Advance a paused world by one frame; during a seek, queue that frame.

        :raises Running: time is running
        """
        if self._simulation.speed == 0 and not self._loop.apply_ready():
            return _at(self._simulation.playback.queue_frame())
        return self.step_now()

    def step_now(self) -> Text:
        """
        Advance a paused world by one frame, after a seek that is under way.

        :raises Running: time is running
        """
        if self._simulation.speed != 0:
            raise Running('time is running; pause first')
        self._loop.advance_frame()
        return _at(self._simulation.stamp)

    async def reset(self) -> Text:
        """Go to the beginning, which a thread builds."""
        return self._simulation.reset(ahead=await self.beginning())

    async def beginning(self) -> Beginning:
        """Return the beginning of the state that was loaded last, which a thread builds."""
        loaded, rate = self._simulation.loaded, self._simulation.physics_rate
        return await on_thread(partial(beginning_of, loaded, rate))


def _at(stamp: int) -> Text:
    """Return the message about a moment, by its simulation time [ns]."""
    return Text('at {time}', time=f'{stamp * 1e-9:.6f} s')
