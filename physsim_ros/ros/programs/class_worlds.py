# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Some worlds of a class in one process, which `physsim_class` starts and ends.

It prints a line of JSON for each world: its number and its addresses.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
import json
import os
import sys

from physsim_ros.files import user_lessons, user_worlds
from physsim_ros.model.errors import PhysSimError
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.programs.process import begin_process, end_process
from physsim_ros.ros.programs.real_time_loop import run_worlds
from physsim_ros.sketchpad import results_file, Role
import rclpy
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

# Memory of the past of each world [MB]: thirty of them have that of six.
HISTORY_MEMORY = 48.0


def main() -> None:
    """Run the worlds until the process is interrupted, or its parent has ended."""
    watch, parent = begin_process(), os.getppid()
    parser = ArgumentParser(prog='class_worlds')
    parser.add_argument('--first', type=int, required=True)
    parser.add_argument('--count', type=int, required=True)
    parser.add_argument('--port', type=int, required=True)
    parser.add_argument('--address', required=True)
    options = parser.parse_args(remove_ros_args(sys.argv)[1:])

    try:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        numbers = range(options.first, options.first + options.count)
        nodes = [
            PhysSimNode(
                namespace=f'/pupil_{number}', parameter_overrides=_parameters(number, options)
            )
            for number in numbers
        ]
    except (PhysSimError, RuntimeError) as error:
        sys.exit(f'physsim_class: {error}')
    for number, node in zip(numbers, nodes, strict=True):
        _print_addresses(number, node)
    run_worlds(nodes, lambda: watch.requested or os.getppid() != parent)
    end_process()


def _parameters(number: int, options: Namespace) -> list[Parameter]:
    """Return the parameters in which a world of a class differs from another one."""
    values = {
        'sketchpad': 'serve',
        'sketchpad_address': options.address,
        'sketchpad_port': options.port + number if options.port else 0,
        # Nobody looks at thirty viewers, and there is one clock.
        'viewer': 'none',
        'publish_clock': False,
        'history_memory': HISTORY_MEMORY,
        # Of the teacher: a pupil's own directory has none.
        'lesson_dir': str(user_lessons(user_worlds())),
        'world_dir': str(user_worlds() / 'class' / f'pupil_{number}'),
    }
    return [Parameter(name, value=value) for name, value in values.items()]


def _print_addresses(number: int, node: PhysSimNode) -> None:
    """Print the line of a world."""
    sketchpad = node.outputs.sketchpad
    if sketchpad is not None:
        addresses = {
            'pupil': sketchpad.url(),
            'teacher': sketchpad.url(Role.TEACH),
            'results': str(results_file(node.world_files.directory)),
        }
        sys.stdout.write(json.dumps({'number': number, **addresses}) + '\n')
        sys.stdout.flush()


if __name__ == '__main__':
    main()
