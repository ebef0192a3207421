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
The program `physsim_draw`: publishes the strokes of a drawing to a world, one after the other.

Law: it uses topics and services only, and publishes a stroke after the answer to the one before.
Each stroke of a drawing is a thing of its own: its stamps say that the pen paused before it.
"""

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Callable, Sequence
import math
import signal
import sys
import time

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
import numpy as np
from physsim_ros.drawing import DRAWING_RANGES
from physsim_ros.files import BadDrawing, drawings, find_drawing, load_drawing, Pace, shipped
from physsim_ros.model.arrays import Floats
from physsim_ros.ros.qos_safe_node import LOSSLESS, NodeWithoutQosEvents
from physsim_ros.ros.usage import files_table
import rclpy
from rclpy.exceptions import InvalidTopicNameException
from rclpy.experimental import EventsExecutor
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from std_srvs.srv import Trigger

# Time between two strokes by their stamps [s]: no world reads strokes so far apart together.
_PAUSE = 1.0 + DRAWING_RANGES['regroup'].high


class Unanswered(Exception):
    """There is no world, or it does not answer."""


class Interrupted(Exception):
    """The program was interrupted by a signal."""


class StrokePublisher(NodeWithoutQosEvents):
    """
    A node that publishes strokes and receives the answers.

    :param world: name of the node of the world
    :param patience: timeout for the discovery of the world, and for each answer [s]
    """

    def __init__(self, world: str, *, patience: float) -> None:
        super().__init__('physsim_draw')
        self._patience = patience
        self._answers: deque[DiagnosticStatus] = deque()
        # The least stamp of the next stroke [ns].
        self._next_stamp = 0
        self._strokes = self.create_publisher(Path, f'{world}/stroke', LOSSLESS)
        self._events = self.create_subscription(
            DiagnosticStatus, f'{world}/events', self._receive, LOSSLESS
        )
        self._buttons = {
            name: self.create_client(Trigger, f'{world}/{name}') for name in ('pause', 'play')
        }
        self._executor = EventsExecutor()
        self._executor.add_node(self)
        self._stopped: list[int] = []
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda received, _: self._stopped.append(received))

    def wait_for_world(self) -> None:
        """
        Wait until publishers and subscriptions have been matched with those of the world.

        :raises Unanswered: there is no world
        """
        events, strokes = self._events, self._strokes
        self._spin_until(
            lambda: strokes.get_subscription_count() and events.get_publisher_count(),
            f'there is no world at {strokes.topic_name.rpartition("/")[0]}',
        )

    def draw_stroke(
        self, stroke: Floats, *, frame_id: str, at_once: bool
    ) -> list[DiagnosticStatus]:
        """
        Publish a stroke after the duration of drawing it, and return the answers to it.

        :param stroke: (n, 3) float64: x, y [m], time [s]
        :param frame_id: of the stroke; '' is the world frame
        :param at_once: whether to publish without that duration
        :raises Unanswered: the world does not answer
        """
        if not at_once:
            lifted = time.monotonic() + float(stroke[-1, 2])
            self._spin_until(lambda: time.monotonic() >= lifted, '', math.inf)
        self._answers.clear()
        self._strokes.publish(self._message(stroke, frame_id))
        self._spin_until(lambda: self._answers, 'the world does not answer')
        # The first answer reports the reading, and the number of answers that follow.
        values = {pair.key: pair.value for pair in self._answers[0].values}
        count = 1 + int(values.get('requests', '0'))
        self._spin_until(lambda: len(self._answers) >= count, 'the world does not answer')
        return [self._answers.popleft() for _ in range(count)]

    def call_service(self, service: str) -> None:
        """
        Call `~/pause` or `~/play`.

        :raises Unanswered: it does not answer
        """
        client = self._buttons[service]
        self._spin_until(client.service_is_ready, f'{service} is not there')
        futures: list[Future] = []

        def answered() -> bool:
            # Called again each second: a service that has not discovered its client yet drops the
            # response.
            if time.monotonic() >= began + len(futures):
                futures.append(client.call_async(Trigger.Request()))
            return any(future.done() for future in futures)

        began = time.monotonic()
        self._spin_until(answered, f'{service} is not answered')

    def close(self) -> None:
        """Destroy the node and its executor."""
        self._executor.remove_node(self)
        self._executor.shutdown()
        self.destroy_node()

    def _message(self, stroke: Floats, frame_id: str) -> Path:
        message = Path()
        message.header.frame_id = frame_id
        began = max(self.get_clock().now().nanoseconds, self._next_stamp)
        self._next_stamp = began + round((float(np.ptp(stroke[:, 2])) + _PAUSE) * 1e9)
        for x, y, seconds in stroke.tolist():
            sample = PoseStamped()
            sample.header.frame_id = frame_id
            sample.header.stamp = Time(nanoseconds=began + round(seconds * 1e9)).to_msg()
            sample.pose.position.x, sample.pose.position.y = x, y
            sample.pose.orientation.w = 1.0
            message.poses.append(sample)
        return message

    def _receive(self, status: DiagnosticStatus) -> None:
        if status.name == '~/stroke':
            self._answers.append(status)

    def _spin_until(
        self, predicate: Callable[[], object], otherwise: str, patience: float | None = None
    ) -> None:
        deadline = time.monotonic() + (self._patience if patience is None else patience)
        while not predicate():
            if self._stopped:
                # Raised once, so that `play` can still be called.
                self._stopped.clear()
                raise Interrupted
            if time.monotonic() > deadline:
                raise Unanswered(f'{otherwise} (waited {self._patience:g} s)')
            self._executor.spin_once(timeout_sec=0.01)


def main() -> None:
    """Draw a drawing, print the reading of each stroke, and exit."""
    try:
        options = _options(remove_ros_args(sys.argv)[1:])
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        # rcl raises it for invalid arguments.
        sys.exit(f'physsim_draw: {error}')
    try:
        _draw_drawing(options)
    except (BadDrawing, Unanswered) as error:
        sys.exit(f'physsim_draw: {error}')
    except InvalidTopicNameException as error:
        # The lines below the first one mark the invalid character.
        first, *_ = str(error).splitlines()
        sys.exit(f'physsim_draw: --world: {first.rstrip(":")}')
    except Interrupted:
        sys.exit(130)
    finally:
        rclpy.shutdown()


def _draw_drawing(options: argparse.Namespace) -> None:
    strokes = load_drawing(
        find_drawing(options.drawing),
        scale=options.scale,
        pace=Pace(speed=options.speed, rate=options.rate),
    )
    for stroke in strokes:
        stroke[:, :2] += options.at
    publisher = StrokePublisher(options.world, patience=options.patience)
    try:
        refused = _draw_all(publisher, strokes, options)
    finally:
        publisher.close()
    if refused:
        sys.exit(f'physsim_draw: {refused} of {len(strokes)} strokes were refused')


def _draw_all(
    publisher: StrokePublisher, strokes: Sequence[Floats], options: argparse.Namespace
) -> int:
    """Draw strokes and return the number of those with a refused request."""
    publisher.wait_for_world()
    refused = 0
    if options.pause:
        publisher.call_service('pause')
    try:
        for number, stroke in enumerate(strokes, 1):
            answers = publisher.draw_stroke(stroke, frame_id=options.frame, at_once=options.once)
            refused += any(answer.level != DiagnosticStatus.OK for answer in answers)
            for answer in answers:
                words = 'refused: ' if answer.level != DiagnosticStatus.OK else ''
                line = f'{number}/{len(strokes)}  {words}{answer.message}'
                print(line, flush=True)  # noqa: T201
    finally:
        if options.pause:
            publisher.call_service('play')
    return refused


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog='physsim_draw',
        description='Draw a drawing into a running world, stroke by stroke.',
        epilog='It ends with 1 where a stroke was refused. '
        f'Shipped drawings, as --list tells them: {", ".join(drawings())}.',
    )
    parser.add_argument(
        'drawing',
        help='an SVG file, a JSON file ([[[x, y], ...], ...], or [x, y, t]), or the name of a '
        'shipped drawing',
    )
    parser.add_argument(
        '--list', action=_List, help='tell the shipped drawings and where they are, and exit'
    )
    parser.add_argument(
        '--scale',
        type=_positive,
        help='metres for a unit of the file (default: 0.01 for SVG, 1 for JSON)',
    )
    parser.add_argument(
        '--at',
        type=float,
        nargs=2,
        default=(0.0, 0.0),
        metavar=('X', 'Y'),
        help='where the lower left corner of the page lies [m] (default: the origin)',
    )
    parser.add_argument(
        '--speed', type=_positive, default=4.0, help='of the pen [m/s] (default: %(default)g)'
    )
    parser.add_argument(
        '--rate', type=_positive, default=100.0, help='of its samples [Hz] (default: %(default)g)'
    )
    parser.add_argument(
        '--once', action='store_true', help='draw each stroke at once, not at the speed of the pen'
    )
    parser.add_argument(
        '--pause', action='store_true', help='let time stand still meanwhile, and play then'
    )
    parser.add_argument(
        '--world', default='/physsim', help="the name of the world's node (default: %(default)s)"
    )
    parser.add_argument('--frame', default='', help="to draw in: a body's name (default: world)")
    parser.add_argument(
        '--patience',
        type=_positive,
        default=20.0,
        help='how long to wait for the world, and for each answer [s] (default: %(default)g)',
    )
    return parser.parse_args(arguments)


class _List(argparse.Action):
    """Tells the shipped drawings, and exits."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str) -> None:  # noqa: A002
        super().__init__(option_strings, dest, nargs=0, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        listed = files_table(f'drawings in {shipped("drawings")}:', drawings())
        parser.exit(message=listed)


def _positive(text: str) -> float:
    number = float(text)
    if not 0.0 < number < math.inf:
        raise argparse.ArgumentTypeError(f'{text} is no positive number')
    return number
