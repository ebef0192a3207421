# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The program `physsim`: the node from its start to its end."""

from __future__ import annotations

from argparse import ArgumentParser
from functools import partial
from itertools import takewhile
import signal
import sys

from physsim_ros.ros.programs.process import begin_process, end_process


class _Usage(ArgumentParser):
    """A parser whose help ends with the worlds and parameters there are."""

    def format_help(self) -> str:
        """Return the help."""
        from physsim_ros.ros.programs.help import physsim_help

        return super().format_help() + physsim_help()


def _initialise() -> None:
    """Initialise ROS by the command line; end the program where that is refused."""
    import rclpy
    from rclpy.impl.implementation_singleton import rclpy_implementation
    from rclpy.signals import SignalHandlerOptions
    from rclpy.utilities import remove_ros_args

    # All settings are parameters; the parser refuses other arguments, which would be ignored.
    usage = _Usage(
        prog='physsim',
        usage='physsim [-h] [--ros-args -p name:=value ...]',
        description='Run a physics world as a ROS 2 node.',
        epilog="For example: physsim --ros-args -p world_file:=demo -p gravity:='[0.0, -1.62]'",
    )
    # rcl reads a parameter among them as a remapping of names.
    for word in takewhile(lambda each: each != '--ros-args', sys.argv[1:]):
        if ':=' in word:
            usage.error(f'{word} stands before --ros-args; a parameter: --ros-args -p {word}')
    try:
        usage.parse_args(remove_ros_args(sys.argv)[1:])
        # The signal handlers of rclpy (Jazzy) raise at any point of the program, which can abort
        # its end.
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    except rclpy_implementation.UnknownROSArgsError as error:
        # Its text is a list of them.
        sys.exit(f'physsim: unknown arguments after --ros-args: {error}')
    except RuntimeError as error:
        # rcl raises it for invalid arguments, and where it cannot write its log.
        hint = '; ROS_LOG_DIR names another' if 'log directory' in str(error) else ''
        sys.exit(f'physsim: {error}{hint}')


def main() -> None:
    """Run the node until it is interrupted."""
    watch = begin_process()
    # A signal is received while ROS and the engine are imported, too, which takes 0.4 s.
    from geometry_msgs.msg import Twist
    from physsim_ros.model.errors import PhysSimError
    from physsim_ros.ros.node import PhysSimNode
    from physsim_ros.ros.programs.real_time_loop import run_worlds
    import rclpy

    _initialise()
    try:
        node = PhysSimNode(expected_commands=Twist)
    except PhysSimError as error:
        rclpy.shutdown()
        sys.exit(f'physsim: {error}')
    node.control.on_quit = partial(signal.raise_signal, signal.SIGTERM)
    run_worlds([node], lambda: watch.requested)
    end_process()
