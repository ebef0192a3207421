# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scans of robots in the recording: where beams hit, at the rate of the lasers."""

from __future__ import annotations

import numpy as np
from physsim_ros.files import state_from
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation
import pytest

POSITIONS = 'Points3D:positions'
WALL = {'name': 'wall/0', 'box': {'width': 0.2, 'height': 9}, 'at': [2.1, 0], 'anchored': True}


def frames_of(*bodies, count=60):
    """Return the frames of a second of a world that is seen from above."""
    simulation = Simulation(settings=WorldSettings())
    content = {'format': 1, 'gravity': [0, 0], 'bodies': [*bodies]}
    simulation.load(state_from(content, simulation.settings, simulation.physics_rate))
    frames = []
    for _ in range(count):
        frames.append(Frame(snapshot=simulation.world.snapshot(), contacts=None))
        simulation.world.step(4)
    return frames


def test_beams_that_hit_are_points_where_they_hit_at_the_rate_of_the_laser(recording):
    robot = {'name': 'tb3/0', 'robot': 'turtlebot3_burger', 'at': [0, 0]}

    recording.draw(*frames_of(WALL, robot))

    rows = recording.rows('world/scans', POSITIONS)
    # 5 Hz, and the first frame.
    assert 5 <= len(rows) <= 6
    assert rows[0].frame == 0
    # The wall is in reach from 2 m away on: some 110 of 360 beams, with noise of 1 cm.
    assert 90 < len(rows[0].value) < 130
    assert rows[0].value[:, 0] == pytest.approx(np.full(len(rows[0].value), 2.0), abs=0.1)


def test_scans_go_with_the_last_robot(recording):
    robot = {'name': 'tb3/0', 'robot': 'turtlebot3_burger', 'at': [0, 0]}

    recording.draw(*frames_of(WALL, robot, count=2))
    recording.draw(*frames_of(WALL, count=2))

    first, last = recording.rows('world/scans', POSITIONS)
    assert len(first.value)
    assert not len(last.value)


def test_a_world_without_robots_has_no_scans(recording):
    recording.draw(*frames_of(WALL, count=2))

    assert recording.rows('world/scans', POSITIONS) == []
