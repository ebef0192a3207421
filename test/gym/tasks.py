# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A task of the tests: a noisy robot in the corridor, which begins anywhere near its end."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from physsim_ros import find_world, load_world, Robot, robot_spawn, Simulation
from physsim_ros.gym import Task

ROBOT = {
    'from': 'turtlebot3_burger',
    'odometry': {'slip': [0.05, 0.05]},
    'sensors': [
        {'kind': 'laser', 'name': 'scan', 'beams': 36, 'range': [0.05, 3.5], 'noise': 0.01}
    ],
}


def reward(robot: Robot, action: Any) -> float:
    """Return the speed ahead [m/s], less for steering, and -5 for a crash."""
    return robot.truth().twist[0] - 0.01 * float(action[1] ** 2) - 5.0 * robot.bumped


def crashed(robot: Robot) -> bool:
    return robot.bumped


def anywhere(robot: Robot, rng: np.random.Generator) -> None:
    robot.place(*rng.uniform((-0.3, -0.2, -1.0), (1.0, 0.2, 1.0)).tolist())


def task(**changes: Any) -> Task:
    simulation = Simulation()
    simulation.load(load_world(find_world('corridor')))
    simulation.perform(robot_spawn(ROBOT))
    made = Task(
        world=simulation.save(), begin=anywhere, reward=reward, is_over=crashed, longest=6.0
    )
    return replace(made, **changes)
