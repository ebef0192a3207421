# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make soak`; `make soak MINUTES=5 SEED=3` chooses length and seed.

A world runs as people start it. Rounds of random requests, and scenes at full size, are each
followed by some quiet seconds with the same world, in which memory, threads, descriptors, child
processes and late frames are measured. Growth, lateness, divergence and a missing answer are
faults, and the exit code is 1.
"""

from __future__ import annotations

from contextlib import ExitStack
import os
from pathlib import Path
import signal
import sys
from tempfile import TemporaryDirectory
from test.outside import Outside, Program
import time

from physsim_ros.testing.domain import own_domain
import psutil
import rclpy

from . import scenes
from .driver import Driver
from .monitor import Monitor

# Disturbances in a round, and how long a world is left alone after them [s].
ROUND = 25
QUIET = 4.0
# Memory of the past [MB]: resets and courses that were left fill it within minutes.
BUDGET = 24.0
SCENES = (
    scenes.one_pose,
    scenes.sphere_lists,
    scenes.coincident_lists,
    scenes.crossing_rods,
)


def main(minutes: float, seed: int) -> int:
    with TemporaryDirectory() as place, own_domain() as domain, ExitStack() as closing:
        directory = Path(place)
        os.environ['PYTHONFAULTHANDLER'] = '1'
        outside = Outside(directory, domain, closing)
        world = outside.start_world(
            record_file=directory / 'soak.rrd',
            world_dir=directory,
            history=60.0,
            history_memory=BUDGET,
        )
        world.wait_for('ready')
        os.environ.update(outside.environment)
        rclpy.init()
        closing.callback(rclpy.shutdown)
        driver = Driver(seed)
        closing.callback(driver.close)
        monitor = Monitor(world.process.pid, BUDGET)
        faults = []
        try:
            _soak(minutes, driver, monitor, outside)
        except (TimeoutError, psutil.NoSuchProcess) as error:
            # It prints where each of its threads is.
            world.process.send_signal(signal.SIGABRT)
            world.finish()
            faults += [f'{driver.doing}: {error}', ''.join(world.lines[-60:])]
        else:
            faults += _end(world)
        faults += monitor.faults() + [f'divergence: {each}' for each in driver.divergences]
        if any('Traceback' in line for line in world.lines):
            faults.append(''.join(world.lines[-30:]))
    print(monitor.words)
    print('events:', ', '.join(f'{code or "done"} {n}' for code, n in driver.codes.most_common()))
    print('\n'.join(f'FAULT: {fault}' for fault in faults) or 'no faults')
    return bool(faults)


def _soak(minutes: float, driver: Driver, monitor: Monitor, outside: Outside) -> None:
    """
    Disturb a world round by round, and print a line for each.

    :raises TimeoutError: the world does not answer
    """
    began = time.monotonic()
    deaf: Program | None = None
    print('  min      MB  past  threads  fds  children  late')
    number = 0
    while (passed := (time.monotonic() - began) / 60) < minutes:
        for _ in range(ROUND):
            driver.disturb()
            driver.spin(driver.random.uniform(0.0, 0.2))
        _kill_children(monitor)
        if deaf is None:
            deaf = outside.start_elsewhere('deaf')
            deaf.wait_for('DEAF')
            deaf.process.send_signal(signal.SIGSTOP)
        else:
            deaf.close()
            deaf = None
        scene = SCENES[number % len(SCENES)]
        driver.call('clear')
        answered = driver.publish_scene(scene())
        driver.settle()
        driver.spin(QUIET)
        late, waited = driver.late_frames(), monitor.waited
        driver.spin(QUIET)
        late = driver.late_frames() - late
        sample = monitor.sample(passed, driver.past(), late, monitor.waited - waited)
        print(
            f'{sample.minutes:5.1f} {sample.megabytes:7.0f} {sample.past:5.0f} '
            f'{sample.threads:8d} {sample.descriptors:4d} {sample.children:9d} '
            f'{sample.late_frames:5d}  {scene.__name__}, {answered:.1f} s to the last answer',
            flush=True,
        )
        number += 1


def _kill_children(monitor: Monitor) -> None:
    """Kill the programs of viewers, as people close windows."""
    for child in monitor.children():
        child.kill()


def _end(world: Program) -> list[str]:
    """End a world; return what was wrong about that."""
    children = psutil.Process(world.process.pid).children(recursive=True)
    began = time.monotonic()
    code = world.interrupt()
    took = time.monotonic() - began
    _, alive = psutil.wait_procs(children, timeout=3.0)
    faults = [f'{len(alive)} child processes outlive the node'] if alive else []
    if code or took > 3.0:
        faults.append(f'ended with code {code} after {took:.1f} s')
    return faults


if __name__ == '__main__':
    sys.exit(
        main(minutes=float(os.environ.get('MINUTES') or 30), seed=int(os.environ.get('SEED') or 0))
    )
