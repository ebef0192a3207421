# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of joints: a step of a machine, with its joints and without."""

import statistics
from test.building import net, spawn

from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World

from .bodies import cpu_time

STEPS = 480
FRAMES = 180


def chain(count: int, *, links: int, joined: bool) -> World:
    """Return chains of so many links side by side, `count` links in all."""
    world = World()
    for number in range(count):
        row, link = divmod(number, links)
        name, x, y = f'link/{number}', 0.2 * link, 2.0 * row
        shape = Box(width=0.2, height=0.1)
        spawn(world, name, shape, (x + 0.1, y, 0.0), mass=0.1, sensor=True)
        if joined:
            other, points = f'link/{number - 1}' if link else 'world', ((x, y),)
            kind = JointKind.AXLE
            world.apply(Join(name=f'joint/{number}', kind=kind, points=points, a=name, b=other))
    return world


def median_step(world: World) -> float:
    """Return the median CPU time of a step [ms]."""
    return statistics.median(cpu_time(lambda: world.step(1)) for _ in range(STEPS))


def frames(world: World) -> tuple[float, float]:
    """Return the median CPU time of a frame, and the longest one, with a checkpoint in it [ms]."""
    simulation = Simulation(checkpoints=1.0)
    simulation.load(world.save())
    costs = [cpu_time(simulation.advance_frame) for _ in range(FRAMES)]
    # The first step makes the tables of joints.
    return statistics.median(costs), max(costs[1:])


def table() -> None:
    """Print it."""
    print('\nA step with joints, and of the same bodies without [ms]')
    for count, links in ((1, 1), (100, 1), (10, 10), (50, 50), (200, 50), (1000, 1)):
        with_, without = (
            median_step(chain(count, links=links, joined=joined)) for joined in (True, False)
        )
        print(f'{count // links:>5} x {links:<3} links  {with_:7.3f} : {without:7.3f}')
    print('\nA frame of 4 steps of a net of discs that hang together by rods [ms]')
    print('   discs   rods  median  longest')
    for side in (5, 10, 20):
        median, longest = frames(net(side))
        rods = 2 * side * (side - 1)
        print(f'{side * side:>8} {rods:>6} {median:>7.1f} {longest:>8.1f}')
