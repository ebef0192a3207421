# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The program `physsim_class`: a world for each pupil, in one process for each processor.

A world is the node `/pupil_<number>/physsim`, with a page of its own. The page of the class sends
each pupil to a world, and shows a teacher who is where.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from contextlib import suppress
from itertools import pairwise
import json
import os
from pathlib import Path
from shutil import copyfileobj
import subprocess
import sys
from threading import Thread

from physsim_ros.model.errors import PhysSimError
from physsim_ros.ros.programs.process import open_closed_streams, TerminationWatch
from physsim_ros.runtime.ending import CLOSING
from physsim_ros.sketchpad import ClassServer, Role, WorldAddresses

# Most worlds of a class.
MOST_PUPILS = 60


def shares(pupils: int, processes: int) -> list[range]:
    """Return the numbers of the worlds of each process, from 1, as even as can be."""
    bounds = [1 + pupils * each // processes for each in range(processes + 1)]
    return [range(*pair) for pair in pairwise(bounds) if range(*pair)]


def main() -> None:
    """Run a class until it is interrupted."""
    open_closed_streams()
    watch = TerminationWatch()
    options, arguments = _parsed(sys.argv[1:])
    parts = shares(options.pupils, len(os.sched_getaffinity(0)))
    processes = [_start(part, options.address, options.port, arguments) for part in parts]
    try:
        worlds = [
            world
            for process, part in zip(processes, parts, strict=True)
            for world in _worlds(process, len(part))
        ]
        if len(worlds) < options.pupils and not watch.requested:
            sys.exit('physsim_class: a world has not started; see above')
        _serve(worlds, processes, options, watch)
        if not watch.requested:
            sys.exit('physsim_class: the process of some worlds has ended; see above')
    except PhysSimError as error:
        sys.exit(f'physsim_class: {error}')
    finally:
        _end(processes)


def _parsed(arguments: list[str]) -> tuple[Namespace, list[str]]:
    """Return the options of the class, and the arguments of each world."""
    parser = ArgumentParser(
        prog='physsim_class',
        description='Run a physics world for each pupil of a class.',
        epilog='Arguments after --ros-args are those of each world, as: '
        'physsim_class --pupils 20 --ros-args -p world_file:=free_fall',
    )
    default = '(default: %(default)s)'
    parser.add_argument(
        '--pupils', type=int, default=20, help=f'number of worlds, 1 to {MOST_PUPILS} {default}'
    )
    parser.add_argument(
        '--address',
        default='127.0.0.1',
        help=f'address to listen on; 0.0.0.0 is the whole network {default}',
    )
    parser.add_argument(
        '--port',
        type=int,
        default=8800,
        help=f'port of the class; worlds use the ports after it {default}',
    )
    parser.add_argument(
        '--seats',
        type=int,
        default=4,
        help='greatest number of worlds for one machine; 0 is no limit, for pupils behind one '
        f'address {default}',
    )
    split = arguments.index('--ros-args') if '--ros-args' in arguments else len(arguments)
    options = parser.parse_args(arguments[:split])
    if not 1 <= options.pupils <= MOST_PUPILS:
        parser.error(f'--pupils must be 1 to {MOST_PUPILS}')
    return options, arguments[split:]


def _serve(
    worlds: list[WorldAddresses],
    processes: list[subprocess.Popen[str]],
    options: Namespace,
    watch: TerminationWatch,
) -> None:
    """
    Serve the page of the class until a signal comes, or a process of worlds ends.

    :raises PhysSimError: it cannot listen
    """
    server = ClassServer(
        worlds, address=options.address, port=options.port, seats_of_machine=options.seats
    )
    sys.stdout.write(
        f'\n  {len(worlds)} worlds in {len(processes)} processes. The page of the class:\n\n'
        f'      {server.url(Role.DRAW)}\n\n'
        f'  and for a teacher: {server.url(Role.TEACH)}\n\n'
    )
    sys.stdout.flush()
    server.run(lambda: watch.requested or any(each.poll() is not None for each in processes))


def _start(part: range, address: str, port: int, arguments: list[str]) -> subprocess.Popen[str]:
    """Start the process of some worlds."""
    module = 'physsim_ros.ros.programs.class_worlds'
    counts = ['--first', str(part.start), '--count', str(len(part))]
    place = ['--port', str(port), '--address', address]
    return subprocess.Popen(  # noqa: S603 - the arguments are those of the user
        [sys.executable, '-m', module, *counts, *place, *arguments],
        stdout=subprocess.PIPE,
        text=True,
        # Ctrl-C at a terminal goes to this process alone, which ends the others.
        process_group=0,
    )


def _worlds(process: subprocess.Popen[str], count: int) -> list[WorldAddresses]:
    """Wait for the worlds of a process, and return their addresses; fewer where it has ended."""
    worlds: list[WorldAddresses] = []
    while process.stdout is not None and len(worlds) < count:
        line = process.stdout.readline()
        if not line:
            break
        # Other lines are for people.
        if line.startswith('{'):
            content = json.loads(line)
            results = Path(content['results'])
            worlds.append(WorldAddresses(content['pupil'], content['teacher'], results))
    # A world that prints to a pipe that nobody reads would stand.
    Thread(target=copyfileobj, args=(process.stdout, sys.stderr), daemon=True).start()
    return worlds


def _end(processes: list[subprocess.Popen[str]]) -> None:
    """End the processes of the worlds."""
    for process in processes:
        process.terminate()
    for process in processes:
        with suppress(subprocess.TimeoutExpired):
            process.wait(CLOSING)
        process.kill()
        process.wait()


if __name__ == '__main__':
    main()
