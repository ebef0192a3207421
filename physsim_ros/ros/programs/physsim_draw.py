# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The program `physsim_draw`: draws the strokes of a drawing in a running world."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import math
import sys

from diagnostic_msgs.msg import DiagnosticStatus
from physsim_ros.files import BadDrawing, drawings, find_drawing, load_drawing, Pace, shipped
from physsim_ros.model.arrays import Floats
from physsim_ros.ros.programs.help import files_table
from physsim_ros.ros.programs.stroke_publisher import (
    Interrupted,
    SeveralWorlds,
    StrokePublisher,
    Unanswered,
)
import rclpy
from rclpy.exceptions import InvalidTopicNameException
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args


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
    except (BadDrawing, SeveralWorlds, Unanswered) as error:
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
        epilog='The exit code is 1 if a stroke was refused. '
        f'Shipped drawings (--list): {", ".join(drawings())}.',
    )
    parser.add_argument(
        'drawing',
        help='an SVG file, a JSON file ([[[x, y], ...], ...], or [x, y, t]), or the name of a '
        'shipped drawing',
    )
    parser.add_argument(
        '--list', action=_List, help='list the shipped drawings and their directory, and exit'
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
        help='where the origin of the drawing goes [m]: the lower left corner of the page of an '
        'SVG file, [0, 0] of a JSON file (default: the origin of the frame)',
    )
    parser.add_argument(
        '--speed', type=_positive, default=4.0, help='of the pen [m/s] (default: %(default)g)'
    )
    parser.add_argument(
        '--rate', type=_positive, default=100.0, help='of its samples [Hz] (default: %(default)g)'
    )
    parser.add_argument(
        '--once',
        action='store_true',
        help='publish each stroke at once, not at the speed of the pen',
    )
    parser.add_argument('--pause', action='store_true', help='pause time while drawing, then play')
    parser.add_argument(
        '--world', default='/physsim', help="the name of the world's node (default: %(default)s)"
    )
    parser.add_argument('--frame', default='', help="to draw in: a body's name (default: world)")
    parser.add_argument(
        '--patience',
        type=_positive,
        default=20.0,
        help='timeout for finding the world, and for each answer [s] (default: %(default)g)',
    )
    return parser.parse_args(arguments)


class _List(argparse.Action):
    """Prints the shipped drawings, and exits."""

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
