# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Short scenes of the laws and worlds, each with one number for its error.

The error is the greatest deviation from the exact answer; a scene fails where it is greater than
the tolerance of the law, or no number at all.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
import itertools
import math
from test.laws.scenes import (
    bar_among_discs,
    DT,
    energy,
    floor,
    G,
    hanging_chain,
    join,
    NOWHERE,
    run,
    simulation,
    spawn,
    steps,
    turned,
)
from test.laws.test_machines import pendulum, speeds_after_cradle
from test.worlds import film
import time
from typing import Any, NamedTuple

import numpy as np
from physsim_ros.model.requests import Delete, DriveRobot
from physsim_ros.model.shapes import Box, Disc, Shape
import pymunk

# Bodies at rest in the scene of sleeping, how many of them in a column, and steps that are timed.
LYING, HIGH, TIMED = 1000, 4, 60


class Scene(NamedTuple):
    """
    A scene.

    :ivar name: and the law that it is of
    :ivar unit: of its error
    :ivar tolerance: of the law
    :ivar error: plays the scene, and returns its error
    """

    name: str
    unit: str
    tolerance: float
    error: Callable[[], float]


def _free_flight() -> float:
    """Throw a disc for a second; return the greatest deviation from the parabola."""
    sim = simulation()
    spawn(sim, 'disc/0', Disc(radius=0.1), velocity=(3.0, 4.0))
    return max(
        math.dist(now.poses[0, :2], (3.0 * t, 4.0 * t - G * t * t / 2))
        for now in steps(sim, 240)
        if (t := now.step * DT)
    )


def _thin_wall() -> float:
    """Throw discs at a wall of 0.1 m; return by how far one gets past its face."""
    deepest = 0.0
    for distance in (1.0, 1.1, 1.2, 1.3):
        sim = simulation(gravity=NOWHERE)
        spawn(sim, 'wall/0', Box(width=0.1, height=20.0), anchored=True)
        disc = spawn(sim, 'disc/0', Disc(radius=0.1), (distance, 0.0, 0.0), velocity=(-400.0, 0))
        places = [now.poses[disc, 0] for now in steps(sim, 12)]
        deepest = max(deepest, 0.15 - min(places))
    return deepest


def _fast_bar() -> float:
    """Turn a bar of 4 m at 300 rad/s through 40 discs; return how many it misses."""
    sim, discs = bar_among_discs(300.0)
    hit = np.zeros(40, np.bool_)
    for now in steps(sim, 8):
        hit |= np.hypot(*now.twists[discs, :2].T) > 60.0
    return 40.0 - hit.sum()


def _squares_that_part() -> float:
    """Let squares part that face each other exactly; return the greatest speed of those behind."""
    random = np.random.default_rng(3)
    sim = simulation(gravity=NOWHERE)
    square = Box(width=1.0, height=1.0)
    for number in range(400):
        x, y, heading = 5.0 * (number % 20), 5.0 * (number // 20), random.uniform(0.0, math.tau)
        cos, sin, far = math.cos(heading), math.sin(heading), random.uniform(1.01, 1.21)
        spawn(sim, f'one/{number}', square, (x, y, heading))
        pose = x + far * cos, y + far * sin, heading
        spawn(sim, f'other/{number}', square, pose, velocity=(0.3 * cos, 0.3 * sin))
    *_, last = steps(sim, 60)
    return float(np.abs(last.twists[::2]).max())


def _between_walls() -> float:
    """
    Play elastic balls between two walls for a second; return by how far off they are.

    They start where no impact is at the end of a sub-step.
    """
    sim, gap, speeds = simulation(gravity=NOWHERE, elasticity=1.0), 0.4, (3.0, 10.0, 30.0, 60.0)
    for number, x in enumerate((-0.5, gap + 0.6)):
        spawn(sim, f'wall/{number}', Box(width=1.0, height=20.0), (x, 0.0, 0.0), anchored=True)
    balls = [
        spawn(sim, f'ball/{speed:g}', Disc(radius=0.05), (0.253, row, 0.0), velocity=(speed, 0.0))
        for row, speed in enumerate(speeds)
    ]
    *_, last = steps(sim, 240)
    # The path unfolded: from the first wall and back is twice the gap.
    phase = (0.203 + np.array(speeds)) % (2.0 * gap)
    exact = 0.05 + np.minimum(phase, 2.0 * gap - phase)
    return float(np.abs(last.poses[balls, 0] - exact).max() / gap)


def _corner() -> float:
    """
    Throw an elastic disc at a corner at 8 m/s; return by how far its velocity is off.

    It meets the corner within a sub-step.
    """
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    spawn(
        sim, 'box/0', Box(width=2.0, height=2.0), (math.sqrt(2.0), 0.0, math.pi / 4), anchored=True
    )
    outwards = np.array((-math.cos(0.5), math.sin(0.5)))
    start = 0.05 * outwards - np.array((1.003, 0.0))
    disc = spawn(sim, 'disc/0', Disc(radius=0.05), (*start.tolist(), 0.0), velocity=(8.0, 0.0))
    exact = np.array((8.0, 0.0)) - 16.0 * outwards[0] * outwards
    return math.dist(run(sim, 0.2).twists[disc, :2], exact) / 8.0


def _seams() -> float:
    """Slide a box over tiles, its face in the plane of a seam; return the share of speed lost."""
    sim = simulation(friction=0.0)
    for number in range(8):
        tile = Box(width=0.5, height=0.5)
        spawn(sim, f'tile/{number}', tile, (0.5 * number, -0.25, 0.0), anchored=True)
    box = Box(width=0.3, height=0.3)
    row = spawn(sim, 'box/0', box, (0.0, 0.15, 0.0), velocity=(3.0, 0.0))
    return 1.0 - float(run(sim, 1.0).twists[row, 0]) / 3.0


def _flat_fall() -> float:
    """Drop an upright box flat; return its greatest turn in 2 s."""
    sim = simulation(elasticity=0.5)
    floor(sim)
    row = spawn(sim, 'box/0', Box(width=0.5, height=1.0), (0.0, 1.5, 0.0))
    return max(abs(float(each.poses[row, 2])) for each in steps(sim, 480))


def _clay() -> float:
    """Drop a disc of clay onto a light plate on the floor; return by how much it rises again."""
    sim = simulation(elasticity=0.0)
    floor(sim)
    spawn(sim, 'plate/0', Box(width=1.0, height=0.2), (0.0, 0.1, 0.0), mass=1.0)
    clay = spawn(sim, 'clay/0', Disc(radius=0.3), (0.0, 3.5, 0.0), mass=30.0)
    heights = [float(now.poses[clay, 1]) for now in steps(sim, 480)]
    lowest = heights.index(min(heights))
    return max(heights[lowest:]) - heights[lowest]


def _stack() -> float:
    """Put down a stack of ten boxes; return its speed from 3 to 5 s."""
    sim, size = simulation(), 0.3
    floor(sim)
    for level in range(10):
        spawn(sim, f'box/{level}', Box(width=size, height=size), (0.0, size * (level + 0.5), 0.0))
    run(sim, 3.0)
    return max(float(np.abs(now.twists[1:, :2]).max()) for now in steps(sim, 480))


def _removed_floor() -> float:
    """Remove the floor under a pile; return the deviation from free fall after half a second."""
    sim = simulation()
    floor(sim)
    for number in range(20):
        column, level = number % 4, number // 4
        place = (0.6 * column + 0.1 * (level % 2), 0.25 + 0.5 * level, 0.0)
        spawn(sim, f'box/{number}', Box(width=0.5, height=0.5), place)
    run(sim, 2.0)
    before = sim.world.snapshot()
    sim.perform(Delete(name='floor/0'))
    *_, after = steps(sim, 120)
    t = 120 * DT
    return float(np.abs(after.poses - before.poses[1:] + (0.0, G * t * t / 2, 0.0)).max())


def _cradle() -> float:
    """Swing two and three of five balls; return the worst deviation of the speeds after it."""
    return max(
        float(np.abs(speeds_after_cradle(swung, gap) - (np.arange(5) >= 5 - swung)).max())
        for swung in (2, 3)
        for gap in (0.0, 1e-3)
    )


def _elastic_rows() -> float:
    """Let two of five bodies strike the others; return the worst deviation of the speeds."""
    disc, box = Disc(radius=0.1), Box(width=0.2, height=0.2)
    rows = itertools.product((disc, box), (0.02, 0.024, 0.0273))
    return max(_elastic_row_of(shape, flight) for shape, flight in rows)


def _elastic_row_of(shape: Shape, flight: float) -> float:
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    for number in range(5):
        flies = number < 2
        place = (0.2 * number - flight * flies, 0.0, 0.0)
        spawn(sim, f'body/{number}', shape, place, mass=1.0, velocity=(2.0 * flies, 0.0))
    *_, last = steps(sim, 72)
    return float(np.abs(last.twists[:, 0] / 2.0 - (0.0, 0.0, 0.0, 1.0, 1.0)).max())


def _pendulum() -> float:
    """Swing a pendulum from 90 degrees for 10 s; return the greatest change of its energy."""
    sim = pendulum(math.pi / 2)
    before = sim.world.snapshot()
    deepest = float(before.scene.inertia[0, 0]) * G
    return max(abs(energy(now) - energy(before)) / deepest for now in steps(sim, 2400))


def _chain() -> float:
    """Let a chain of 50 axles swing for 5 s; return by which share it stretches."""
    ends = (now.ends[:, 0] - now.ends[:, 1] for now in steps(hanging_chain(50), 1200))
    return max(float(np.hypot(*gaps.T).sum()) for gaps in ends) / 10.0


def _gear_train() -> float:
    """Run the world of gears for 3 s; return by how far they are from the ratio of their teeth."""
    seen = film.Film(film.simulation('gear_train'), 3.0)
    first, second, third, fourth = (
        seen.yaw(f'wheel/{number}') - seen.yaw(f'wheel/{number}')[0] for number in range(4)
    )
    gaps = 12 * first + 24 * second, second - third, 10 * third + 30 * fourth
    return max(float(np.abs(gap).max()) for gap in gaps)


def _plough() -> float:
    """Drive a plough through two discs; return the error of its displacement [1, of it]."""
    sim = simulation(gravity=NOWHERE)
    row = spawn(sim, 'plough/0', Box(width=0.3, height=1.0), mass=1000.0, velocity=(30.0, 0.0))
    for number in range(2):
        spawn(sim, f'disc/{number}', Disc(radius=0.05), (1.0 + 0.15 * number, 0.0, 0.0), mass=1.0)
    first = last = sim.world.snapshot()
    integral = 0.0
    for now in steps(sim, 60):
        integral += float(last.twists[row, 0] + now.twists[row, 0]) / 2 * DT
        last = now
    return abs(float(last.centers[row, 0] - first.centers[row, 0]) / integral - 1.0)


def _slide() -> float:
    """Slide a box on a floor until it stands; return the error of its distance, v² / (2 μ g)."""
    sim = simulation(gravity=NOWHERE, floor_friction=0.5)
    spawn(sim, 'box/0', Box(width=0.4, height=0.2), velocity=(2.0, 0.0))
    *_, last = steps(sim, 240)
    return abs(float(last.poses[0, 0]) - 2.0**2 / (2 * 0.5 * G))


def _robot() -> float:
    """Drive a robot on circles; return its greatest distance from the arc that it is told."""
    sim = simulation(gravity=NOWHERE, floor_friction=0.5)
    drive = {'kind': 'differential', 'acceleration': 100.0, 'timeout': 0.0}
    spawn(sim, 'robot/0', Disc(radius=0.1), mass=1.0, robot={'drive': drive})
    sim.perform(DriveRobot(name='robot/0', velocity=(0.2, 0.0, 1.0)))
    # At first its wheels slip.
    *_, start = steps(sim, 60)
    x, y, yaw = start.poses[0]
    center = x - 0.2 * math.sin(yaw), y + 0.2 * math.cos(yaw)
    return max(
        math.dist(
            now.poses[0, :2],
            (center[0] + 0.2 * math.sin(yaw + angle), center[1] - 0.2 * math.cos(yaw + angle)),
        )
        for now in steps(sim, 1200)
        if (angle := (now.step - start.step) * DT)
    )


def _bridge() -> float:
    """Let the truck drive over the bridge for 4 s; return by how far a plank is displaced."""
    seen = film.Film(film.simulation('bridge'), 4.0)
    deck = np.array([seen.pose(f'deck/{number}') for number in range(8)])
    return float(np.abs(deck[:, :, 1] - 3.0).max())


def _checkpoint() -> float:
    """Take a checkpoint of a chain and a stack at rest; return their greatest speed after it."""
    sim = simulation()
    floor(sim)
    for number in range(10):
        place = (3.0, 0.25 + 0.5 * number, 0.0)
        spawn(sim, f'box/{number}', Box(width=0.5, height=0.5), place)
    for number in range(20):
        place = (0.0, 6.0 - 0.2 * (number + 0.5), 0.0)
        spawn(sim, f'link/{number}', Box(width=0.05, height=0.2), place, mass=0.1)
        other = f'link/{number - 1}' if number else 'world'
        points = [(0.0, 6.0 - 0.2 * number)]
        join(sim, f'axle/{number}', 'axle', points, a=f'link/{number}', b=other)
    sim.world.step(720)
    sim.world.renew()
    return max(float(np.abs(now.twists).max()) for now in steps(sim, 24))


def _at_rest() -> float:
    """Return the cost of a step of bodies at rest, in steps of Pymunk that does not sleep."""
    sim, bare = simulation(), pymunk.Space()
    floor(sim)
    bare.gravity = (0.0, -G)
    slab = pymunk.Poly(bare.static_body, [(-200.0, -2.0), (200.0, -2.0), (200.0, 0), (-200.0, 0)])
    bare.add(slab)
    for number in range(LYING):
        place = (0.3 * (number // HIGH), 0.1 + 0.2 * (number % HIGH))
        spawn(sim, f'box/{number}', Box(width=0.2, height=0.2), (*place, 0.0), mass=1.0)
        twin = pymunk.Body(1.0, 0.2**2 / 6)
        twin.position = place
        bare.add(twin, pymunk.Poly.create_box(twin, (0.2, 0.2)))
    sim.world.step(480)
    for _ in range(180):
        bare.step(DT)
    spawn(sim, 'ball/0', Disc(radius=0.1), (-10.0, 100.0, 0.0))
    ours, theirs = [], []
    for _ in range(TIMED):
        ours.append(_timed(lambda: sim.world.step(1)))
        theirs.append(_timed(lambda: bare.step(DT)))
    return min(ours) / min(theirs)


def _timed(act: Callable[[], Any]) -> float:
    began = time.perf_counter()
    act()
    return time.perf_counter() - began


def _raft() -> float:
    """Return how far a raft in syrup floats from the depth of Archimedes."""
    sim = simulation()
    said: dict[str, Any] = {'anchored': True, 'sensor': True}
    syrup = {'density': 10.0, 'viscosity': 10.0}
    spawn(sim, 'pool/0', Box(width=9.0, height=9.0), (0.0, -4.5, 0.0), medium=syrup, **said)
    spawn(sim, 'raft/0', Box(width=1.0, height=0.2), (0.0, 0.0, 0.1), density=4.0)
    sim.world.step(2400)
    return abs(sim.world.snapshot().poses[1, 1] - 0.02)


def _tips() -> float:
    """Return how deep a box of great friction that tips on an incline comes in with its corner."""
    sim, angle, height, depth = simulation(friction=3.0, elasticity=0.0), 0.8, 1.0, 0.0
    floor(sim, angle=angle)
    spawn(sim, 'box/0', Box(width=0.5, height=height), (*turned((0.0, 0.5), angle), angle))
    for now in steps(sim, 240):
        x, y, yaw = now.poses[1]
        fallen = abs(yaw - angle)
        below = 0.25 * math.sin(fallen) + height / 2 * math.cos(fallen)
        if fallen < 1.2:
            depth = max(depth, below - turned((x, y), -angle)[1])
    return depth


SCENES = (
    Scene('free flight (1)', 'm', 1e-9, _free_flight),
    Scene('thin wall (25)', 'm', 0.01, _thin_wall),
    Scene('fast bar (35)', 'discs', 0.0, _fast_bar),
    Scene('squares that part (3)', 'm/s', 1e-9, _squares_that_part),
    Scene('between walls (46)', 'gap', 0.02, _between_walls),
    Scene('disc on a corner (6)', 'v', 1e-6, _corner),
    Scene('seams of tiles', 'v', 0.01, _seams),
    Scene('flat fall (8)', 'rad', 1e-4, _flat_fall),
    Scene('clay on a plate (44)', 'm', 1e-3, _clay),
    Scene('stack of ten (18)', 'm/s', 1e-3, _stack),
    Scene('removed floor', 'm, rad', 1e-3, _removed_floor),
    Scene('cradle, 2 and 3 of 5 (17)', 'v', 0.02, _cradle),
    Scene('elastic rows, 2 of 5 (36)', 'v', 0.02, _elastic_rows),
    Scene('pendulum (15)', 'm g l', 0.01, _pendulum),
    Scene('chain of 50 (20)', 'length', 0.05, _chain),
    Scene('gear train', 'rad', 1e-6, _gear_train),
    Scene('plough (28)', 'displacement', 0.02, _plough),
    Scene('slide on a floor (37)', 'm', 0.5 * G * DT**2, _slide),
    Scene('robot on an arc (38)', 'm', 1e-6, _robot),
    Scene('bridge', 'm', 2e-3, _bridge),
    Scene('raft (70)', 'm', 1e-4, _raft),
    Scene('box that tips (78)', 'm', 1e-4, _tips),
    Scene('checkpoint (26)', 'm/s', 5e-3, _checkpoint),
    Scene('at rest', 'bare steps', 1.0, _at_rest),
)


def error_of(scene: Scene) -> float:
    """Play a scene; return its error, which is no number where the engine gives up."""
    with suppress(ArithmeticError, np.linalg.LinAlgError):
        return scene.error()
    return math.nan


def fails(scene: Scene, error: float) -> bool:
    """Tell whether an error is beyond the tolerance of a scene."""
    return not error <= scene.tolerance
