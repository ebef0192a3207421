# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What the node does besides single requests: services, time, world files, the end of the program.

Law: services, topics, pages and `simulation_interfaces` do it all by this one control.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.files import on_thread
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Running
from physsim_ros.model.requests import DeleteAll
from physsim_ros.model.timeline import run_state
from physsim_ros.ros import parameters
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.ros.requests.services import Service
from physsim_ros.ros.world_files import WorldFiles
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import in_slices, Sliced
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import Beginning, beginning_of
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64


class NodeControl:
    """
    The control of a node; a returned text is a message about what was done.

    :param simulation: of the node
    :param loop: of the node, which makes single frames
    :param outputs: of the node, with the statistics of frames
    :param world_files: reads and writes the world
    :param live: the parameters of the node
    :param boundary: of the node

    :ivar values: of the parameters of the node, by name, always up to date
    :ivar services: by their names
    :ivar current_snapshot: applies the waiting requests, and returns the snapshot that is shown
    :ivar make_call: makes a call at its time among the requests
    :ivar on_quit: ends the program, where a service may; None where it has other worlds as well
    """

    def __init__(
        self,
        simulation: Simulation,
        *,
        loop: FrameLoop,
        outputs: Outputs,
        world_files: WorldFiles,
        live: LiveParameters,
        boundary: ErrorBoundary,
    ) -> None:
        self.boundary = boundary
        self.simulation = simulation
        self.values: Mapping[str, Any] = live.values
        self.on_quit: Callable[[], object] | None = None
        self._is_quitting = False
        self._loop = loop
        self.current_snapshot = loop.current_snapshot
        self.make_call = loop.make_call
        self._outputs = outputs
        self._files = world_files
        self._live = live
        # The world whose bodies are locked: the one that was loaded last when they were.
        self._locked_in = simulation.loaded.world
        self.services = {
            'play': Service(lambda: self._run_at(1.0)),
            'pause': Service(lambda: self._run_at(0.0)),
            'rewind': Service(lambda: self._run_at(-1.0)),
            'fast_forward': Service(lambda: self._run_at(self.values['fast_speed'])),
            'fast_rewind': Service(lambda: self._run_at(-self.values['fast_speed'])),
            'step': Service(self._step),
            'undo': Service(simulation.undo, Wait.BEHIND_REQUESTS),
            'redo': Service(simulation.redo, Wait.BEHIND_REQUESTS),
            'reset': Service(self.reset, Wait.BEHIND_REQUESTS),
            'clear': Service(lambda: simulation.perform(DeleteAll()), Wait.FOR_SEEK),
            'load_world': Service(lambda: world_files.load(confined=True), Wait.FOR_SEEK),
            'save_world': Service(world_files.save, Wait.TO_READ),
        }

    # Values

    @property
    def world_dir(self) -> Path:
        """Return the directory of the user's worlds."""
        return self._files.directory

    @property
    def lesson_dir(self) -> Path:
        """Return the directory of the user's lessons."""
        return self._files.lessons

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""
        return parameters.drawing_settings(self.values)

    @property
    def recording_address(self) -> str:
        """Return the address of the viewer's web page on this machine; '' while there is none."""
        return self._outputs.viewer.page_address

    @property
    def is_frozen(self) -> bool:
        """Whether pages of pupils change nothing."""
        return bool(self.values['sketchpad_frozen'])

    @property
    def locked_bodies(self) -> tuple[str, ...]:
        """Return patterns of the names of bodies that pupils do not change, in this world."""
        if self._locked_in is not self.simulation.loaded.world:
            return ()
        return parameters.listed_names(self.values['sketchpad_locked'])

    def note_locked(self) -> None:
        """Note that `sketchpad_locked` is about the world of now."""
        self._locked_in = self.simulation.loaded.world

    def set_parameter(self, name: str, value: Any) -> None:
        """
        Set a parameter.

        :raises Refusal: it is refused
        """
        self._live.set_together([Parameter(name, value=value)])

    # Requests

    def service(self, name: str) -> Service:
        """Return a service."""
        return self.services[name]

    async def perform_on(self, service: str, world: str) -> str:
        """
        Perform a service on the world file of a name; where that is refused, nothing has changed.

        :raises PhysSimError: it is refused
        """
        return await self._perform_with(world, self.services[service].perform)

    async def open_world(self, world: str) -> str:
        """
        Begin with the world of a name, at time 0; undo reverts it.

        :raises PhysSimError: it is refused, and nothing has changed
        """
        return await self._perform_with(world, self._files.open_world)

    async def _perform_with(self, world: str, action: Sliced[str]) -> str:
        before = self.values['world_file']
        self.set_parameter('world_file', world)
        try:
            return await in_slices(action)
        except Exception:
            # Somebody may have set it meanwhile.
            if self.values['world_file'] == world:
                self.set_parameter('world_file', before)
            raise

    def note_change(self) -> None:
        """Have the parameters mirror the world, and a short seek be done at once."""
        self._live.mirror_settings()
        self._loop.finish_short_seek()

    def end_program(self) -> bool:
        """Have the next tick end the program; return whether it may."""
        self._is_quitting = self.on_quit is not None
        return self._is_quitting

    def quit_if_asked(self) -> None:
        """End the program where that was asked for; called at each tick."""
        if self._is_quitting and self.on_quit is not None:
            self._is_quitting = False
            self.on_quit()

    # Time

    def subscribe(self, topics: RequestTopics) -> None:
        """Subscribe to `~/speed` and `~/seek`."""
        requests = self.simulation.requests

        def set_speed(message: Float64) -> None:
            requests.tell(Answer(topic='~/speed', message=self.set_speed(message.data)))

        def seek(message: Clock) -> None:
            stamp = message.clock.sec * 10**9 + message.clock.nanosec
            self.submit_seek(stamp, Origin('~/seek'))

        topics.subscribe(Float64, '~/speed', set_speed)
        topics.subscribe(Clock, '~/seek', seek)

    def set_speed(self, speed: float) -> str:
        """
        Set the speed, simulation seconds a second.

        :raises Refusal: it is out of range
        """
        # + 0.0 removes the sign of a negative zero.
        speed = float(speed) + 0.0
        self.set_parameter('speed', speed)
        return f'speed {speed:g}'

    def submit_seek(self, stamp: int, origin: Origin) -> None:
        """Go to a simulation time [ns], in place of a seek under way; its end is answered."""
        self._outputs.statistics.reset_pace()
        self.simulation.stop_driving()
        self.simulation.requests.submit_seek(stamp, origin)
        self._loop.apply_in_time()

    def _step(self) -> str:
        """
        Advance a paused world by one frame; during a seek, queue that frame.

        :raises Running: time is running
        """
        if self.simulation.speed == 0 and not self._loop.apply_in_time():
            return f'at {self.simulation.playback.queue_frame() * 1e-9:.6f} s'
        return self.advance_frame()

    def advance_frame(self) -> str:
        """
        Advance a paused world by one frame, after a seek that is under way.

        :raises Running: time is running
        """
        if self.simulation.speed != 0:
            raise Running('time is running; pause first')
        self._loop.make_frame()
        return f'at {self.simulation.world.stamp * 1e-9:.6f} s'

    async def reset(self) -> str:
        """Go to the beginning, which a thread builds."""
        return self.simulation.reset(ahead=await self.beginning())

    async def beginning(self) -> Beginning:
        """Return the beginning of the state that was loaded last, which a thread builds."""
        loaded, rate = self.simulation.loaded, self.simulation.physics_rate
        return await on_thread(partial(beginning_of, loaded, rate))

    def _run_at(self, speed: float) -> str:
        self.set_speed(speed)
        return run_state(speed)
