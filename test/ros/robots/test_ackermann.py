# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands of cars as messages of ackermann_msgs, which are built for the test."""

from __future__ import annotations

from collections.abc import Callable
import math

from physsim_ros.testing import PhysSim
import pytest

from ..built_interfaces import import_built
from ...client import Client


@pytest.fixture
def flat(request: pytest.FixtureRequest, start: Callable[..., PhysSim]) -> PhysSim:
    """Give a test a world that is seen from above."""
    import_built('ackermann_msgs', request)
    return start(gravity=[0.0, 0.0], floor_friction=0.5)


def commanded(flat: PhysSim, speed: float, angle: float) -> Client:
    """Send a command, and return the client that has sent it."""
    from ackermann_msgs.msg import AckermannDriveStamped  # noqa: PLC0415 - built for the test

    client, message = Client(flat), AckermannDriveStamped()
    publisher = client.node.create_publisher(AckermannDriveStamped, '/robot_0/cmd_vel', 10)
    message.drive.speed, message.drive.steering_angle = speed, angle
    flat.run(0.5)
    publisher.publish(message)
    flat.settle()
    return client


@pytest.mark.parametrize(
    ('speed', 'angle', 'wheels'),
    [(0.5, 0.3, 0.3), (0.5, -0.3, -0.3), (-0.4, 0.2, 0.2), (0.5, 1.5, 0.6), (0.0, 0.3, 0.0)],
)
def test_a_car_drives_the_circle_of_its_steering_angle(
    flat: PhysSim, speed: float, angle: float, wheels: float
) -> None:
    drive = {'kind': 'car', 'wheelbase': 0.25, 'steering': 0.6, 'max_speed': 1.0, 'max_turn': 9.0}
    robot = flat.robot({'from': 'car', 'drive': {**drive, 'timeout': 0}})
    commanded(flat, speed, angle)
    flat.run(1.0)
    twist = robot.truth().twist.twist
    assert twist.linear.x == pytest.approx(speed, abs=1e-6)
    assert twist.angular.z == pytest.approx(speed * math.tan(wheels) / 0.25, abs=1e-6)


def test_what_is_not_finite_is_refused(flat: PhysSim) -> None:
    flat.robot('car')
    client = commanded(flat, 0.5, math.nan)
    flat.run(0.5)
    assert [event.code for event in client.refusals] == ['malformed']


def test_no_other_drive_hears_them(flat: PhysSim) -> None:
    flat.robot('turtlebot3_burger')
    client = commanded(flat, 0.5, 0.0)
    (event,) = client.refusals
    assert (event.code, event.field) == ('bad_property', 'cmd_vel')
    assert 'Twist or TwistStamped is heard' in event.message
