# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the node for the lasers of all robots."""

from __future__ import annotations

import math

from physsim_ros.testing import box, PhysSim
import pytest
from sensor_msgs.msg import LaserScan

from ...client import Client, set_parameter


def test_parameters_set_beams_and_angles_of_a_shipped_robots_laser(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    flat.spawn(box('wall/0', at=(1.0, 0.0), size=(0.1, 4.0), anchored=True))
    scans = client.listen(LaserScan, '/robot_0/scan')

    def next_scan() -> LaserScan:
        scans.clear()
        flat.until(lambda: scans)
        return scans[-1]

    own = next_scan()
    assert (len(own.ranges), own.angle_min) == (360, 0.0)
    set_parameter(flat, 'laser_beams', 181)
    set_parameter(flat, 'laser_angle', [-math.pi / 2, math.pi / 2])
    scan = next_scan()
    assert len(scan.ranges) == 181
    assert (scan.angle_min, scan.angle_max) == pytest.approx((-math.pi / 2, math.pi / 2))
    # The middle beam is ahead, where the wall is; each has a noise of 1 cm.
    assert scan.ranges[90] == pytest.approx(own.ranges[0], abs=0.06)
    set_parameter(flat, 'laser_beams', 0)
    set_parameter(flat, 'laser_angle', [])
    again = next_scan()
    assert (len(again.ranges), again.angle_min) == (360, 0.0)


def test_more_beams_than_a_narrow_laser_has_room_for_are_refused_and_it_keeps_its_own(
    flat: PhysSim, client: Client
) -> None:
    narrow = {'kind': 'laser', 'beams': 3, 'angle': [0.0, 0.001]}
    flat.robot({'from': 'turtlebot3_burger', 'sensors': [narrow]})
    scans = client.listen(LaserScan, '/robot_0/scan')
    set_parameter(flat, 'laser_beams', 10_000)
    flat.until(lambda: scans)
    assert len(scans[-1].ranges) == 3
    (event,) = client.refusals
    assert (event.code, event.name) == ('bad_property', '/robot_0/scan')
