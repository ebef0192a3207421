# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hundreds of joints that hang together are held as exactly as two, and found out about once."""

import math

import numpy as np
from physsim_ros.model.joints import JointKind
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from ..building import G, join, MESH, net, spawn, swing


def stretched(world: World) -> float:
    """Return by how much the worst rod of a net is too long or too short [m]."""
    snapshot = world.snapshot()
    places = dict(zip(snapshot.scene.names, snapshot.poses[:, :2], strict=True))
    rods = [joint for joint in snapshot.scene.joints if joint.kind is JointKind.ROD]
    return max(abs(math.dist(places[rod.a], places[rod.b]) - MESH) for rod in rods)


@pytest.mark.parametrize('side', [5, 12])
def test_a_net_is_as_long_as_its_rods(side):
    world = net(side)
    for _ in range(10):
        world.step(12)
        assert stretched(world) < 2e-3


def test_a_heavy_ball_swings_on_a_light_chain():
    world = swing(link=0.5, ball=20.0, radius=0.1)
    start = world.snapshot()
    fall = 20.0 * G * 3.0 * (1.0 - math.cos(math.radians(45.0)))
    for _ in range(72):
        world.step(20)
        now = world.snapshot()
        gained = now.kinetic_energy + now.potential_energy
        gained -= start.kinetic_energy + start.potential_energy
        # J; ten iterations lose some energy at masses of 40 : 1, but gain none
        assert -0.1 * fall < gained < 0.03 * fall
        # Its links weigh something, so that it is bent a little as it turns back.
        assert math.hypot(*now.poses[-1, :2]) == pytest.approx(3.0, rel=0.05)  # law 20


def wheel(spokes: int) -> World:
    """Return a hub with so many bars welded to it, and as many that hang from these."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    spawn(world, 'hub/0', Disc(radius=1.0), mass=1000.0, spin=1.0, group=1)
    for ring, kind in enumerate(('pin', 'axle')):
        for number in range(spokes):
            angle = math.tau * number / spokes
            x, y = math.cos(angle), math.sin(angle)
            far = 1.5 + ring
            bar = Box(width=1.0, height=0.01)
            spawn(world, f'bar{ring}/{number}', bar, (far * x, far * y, angle), group=1)
            inner = f'bar{ring - 1}/{number}' if ring else 'hub/0'
            name, at = f'joint{ring}/{number}', ((far - 0.5) * x, (far - 0.5) * y)
            join(world, kind, [at], name, a=f'bar{ring}/{number}', b=inner)
    return world


def test_what_is_too_much_to_be_solved_at_once_is_held_part_by_part():
    # Three rows of each of 220 pins meet on the hub, and the bars beyond them hang together only
    # by what is in other parts.
    world = wheel(220)
    world.step(24)
    snapshot = world.snapshot()
    # It turns as one: the hub by itself would keep its spin of 1 rad/s.
    assert 0.0 < snapshot.twists[0, 2] < 1.0
    assert snapshot.momentum == pytest.approx((0.0, 0.0), abs=1e-6)
    inner = snapshot.poses[1:221, :2]
    assert np.hypot(*inner.T) == pytest.approx(np.full(220, 1.5), abs=0.02)


def test_a_machine_among_bodies_that_come_goes_on_as_one_that_knows_nothing():
    known, fresh = net(5), net(5)
    for world in (known, fresh):
        world.step(3)
    key = known.renew()
    known.step(5)
    known.resume(key)
    fresh.renew()
    for world in (known, fresh):
        world.step(20)
        spawn(world, 'stone/0', Disc(radius=0.1), (0.6, 0.0, 0.0))
        world.step(60)
    assert known.digest() == fresh.digest()


@pytest.mark.cost
def test_a_thousand_joints_of_one_body_are_linear_in_memory():
    # Its rows would fill a band of 2,000 by 2,000, from 4 million pairs.
    world = World()
    spawn(world, 'hub/0', Disc(radius=1.0), (0.0, 0.0, 0.0))
    for number in range(1000):
        at = (0.9 * math.cos(number), 0.9 * math.sin(number))
        join(world, 'axle', [at], f'axle/{number}', a='hub/0')

    process = pytest.importorskip('psutil').Process()
    before = process.memory_info().rss
    world.step(24)

    # The memory of a step stays with the world. All pairs of rows would be 290 MB.
    assert process.memory_info().rss - before < 120e6
    assert world.snapshot().poses[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
