# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The forces of joints as vectors: with weight they are what changes the momentum of a body."""

import math

import numpy as np
from physsim_ros.model.joints import JointKind
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from .jointed import KINDS, PROPERTIES
from ..building import BOX, join, spawn

GRAVITY = np.array([3.0, -9.81])


def loaded(kind: JointKind) -> World:
    """Return a world in which a box hangs on an anchored one."""
    world = World(settings=WorldSettings(gravity=(3.0, -9.81)))
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.3), anchored=True)
    spawn(world, 'a/1', BOX, (1.6, 0.2, -0.2))
    points = [(0.4, 0.0), (1.4, 0.0)][: kind.points]
    join(world, kind, points, a='a/0', b='a/1', **PROPERTIES.get(kind, {}))
    world.reports_contacts = True
    return world


@pytest.mark.parametrize('kind', KINDS)
def test_weight_and_joint_are_what_changes_the_momentum(kind):
    world = loaded(kind)
    (joint,) = world.snapshot().scene.joints
    sign = 1.0 if joint.b == 'a/1' else -1.0
    mass = world.snapshot().scene.inertia[1, 0]
    world.step(120)
    for _ in range(240):
        before = world.snapshot().twists[1, :2]
        world.step(1)
        after = world.snapshot()
        changed = mass * (after.twists[1, :2] - before) / world.dt
        expected = mass * GRAVITY + sign * after.pulls[0]
        # The true velocity of a body that begins to fall freely, or ends to, is half a step of
        # gravity away from that of the engine.
        slack = mass * math.hypot(*GRAVITY) if kind in (JointKind.GEAR, JointKind.ROPE) else 0.0
        # The direction of a rod is that after its gap was closed: a micrometre in a metre.
        assert changed == pytest.approx(expected, abs=0.5 * slack + 1e-4)


def test_joints_have_no_vectors_where_nobody_watches():
    world = loaded(JointKind.ROD)
    world.reports_contacts = False
    world.step(4)
    assert world.snapshot().pulls.shape == (0, 2)
    assert world.snapshot().forces.shape == (1,)


@pytest.mark.parametrize('kind', [JointKind.ROPE, JointKind.ROD, JointKind.PIN, JointKind.AXLE])
def test_the_first_force_of_a_joint_is_the_weight(kind):
    world = World(settings=WorldSettings())
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.0), mass=1.0)
    points = [(0.0, 0.0), (0.0, 1.0)][: kind.points]
    join(world, kind, points, a='a/0', b='world')
    for _ in range(3):
        world.step(1)
        assert world.snapshot().forces == pytest.approx([9.81], abs=1e-6)


def test_the_first_force_of_an_axle_beside_a_bar_is_a_quarter_of_its_weight():
    world = World(settings=WorldSettings())
    spawn(world, 'a/0', Box(width=1.0, height=1e-3), (0.5, 0.0, 0.0), mass=1.0)
    join(world, JointKind.AXLE, [(0.0, 0.0)], a='a/0', b='world')
    world.step(1)
    # While it turns by 1e-4 rad.
    assert world.snapshot().forces == pytest.approx([9.81 / 4], rel=1e-3)


@pytest.mark.parametrize('shape', [Disc(radius=0.5), BOX])
def test_the_first_force_of_a_contact_is_the_weight(shape):
    world = World(settings=WorldSettings(bounds=(-9.0, 0.0, 9.0, 9.0)))
    spawn(world, 'a/0', shape, (0.0, 0.5, 0.0), mass=1.0)
    world.reports_contacts = True
    world.step(1)
    (pressed,) = np.abs(world.contacts(world.snapshot()).impulses[:, 1]) / world.dt
    # A box also takes back what it turned by rounding.
    assert pressed == pytest.approx(9.81, rel=0.01)
