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
physsim_draw: draws a drawing into a world, stroke by stroke, as somebody with a pen would.

Law: it knows the world by its topics alone, and draws on only when the stroke before is answered.
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
from physsim_ros.files import BadDrawing, find_drawing, load_drawing, Pace
from physsim_ros.model.arrays import Floats
from physsim_ros.ros.qos_safe_node import LOSSLESS, QuietNode
import rclpy
from rclpy.exceptions import InvalidTopicNameException
from rclpy.experimental import EventsExecutor
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from std_srvs.srv import Trigger


class Unanswered(Exception):
    """The world is not there, or does not answer."""


class Interrupted(Exception):
    """Somebody wants it to end."""


class Artist(QuietNode):
    """
    A node that draws strokes and hears what becomes of them.

    :param world: the name of the world's node
    :param patience: for the world to appear, and for each answer [s]
    """

    def __init__(self, world: str, *, patience: float) -> None:
        super().__init__('physsim_draw')
        self._patience = patience
        self._answers: deque[DiagnosticStatus] = deque()
        self._strokes = self.create_publisher(Path, f'{world}/stroke', LOSSLESS)
        self._events = self.create_subscription(
            DiagnosticStatus, f'{world}/events', self._hear, LOSSLESS
        )
        self._buttons = {
            name: self.create_client(Trigger, f'{world}/{name}') for name in ('pause', 'play')
        }
        self._executor = EventsExecutor()
        self._executor.add_node(self)
        self._stopped: list[int] = []
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda received, _: self._stopped.append(received))

    def meet(self) -> None:
        """
        Wait until the world hears and is heard.

        :raises Unanswered: there is none
        """
        events, strokes = self._events, self._strokes
        self._spin_until(
            lambda: strokes.get_subscription_count() and events.get_publisher_count(),
            f'there is no world at {strokes.topic_name.rpartition("/")[0]}',
        )

    def draw(self, stroke: Floats, *, frame_id: str, at_once: bool) -> list[DiagnosticStatus]:
        """
        Draw a stroke as fast as its times say, and return all that the world answers.

        :param stroke: (n, 3) float64: x, y [m], time [s]
        :param frame_id: that it is drawn in; '' is the world's
        :param at_once: whether the pen takes no time
        :raises Unanswered: the world does not
        """
        if not at_once:
            lifted = time.monotonic() + float(stroke[-1, 2])
            self._spin_until(lambda: time.monotonic() >= lifted, '', math.inf)
        self._answers.clear()
        self._strokes.publish(self._message(stroke, frame_id))
        self._spin_until(lambda: self._answers, 'the world does not answer')
        # The first one tells how the stroke was read, and how many answers follow.
        values = {pair.key: pair.value for pair in self._answers[0].values}
        count = 1 + int(values.get('requests', '0'))
        self._spin_until(lambda: len(self._answers) >= count, 'the world does not answer')
        return [self._answers.popleft() for _ in range(count)]

    def call(self, service: str) -> None:
        """
        Have the world pause or play.

        :raises Unanswered: it does not answer
        """
        client = self._buttons[service]
        self._spin_until(client.service_is_ready, f'{service} is not there')
        futures: list[Future] = []

        def answered() -> bool:
            # Again each second: a world that has not discovered a client yet drops its answer.
            if time.monotonic() >= began + len(futures):
                futures.append(client.call_async(Trigger.Request()))
            return any(future.done() for future in futures)

        began = time.monotonic()
        self._spin_until(answered, f'{service} is not answered')

    def close(self) -> None:
        """Leave the graph."""
        self._executor.remove_node(self)
        self._executor.shutdown()
        self.destroy_node()

    def _message(self, stroke: Floats, frame_id: str) -> Path:
        message = Path()
        message.header.frame_id = frame_id
        began = self.get_clock().now().nanoseconds
        for x, y, seconds in stroke.tolist():
            sample = PoseStamped()
            sample.header.frame_id = frame_id
            sample.header.stamp = Time(nanoseconds=began + round(seconds * 1e9)).to_msg()
            sample.pose.position.x, sample.pose.position.y = x, y
            sample.pose.orientation.w = 1.0
            message.poses.append(sample)
        return message

    def _hear(self, status: DiagnosticStatus) -> None:
        if status.name == '~/stroke':
            self._answers.append(status)

    def _spin_until(
        self, predicate: Callable[[], object], otherwise: str, patience: float | None = None
    ) -> None:
        deadline = time.monotonic() + (self._patience if patience is None else patience)
        while not predicate():
            if self._stopped:
                # Told once: what is left to be put right can still be.
                self._stopped.clear()
                raise Interrupted
            if time.monotonic() > deadline:
                raise Unanswered(f'{otherwise} (waited {self._patience:g} s)')
            self._executor.spin_once(timeout_sec=0.01)


def main() -> None:
    """Draw a drawing, say what each stroke was read as, and end."""
    try:
        options = _options(remove_ros_args(sys.argv)[1:])
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        # rcl's own: arguments that it cannot read.
        sys.exit(f'physsim_draw: {error}')
    try:
        _draw_drawing(options)
    except (BadDrawing, Unanswered) as error:
        sys.exit(f'physsim_draw: {error}')
    except InvalidTopicNameException as error:
        # The lines below point at what is wrong with it.
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
    artist = Artist(options.world, patience=options.patience)
    try:
        refused = _draw_all(artist, strokes, options)
    finally:
        artist.close()
    if refused:
        sys.exit(f'physsim_draw: {refused} of {len(strokes)} strokes were refused')


def _draw_all(artist: Artist, strokes: Sequence[Floats], options: argparse.Namespace) -> int:
    """Draw strokes and return how many of them the world refused something of."""
    artist.meet()
    refused = 0
    if options.pause:
        artist.call('pause')
    try:
        for number, stroke in enumerate(strokes, 1):
            answers = artist.draw(stroke, frame_id=options.frame, at_once=options.once)
            refused += any(answer.level != DiagnosticStatus.OK for answer in answers)
            for answer in answers:
                words = 'refused: ' if answer.level != DiagnosticStatus.OK else ''
                line = f'{number}/{len(strokes)}  {words}{answer.message}'
                print(line, flush=True)  # noqa: T201
    finally:
        if options.pause:
            artist.call('play')
    return refused


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog='physsim_draw',
        description='Draw a drawing into a running world, stroke by stroke.',
        epilog='It ends with 1 where a stroke was refused.',
    )
    parser.add_argument('drawing', help='an SVG or JSON file, or a name in config/drawings')
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


def _positive(text: str) -> float:
    number = float(text)
    if not 0.0 < number < math.inf:
        raise argparse.ArgumentTypeError(f'{text} is no positive number')
    return number
