# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Controllers of the tests, where other processes find them."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
from typing import Any

import numpy as np
from physsim_ros import find_world, load_world, Robot, robot_spawn, Simulation
from physsim_ros.sweeps import Experiment


class WallFollower:
    """
    Follows the wall on its right, by a gain on its distance; without one into the next wall.

    :param gain: turn rate by error of the distance [rad/(s m)]
    """

    def __init__(self, gain: float) -> None:
        self.gain = gain

    def __call__(self, robot: Robot) -> None:
        scan = np.clip(robot.scan(), 0.0, 3.5)
        if self.gain and scan[0] < 0.5:
            robot.drive(0.0, 1.0)
            return
        # Beam k of 36 looks 10 degrees times k to the left.
        ahead, right = float(scan[32]), float(scan[27])
        angle = math.atan2(
            ahead * math.cos(math.radians(50)) - right, ahead * math.sin(math.radians(50))
        )
        robot.drive(0.2, self.gain * (0.35 - right * math.cos(angle) - 0.2 * math.sin(angle)))


def stumbling(**_: Any) -> Any:
    """Return a controller that fails by itself after a second."""

    def control(robot: Robot) -> None:
        robot.drive(0.1)
        if robot.simulation.step >= 240:
            raise ZeroDivisionError('no idea what to do')

    return control


def _exit() -> None:
    sys.exit(3)


def _end_at_once() -> None:
    os._exit(4)


def _kill() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def _hang() -> None:
    while True:
        pass


def _sleep() -> None:
    threading.Event().wait()


def _raise() -> None:
    raise ValueError('boom')


# How a controller ends its process, or does not.
ENDS = {
    '': lambda: None,
    'exit': _exit,
    'end at once': _end_at_once,
    'kill': _kill,
    'hang': _hang,
    'sleep': _sleep,
    'raise': _raise,
}


class Fated:
    """
    Drives on for a second, and ends in a way.

    :param fate: a key of `ENDS`
    :param calls: of the controller until then; 0 is as it is made
    """

    def __init__(self, fate: str, calls: int = 10) -> None:
        self.fate = fate
        self.calls = calls
        self._end_at(0)

    def __call__(self, robot: Robot) -> None:
        robot.drive(0.1)
        self.calls -= 1
        self._end_at(0)

    def _end_at(self, calls: int) -> None:
        if self.calls == calls:
            ENDS[self.fate]()


def skewed(robot: Robot, rng: np.random.Generator) -> None:
    robot.place(0.0, rng.uniform(-0.2, 0.2), rng.uniform(-0.3, 0.3))


def way_right(robot: Robot) -> float:
    return robot.truth().pose[0]


def experiment(**changes: Any) -> Experiment:
    simulation = Simulation()
    simulation.load(load_world(find_world('corridor')))
    laser = {'kind': 'laser', 'beams': 36, 'range': [0.05, 3.5], 'noise': 0.01}
    simulation.perform(robot_spawn({'from': 'turtlebot3_burger', 'sensors': [laser]}))
    given: dict[str, Any] = {'controller': WallFollower, 'begin': skewed, 'seconds': 20.0}
    return Experiment(world=simulation.save(), **{**given, **changes})
