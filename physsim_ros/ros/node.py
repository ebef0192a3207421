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
The node: subscriptions, services, parameters and one timer around a Simulation.

It wires and reports, and decides nothing.
"""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
import gc
import os
from pathlib import Path
import signal
import sys
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Path as PathMessage
from physsim_ros.drawing import DrawingSession, reading_answer, Tool
from physsim_ros.files import world_file
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import PhysSimError, Refusal
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Configure,
    DeleteAll,
    Pin,
    Release,
    Request,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame, run_state, Snapshot
from physsim_ros.ros import conversions, parameters, stroke_reader
from physsim_ros.ros.diagnostics import Meter
from physsim_ros.ros.publishers import Streams
from physsim_ros.ros.qos_safe_node import LOSSLESS, QuietNode
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.view.viewer import Viewer, ViewerMode
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.context import Context
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray


class PhysSimNode(QuietNode):
    """
    A physics world on the ROS graph.

    :param context: of ROS; None is the default one
    :param parameter_overrides: values that come before those of the command line
    :raises PhysSimError: a parameter or the world file is refused
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
        self._parameter_service = parameters.ParameterServices(self)
        self._viewer = Viewer()
        try:
            self._set_up()
        except BaseException:
            # What is refused leaves nothing on the graph.
            self.destroy_node()
            raise

    def _set_up(self) -> None:
        """
        Make the world, and let the graph reach it.

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
        self._frame_id: str = self._values['frame_id']
        self._world_dir = Path(self._values['world_dir'])
        self._streams = Streams(
            self, frame_id=self._frame_id, publish_clock=self._values['publish_clock']
        )
        self._pen = DrawingSession(
            parameters.drawing_settings(self._values), Tool(self._values['tool'])
        )
        self._meter = Meter()
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        # The last one that was delivered.
        self.frame: Frame | None = None
        self._started = False
        self._followed: WorldSettings | None = self.simulation.settings
        if self._values['world_file']:
            self.simulation.begin(self._read_world(confined=False)[0])
            self._follow()
        self._subscribe()
        self._serve()
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._take_parameters)

    def start(self) -> None:
        """Let time run: frames at the publish rate of a steady clock, and a viewer."""
        self._started = True
        if self._values['record_file']:
            self.record(Path(self._values['record_file']))
        self._open_viewer()
        # The node that publishes the clock must not wait for it.
        steady = RosClock(clock_type=ClockType.STEADY_TIME)
        period = 1.0 / self._values['publish_rate']
        self.create_timer(period, lambda: self.tick(time.monotonic_ns()), clock=steady)
        self.create_timer(1.0, self._diagnose, clock=steady)
        self.get_logger().info(f'ready: {len(self.simulation.world)} bodies')

    def tick(self, now_ns: int) -> None:
        """
        Go on by what is due at a steady time, and deliver the frames.

        :param now_ns: steady time, never going back [ns]
        """
        began = time.perf_counter_ns()
        self._watch()
        frames = self.simulation.advance(now_ns)
        stepped = time.perf_counter_ns()
        for frame in frames:
            self.deliver(frame)
        if not frames:
            if self.frame is not None and self.frame.preview != self._pen.preview:
                # Nothing has happened but that what was half drawn has been dropped.
                self._show(replace(self.frame, answers=(), moved=False))
            self._streams.welcome()
            return
        last = frames[-1]
        if last.moved:
            self._meter.add(
                now_ns=now_ns,
                stamp=last.snapshot.stamp,
                step_ns=stepped - began,
                frame_ns=time.perf_counter_ns() - began,
            )
        else:
            self._meter.pause()

    def deliver(self, frame: Frame) -> None:
        """Send a frame to topics and viewer."""
        self._follow()
        for answer in frame.answers:
            self._log(answer)
        self._streams.publish(frame)
        self._show(frame)

    def _show(self, frame: Frame) -> None:
        """Send a frame, and what is half drawn now, to the viewer."""
        if self._pen.preview != frame.preview:
            frame = replace(frame, preview=self._pen.preview)
        self.frame = frame
        self._viewer.show(frame, real_time_factor=self._meter.real_time_factor)

    def advance_frame(self) -> None:
        """Go on by one publish period, whatever the clock says, and deliver the frame."""
        self._watch()
        self.deliver(self.simulation.advance_frame())

    def apply(self) -> None:
        """Carry out what was asked while time stands still."""
        self._watch()
        frame = self.simulation.settle()
        if frame is not None:
            self.deliver(frame)
        else:
            self._streams.flush()

    @property
    def frame_period(self) -> float:
        """Return the simulation time from one frame to the next at speed 1 [s]."""
        return self.simulation.frame_steps / self.simulation.physics_rate

    def _watch(self) -> None:
        """Have contacts read where somebody looks."""
        self.simulation.watch_contacts(self._streams.wants_contacts or self._viewer.is_open)

    def destroy_node(self) -> None:
        """Close the viewer, then everything of ROS."""
        self._viewer.close()
        super().destroy_node()

    # Requests

    def _subscribe(self) -> None:
        def listen(kind: type, topic: str, convert: Callable[..., Request]) -> None:
            field = 'point' if kind is PointStamped else ''

            def callback(message: Any) -> None:
                self._submit(message, topic, convert, field=field)

            self.create_subscription(kind, topic, callback, LOSSLESS)

        listen(Marker, '~/spawn', conversions.body_request)
        listen(Marker, '~/join', conversions.joint_request)
        listen(PointStamped, '~/pin', partial(conversions.point_request, Pin))
        listen(PointStamped, '~/axle', partial(conversions.point_request, Axle))
        listen(PointStamped, '~/anchor', partial(conversions.point_request, Anchor))
        listen(PointStamped, '~/release', partial(conversions.point_request, Release))
        listen(MultiDOFJointState, '~/command', conversions.command_request)
        self.create_subscription(MarkerArray, '~/spawn_array', self._spawn_array, LOSSLESS)
        self.create_subscription(Float64, '~/speed', self._speed, LOSSLESS)
        self.create_subscription(PointStamped, 'clicked_point', self._click, LOSSLESS)
        self.create_subscription(PathMessage, '~/stroke', self._stroke, LOSSLESS, raw=True)
        self.create_subscription(Clock, '~/seek', self._seek, LOSSLESS)

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
        """Submit what one gesture asks for: it is undone as one."""
        for number, request in enumerate(requests):
            self.simulation.submit(request, topic=topic, joined=number > 0, field=field)

    def _spawn_array(self, message: MarkerArray) -> None:
        for number, marker in enumerate(message.markers):
            self._submit(marker, '~/spawn_array', conversions.body_request, joined=number > 0)

    def _speed(self, message: Float64) -> None:
        # Without the sign of a negative zero.
        speed = Parameter('speed', value=message.data + 0.0)
        try:
            # Here too, since rclpy refuses what is out of range in words without a code.
            parameters.check(speed)
        except Refusal as refusal:
            self._refuse(refusal, '~/speed')
            return
        self.set_parameters([speed])
        self.simulation.tell(Answer(topic='~/speed', message=f'speed {speed.value:g}'))

    def _seek(self, message: Clock) -> None:
        stamp = message.clock.sec * 10**9 + message.clock.nanosec
        try:
            done = self.simulation.seek(stamp)
        except Refusal as refusal:
            self._refuse(refusal, '~/seek')
            return
        self._meter.pause()
        self._follow()
        self.simulation.tell(Answer(topic='~/seek', message=done))

    def _click(self, message: PointStamped) -> None:
        with self._drawing('clicked_point', 'point') as snapshot:
            point, frame = conversions.click(message, frame_id=self._frame_id)
            step = self._pen.click(point, frame, snapshot)
            if step.message:
                self.simulation.tell(Answer(topic='clicked_point', message=step.message))
            self._submit_all(step.requests, 'clicked_point', 'point')

    def _stroke(self, message: bytes) -> None:
        with self._drawing('~/stroke', 'poses') as snapshot:
            samples, frame = stroke_reader.stroke_from(message, frame_id=self._frame_id)
            reading = self._pen.stroke(samples, frame, snapshot)
            self.simulation.tell(reading_answer(reading, topic='~/stroke'))
            self._submit_all(reading.requests, '~/stroke', 'poses')

    @contextmanager
    def _drawing(self, topic: str, field: str) -> Iterator[Snapshot]:
        """
        Give what is seen, with all that was asked before; refuse what cannot be drawn.

        :param field: of the message, that drawings are made of
        """
        self.apply()
        try:
            yield self.simulation.world.snapshot() if self.frame is None else self.frame.snapshot
        except Refusal as refusal:
            self.simulation.refuse(refusal, topic=topic, subject='', field=field)
        self._streams.show(self._pen.preview)

    def _refuse(self, refusal: Refusal, topic: str) -> None:
        """Refuse what makes no frame, after the answers to what was asked before."""
        self.apply()
        self._report(Answer.refused(refusal, topic=topic))

    def _report(self, answer: Answer) -> None:
        """Tell of what comes without a frame."""
        self._streams.report(answer)
        self._log(answer)

    def _log(self, answer: Answer) -> None:
        if answer.code:
            # What happens without a request is called as its code is.
            what = dict.fromkeys((answer.topic, answer.code))
            self.get_logger().warning(
                f'{": ".join(what)}: {answer.message}', throttle_duration_sec=1.0
            )
        elif answer.topic == 'viewer':
            # Where to look is what somebody at the terminal waits for.
            self.get_logger().info(answer.message)

    # Services

    def _serve(self) -> None:
        for name, act in {
            'play': lambda: self._run_at(1.0),
            'pause': lambda: self._run_at(0.0),
            'rewind': lambda: self._run_at(-1.0),
            'fast_forward': lambda: self._run_at(self._values['fast_speed']),
            'fast_rewind': lambda: self._run_at(-self._values['fast_speed']),
            'step': self._step,
            'undo': self.simulation.undo,
            'redo': self.simulation.redo,
            'reset': self.simulation.reset,
            'clear': lambda: self.simulation.perform(DeleteAll()),
            'load_world': lambda: self.load_world(confined=True),
            'save_world': self._save,
        }.items():
            self.create_service(Trigger, f'~/{name}', self._answering(act))

    def _answering(self, act: Callable[[], str]) -> Callable[..., Trigger.Response]:
        def callback(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                response.message = act()
                response.success = True
                self._follow()
            except Refusal as refusal:
                response.message = f'{refusal.code}: {refusal}'
                response.success = False
            except PhysSimError as error:
                response.message = str(error)
                response.success = False
            return response

        return callback

    def _run_at(self, speed: float) -> str:
        self.set_parameters([Parameter('speed', value=speed)])
        return run_state(speed)

    def _step(self) -> str:
        if self.simulation.speed != 0:
            raise PhysSimError('running; pause first')
        self.advance_frame()
        return f'at {self.simulation.world.stamp * 1e-9:.6f} s'

    def load_world(self, *, confined: bool) -> str:
        """
        Replace the world by that of parameter `world_file`, and say what was loaded.

        :param confined: whether only files below `world_dir` and the shipped worlds may be read
        :raises BadWorldFile: there is no such file, or it is refused
        """
        state, path = self._read_world(confined=confined)
        message = self.simulation.load(state)
        return f'{message} from {path.name}'

    def _read_world(self, *, confined: bool) -> tuple[WorldState, Path]:
        path = world_file.find(
            self._values['world_file'], world_dir=self._world_dir, confined=confined
        )
        simulation = self.simulation
        state = world_file.load(
            path, settings=simulation.settings, physics_rate=simulation.physics_rate
        )
        return state, path

    def _save(self) -> str:
        state = self.simulation.save()
        path = world_file.save(
            state,
            self._values['world_file'],
            world_dir=self._world_dir,
            physics_rate=self.simulation.physics_rate,
        )
        message = f'saved {len(state.bodies)} bodies to {path.name}'
        if world_file.hides_shipped(path, world_dir=self._world_dir):
            message += '; from now on it comes before the shipped world of that name'
        return message

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

    def _take_parameters(self, changed: list[Parameter]) -> None:
        for parameter in changed:
            self._values[parameter.name] = parameter.value
        changes = parameters.world_changes(changed)
        settings = self.simulation.settings
        if replace(settings, **changes) != settings:
            self.simulation.perform(Configure(changes=changes))
            # Others may have changed as well, by what waited before.
            self._followed = None
        names = {parameter.name for parameter in changed}
        if 'speed' in names:
            self.simulation.speed = self._values['speed']
        self._pen.settings = parameters.drawing_settings(self._values)
        self._pen.tool = Tool(self._values['tool'])
        self._streams.show(self._pen.preview)
        if 'history' in names:
            self.simulation.history = self._values['history']
        if 'publish_clock' in names:
            self._streams.publish_clock = self._values['publish_clock']
        if 'viewer' in names and self._started:
            self._open_viewer()

    def _follow(self) -> None:
        """Let the parameters say what the world has been set to, where time has led to that."""
        if self.simulation.settings is not self._followed:
            self._followed = settings = self.simulation.settings
            self.set_parameters(parameters.world_parameters(settings))
        if self.simulation.speed != self._values['speed']:
            self.set_parameters([Parameter('speed', value=self.simulation.speed)])

    # Watching

    def _open_viewer(self) -> None:
        self._viewer.turn_to(ViewerMode(self._values['viewer']), self._values['viewer_url'])

    def record(self, path: Path) -> None:
        """
        Write what happens from now on to a file, beside any viewer.

        :param path: of the `.rrd` file; complete when the node is destroyed
        """
        self._viewer.record(str(path))

    def _diagnose(self) -> None:
        for answer in self._viewer.poll():
            self._report(answer)
        if self.frame is None or self._diagnostics.get_subscription_count() == 0:
            return
        self._diagnostics.publish(
            self._meter.report(
                self.frame.snapshot,
                node=self.get_fully_qualified_name(),
                speed=self.simulation.speed,
                late_frames=self.simulation.late_frames,
                viewer=self._viewer.state,
            )
        )


def clear_the_way() -> None:
    """Keep what runs beside the world in its process from holding it up; before rclpy begins."""
    # A busy Python thread beside it (the viewer's) would otherwise hold a step of 0.6 ms up for
    # 6 ms: the default switch interval is 5 ms.
    sys.setswitchinterval(0.0005)
    # Fast DDS then hands messages to the network in a thread of its own, beside the next step.
    os.environ.setdefault('RMW_FASTRTPS_PUBLICATION_MODE', 'ASYNCHRONOUS')


def main() -> None:
    """Run the node until it is interrupted."""
    # All that it is told comes as parameters; what stands elsewhere would be ignored.
    usage = ArgumentParser(
        prog='physsim',
        description='Run a physics world as a ROS 2 node.',
        epilog='Parameters, as config/physsim.yaml lists them, come after --ros-args: '
        'physsim --ros-args -p world_file:=demo -p gravity:="[0.0, -1.62]"',
    )
    clear_the_way()
    stopped: list[int] = []
    # rclpy's own handler raises wherever the interpreter is, which can abort it while it ends.
    try:
        usage.parse_args(remove_ros_args(sys.argv)[1:])
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        # rcl's own: arguments that it cannot read.
        sys.exit(f'physsim: {error}')
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: stopped.append(received))
    try:
        node = PhysSimNode()
    except PhysSimError as error:
        rclpy.shutdown()
        sys.exit(f'physsim: {error}')
    executor = EventsExecutor()
    try:
        executor.add_node(node)
        node.start()
        # What exists now stays; the collector need not look at it in every frame.
        gc.collect()
        gc.freeze()
        # `spin` of this executor never returns; spin_once ends, and raises what callbacks raise.
        while not stopped:
            executor.spin_once(timeout_sec=0.1)
    finally:
        # A crash too leaves no viewer behind.
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown()
