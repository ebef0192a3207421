# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Time to accuracy: the processor time that each engine needs for the same error, scene by scene.

An engine is run at all of its rates; the cheapest one whose error is as small as is allowed is
told, and `RUNS` has all. Here frames are made, in the other engines steps alone. Box2D 3 is
measured where its bindings are installed: `pip install pyb2d3`.
"""

from __future__ import annotations

from collections.abc import Mapping
import csv
from functools import partial
import math
from pathlib import Path
from test.laws.scenes import floor, NOWHERE, spawn, walls
import time
from typing import NamedTuple

import numpy as np
from physsim_ros.model.requests import Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.simulation import Simulation

from .peers import depths, ENGINES, Errors, FRAMES, Rate, Run
from .scenes import bob_on_spring, bridge, chain, double_pendulum, gas, pendulum, racer, Scene

G = -WorldSettings().gravity[1]
# The table of all runs, which is written anew.
RUNS = Path('build', 'work_precision.csv')
# Half the side of a box, speed of the braking box [m/s], friction of a pair [1].
HALF, SPEED, FRICTION = 0.25, 4.0, 0.5
# Radius of the discs of the crowd, and half of the width of their bin [m].
RADIUS, BIN = 0.25, 6.0
BOX = Box(width=2 * HALF, height=2 * HALF)
ELASTIC = {'elasticity': 1.0, 'friction': 0.0}


def tower(sim: Simulation) -> None:
    """Add twenty boxes on each other."""
    floor(sim)
    for number in range(20):
        spawn(sim, f'box/{number}', BOX, (0.0, HALF + 2 * HALF * number, 0.0))


def load(sim: Simulation) -> None:
    """Add 1,000 kg on three boxes of 20 kg."""
    floor(sim)
    for number in range(4):
        mass = 1000.0 if number == 3 else 20.0
        spawn(sim, f'box/{number}', BOX, (0.0, HALF + 2 * HALF * number, 0.0), mass=mass)


def braking(sim: Simulation) -> None:
    """Add a box that slides to a stop."""
    material = {'friction': FRICTION, 'elasticity': 0.0}
    floor(sim, **material)
    flat = Box(width=1.0, height=0.1)
    spawn(sim, 'box/0', flat, (0.0, 0.05, 0.0), velocity=(SPEED, 0.0), **material)


def slope(sim: Simulation) -> None:
    """Add a box at rest on a slope, at nine tenths of its friction."""
    angle, material = math.atan(0.9 * FRICTION), {'friction': FRICTION}
    floor(sim, angle=angle, **material)
    place = (-HALF * math.sin(angle), HALF * math.cos(angle), angle)
    spawn(sim, 'box/0', BOX, place, **material)


def crowd(sim: Simulation) -> None:
    """Add 400 discs that fall into a bin."""
    walls(sim, -BIN, 0.0, BIN, 100.0)
    for number in range(400):
        x, y = number % 20 * 0.58 - 5.6, 0.4 + number // 20 * 0.6
        place = (x + 0.02 * (number % 3), y, 0.0)
        spawn(sim, f'disc/{number}', Disc(radius=RADIUS), place, elasticity=0.0)


def cradle(sim: Simulation) -> None:
    """Add five balls a millimetre apart, the first of which hits the others."""
    sim.perform(Configure(changes={'gravity': NOWHERE}))
    for number in range(5):
        place = (0.501 * number - (0.5 if number == 0 else 0.0), 0.0, 0.0)
        velocity = (1.0 if number == 0 else 0.0, 0.0)
        spawn(sim, f'ball/{number}', Disc(radius=0.25), place, velocity=velocity, **ELASTIC)


def bounce(sim: Simulation) -> None:
    """Add an elastic ball that falls from a metre."""
    floor(sim, **ELASTIC)
    spawn(sim, 'ball/0', Disc(radius=RADIUS), (0.0, 1.0 + RADIUS, 0.0), **ELASTIC)


def thrown(sim: Simulation) -> None:
    """Add a ball that is thrown."""
    spawn(sim, 'ball/0', Disc(radius=RADIUS), velocity=(3.0, 8.0))


# Errors of states, one a frame


def energy(states: list[Snapshot]) -> float:
    """
    Return the greatest change of energy, as a share of the greatest kinetic one.

    It is the mean over a second, since the velocities of some engines are those of half a step
    later than their poses.
    """
    total = [each.kinetic_energy + each.potential_energy + each.elastic_energy for each in states]
    moving = max(each.kinetic_energy for each in states)
    means = np.reshape(total[: len(total) // FRAMES * FRAMES], (-1, FRAMES)).mean(axis=1)
    return float(np.abs(means - means[0]).max()) / moving


def gap(states: list[Snapshot]) -> float:
    """Return the greatest distance of the two anchors of an axle [m]."""
    return max(float(np.hypot(*(each.ends[:, 0] - each.ends[:, 1]).T).max()) for each in states)


def moved(states: list[Snapshot]) -> float:
    """Return how far the last body has moved in the end [m]."""
    return float(np.hypot(*(states[-1].centers[-1] - states[0].centers[-1])))


def braked(states: list[Snapshot]) -> float:
    """Return the error of the distance of the braking box [m]."""
    distance = SPEED**2 / (2 * FRICTION * G)
    return abs(float(states[-1].centers[-1, 0] - states[0].centers[-1, 0]) - distance)


def deepest(states: list[Snapshot]) -> float:
    """Return how deep a disc of the settled crowd lies in another or in the bin [m]."""
    return max(float(depths(each, RADIUS, BIN).max()) for each in states[-30:])


def swapped(states: list[Snapshot]) -> float:
    """Return the error of the speeds of the balls at the end, as a share of the first one's."""
    speeds = states[-1].twists[:, 0]
    return float(np.abs(speeds - (0.0, 0.0, 0.0, 0.0, 1.0)).max())


def height(states: list[Snapshot]) -> float:
    """Return the error of the height to which the ball comes in the last second [m]."""
    return abs(max(float(each.centers[-1, 1]) for each in states[-FRAMES:]) - 1.0 - RADIUS)


def path(states: list[Snapshot]) -> float:
    """Return the distance of the thrown ball from its parabola at the end [m]."""
    seconds = states[-1].stamp * 1e-9
    place = np.array((3.0 * seconds, 8.0 * seconds - G * seconds**2 / 2))
    return float(np.hypot(*(states[-1].centers[-1] - place)))


def outside(states: list[Snapshot]) -> float:
    """Return how far the racing disc has come through the walls of its box [m]."""
    reach = max(float(np.abs(each.centers[-1]).max()) for each in states)
    return max(0.0, reach + 0.1 - 4.0)


class Trial(NamedTuple):
    """
    A scene with an exact answer.

    :ivar scene: that is built
    :ivar seconds: for which it runs
    :ivar error: of its states
    :ivar allowed: greatest error
    :ivar unit: of it, by which it is multiplied where it is told
    """

    scene: Scene
    seconds: float
    error: Errors
    allowed: float
    unit: str


_UNITS = {'%': 1e2, 'mm': 1e3}
TRIALS: dict[str, Trial] = {
    'pendulum, energy in 20 s': Trial(pendulum, 20.0, energy, 5e-3, '%'),
    'double pendulum, energy in 20 s': Trial(double_pendulum, 20.0, energy, 1e-2, '%'),
    'chain of fifty, gaps': Trial(chain, 5.0, gap, 1e-3, 'mm'),
    'bridge that bears 30 : 1, gaps': Trial(partial(bridge, mass=30.0), 5.0, gap, 20e-3, 'mm'),
    'bob on a spring, energy in 10 s': Trial(bob_on_spring, 10.0, energy, 1e-2, '%'),
    'tower of twenty, displacement of its top in 10 s': Trial(tower, 10.0, moved, 10e-3, 'mm'),
    '1,000 kg on three of 20 kg, the same': Trial(load, 10.0, moved, 3e-3, 'mm'),
    'braking box, distance': Trial(braking, 2.0, braked, 1e-3, 'mm'),
    'box on a slope, displacement in 5 s': Trial(slope, 5.0, moved, 1e-3, 'mm'),
    'crowd of 400, depth': Trial(crowd, 5.0, deepest, 6e-3, 'mm'),
    'cradle, speeds': Trial(cradle, 2.0, swapped, 1e-3, '%'),
    'bounce, height in 5 s': Trial(bounce, 5.0, height, 1e-3, 'mm'),
    'gas of 48, energy in 10 s': Trial(gas, 10.0, energy, 1e-3, '%'),
    'thrown ball, place after 2 s': Trial(thrown, 2.0, path, 1e-3, 'mm'),
    'disc at 43 m/s in thin walls, out of them': Trial(racer, 5.0, outside, 1e-3, 'mm'),
}


class Result(NamedTuple):
    """
    A run of an engine.

    :ivar rate: of it
    :ivar cost: processor time for a second of simulation [ms]
    :ivar error: of the scene; infinite where a state is no number
    """

    rate: Rate
    cost: float
    error: float


def measured(run: Run, rate: Rate, trial: Trial) -> Result:
    """Play a scene in an engine, and return its cost and error."""
    states, spent = [run.snapshot()], 0
    for _ in range(round(trial.seconds * FRAMES)):
        began = time.process_time_ns()
        run.advance()
        spent += time.process_time_ns() - began
        states.append(run.snapshot())
    error = trial.error(states)
    cost = spent * 1e-6 / trial.seconds
    return Result(rate, cost, error if math.isfinite(error) else math.inf)


def results_of(engine: str, trial: Trial) -> list[Result]:
    """Return a run of an engine at each of its rates, the cheapest first."""
    kind, rates = ENGINES[engine]
    return [measured(kind(trial.scene, rate), rate, trial) for rate in rates]


def cheapest(results: list[Result], allowed: float) -> Result | None:
    """Return the first run whose error is allowed; None if there is none."""
    return next((each for each in results if each.error <= allowed), None)


def table() -> None:
    """Print a row for each scene, and write the table of all runs."""
    names = list(ENGINES)
    RUNS.parent.mkdir(exist_ok=True)
    print(
        '\nProcessor time for a second of simulation [ms] at the cheapest rate [Hz] with no more'
    )
    print(f'than the error; times: of the best of {", ".join(names[1:])}; -: no rate has it')
    print(f'{"scene":42} {"error":>8}', *(f'{name:>22}' for name in names), f'{"times":>7}')
    with RUNS.open('w', encoding='utf-8') as file:
        writer = csv.writer(file)
        writer.writerow(('scene', 'engine', 'rate', 'cost [ms]', 'error'))
        for name, trial in TRIALS.items():
            runs = {engine: results_of(engine, trial) for engine in names}
            for engine, results in runs.items():
                writer.writerows((name, engine, *each) for each in results)
            print_row(name, trial, runs)


def print_row(name: str, trial: Trial, runs: Mapping[str, list[Result]]) -> None:
    """Print the cheapest run of each engine whose error is allowed."""
    best = {engine: cheapest(results, trial.allowed) for engine, results in runs.items()}
    cells = ['-' if each is None else f'{each.cost:.2f} ({each.rate})' for each in best.values()]
    ours = best.pop('here')
    peers = [each.cost for each in best.values() if each]
    times = f'{ours.cost / min(peers):.1f}' if ours and peers else '-'
    allowed = f'{trial.allowed * _UNITS[trial.unit]:g} {trial.unit}'
    print(f'{name:42} {allowed:>8}', *(f'{cell:>22}' for cell in cells), f'{times:>7}', flush=True)
