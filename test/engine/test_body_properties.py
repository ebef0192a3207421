# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Kinematic bodies, sensors and groups in the engine."""

from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import Anchor
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, command, DISC, ELL, G, pose, ROUNDING_OF_SUMS, spawn, twist

YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


# Kinematic bodies


def test_a_kinematic_body_pushes_and_is_not_pushed():
    world = World(settings=YARD)
    spawn(world, 'robot/0', BOX, (-3.0, 0.5, 0.0), kinematic=True, velocity=(1.0, 0.0))
    spawn(world, 'crate/0', BOX, (0.0, 0.5, 0.0), mass=1000.0)

    world.step(960)

    # Neither the crate nor gravity has held it up, not by a last bit more than the sums.
    assert pose(world, 'robot/0') == pytest.approx((1.0, 0.5, 0.0), abs=ROUNDING_OF_SUMS)
    assert twist(world, 'robot/0').tolist() == [1.0, 0.0, 0.0]
    assert pose(world, 'crate/0')[0] >= 2.0 - 0.006


def test_a_kinematic_body_passes_what_is_anchored(world):
    spawn(world, 'wall/0', Box(width=0.5, height=9.0), anchored=True)
    spawn(world, 'robot/0', BOX, (-2.0, 0.0, 0.0), kinematic=True, velocity=(1.0, 0.0), spin=0.5)

    world.step(960)

    assert pose(world, 'robot/0') == pytest.approx((2.0, 0.0, 2.0), abs=ROUNDING_OF_SUMS)


def test_a_kinematic_body_takes_pose_and_twist_and_no_wrench(world):
    spawn(world, 'robot/0', ELL, kinematic=True)

    command(world, 'robot/0', pose=(1.0, 2.0, 0.3), twist=(0.0, 1.0, 0.0))
    assert pose(world, 'robot/0') == pytest.approx((1.0, 2.0, 0.3), abs=1e-12)
    world.step(240)
    assert pose(world, 'robot/0') == pytest.approx((1.0, 3.0, 0.3), abs=ROUNDING_OF_SUMS)
    with pytest.raises(BadProperty):
        command(world, 'robot/0', wrench=(1.0, 0.0, 0.0))


def test_a_kinematic_body_can_be_anchored_and_let_go_as_it_was(world):
    spawn(world, 'robot/0', BOX, kinematic=True, velocity=(1.0, 0.0))

    world.apply(Anchor(point=(0.0, 0.0)))
    world.step(24)
    assert pose(world, 'robot/0').tolist() == [0.0, 0.0, 0.0]
    spawn(world, 'robot/0', BOX, anchored=False, velocity=(1.0, 0.0))
    spawn(world, 'ball/0', DISC, (3.0, 0.0, 0.0), mass=1e6, velocity=(-1.0, 0.0))
    world.step(240)

    assert pose(world, 'robot/0') == pytest.approx((1.0, 0.0, 0.0), abs=ROUNDING_OF_SUMS)


# Sensors and groups


def test_a_sensor_reports_what_it_overlaps_and_pushes_nothing(world):
    spawn(world, 'gate/0', Box(width=1.0, height=4.0), (2.0, 0.0, 0.0), sensor=True, anchored=True)
    spawn(world, 'a/0', DISC, velocity=(5.0, 1.0))
    world.reports_contacts = True

    seen = []
    for _ in range(120):
        world.step(1)
        contacts = world.contacts(world.snapshot())
        seen.append(contacts.pairs.tolist())
        assert not contacts.impulses.any()

    assert pose(world, 'a/0') == pytest.approx((2.5, 0.5, 0.0), abs=ROUNDING_OF_SUMS)
    touching = [step for step, pairs in enumerate(seen, 1) if pairs]
    # From x = 1, where the rim meets the gate, to the end at 2.5.
    assert touching == list(range(touching[0], 121))
    assert touching[0] == pytest.approx(1.0 / 5.0 * 240, abs=2)
    begun = touching[0]
    assert all(pairs == [[0, 1]] for pairs in seen[begun:])


def test_a_loose_sensor_falls_through_everything():
    world = World(settings=YARD)
    spawn(world, 'floor/0', BOX, (0.0, 5.0, 0.0), anchored=True)
    spawn(world, 'ghost/0', DISC, (0.0, 8.0, 0.0), sensor=True)

    world.step(240)

    assert pose(world, 'ghost/0') == pytest.approx((0.0, 8.0 - G / 2, 0.0), abs=ROUNDING_OF_SUMS)


@pytest.mark.parametrize(
    ('groups', 'through'),
    [((0, 0), False), ((1, 1), True), ((1, 2), False), ((1, 0), False), ((-1, -1), True),
     ((-1, 1), False), ((-1, 2**31 - 1), False), ((-(2**31), 2**31 - 1), False),
     ((-(2**31), 0), False)],
)  # fmt: skip
@pytest.mark.parametrize('speed', [2.0, 200.0], ids=['slow', 'fast'])
def test_bodies_of_one_group_pass_through_each_other(groups, through, speed, world):
    spawn(world, 'a/0', DISC, (-2.0, 0.0, 0.0), velocity=(speed, 0.0), group=groups[0])
    spawn(world, 'a/1', DISC, (2.0, 0.0, 0.0), velocity=(-speed, 0.0), group=groups[1])

    world.step(round(4.0 / speed * 240))

    left, right = world.snapshot().poses[:, 0]
    assert bool(left > right) is through


def test_a_group_is_kept_where_the_body_is_changed(world):
    for number in range(2):
        spawn(world, f'a/{number}', DISC, (-1.0 + 2.0 * number, 0.0, 0.0), group=-5)

    spawn(world, 'a/0', BOX, (-1.0, 0.0, 0.0), velocity=(3.0, 0.0))
    world.step(240)

    assert twist(world, 'a/0').tolist() == [3.0, 0.0, 0.0]
