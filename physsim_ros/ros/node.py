# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The node: subscriptions, parameters and timers around a Simulation.

Law: a callback converts a message, submits the request and reports a refusal; all decisions are
taken by the simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
import sys
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Path as PathMessage
from physsim_ros.drawing import DrawingSession, Reading, submit_reading, Tool
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Anchor, Axle, Configure, Pin, Release, Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.ros import conversions, parameters, stroke_reader
from physsim_ros.ros.diagnostics import Backlog, FrameStatistics
from physsim_ros.ros.page_control import PageControl
from physsim_ros.ros.publishers import Publishers
from physsim_ros.ros.qos_safe_node import NodeWithoutQosEvents
from physsim_ros.ros.reply_pacer import ReplyPacer
from physsim_ros.ros.services import create_services, WorldFiles
from physsim_ros.ros.subscriptions import RequestSubscriptions
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import Role, Sketchpad
from physsim_ros.view import FrameContext, Viewer, ViewerMode
from rcl_interfaces.msg import SetParametersResult
from rclpy.context import Context
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray

# From one message on `/diagnostics` to the next [ns].
DIAGNOSTICS_PERIOD = 1_000_000_000

# Time of a tick after which no further publish period is simulated in it [ns]: requests, services
# and signals wait so long at most, which a person hardly notices. At speed 64 a frame has 64.
MOST_TICK_NS = 100_000_000


class PhysSimNode(NodeWithoutQosEvents):
    """
    A physics world on the ROS graph.

    :param context: of ROS; None is the default one
    :param parameter_overrides: values that override those of the command line
    :raises PhysSimError: a parameter or the world file is refused

    :ivar simulation: the world and its time
    :ivar world_files: reads and writes the world file of parameter `world_file`
    :ivar message_delay: time that messages wait before they are handled [s]
    :ivar requests: the subscriptions of requests
    :ivar frame: the last frame that was published; None before the first
    """

    def __init__(
        self,
        *,
        context: Context | None = None,
        parameter_overrides: list[Parameter] | None = None,
    ) -> None:
        super().__init__(
            'physsim',
            context=context,
            parameter_overrides=parameter_overrides,
            start_parameter_services=False,
        )
        self._viewer = Viewer()
        self._sketchpad: Sketchpad | None = None
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
        self.simulation = Simulation(
            physics_rate=self._values['physics_rate'],
            publish_rate=self._values['publish_rate'],
            settings=parameters.world_settings(self._values),
            speed=self._values['speed'],
            history=self._values['history'],
        )
        self._parameter_service = parameters.ParameterServices(self, self.simulation.tell)
        self._frame_id: str = self._values['frame_id']
        self.world_files = WorldFiles(self.simulation, self._values, self.get_logger().info)
        self._world_publishers = Publishers(
            self,
            frame_id=self._frame_id,
            publish_clock=self._values['publish_clock'],
            publish_tf=self._values['publish_tf'],
        )
        self._session = DrawingSession(
            parameters.drawing_settings(self._values), Tool(self._values['tool'])
        )
        self._statistics = FrameStatistics()
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._diagnostics_due = 0
        self.message_delay = 0.0
        self.frame: Frame | None = None
        self._started = False
        # The settings of the world that the parameters have; None where they may differ.
        self._mirrored: WorldSettings | None = self.simulation.settings
        if self._values['world_file']:
            self.world_files.begin_with()
            self._mirror_settings()
        self._world_publishers.publish_timeline(self.simulation.status, moving=False)
        self._reply_pacer = ReplyPacer(self)
        self.requests = RequestSubscriptions(self, self._refuse_message)
        self._create_subscriptions()
        actions = create_services(
            self,
            self.simulation,
            self.world_files,
            self._reply_pacer,
            fast_speed=lambda: self._values['fast_speed'],
            set_speed=lambda speed: self.set_parameters([Parameter('speed', value=speed)]),
            advance_frame=self.advance_frame,
            read_instead=self._read_instead,
            on_success=self._mirror_settings,
        )
        self._page_control = PageControl(
            simulation=self.simulation,
            values=self._values,
            actions=actions,
            set_parameters=self.set_parameters,
            current_snapshot=self._current_snapshot,
        )
        self._open_sketchpad()
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)

    def start(self) -> None:
        """Start the viewer and the diagnostics; `tick` advances time from now on."""
        self._started = self._reply_pacer.paced = True
        if self._sketchpad is not None:
            _print_addresses(self._sketchpad)
        if self._values['record_file']:
            self.record(Path(self._values['record_file']))
        self._open_viewer()
        self.get_logger().info(f'ready: {len(self.simulation.world)} bodies')

    def tick(self, now_ns: int) -> None:
        """
        Advance the world to a steady time, and publish the frames.

        :param now_ns: steady time, monotonic [ns]
        """
        began = time.perf_counter_ns()
        self._reply_pacer.flush()
        if self._started and now_ns >= self._diagnostics_due:
            self._diagnostics_due = now_ns + DIAGNOSTICS_PERIOD
            self._publish_diagnostics()
        self._handle_pages()
        self._update_contact_recording()
        frames = self.simulation.advance(
            now_ns, is_overdue=lambda: time.perf_counter_ns() - began > MOST_TICK_NS
        )
        stepped = time.perf_counter_ns()
        for frame in frames:
            self.publish_frame(frame)
        if not frames:
            self._report_answers()
            if self.frame is not None and self.frame.preview != self._session.preview:
                # Only the preview has changed: an unfinished gesture was dropped.
                self._show_frame(replace(self.frame, answers=(), moved=False))
            self._world_publishers.publish_to_late_subscribers()
            return
        last = frames[-1]
        if last.moved:
            self._statistics.add(
                now_ns=now_ns,
                stamp=last.snapshot.stamp,
                step_ns=stepped - began,
                frame_ns=time.perf_counter_ns() - began,
            )
        else:
            self._statistics.reset_pace()

    def publish_frame(self, frame: Frame) -> None:
        """Publish a frame on the topics and in the viewer."""
        self._mirror_settings()
        for answer in frame.answers:
            self._log_answer(answer)
        self._world_publishers.publish_frame(frame)
        self._world_publishers.publish_timeline(self.simulation.status, moving=frame.moved)
        self._show_frame(frame)

    def _show_frame(self, frame: Frame) -> None:
        """Send a frame, with the current preview, to the viewer."""
        if self._session.preview != frame.preview:
            frame = replace(frame, preview=self._session.preview)
        self.frame = frame
        statistics = self._statistics
        context = FrameContext(
            real_time_factor=statistics.real_time_factor,
            cost=statistics.frame_cost,
            traced=parameters.traced_names(self._values['trace']),
        )
        self._viewer.show(frame, context=context)
        if self._sketchpad is not None:
            self._sketchpad.show(frame)

    def advance_frame(self) -> None:
        """Advance the world by one publish period, at any time, and publish the frame."""
        self._handle_pages()
        self._update_contact_recording()
        self.publish_frame(self.simulation.advance_frame())

    def apply_requests(self) -> tuple[Answer, ...]:
        """Apply the waiting requests without advancing time, publish and return the answers."""
        self._update_contact_recording()
        frame = self.simulation.settle()
        if frame is not None:
            self.publish_frame(frame)
            return frame.answers
        answers = self._report_answers()
        self._world_publishers.flush_answers()
        return answers

    @property
    def publish_period(self) -> float:
        """Return the time from one tick to the next [s]."""
        return 1.0 / float(self._values['publish_rate'])

    @property
    def frame_period(self) -> float:
        """Return the simulation time of a frame at speed 1 [s]."""
        return self.simulation.frame_steps / self.simulation.physics_rate

    def _update_contact_recording(self) -> None:
        """Record contacts while there is a subscriber or a viewer."""
        self.simulation.watch_contacts(
            self._world_publishers.wants_contacts
            or self._viewer.is_open
            or (self._sketchpad is not None and self._sketchpad.wants_contacts)
        )

    def destroy_node(self) -> None:
        """Close the viewer and the sketchpad, and destroy the node."""
        if self._sketchpad is not None:
            self._sketchpad.close()
        self._viewer.close()
        super().destroy_node()

    # Requests

    def _create_subscriptions(self) -> None:
        def subscribe(kind: type, topic: str, convert: Callable[..., Request]) -> None:
            field = 'point' if kind is PointStamped else ''

            def callback(message: Any) -> None:
                self._submit(message, topic, convert, field=field)

            self.requests.add(kind, topic, callback)

        subscribe(Marker, '~/spawn', conversions.body_request)
        subscribe(Marker, '~/join', conversions.joint_request)
        subscribe(PointStamped, '~/pin', partial(conversions.point_request, Pin))
        subscribe(PointStamped, '~/axle', partial(conversions.point_request, Axle))
        subscribe(PointStamped, '~/anchor', partial(conversions.point_request, Anchor))
        subscribe(PointStamped, '~/release', partial(conversions.point_request, Release))
        subscribe(MultiDOFJointState, '~/command', conversions.command_request)
        subscribe(InteractiveMarkerFeedback, '~/drag/feedback', conversions.hand_request)
        self.requests.add(MarkerArray, '~/spawn_array', self._spawn_array)
        self.requests.add(Float64, '~/speed', self._speed)
        self.requests.add(PointStamped, 'clicked_point', self._click)
        self.requests.add_raw(PathMessage, '~/stroke', self._stroke)
        self.requests.add(Clock, '~/seek', self._seek)

    def _submit(
        self,
        message: Any,
        topic: str,
        convert: Callable[..., Request],
        *,
        joined: bool = False,
        field: str = '',
    ) -> None:
        try:
            request = convert(message, frame_id=self._frame_id)
        except Refusal as refusal:
            subject = conversions.subject_of(message, joint=topic == '~/join')
            self.simulation.refuse(refusal, topic=topic, subject=subject, joined=joined)
            return
        self.simulation.submit(request, topic=topic, joined=joined, field=field)

    def _submit_all(self, requests: Iterable[Request], topic: str, field: str) -> None:
        """Submit the requests of one gesture, which are undone together."""
        for number, request in enumerate(requests):
            self.simulation.submit(request, topic=topic, joined=number > 0, field=field)

    def _refuse_message(self, refusal: Refusal, topic: str) -> None:
        self.simulation.refuse(refusal, topic=topic, subject='')

    def _spawn_array(self, message: MarkerArray) -> None:
        if not message.markers:
            self.simulation.tell(Answer(topic='~/spawn_array', message='the array is empty'))
        for number, marker in enumerate(message.markers):
            self._submit(marker, '~/spawn_array', conversions.body_request, joined=number > 0)

    def _speed(self, message: Float64) -> None:
        # + 0.0 removes the sign of a negative zero.
        speed = Parameter('speed', value=message.data + 0.0)
        try:
            # Checked here as well: a refusal by rclpy has no code.
            parameters.check(speed)
        except Refusal as refusal:
            self._refuse_command(refusal, '~/speed')
            return
        self.set_parameters([speed])
        self.simulation.tell(Answer(topic='~/speed', message=f'speed {speed.value:g}'))

    def _seek(self, message: Clock) -> None:
        stamp = message.clock.sec * 10**9 + message.clock.nanosec
        try:
            done = self.simulation.seek(stamp)
        except Refusal as refusal:
            self._refuse_command(refusal, '~/seek')
            return
        self._statistics.reset_pace()
        self._mirror_settings()
        self.simulation.tell(Answer(topic='~/seek', message=done))

    def _click(self, message: PointStamped) -> None:
        with self._drawing_on_snapshot('clicked_point', 'point') as snapshot:
            point, frame = conversions.point_in_frame(message, frame_id=self._frame_id)
            result = self._session.click(point, frame, snapshot)
            if result.message:
                self.simulation.tell(Answer(topic='clicked_point', message=result.message))
            self._submit_all(result.requests, 'clicked_point', 'point')

    def _stroke(self, message: bytes) -> None:
        with self._drawing_on_snapshot('~/stroke', 'poses') as snapshot:
            samples, frame, stamp = stroke_reader.stroke_from(message, frame_id=self._frame_id)
            began = time.monotonic() if stamp is None else stamp
            reading = self._session.stroke(samples, frame, snapshot, began=began)
            self._submit_reading(reading, '~/stroke')

    def _read_instead(self) -> str:
        """
        Take the next guess about the last stroke, and return a message about it.

        :raises Refusal: there is none, or the world cannot have it
        """
        self.apply_requests()
        reading = self._session.instead()
        self._submit_reading(reading, '~/instead')
        self._world_publishers.publish_preview(self._session.preview)
        return reading.message

    def _submit_reading(self, reading: Reading, topic: str) -> None:
        submit_reading(self.simulation, self._session, reading, topic=topic, field='poses')

    @contextmanager
    def _drawing_on_snapshot(self, topic: str, field: str) -> Iterator[Snapshot]:
        """
        Give the snapshot that a click or stroke refers to, and refuse one that cannot be drawn.

        :param field: of the message, for the refusal
        """
        try:
            yield self._current_snapshot()
        except Refusal as refusal:
            self.simulation.refuse(refusal, topic=topic, subject='', field=field)
        self._world_publishers.publish_preview(self._session.preview)

    def _current_snapshot(self) -> Snapshot:
        """Apply the waiting requests, and return the snapshot that is shown."""
        self.apply_requests()
        return self.simulation.world.snapshot() if self.frame is None else self.frame.snapshot

    def _refuse_command(self, refusal: Refusal, topic: str) -> None:
        """Publish a refusal outside of a frame, after the answers to earlier requests."""
        self.apply_requests()
        self._report_answer(Answer.refused(refusal, topic=topic))

    def _report_answer(self, answer: Answer) -> None:
        """Publish and log an answer outside of a frame."""
        self._world_publishers.publish_answer(answer)
        if self._sketchpad is not None:
            self._sketchpad.report(answer)
        self._log_answer(answer)

    def _report_answers(self) -> tuple[Answer, ...]:
        """Publish and log the answers that no frame carries, and return them."""
        answers = self.simulation.take_answers()
        for answer in answers:
            self._report_answer(answer)
        return answers

    def _log_answer(self, answer: Answer) -> None:
        if answer.code:
            # The topic of an event without a request is its code, which is named once.
            names = dict.fromkeys((answer.topic, answer.code))
            self.get_logger().warning(
                f'{": ".join(names)}: {answer.message}', throttle_duration_sec=1.0
            )
        elif answer.topic == 'viewer':
            # The address of the viewer, for the person at the terminal.
            self.get_logger().info(answer.message)

    # Parameters

    def _check_parameters(self, changed: list[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                parameters.check(parameter)
            replace(self.simulation.settings, **parameters.world_changes(changed))
            values = {parameter.name: parameter.value for parameter in changed}
            parameters.drawing_settings(self._values | values)
        except Refusal as refusal:
            return SetParametersResult(successful=False, reason=f'{refusal.code}: {refusal}')
        return SetParametersResult(successful=True)

    def _apply_parameters(self, changed: list[Parameter]) -> None:
        for parameter in changed:
            self._values[parameter.name] = parameter.value
        changes = parameters.world_changes(changed)
        settings = self.simulation.settings
        if replace(settings, **changes) != settings:
            self.simulation.perform(Configure(changes=changes))
            # Requests that waited before may have changed other settings.
            self._mirrored = None
        names = {parameter.name for parameter in changed}
        if 'speed' in names:
            self.simulation.speed = self._values['speed']
        self._session.settings = parameters.drawing_settings(self._values)
        self._session.tool = Tool(self._values['tool'])
        self._world_publishers.publish_preview(self._session.preview)
        if 'history' in names:
            self.simulation.history = self._values['history']
        if 'publish_clock' in names:
            self._world_publishers.publish_clock = self._values['publish_clock']
        if 'viewer' in names and self._started:
            self._open_viewer()
        if 'sketchpad' in names:
            self._open_sketchpad()

    def _mirror_settings(self) -> None:
        """Set the parameters to the settings and speed of the world."""
        if self.simulation.settings is not self._mirrored:
            self._mirrored = settings = self.simulation.settings
            self.set_parameters(parameters.world_parameters(settings))
        if self.simulation.speed != self._values['speed']:
            self.set_parameters([Parameter('speed', value=self.simulation.speed)])

    # Sketchpad

    def _open_sketchpad(self) -> None:
        """Open or close the sketchpad, as the parameter says."""
        wanted = self._values['sketchpad'] == 'serve'
        if wanted == (self._sketchpad is not None):
            return
        if self._sketchpad is not None:
            self._sketchpad.close()
            self._sketchpad = None
            return
        self._sketchpad = Sketchpad(
            self._page_control,
            welcome={
                'version': 1,
                'frame_id': self._frame_id,
                'rate': self._values['publish_rate'],
            },
            recording_address=lambda: self._viewer.page_address,
            address=self._values['sketchpad_address'],
            port=self._values['sketchpad_port'],
            world_dir=self.world_files.directory,
            wake=self._wake,
        )
        if self.frame is not None:
            self._sketchpad.show(replace(self.frame, answers=()))
        else:
            # A page shows the world before its time has begun.
            self.apply_requests()
        if self._started:
            _print_addresses(self._sketchpad)

    @property
    def sketchpad(self) -> Sketchpad | None:
        """Return the sketchpad; None where it is not served."""
        return self._sketchpad

    def _handle_pages(self) -> None:
        if self._sketchpad is not None:
            self._sketchpad.handle_messages()

    def _wake(self) -> None:
        """Have the messages of pages handled; called on the thread of the sketchpad."""
        executor = self.executor
        # With timers, the next tick handles them.
        if not self._started and executor is not None:
            executor.create_task(self._serve_pages)

    def _serve_pages(self) -> None:
        self._handle_pages()
        self.apply_requests()

    # Viewer and diagnostics

    def _open_viewer(self) -> None:
        self._viewer.open_viewer(ViewerMode(self._values['viewer']), self._values['viewer_url'])

    def record(self, path: Path) -> None:
        """
        Record all frames from now on in a file, beside any viewer.

        :param path: of the `.rrd` file, which is complete when the node is destroyed
        """
        self._viewer.record(path)

    def _publish_diagnostics(self) -> None:
        for answer in self._viewer.poll():
            self._report_answer(answer)
        if self.frame is None or self._diagnostics.get_subscription_count() == 0:
            return
        self._diagnostics.publish(
            self._statistics.report(
                self.frame.snapshot,
                node=self.get_fully_qualified_name(),
                speed=self.simulation.speed,
                late_frames=self.simulation.late_frames,
                viewer=self._viewer.state,
                backlog=Backlog(
                    message_delay=self.message_delay,
                    undecodable=self.requests.undecodable,
                    waiting_answers=self._world_publishers.events.waiting,
                    stopped_listener=self._world_publishers.events.stopped,
                ),
            )
        )


def _print_addresses(sketchpad: Sketchpad) -> None:
    """Print where the page is, for the person at the terminal."""
    sys.stdout.write(
        '\n'
        '  The page is at\n\n'
        f'      {sketchpad.url()}\n\n'
        f'  and for those who only watch: {sketchpad.url(Role.VIEW)}\n\n'
    )
    sys.stdout.flush()
