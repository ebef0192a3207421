# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An experiment: a controller drives a robot of a world until it fails, or the time is over.

Law: a run depends on the experiment and its case alone, to the bit, in whatever process. It
pickles, as an experiment and a case do whose functions are defined in a module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
import traceback
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import LONGEST, Within
from physsim_ros.model.errors import StepFailed
from physsim_ros.model.requests import DriveRobot
from physsim_ros.simulation.robot import Robot
from physsim_ros.simulation.simulation import Simulation

_PACKAGE = Path(__file__).resolve().parents[1]
# Past that a run keeps beyond the moment to which a failed one returns [s].
_MARGIN = 0.5
# Ranges of the times of an experiment; the past of a run is kept whole up to an hour.
_TIMES = {
    'seconds': Within(1e-4, LONGEST, 's'),
    'period': Within(1e-4, 1.0, 's'),
    'before': Within(0.0, 3600.0, 's'),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """
    A case of an experiment.

    :param seed: of all noise, and of what `begin` draws
    :param parameters: of the controller, by name
    """

    seed: int = 0
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Run:
    """
    What came of a case.

    :param case: that was run
    :param failure: why it failed; '' if it did not
    :param seconds: simulation time until then, or until the end [s]
    :param way: (k, 2) float64: positions of the robot at the controller's periods, world [m]
    :param score: of the robot at the end; NaN without a function for it
    :param before: the world shortly before a failure; None without one
    :param physics_rate: steps a second of the world [Hz]
    """

    case: Case
    failure: str
    seconds: float
    way: Floats
    score: float
    before: WorldState | None
    physics_rate: float

    @property
    def length(self) -> float:
        """Return the length of its way [m]."""
        steps = np.diff(self.way, axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def _stay(_: Robot, __: np.random.Generator) -> None:
    """Leave the world as it is."""


def has_bumped(robot: Robot) -> str:
    """Return a failure where a robot has touched something."""
    return 'crashed' if robot.bumped else ''


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """
    A controller in a world.

    :param world: with the robot; a run begins with it, and with noise of its own seed
    :param controller: makes the controller of a case, of its parameters by keyword; that is called
        with the robot once in a period, and has it drive
    :param robot: name of its body
    :param begin: changes the world at the beginning, by random numbers of the seed
    :param failure: why a robot has failed since the last period, or ''
    :param score: of the robot at the end of a run; None is none
    :param seconds: simulation time after which a run ends well [s]
    :param period: of the controller, simulation time [s]
    :param physics_rate: steps a second of the world [Hz], a multiple of 1 / period
    :param before: simulation time from the world that is kept of a failed run to its failure [s];
        while it is shorter than the timeout of the drive, the robot runs on into it by itself
    :raises BadProperty: a time is out of range
    """

    world: WorldState
    controller: Callable[..., Callable[[Robot], object]]
    robot: str = 'robot/0'
    begin: Callable[[Robot, np.random.Generator], object] = _stay
    failure: Callable[[Robot], str] = has_bumped
    score: Callable[[Robot], float] | None = None
    seconds: float = 60.0
    period: float = 0.1
    physics_rate: float = 240.0
    before: float = 0.4

    def __post_init__(self) -> None:
        for name, check in _TIMES.items():
            object.__setattr__(self, name, check(getattr(self, name), name))

    def run(self, case: Case) -> Run:
        """
        Run a case.

        An error of `begin` or of the controller is the failure of its run, and ends no other one.

        :raises Refusal: the world cannot be simulated, or has no such robot
        """
        simulation = Simulation(
            physics_rate=self.physics_rate,
            publish_rate=1.0 / self.period,
            history=self.before + _MARGIN,
            checkpoints=_MARGIN,
        )
        settings = replace(self.world.settings, seed=case.seed)
        simulation.begin(replace(self.world, settings=settings))
        robot = Robot(simulation, self.robot)
        way, failure, score = [robot.truth().pose[:2]], '', float('nan')
        try:
            self.begin(robot, np.random.default_rng(case.seed))
            way = [robot.truth().pose[:2]]
            control = self.controller(**case.parameters)
            for _ in range(round(self.seconds / self.period)):
                control(robot)
                simulation.run(self.period)
                way.append(robot.truth().pose[:2])
                failure = self.failure(robot)
                if failure:
                    break
            if self.score is not None:
                score = float(self.score(robot))
        except (Exception, StepFailed) as error:  # noqa: BLE001 - told, and others run on
            failure = _told(error)
        seconds = simulation.step / self.physics_rate
        return Run(
            case=case,
            failure=failure,
            seconds=seconds,
            way=np.array(way),
            score=score,
            before=_world_at(simulation, seconds - self.before) if failure else None,
            physics_rate=self.physics_rate,
        )


def _told(error: BaseException) -> str:
    """Return an error in one line, with the last place outside of this package."""
    places = traceback.extract_tb(error.__traceback__)
    outside = [each for each in places if not Path(each.filename).is_relative_to(_PACKAGE)]
    place = (outside or places)[-1]
    return f'{type(error).__name__}: {error} ({place.name}, line {place.lineno})'


def _world_at(simulation: Simulation, seconds: float) -> WorldState:
    """
    Return the world at a simulation time [s], or at the oldest that is kept.

    Robots drive there as they did, from now on to the timeouts of their drives.
    """
    simulation.seek(round(max(seconds, simulation.status.oldest) * 1e9))
    snapshot = simulation.frame.snapshot
    for row, aim in zip(snapshot.scene.robot_rows.tolist(), snapshot.robots.aim, strict=True):
        ahead, aside, turn = aim.tolist()
        name = snapshot.scene.names[row]
        simulation.perform(DriveRobot(name=name, velocity=(ahead, aside, turn)))
    return simulation.save()
