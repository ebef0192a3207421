# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots in the recording: where beams hit, at the rate of the lasers; ways, and odometry."""

from __future__ import annotations

import numpy as np
from physsim_ros.files import state_from
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation
import pytest

POSITIONS, STRIPS = 'Points3D:positions', 'LineStrips3D:strips'
WALL = {'name': 'wall/0', 'box': {'width': 0.2, 'height': 9}, 'at': [2.1, 0], 'anchored': True}
ROBOT = {'name': 'tb3/0', 'robot': 'turtlebot3_burger', 'at': [0, 0]}


def frames_of(*bodies, count=60, skipped=0, velocity=None):
    """Return the frames of a second of a world that is seen from above."""
    simulation = Simulation(settings=WorldSettings())
    content = {'format': 1, 'gravity': [0, 0], 'bodies': [*bodies]}
    simulation.load(state_from(content, simulation.settings, simulation.physics_rate))
    for body in bodies if velocity else ():
        simulation.perform(DriveRobot(name=body['name'], velocity=velocity))
    simulation.world.step(4 * skipped)
    frames = []
    for _ in range(count):
        frames.append(Frame(snapshot=simulation.world.snapshot(), contacts=None))
        simulation.world.step(4)
    return frames


def test_beams_that_hit_are_points_where_they_hit_at_the_rate_of_the_laser(recording):
    recording.draw(*frames_of(WALL, ROBOT))

    rows = recording.rows('world/scans', POSITIONS)
    # 5 Hz, and the first frame.
    assert 5 <= len(rows) <= 6
    assert rows[0].frame == 0
    # The wall is in reach from 2 m away on: some 110 of 360 beams, with noise of 1 cm.
    assert 90 < len(rows[0].value) < 130
    assert rows[0].value[:, 0] == pytest.approx(np.full(len(rows[0].value), 2.0), abs=0.1)


def test_scans_go_with_the_last_robot(recording):
    recording.draw(*frames_of(WALL, ROBOT, count=2))
    recording.draw(*frames_of(WALL, count=2))

    first, last = recording.rows('world/scans', POSITIONS)
    assert len(first.value)
    assert not len(last.value)


def test_a_world_without_robots_has_no_scans(recording):
    recording.draw(*frames_of(WALL, count=2))

    assert recording.rows('world/scans', POSITIONS) == []


@pytest.mark.parametrize('skipped', [0, 30])
def test_odometry_without_slip_is_the_way_and_with_slip_it_parts_from_it(recording, skipped):
    robots = [
        {
            'name': f'{name}/0',
            'at': [1, y, 0.5],
            'robot': {'from': 'turtlebot3_burger', 'odometry': {'slip': [slip, slip]}},
        }
        for y, name, slip in ((0, 'exact', 0), (2, 'slips', 0.2))
    ]
    frames = frames_of(*robots, count=25, skipped=skipped, velocity=(0.2, 0.0, 0.5))

    recording.draw(*frames)

    truth, odometry = (
        recording.rows(f'world/ways/{which}', STRIPS) for which in ('truth', 'odometry')
    )
    assert [row.frame for row in truth] == [0, 6, 12, 18, 24]
    places = np.array([row.value for row in truth])[:, :, 1, :2]
    poses = np.array([frame.snapshot.poses[:, :2] for frame in frames[::6]])
    assert places == pytest.approx(poses, abs=1e-6)
    reckoned = np.array([row.value for row in odometry])[:, :, 1, :2]
    # Both begin where the robot is as it is first seen.
    off = np.linalg.norm(reckoned - places, axis=2)
    assert off[0] == pytest.approx(0.0, abs=1e-6)
    assert off[:, 0] == pytest.approx(0.0, abs=1e-5)
    assert off[-1, 1] > 1e-4
