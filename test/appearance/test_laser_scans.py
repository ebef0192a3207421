# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scans for page and Rerun: only of what is shown, at the rate of the laser, within a budget."""

import numpy as np
from physsim_ros.appearance import laser_scans, LaserScans
from physsim_ros.files import state_from
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.simulation import Simulation
import pytest

BURGER = 'turtlebot3_burger'
WALL = {'name': 'wall/0', 'box': {'width': 0.2, 'height': 9}, 'at': [2.1, 0], 'anchored': True}
BODIES = [
    WALL,
    {'name': 'tb3/0', 'robot': BURGER, 'at': [0, 0]},
    {'name': 'tb3/1', 'robot': BURGER, 'at': [0, 3]},
    {'name': 'tb3/2', 'robot': {'from': BURGER, 'sensors': []}, 'at': [0, -3]},
]
NAMES = {'tb3/0', 'tb3/1', 'tb3/2', 'wall/0', 'nobody'}


@pytest.fixture
def world():
    """Give a test a world with robots."""
    simulation = Simulation(settings=WorldSettings())
    content = {'format': 1, 'gravity': [0, 0], 'bodies': BODIES}
    simulation.load(state_from(content, simulation.settings, simulation.physics_rate))
    return simulation.world


def test_only_robots_with_a_laser_have_a_scan(world):
    scans = LaserScans()
    scans.read(world.snapshot(), NAMES)
    assert [name for name in sorted(NAMES) if scans.points(name) is not None] == ['tb3/0', 'tb3/1']
    scans.read(world.snapshot(), {'tb3/1'})
    assert scans.points('tb3/0') is None
    scans.read(world.snapshot(), set())
    assert scans.points('tb3/1') is None


def test_the_oldest_scan_is_the_next_where_there_is_no_time_for_all(world, monkeypatch):
    monkeypatch.setattr(laser_scans, 'BUDGET', 1)
    scans, read = LaserScans(), []
    for _ in range(4):
        before = {name: scans.points(name) for name in ('tb3/0', 'tb3/1')}
        scans.read(world.snapshot(), NAMES)
        read += [name for name, points in before.items() if scans.points(name) is not points]
        # A second is longer than the period of both.
        world.step(240)
    assert sorted(read[:2]) == ['tb3/0', 'tb3/1']
    assert read[2:] == read[:2]


def test_a_scan_stays_until_the_laser_reads_again(world):
    scans = LaserScans()
    changes = 0
    before = None
    for _ in range(240):
        scans.read(world.snapshot(), {'tb3/0'})
        points = scans.points('tb3/0')
        changes += points is not before
        before = points
        world.step(1)
    # 5 Hz, and the first one.
    assert 5 <= changes <= 6
    assert np.isfinite(before).all()
