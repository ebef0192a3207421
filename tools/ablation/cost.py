# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of each stage: by how much a pile comes down faster without it."""

from __future__ import annotations

from functools import cache
from test.laws.scenes import floor, join, simulation, spawn
from time import process_time

from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation

from .stages import Stage, switched_off

# A checkpoint is taken in these frames.
PILE, LINKS, FRAMES = 300, 30, 190
# Number of runs, of which the fastest counts.
ROUNDS = 3


def _pile() -> Simulation:
    """Return discs of restitution 0.9 and boxes of 0 above a floor, and a chain beside them."""
    sim = simulation()
    floor(sim)
    for number in range(PILE):
        row, column = divmod(number, 20)
        place = (0.6 * column + 0.1 * (row % 2), 0.5 + 0.6 * row, 0.0)
        if number % 2:
            spawn(sim, f'body/{number}', Disc(radius=0.25), place, elasticity=0.9)
        else:
            spawn(sim, f'body/{number}', Box(width=0.5, height=0.5), place, elasticity=0.0)
    for number in range(LINKS):
        place = (-10.0 + 0.2 * (number + 0.5), 10.0, 0.0)
        spawn(sim, f'link/{number}', Box(width=0.2, height=0.05), place, mass=0.1)
        other = f'link/{number - 1}' if number else 'world'
        points = [(-10.0 + 0.2 * number, 10.0)]
        join(sim, f'axle/{number}', 'axle', points, a=f'link/{number}', b=other)
    return sim


@cache
def _time(stage: Stage | None) -> float:
    """Return the least processor time in which the pile comes down without a stage [s]."""
    return min(_run(stage) for _ in range(ROUNDS))


def _run(stage: Stage | None) -> float:
    with switched_off(stage):
        sim = _pile()
        began = process_time()
        for _ in range(FRAMES):
            sim.advance_frame()
        return process_time() - began


def share(stage: Stage) -> float:
    """Return the share of a stage of the core in the time of all frames."""
    return 1.0 - _time(stage) / _time(None)
