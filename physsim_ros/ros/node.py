# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The node: parameters, topics, services and pages around a Simulation.

Law: the node connects; what a message means is decided by the files that it names, and what
happens then by the simulation.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
import sys
import time
from typing import Any

from physsim_ros.drawing import DrawingSession, Tool
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import PhysSimError
from physsim_ros.model.requests import DeleteAll
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.model.texts import counted
from physsim_ros.ros import parameters
from physsim_ros.ros.diagnostics_publisher import DiagnosticsPublisher
from physsim_ros.ros.drawing_topics import DrawingTopics
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.pages import Pages
from physsim_ros.ros.qos_safe_node import NodeWithoutQosEvents
from physsim_ros.ros.requests.parameter_services import ParameterServices
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.ros.requests.services import create_services, Service, ServiceCalls
from physsim_ros.ros.robots import Fleet
from physsim_ros.ros.simulation_services import create_simulation_services
from physsim_ros.ros.time_control import TimeControl
from physsim_ros.ros.world_files import WorldFiles
from physsim_ros.simulation.request_queue import Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import locks_of, WorldControl
from rclpy.context import Context
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.parameter import Parameter
import rclpy.service
from rclpy.subscription import Subscription


class PhysSimNode(NodeWithoutQosEvents):
    """
    A physics world on the ROS graph.

    :param context: of ROS; None is the default one
    :param namespace: of the node; '' is that of the command line
    :param parameter_overrides: values that override those of the command line
    :param expected_commands: type of the commands of robots that is subscribed to while nobody
        publishes them; None is none, where the process has other nodes
    :raises PhysSimError: a parameter or the world file is refused

    :ivar boundary: where unexpected errors of messages and outputs end
    :ivar simulation: the world and its time
    :ivar world_files: reads and writes the world file of parameter `world_file`
    :ivar outputs: the topics, the viewer and the sketchpad
    :ivar fleet: the topics of robots
    :ivar loop: applies requests, advances time, shows frames
    :ivar requests: the topics of requests
    :ivar message_delay: time that messages wait before they are handled [s]
    :ivar on_quit: ends the program, where a service may; None where it has other worlds as well
    """

    def __init__(
        self,
        *,
        context: Context | None = None,
        namespace: str = '',
        parameter_overrides: list[Parameter] | None = None,
        expected_commands: type | None = None,
    ) -> None:
        self._expected_commands = expected_commands
        try:
            super().__init__(
                'physsim',
                context=context,
                namespace=namespace,
                parameter_overrides=parameter_overrides,
                start_parameter_services=False,
            )
        except rclpy_implementation.RCLError as error:
            # As for a namespace of the command line that is longer than a name of DDS may be.
            raise PhysSimError(str(error)) from error
        self.boundary = ErrorBoundary(self.get_logger().error, time.thread_time)
        self._closing = ExitStack()
        try:
            self._set_up()
        except BaseException:
            # A refused node leaves nothing on the graph.
            self.destroy_node()
            raise

    def _set_up(self) -> None:
        """
        Create the world, then publishers, subscriptions and services.

        :raises PhysSimError: a parameter or the world file is refused
        """
        self.message_delay = 0.0
        self.on_quit: Callable[[], object] | None = None
        self._is_quitting = False
        self._values = parameters.declare(self)
        # rclpy 7.1 has no public name for the values that it was started with.
        parameters.check_names(self._parameter_overrides, self, sys.argv)
        self._create_world()
        self._create_loop()
        self._create_doors()
        self._live_parameters = LiveParameters(
            self,
            self._values,
            self.simulation,
            self._session,
            effects={'sketchpad': self._pages.update, 'viewer': self._open_viewer},
            prepare={
                'sketchpad': self._pages.open_for,
                'sketchpad_locked': lambda value: locks_of(parameters.listed_names(value)),
            },
            on_change=self.outputs.publish_preview,
            boundary=self.boundary,
        )
        self._live_parameters.mirror_settings()
        self.outputs.all.insert(0, self._live_parameters)
        self._pages.open_for(self._values['sketchpad'])
        self._pages.update()

    def _create_world(self) -> None:
        """Create the simulation, which begins with the world file, and the drawing session."""
        values = self._values
        self.simulation = Simulation(
            physics_rate=values['physics_rate'],
            publish_rate=values['publish_rate'],
            settings=parameters.world_settings(values),
            speed=values['speed'],
            history=values['history'],
            history_memory=values['history_memory'],
            boundary=self.boundary,
        )
        self._session = DrawingSession(
            parameters.drawing_settings(values), Tool(values['tool']), clock=time.thread_time
        )
        self.world_files = WorldFiles(self.simulation, values, self.get_logger().info)
        if values['world_file']:
            with self.boundary.reading('world_file'):
                self.world_files.begin_with()

    def _create_loop(self) -> None:
        """Create the outputs and the loop that shows them frames."""
        values, boundary = self._values, self.boundary
        self.outputs = Outputs(self, values, self._session, self.simulation, boundary)
        self._closing.callback(self.outputs.close)
        expected = self._expected_commands
        self.fleet = Fleet(self, values, self.simulation.requests, boundary, expected=expected)
        self.outputs.all.append(self.fleet)
        self.outputs.topics.timeline.publish(may_wait=False)
        self.loop = FrameLoop(self.simulation, self.outputs, self.fleet)

    def _create_doors(self) -> None:
        """Create topics and services of requests, and the control of pages."""
        simulation, outputs, loop, values = self.simulation, self.outputs, self.loop, self._values
        frame_id, requests = values['frame_id'], simulation.requests
        self.requests = topics = RequestTopics(self, requests, self.boundary, frame_id)
        self._diagnostics = DiagnosticsPublisher(self, simulation, outputs, topics, self.boundary)
        drawing = DrawingTopics(
            topics, simulation, self._session, frame_id=frame_id, loop=loop, outputs=outputs
        )
        control = TimeControl(self, simulation, values, loop, outputs.statistics)
        control.subscribe(topics)
        self._actions = {
            **{name: Service(action) for name, action in control.actions.items()},
            'undo': Service(simulation.undo, Wait.BEHIND_REQUESTS),
            'redo': Service(simulation.redo, Wait.BEHIND_REQUESTS),
            'reset': Service(simulation.reset, Wait.BEHIND_REQUESTS),
            'instead': Service(drawing.read_instead),
            'clear': Service(lambda: simulation.perform(DeleteAll()), Wait.FOR_SEEK),
            'load_world': Service(lambda: self.world_files.load(confined=True), Wait.FOR_SEEK),
            'save_world': Service(self.world_files.save, Wait.FOR_SEEK),
        }
        calls = ServiceCalls(requests, loop.submit_call, self.boundary)
        create_services(self, self._actions, calls, on_success=self._note_change)
        self._parameter_services = ParameterServices(self, calls)
        world = WorldControl(
            boundary=self.boundary,
            simulation=simulation,
            values=values,
            set_parameter=partial(parameters.set_value, self),
            world_dir=self.world_files.directory,
            drawing_settings=lambda: parameters.drawing_settings(values),
            current_snapshot=loop.current_snapshot,
            submit_call=loop.submit_call,
            services=self._actions,
            note_change=self._note_change,
            perform_on=self._perform_on,
            set_speed=control.set_speed,
            seek=control.seek,
            locked_bodies=lambda: parameters.listed_names(values['sketchpad_locked']),
            end_program=self._end_program,
        )
        create_simulation_services(self, world, calls)
        self._pages = Pages(self, outputs, world, loop)

    def _perform_on(self, service: str, world: str) -> str:
        """
        Perform a service on the world file of a name; where that is refused, nothing has changed.

        :raises PhysSimError: it is refused
        """
        before = self._values['world_file']
        parameters.set_value(self, 'world_file', world)
        try:
            return self._actions[service].perform()
        except PhysSimError:
            parameters.set_value(self, 'world_file', before)
            raise

    def _note_change(self) -> None:
        """Have the parameters mirror the world, and a short seek be done at once."""
        self._live_parameters.mirror_settings()
        self.loop.finish_short_seek()

    def _end_program(self) -> bool:
        """Have a later tick end the program; return whether it may."""
        self._is_quitting = self.on_quit is not None
        return self._is_quitting

    def start(self) -> None:
        """Start the viewer and the diagnostics; `tick` advances time from now on."""
        self.loop.started = True
        self._pages.print_addresses()
        # A viewer that is opened begins a recording anew that has failed.
        self._open_viewer()
        if self._values['record_file']:
            self.outputs.viewer.record(Path(self._values['record_file']))
        self.get_logger().info(f'ready: {counted(len(self.simulation.world), "body")}')

    def _open_viewer(self) -> None:
        """Open the viewer of parameter `viewer`, once the node has started."""
        if self.loop.started:
            self.outputs.open_viewer()

    def create_subscription(self, *args: Any, **options: Any) -> Subscription:
        """Create a subscription, as `Node.create_subscription` does, behind the boundary."""
        kind, topic, callback, *others = args

        def receive(message: Any) -> None:
            with self.boundary.output(topic):
                callback(message)

        return super().create_subscription(kind, topic, receive, *others, **options)

    def create_service(self, *args: Any, **options: Any) -> rclpy.service.Service:
        """Create a service, as `Node.create_service` does; after an error, its reply is empty."""
        kind, name, callback, *others = args

        def respond(request: Any, response: Any) -> Any:
            with self.boundary.output(name):
                return callback(request, response)
            return response

        return super().create_service(kind, name, respond, *others, **options)

    def destroy_node(self) -> None:
        """Close the viewer and the sketchpad, and destroy the node."""
        self._closing.close()
        super().destroy_node()

    # Frames

    @property
    def frame(self) -> Frame | None:
        """Return the last frame that was published; None before the first."""
        return self.outputs.frame

    @property
    def publish_period(self) -> float:
        """Return the time from one tick to the next [s]."""
        return 1.0 / float(self._values['publish_rate'])

    @property
    def frame_period(self) -> float:
        """Return the simulation time of a frame at speed 1 [s]."""
        return self.simulation.frame_steps / self.simulation.physics_rate

    def tick(self, now_ns: int) -> None:
        """
        Advance the world to a steady time, and show the frames.

        :param now_ns: steady time, monotonic [ns]
        """
        if self._is_quitting and self.on_quit is not None:
            self._is_quitting = False
            self.on_quit()
        if self.loop.started:
            self._diagnostics.publish_due(now_ns, message_delay=self.message_delay)
        self.loop.tick(now_ns)

    def advance_frame(self) -> None:
        """Advance the world by one publish period, at any time, and show the frame."""
        self.loop.advance_frame()

    def apply_requests(self) -> tuple[Answer, ...]:
        """Apply the waiting requests without advancing time; show and return the answers."""
        return self.loop.apply_requests()
