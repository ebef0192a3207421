# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Ways of robots in the recording: truth, and odometry in the world."""

from __future__ import annotations

import numpy as np
from physsim_ros.files import state_from
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation
import pytest

STRIPS = 'LineStrips3D:strips'


@pytest.mark.parametrize('skipped', [0, 30])
def test_odometry_without_slip_is_the_way_and_with_slip_it_parts_from_it(recording, skipped):
    simulation = Simulation(settings=WorldSettings())
    robots = [
        {'name': f'{name}/0', 'at': [1, y, 0.5], 'robot': {'from': 'turtlebot3_burger', **more}}
        for y, name, more in ((0, 'exact', {}), (2, 'slips', {'odometry': {'slip': [0.2, 0.2]}}))
    ]
    robots[0]['robot']['odometry'] = {'slip': [0, 0]}
    content = {'format': 1, 'gravity': [0, 0], 'bodies': robots}
    simulation.load(state_from(content, simulation.settings, simulation.physics_rate))
    for robot in robots:
        simulation.perform(DriveRobot(name=robot['name'], velocity=(0.2, 0.0, 0.5)))
    simulation.world.step(4 * skipped)
    frames = []
    for _ in range(25):
        frames.append(Frame(snapshot=simulation.world.snapshot(), contacts=None))
        simulation.world.step(4)

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
