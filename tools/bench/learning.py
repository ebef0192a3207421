# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Environments: how many steps they make in a second of CPU time, alone and many in one process.

A robot among walls is driven by random actions for 0.1 s a step, and reads 36 beams. Beside it the
same world in ir-sim (see `robots`), whose steps are kinematic: a pose is moved by its command,
without masses, wheels, friction or contacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import os
from typing import Any

import numpy as np
from physsim_ros.gym import RobotEnv, RobotVectorEnv, Task
from physsim_ros.model.robots.sensors import Laser

from .bodies import cpu_time
from .robots import in_peer, scene, WALLS

BEAMS, PERIOD, WORLDS = 36, 0.1, 8
# Steps of a turn; turns, the fastest of which counts.
STEPS, TURNS = 200, 10


def task() -> Task:
    """Return the task: to drive ahead."""
    world = scene(1).save()
    *walls, robot = world.bodies
    laser = Laser(beams=BEAMS, range=(0.12, 3.5))
    description = replace(robot.body.robot, sensors=(laser,))
    robot = replace(robot, body=replace(robot.body, robot=description))
    return Task(world=replace(world, bodies=(*walls, robot)), reward=speed, period=PERIOD)


def speed(robot: Any, _: Any) -> float:
    """Return the speed ahead [m/s]."""
    return float(robot.truth().twist[0])


def steps_a_second(step: Callable[[Any], object], actions: Any, worlds: int = 1) -> float:
    """Return steps of a world in a second of CPU time, by the fastest of some turns."""

    def play() -> None:
        for action in actions:
            step(action)

    play()
    return 1e3 * len(actions) * worlds / min(cpu_time(play) for _ in range(TURNS))


def table() -> None:
    """Print a row for one world, for many, and for the peer."""
    print(f'\nSteps of {PERIOD} s of an environment with {BEAMS} beams among {WALLS} walls')
    print('what                       steps a second of CPU time')
    rng = np.random.default_rng(0)
    one, many = RobotEnv(task()), RobotVectorEnv(task(), WORLDS)
    one.reset(seed=0)
    many.reset(seed=0)
    actions = rng.uniform(-0.5, 0.5, (STEPS, 2))
    print(f'one world                  {steps_a_second(one.step, actions):8.0f}', flush=True)
    actions = rng.uniform(-0.5, 0.5, (STEPS // WORLDS, WORLDS, 2))
    rate = steps_a_second(many.step, actions, WORLDS)
    print(f'{WORLDS} worlds in one process    {rate:8.0f}', flush=True)
    if 'IRSIM_PYTHON' in os.environ:
        print(f'ir-sim, without dynamics   {in_peer(1, PERIOD, BEAMS) / PERIOD:8.0f}', flush=True)
    else:
        print('ir-sim: skipped: IRSIM_PYTHON names no Python that has ir-sim')
