# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The node: parameters, topics, services and pages around a Simulation.

Law: the node connects; what a message means is decided by the files that it names, and what
happens then by the simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
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
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.model.texts import counted
from physsim_ros.ros import parameters
from physsim_ros.ros.diagnostics_publisher import DiagnosticsPublisher
from physsim_ros.ros.frame_outputs import FrameOutputs
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.pages import Pages
from physsim_ros.ros.qos_safe_node import NodeWithoutQosEvents
from physsim_ros.ros.requests.drawing_topics import DrawingTopics
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

# Time after which a tick simulates no further publish period [ns]: requests, services and signals
# wait at most so long, which a person hardly notices. At speed 64 a frame has 64 periods.
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


class PhysSimNode(NodeWithoutQosEvents):
    """
    A physics world on the ROS graph.

    :param context: of ROS; None is the default one
    :param namespace: of the node; '' is that of the command line
    :param parameter_overrides: values that override those of the command line
    :raises PhysSimError: a parameter or the world file is refused

    :ivar boundary: where unexpected errors of messages and outputs end
    :ivar simulation: the world and its time
    :ivar world_files: reads and writes the world file of parameter `world_file`
    :ivar outputs: the topics, the viewer and the sketchpad
    :ivar fleet: the topics of robots
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
    ) -> None:
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
        self._started = False
        # Duration of the last tick with a frame, without its requests [ns].
        self._rest_ns = 0
        self.message_delay = 0.0
        self.on_quit: Callable[[], object] | None = None
        self._is_quitting = False
        self._values = parameters.declare(self)
        # rclpy 7.1 has no public name for the values that it was started with.
        parameters.check_names(self._parameter_overrides, self, sys.argv)
        self.simulation = Simulation(
            physics_rate=self._values['physics_rate'],
            publish_rate=self._values['publish_rate'],
            settings=parameters.world_settings(self._values),
            speed=self._values['speed'],
            history=self._values['history'],
            history_memory=self._values['history_memory'],
            boundary=self.boundary,
        )
        self._session = DrawingSession(
            parameters.drawing_settings(self._values),
            Tool(self._values['tool']),
            clock=time.thread_time,
        )
        self.world_files = WorldFiles(self.simulation, self._values, self.get_logger().info)
        self.outputs = FrameOutputs(self, self._values, self._session, self.boundary)
        self._closing.callback(self.outputs.close)
        self.fleet = Fleet(self, self._values, self.simulation.requests, self.boundary)
        if self._values['world_file']:
            with self.boundary.reading('world_file'):
                self.world_files.begin_with()
        self.outputs.topics.timeline.publish(self.simulation.status, moving=False)
        self._create_subscriptions()
        self._create_services()
        self._live_parameters = LiveParameters(
            self,
            self._values,
            self.simulation,
            self._session,
            effects={
                'publish_clock': self.outputs.update_clock,
                'sketchpad': self._pages.update,
                'viewer': self._open_viewer,
            },
            prepare={
                'sketchpad': self._pages.open_for,
                'sketchpad_locked': lambda value: locks_of(parameters.listed_names(value)),
            },
            on_change=self.outputs.publish_preview,
            boundary=self.boundary,
        )
        self._live_parameters.mirror_settings()
        self._pages.open_for(self._values['sketchpad'])
        self._pages.update()

    def _create_subscriptions(self) -> None:
        frame_id = self._values['frame_id']
        self.requests = RequestTopics(self, self.simulation.requests, self.boundary, frame_id)
        self._diagnostics = DiagnosticsPublisher(
            self, self.simulation, self.outputs, self.requests, self.boundary
        )
        self._drawing_topics = DrawingTopics(
            self.requests,
            self.simulation,
            self._session,
            frame_id=frame_id,
            current_snapshot=self._current_snapshot,
            publish_preview=self.outputs.publish_preview,
        )
        self._time_control = TimeControl(
            self,
            self.simulation,
            self._values,
            apply_up_to_seek=self._apply_up_to_seek,
            advance_frame=self.advance_frame,
            on_seek=self.outputs.statistics.reset_pace,
        )
        self._time_control.subscribe(self.requests)

    def _create_services(self) -> None:
        simulation = self.simulation
        services = {
            **{name: Service(action) for name, action in self._time_control.actions.items()},
            'undo': Service(simulation.undo, Wait.BEHIND_REQUESTS),
            'redo': Service(simulation.redo, Wait.BEHIND_REQUESTS),
            'reset': Service(simulation.reset, Wait.BEHIND_REQUESTS),
            'instead': Service(self._drawing_topics.read_instead),
            'clear': Service(lambda: simulation.perform(DeleteAll()), Wait.FOR_SEEK),
            'load_world': Service(lambda: self.world_files.load(confined=True), Wait.FOR_SEEK),
            'save_world': Service(self.world_files.save, Wait.FOR_SEEK),
        }
        calls = ServiceCalls(simulation.requests, self._submit_call, self.boundary)
        create_services(self, services, calls, on_success=self._note_change)
        self._parameter_services = ParameterServices(self, calls)
        control = WorldControl(
            boundary=self.boundary,
            simulation=simulation,
            values=self._values,
            set_parameter=partial(parameters.set_value, self),
            world_dir=self.world_files.directory,
            drawing_settings=lambda: parameters.drawing_settings(self._values),
            current_snapshot=self._current_snapshot,
            submit_call=self._submit_call,
            services=services,
            note_change=self._note_change,
            perform_on=lambda name, world: self._perform_on(services[name], world),
            set_speed=self._time_control.set_speed,
            seek=self._time_control.seek,
            locked_bodies=lambda: parameters.listed_names(self._values['sketchpad_locked']),
            end_program=self._end_program,
        )
        create_simulation_services(self, control, calls)
        self._pages = Pages(
            self,
            self.outputs,
            control,
            apply_requests=self.apply_requests,
            is_started=lambda: self._started,
        )

    def _perform_on(self, service: Service, world: str) -> str:
        """
        Perform a service on the world file of a name; where that is refused, nothing has changed.

        :raises PhysSimError: it is refused
        """
        before = self._values['world_file']
        parameters.set_value(self, 'world_file', world)
        try:
            return service.perform()
        except PhysSimError:
            parameters.set_value(self, 'world_file', before)
            raise

    def _end_program(self) -> bool:
        """Have a later tick end the program; return whether it may."""
        self._is_quitting = self.on_quit is not None
        return self._is_quitting

    def start(self) -> None:
        """Start the viewer and the diagnostics; `tick` advances time from now on."""
        self._started = True
        self._pages.print_addresses()
        # A viewer that is opened begins a recording anew that has failed.
        self._open_viewer()
        if self._values['record_file']:
            self.outputs.viewer.record(Path(self._values['record_file']))
        self.get_logger().info(f'ready: {counted(len(self.simulation.world), "body")}')

    def _open_viewer(self) -> None:
        """Open the viewer of parameter `viewer`, once the node has started."""
        if self._started:
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
        Advance the world to a steady time, and publish the frames.

        :param now_ns: steady time, monotonic [ns]
        """
        began = time.perf_counter_ns()
        if self._is_quitting and self.on_quit is not None:
            self._is_quitting = False
            self.on_quit()
        if self._started:
            self._diagnostics.publish_due(now_ns, message_delay=self.message_delay)
        self._handle_pages()
        self._submit_commands()
        frames: tuple[Frame, ...] = ()
        request_time = _RequestTime(self._rest_ns)
        # While time goes back, no command counts, and controllers may be silent.
        if self.simulation.speed < 0.0 or not self.fleet.is_waiting:
            frames = self.simulation.advance(
                now_ns,
                is_overdue=lambda: (
                    self.fleet.in_lockstep or time.perf_counter_ns() - began > MOST_TICK_NS
                ),
                is_spent=request_time.is_spent,
            )
        stepped = time.perf_counter_ns()
        for frame in frames:
            self.publish_frame(frame)
        if not frames:
            self._report_answers()
            self.outputs.republish()
            return
        self._rest_ns = time.perf_counter_ns() - request_time.ended
        last = frames[-1]
        if last.moved:
            self.outputs.statistics.add(
                now_ns=now_ns,
                stamp=last.snapshot.stamp,
                step_ns=stepped - began,
                frame_ns=time.perf_counter_ns() - began,
            )
        else:
            self.outputs.statistics.reset_pace()

    def advance_frame(self) -> None:
        """Advance the world by one publish period, at any time, and publish the frame."""
        self._handle_pages()
        self._submit_commands()
        self.publish_frame(self.simulation.advance_frame())

    def publish_frame(self, frame: Frame) -> None:
        """Publish a frame on the topics, in the viewer and on the pages."""
        self._live_parameters.mirror_settings()
        self.outputs.publish_frame(frame, self.simulation.status)
        self.fleet.publish(frame)

    def _submit_commands(self) -> None:
        """Submit what robots were told since the frame before; none while the past is shown."""
        shown = self.frame
        self.fleet.submit_commands(
            in_past=self.simulation.speed < 0.0 or (shown is not None and shown.past)
        )

    def apply_requests(self) -> tuple[Answer, ...]:
        """Apply the waiting requests without advancing time, publish and return the answers."""
        self._update_contact_recording()
        frame = self.simulation.apply_requests()
        if frame is not None:
            self.publish_frame(frame)
            return frame.answers
        answers = self._report_answers()
        self.outputs.topics.events.flush()
        return answers

    def _handle_pages(self) -> None:
        """Carry out the messages of pages."""
        self._update_contact_recording()
        if self.outputs.sketchpad is not None:
            self.outputs.sketchpad.handle_messages()

    def _update_contact_recording(self) -> None:
        """Record contacts while there is a subscriber, a viewer or a page that shows them."""
        wanted = self.outputs.wants_contacts or self.fleet.wants_contacts()
        self.simulation.reports_contacts = wanted

    def _apply_up_to_seek(self) -> bool:
        """
        Apply the requests before a seek that there is time for; return whether none waits.

        Before `start` nothing is applied, and True is returned.
        """
        if not self._started:
            return True
        return self.simulation.apply_up_to_seek(_RequestTime(self._rest_ns).is_spent)

    def _submit_call(self, call: Callable[[], Iterable[Answer]], wait: Wait) -> None:
        """
        Make a call at its time among the requests, now if they leave the time for it.

        :raises Busy: too many requests wait
        """
        self.simulation.requests.submit_call(call, wait)
        if self._started:
            self._apply_up_to_seek()
        elif wait is not Wait.NONE:
            self.simulation.apply_waiting()

    def _current_snapshot(self) -> Snapshot:
        """Return the snapshot that is shown, with the waiting requests if they are applied."""
        if self._apply_up_to_seek():
            self.apply_requests()
        return self.simulation.world.snapshot() if self.frame is None else self.frame.snapshot

    def _note_change(self) -> None:
        """Have the parameters mirror the world, and a short seek be done at once."""
        self._live_parameters.mirror_settings()
        began = time.perf_counter_ns()
        self.simulation.finish_seek(lambda: time.perf_counter_ns() - began > MOST_TICK_NS)

    # Answers

    def _report_answers(self) -> tuple[Answer, ...]:
        """Publish and log the answers that no frame carries, and return them."""
        answers = self.simulation.take_answers()
        self.outputs.report_answers(answers)
        return answers
