# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The node: parameters, topics, services and pages around a Simulation.

Law: the node connects; what a message means is decided by the files that it names, and what
happens then by the simulation.
"""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
import sys
import time
from typing import Any

from physsim_ros.drawing import DrawingSession, Tool
from physsim_ros.model.errors import PhysSimError
from physsim_ros.model.requests import DeleteAll
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.translation import counted
from physsim_ros.ros import parameters
from physsim_ros.ros.diagnostics import Diagnostics
from physsim_ros.ros.drawing_topics import DrawingTopics
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.pages import Pages
from physsim_ros.ros.requests.parameter_services import ParameterServices
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.ros.requests.services import create_services, Service, ServiceCalls
from physsim_ros.ros.robots import Fleet
from physsim_ros.ros.simulation_services import create_simulation_services
from physsim_ros.ros.time_control import NodeTimeControl
from physsim_ros.ros.world_files import WorldFiles
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Wait
from physsim_ros.simulation.simulation import Simulation
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
    :ivar request_topics: the topics of requests
    :ivar control: what services, topics and pages do besides single requests
    :ivar diagnostics: publishes `/diagnostics`
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
        # The node is the source of `/clock`, and no reader, whatever `use_sim_time` is; nor does
        # its clock wait for one. rclpy 7.1 has no public name for that.
        self._time_source.detach_node()
        self._time_source.ros_time_is_active = False
        self._time_source._associated_clocks.clear()  # noqa: SLF001
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
        self._values = parameters.declare(self)
        # rclpy 7.1 has no public name for the values that it was started with.
        parameters.check_names(self._parameter_overrides, self, sys.argv)
        self._create_world()
        self._create_outputs()
        self._create_doors()
        self._live.effects['viewer'] = self._open_viewer
        self._live.mirror_world()
        self._pages = Pages(self, self.outputs, self.control, self.loop, self._live)

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
        self.world_files = WorldFiles(self.simulation, values)
        if values['world_file']:
            with self.boundary.refusing('world_file'):
                self.world_files.begin_with()

    def _create_outputs(self) -> None:
        """Create the outputs and the loop that shows them frames."""
        values, boundary, simulation = self._values, self.boundary, self.simulation
        expected, session = self._expected_commands, self._session
        requests, past = simulation.requests, simulation.past
        self._live = live = LiveParameters(self, values, simulation, session, boundary)
        self.fleet = fleet = Fleet(self, values, requests, past, boundary, expected=expected)
        self.outputs = outputs = Outputs(
            self, values, session, simulation, boundary, parameters=live, robots=fleet
        )
        self._closing.callback(outputs.close)
        outputs.publishers.timeline.publish()
        self.loop = FrameLoop(simulation, outputs, fleet)

    def _create_doors(self) -> None:
        """Create topics and services of requests."""
        simulation, outputs, loop = self.simulation, self.outputs, self.loop
        boundary, frame_id = self.boundary, self._values['frame_id']
        self.request_topics = topics = RequestTopics(self, simulation.requests, boundary, frame_id)
        self.diagnostics = Diagnostics(self, simulation, outputs, topics, boundary)
        drawing = DrawingTopics(topics, simulation, self._session, frame_id=frame_id, loop=loop)
        time_control = NodeTimeControl(simulation, loop, outputs.statistics, self._values)
        time_control.subscribe(topics)
        services = {
            **time_control.services,
            **self.world_files.services,
            'clear': Service(lambda: simulation.perform(DeleteAll()), Wait.FOR_SEEK),
            'instead': Service(drawing.read_instead),
        }
        self.control = control = NodeControl(
            simulation,
            time_control,
            services,
            loop=loop,
            outputs=outputs,
            files=self.world_files,
            live=self._live,
            boundary=boundary,
        )
        calls = ServiceCalls(simulation.requests, loop.make_call, boundary)
        create_services(self, services, calls, on_success=control.note_change)
        self._parameter_services = ParameterServices(self, self._live, calls)
        self._closing.callback(create_simulation_services(self, control, calls))

    def start(self) -> None:
        """Start viewer and diagnostics, and show the first frame; `tick` advances time."""
        self.loop.started = True
        self._pages.print_addresses()
        # A viewer that is opened begins a recording anew that has failed.
        self._open_viewer()
        if self._values['record_file']:
            self.outputs.viewer.record(Path(self._values['record_file']))
        # The first frame does not wait for the first line of the log, which takes 20 ms: rclpy 7.1
        # looks up the file that it comes from.
        self.loop.apply_requests()
        self.get_logger().info(f'ready: {counted(len(self.simulation.world), "body")}')

    def _open_viewer(self) -> None:
        """Open the viewer of parameter `viewer`, once the node has started."""
        if self.loop.started:
            self.outputs.open_viewer()

    def create_subscription(self, *args: Any, **options: Any) -> Subscription:
        """Create a subscription, as `Node.create_subscription` does, behind the boundary."""
        kind, topic, callback, *others = args

        def receive(message: Any) -> None:
            with self.boundary.containing(topic):
                callback(message)

        return super().create_subscription(kind, topic, receive, *others, **options)

    def create_service(self, *args: Any, **options: Any) -> rclpy.service.Service:
        """Create a service, as `Node.create_service` does; after an error, its reply is empty."""
        kind, name, callback, *others = args

        def respond(request: Any, response: Any) -> Any:
            with self.boundary.containing(name):
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
        self.control.quit_if_asked()
        if self.loop.started:
            self.diagnostics.publish_due(now_ns)
        self.loop.tick(now_ns)
