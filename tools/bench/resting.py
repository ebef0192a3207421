# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of rest: bodies that sleep while a ball falls far away."""

from __future__ import annotations

import statistics
from test.building import spawn

from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World

from .bodies import Bare, GROUND, laid, timed

COUNT = 1000
STEPS = 60
REST = 240
# Speeds of the ball [m/s]; the last one needs continuous collision.
SPEEDS = (0.0, 5.0, 20.0)


def _at_rest(speed: float) -> World:
    world = laid(COUNT)
    world.step(REST)
    pose = (0.4 * GROUND, 50.0, 0.0)
    spawn(world, 'ball/0', Disc(radius=0.1), pose, velocity=(0.0, -speed))
    return world


def _bare(world: World, sleep: float) -> Bare:
    bare = Bare(world)
    bare.space.sleep_time_threshold, bare.space.idle_speed_threshold = sleep, 0.005
    bare.step(REST)
    return bare


def _measure(speed: float) -> None:
    """Print a row."""
    world = _at_rest(speed)
    awake, asleep = _bare(world, float('inf')), _bare(world, 0.5)
    acts = (lambda: awake.step(1), lambda: asleep.step(1), lambda: world.step(1))
    times = [[timed(act) for act in acts] for _ in range(STEPS)]
    base, slept, ours = (statistics.median(each) for each in zip(*times, strict=True))
    ratios = f'{ours / base:11.2f} {ours / slept:12.2f}'
    print(f'{speed:10g} {base:12.3f} {slept:13.3f} {ours:7.3f} {ratios}', flush=True)


def table() -> None:
    """Print a row for each speed of the ball."""
    print(
        f'\nA step of {COUNT} bodies at rest and a ball that falls far away [ms];'
        ' asleep: Pymunk with its own sleeping'
    )
    print('ball [m/s]  bare, awake  bare, asleep    ours  ours/awake  ours/asleep')
    for speed in SPEEDS:
        _measure(speed)
