# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pytest fixture: how many times faster than real time a test runs, beside the bare steps.

CPU time of the process, in turns, as a machine whose speed drifts does not favour one of them;
over whole times between checkpoints.
"""

from __future__ import annotations

from test.building import spawn

from physsim_ros.model.requests import Restore
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
from physsim_ros.testing import own_context, PhysSim
import pytest

from .bodies import Bare, cpu_time

COUNTS = (0, 10, 100)
# Duration of a frame of the simulation [ms].
FRAME = 1000 / 60
# Frames in a row, and rows of each world: they contain three checkpoints.
TURN, TURNS = 60, 9
# Speed of discs that roll [m/s], their distance and radius [m].
SPEED, APART, RADIUS = 0.2, 1.0, 0.25


def on_floor(count: int, speed: float) -> World:
    """Return discs in a row on a floor, rolling or at rest."""
    world = World()
    if count:
        floor = Box(width=4.0 * count * APART + 100.0, height=2.0)
        spawn(world, 'floor/0', floor, (0.0, -1.0, 0.0), anchored=True)
    for number in range(count):
        pose, rolling = (APART * number, RADIUS, 0.0), {'spin': -speed / RADIUS}
        spawn(world, f'body/{number}', Disc(radius=RADIUS), pose, velocity=(speed, 0.0), **rolling)
    return world


def measure(sim: PhysSim, count: int, speed: float) -> None:
    """Print a row."""
    world = on_floor(count, speed)
    sim.node.simulation.perform(Restore(state=world.save()))
    bare = Bare(world)
    sim.step(TURN)
    acts = (lambda: sim.step(TURN), lambda: bare.step(4 * TURN))
    times = [[cpu_time(act) for act in acts] for _ in range(TURNS)]
    ours, base = (sum(each) / (TURN * TURNS) for each in zip(*times, strict=True))
    state = 'rolling' if speed else 'at rest'
    print(f'{count:6}  {state} {base:10.3f} {ours:13.3f} {FRAME / ours:15.0f}', flush=True)


def table() -> None:
    """Print a row for each count of bodies that roll on a floor, and that lie on it."""
    print('\nCPU of a frame of 4 steps in the pytest fixture, nothing subscribed')
    print('bodies  on floor  bare [ms]  fixture [ms]  times real time')
    with pytest.MonkeyPatch.context() as patch, own_context(patch) as context:
        for count in COUNTS:
            for speed in (SPEED, 0.0) if count else (0.0,):
                with PhysSim(context) as sim:
                    measure(sim, count, speed)
