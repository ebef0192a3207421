# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fast bodies take no more memory of the engine's broad phase than slow ones."""

from physsim_ros.engine.core import lib, sub_step_of
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pytest

from ...building import spawn

psutil = pytest.importorskip('psutil')

NOWHERE = WorldSettings(gravity=(0.0, 0.0))


@pytest.mark.cost
def test_a_crowd_of_fast_bodies_is_not_paired_with_all_of_itself():
    world = World(settings=NOWHERE)
    process = psutil.Process()
    before = process.memory_info().rss
    for number in range(4000):
        place = (float(number % 55), float(number // 55), 0.0)
        # 20 km/s in all directions; sensors have no continuous collision.
        velocity = (2e4 * (-1) ** number, 1e4 * (number % 7 - 3))
        spawn(world, f'body/{number}', Disc(radius=0.1), place, velocity=velocity, sensor=True)
    world.step(2)
    # Measured: 17 MB, and 101 MB without the stage.
    assert process.memory_info().rss - before < 50e6


def test_what_is_indexed_ahead_moves_to_the_bit_as_if_it_were_not():
    world = World(settings=NOWHERE)
    spawn(world, 'body/0', Disc(radius=0.1), (0.1, 0.2, 0.3), velocity=(1e3, 333.3), spin=7.7)
    world.step(1)
    state = world.save().bodies[0].motion
    pose = [0.1, 0.2, 0.3]
    for _ in range(lib.SUB_STEPS):
        way = (each * sub_step_of(world.physics_rate) for each in (1e3, 333.3, 7.7))
        pose = [at + by for at, by in zip(pose, way, strict=True)]
    assert state[:3] == tuple(pose)
