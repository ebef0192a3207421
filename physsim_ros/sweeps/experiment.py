# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An experiment: a controller drives a robot of a world until it fails, or the time is over.

Law: a run depends on the experiment and its case alone, to the bit, in whatever process. It
pickles, as an experiment and a case do whose functions are defined in a module.
"""

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field, replace
from inspect import Parameter, signature
import math
from pathlib import Path
import traceback
from typing import Annotated, Any

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import LONGEST, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, StepFailed, UnknownProperty
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.texts import nearest_name
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.robot import Robot
from physsim_ros.simulation.simulation import Simulation

_PACKAGE = Path(__file__).resolve().parents[1]
# Past that a run keeps beyond the moment to which a failed one returns [s].
_MARGIN = 0.5
# Kinds of parameters that may be given by keyword.
_NAMED = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """
    A case of an experiment.

    :param seed: seed of all noise, and of the random numbers of `begin`
    :param parameters: parameters of the controller, by name
    """

    seed: int = 0
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Run:
    """
    The result of a case.

    :param case: the case
    :param failure: reason of the failure; '' if the run succeeded
    :param seconds: simulation time until the failure, or until the end [s]
    :param way: (k, 2) float64: positions of the robot at the controller's periods, world [m]
    :param score: score of the robot at the end; NaN if the experiment has no score
    :param before: state of the world shortly before the failure; None if the run succeeded
    :param physics_rate: steps of the world per second of simulation time [Hz]
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
        """Return the length of the robot's way [m]."""
        steps = np.diff(self.way, axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


class Ended(Exception):
    """The process of a run has ended; the message tells how."""


def has_bumped(robot: Robot) -> str:
    """Return the failure `crashed` if a robot has touched something, else ''."""
    return 'crashed' if robot.bumped else ''


@dataclass(frozen=True, kw_only=True)
class Experiment(Checked):
    """
    A controller in a world, to be run with many seeds and parameters.

    :param world: state with the robot, with which each run begins; each has its own noise
    :param controller: creates the controller of a case from its parameters, by keyword; the
        controller is called with the robot once in each period, and drives it
    :param robot: name of the robot's body
    :param begin: changes the world when a run begins, by a random generator of its seed; None
        changes nothing
    :param failure: returns why the robot has failed since the last period, or ''
    :param score: returns a number for the robot at the end of a run; None is no score
    :param physics_rate: steps a second of the world [Hz], a multiple of 1 / period
    :raises BadProperty: a time is out of range, or a run shorter than a period of the controller
    """

    world: WorldState
    controller: Callable[..., Callable[[Robot], object]]
    robot: str = 'robot/0'
    begin: Callable[[Robot, np.random.Generator], object] | None = None
    failure: Callable[[Robot], str] = has_bumped
    score: Callable[[Robot], float] | None = None
    seconds: Annotated[
        float, Within(1e-4, LONGEST, 's'), 'simulation time after which a run ends well'
    ] = 60.0
    period: Annotated[float, Within(1e-4, 1.0, 's'), 'of the controller, simulation time'] = 0.1
    physics_rate: float = 240.0
    before: Annotated[
        float,
        Within(0.0, 3600.0, 's'),
        'simulation time from the world that is kept of a failed run to its failure; while it is '
        'shorter than the timeout of the drive, the robot runs on into it by itself',
    ] = 0.4
    cpu_limit: Annotated[
        float, Within(1.0, LONGEST, 's'), 'CPU time after which a sweep ends a run, as failed'
    ] = 600.0
    wall_limit: Annotated[
        float, Within(0.1, LONGEST, 's'), 'wall time after which a sweep ends a run, as failed'
    ] = 3600.0

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.seconds < self.period:
            raise BadProperty(
                'a run of {seconds:g} s is shorter than a period of {period:g} s; it would not '
                'call the controller',
                field='seconds',
                seconds=self.seconds,
                period=self.period,
            )

    def check(self, case: Case) -> None:
        """
        Refuse a case whose parameters are not those of the controller.

        :raises UnknownProperty: the controller lacks the parameter; the message names the nearest
        :raises BadProperty: a parameter that the controller requires is missing
        """
        try:
            known = signature(self.controller).parameters.values()
        except (TypeError, ValueError):
            # Of what is written in C.
            return
        named = {each.name: each.default for each in known if each.kind in _NAMED}
        if all(each.kind is not Parameter.VAR_KEYWORD for each in known):
            for name in case.parameters:
                if name not in named:
                    near = nearest_name(name, named) or f'; it has {", ".join(named) or "none"}'
                    raise UnknownProperty(
                        'the controller has no parameter {field!r}{near}', field=name, near=near
                    )
        for name, default in named.items():
            if default is Parameter.empty and name not in case.parameters:
                raise BadProperty('the controller needs the parameter {field}', field=name)

    def run(self, case: Case) -> Run:
        """
        Run a case in this process, and return its result.

        If `begin` or the controller raises an error or exits, the run has failed.

        :raises Refusal: the world cannot be simulated, or has no such robot; also as `check`
        """
        return finish(self.calls(case))

    def calls(self, case: Case) -> Generator[int, None, Run]:
        """
        Run a case, as `run`: a generator that returns the run.

        It yields the count of the controller's calls before each; 0 is before `begin` and the
        making of the controller. `Ended` that is thrown there ends the run, as failed.
        """
        self.check(case)
        simulation = self._simulation(case)
        robot = Robot(simulation, self.robot)
        way, failure, score = [robot.truth().pose[:2]], '', math.nan
        try:
            yield 0
            if self.begin is not None:
                self.begin(robot, np.random.default_rng(case.seed))
            way[0] = robot.truth().pose[:2]
            control = self.controller(**case.parameters)
            for call in range(1, round(self.seconds / self.period) + 1):
                yield call
                control(robot)
                simulation.run(self.period)
                way.append(robot.truth().pose[:2])
                failure = self.failure(robot)
                if failure:
                    break
            if self.score is not None:
                score = float(self.score(robot))
        except Ended as ended:
            failure = str(ended)
        except (Exception, StepFailed, SystemExit) as error:  # noqa: BLE001 - a result
            failure = _in_one_line(error)
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

    def _simulation(self, case: Case) -> Simulation:
        """Return the simulation with which the run of a case begins."""
        simulation = Simulation(
            physics_rate=self.physics_rate,
            publish_rate=1.0 / self.period,
            history=self.before + _MARGIN,
            checkpoints=_MARGIN,
        )
        settings = replace(self.world.settings, seed=case.seed)
        simulation.begin(replace(self.world, settings=settings))
        return simulation


def _in_one_line(error: BaseException) -> str:
    """Return an error in one line, with the last place outside of this package."""
    places = traceback.extract_tb(error.__traceback__)
    outside = [each for each in places if not Path(each.filename).is_relative_to(_PACKAGE)]
    place = (outside or places)[-1]
    message = ' '.join(str(error).split())
    return f'{type(error).__name__}: {message} ({place.name}, line {place.lineno})'


def _world_at(simulation: Simulation, seconds: float) -> WorldState:
    """
    Return the world at a simulation time [s], or at the oldest that is kept.

    Robots drive there as they did, from now on to the timeouts of their drives.
    """
    simulation.seek(round(max(seconds, simulation.status.oldest) * 1e9))
    snapshot = simulation.frame.snapshot
    scene, aims = snapshot.scene, snapshot.robots['aim'].tolist()
    for row, robot, aim in zip(scene.robot_rows.tolist(), scene.robots, aims, strict=True):
        if robot.drive is not None:
            simulation.perform(DriveRobot(name=scene.names[row], velocity=aim))
    return simulation.save()
