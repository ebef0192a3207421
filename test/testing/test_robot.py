# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A test drives a robot and reads its messages by a handle."""

from __future__ import annotations

from physsim_ros.model.requests import DriveRobot, Request
from physsim_ros.simulation.past import Past
from physsim_ros.testing import box, PhysSim, Refused, UnknownName
import pytest

from ..ros.robots.driver import driver_of


def test_a_test_steers_otherwise_after_a_rewind(flat: PhysSim) -> None:
    flat.spawn(box('wall/0', at=(1.0, 0.0), size=(0.2, 4.0), anchored=True))
    robot = flat.robot('turtlebot3_burger')
    robot.drive(0.2)
    assert flat.run(until=lambda: robot.bumped, timeout=10.0)
    flat.rewind(2.0)
    robot.drive(-0.2)
    assert not flat.run(until=lambda: robot.bumped, timeout=5.0)
    assert robot.truth().pose.pose.position.x < 0.5


def test_a_robot_that_is_not_there_has_no_readings(flat: PhysSim) -> None:
    flat.run(1.0)
    robot = flat.robot('turtlebot3_burger')
    flat.run(1.0)
    odometry = robot.odom()
    flat.seek(0.5)
    for read in (robot.odom, robot.truth, robot.scan):
        with pytest.raises(UnknownName, match='there is no robot'):
            read()
    flat.run(1.5)
    assert robot.odom() == odometry


def test_a_world_that_is_loaded_is_not_driven_by_the_robots_before_it(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    robot.drive(0.2)
    flat.run(0.5)
    flat.load('boxes')
    assert robot.name in flat.names
    flat.run(0.5)
    assert robot.truth().twist.twist.linear.x == 0.0


@pytest.fixture
def submitted(flat: PhysSim, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Give a test the times at which robots are driven on [s]."""
    times: list[float] = []
    apply = Past.apply_unasked

    def note(past: Past, request: Request) -> None:
        if isinstance(request, DriveRobot):
            times.append(flat.time)
        apply(past, request)

    monkeypatch.setattr(Past, 'apply_unasked', note)
    return times


@pytest.mark.parametrize('timeout', [0.0, 0.02, 0.5])
def test_a_drive_is_submitted_again_before_its_timeout(
    flat: PhysSim, submitted: list[float], timeout: float
) -> None:
    robot = flat.robot(
        {'from': 'turtlebot3_burger', 'drive': {'timeout': timeout}, 'odometry': {'slip': [0, 0]}},
    )
    robot.drive(0.2)
    speeds = []
    for _ in range(120):
        flat.step()
        speeds.append(robot.truth().twist.twist.linear.x)
    # It is there after 0.1 s, and no timeout is met.
    assert speeds[12:] == pytest.approx([0.2] * 108, rel=1e-6)
    assert len(submitted) == {0.0: 1, 0.02: 120, 0.5: 4}[timeout]
    robot.drive(0.0)
    flat.run(1.0)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.0, abs=1e-6)


def test_a_drive_counts_again_after_the_command_of_another_node(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    other = driver_of(flat)
    robot.drive(0.2)
    flat.run(0.5)
    other.send(-0.2)
    flat.step()
    assert flat.node.simulation.world.snapshot().robots['aim'][0, 0] == -0.2
    flat.step()
    assert flat.node.simulation.world.snapshot().robots['aim'][0, 0] == 0.2


def test_of_two_handles_of_a_robot_the_later_one_drives(
    flat: PhysSim, submitted: list[float]
) -> None:
    first = flat.robot('turtlebot3_burger')
    second = flat.find_robot(first.name)
    first.drive(0.2)
    second.drive(0.1)
    flat.run(0.4)
    assert len(submitted) == 1
    assert first.truth().twist.twist.linear.x == pytest.approx(0.1, rel=1e-6)


def test_a_robot_without_a_shipped_name_is_refused(flat: PhysSim) -> None:
    with pytest.raises(Refused, match='name a shipped robot') as caught:
        flat.robot({'drive': {'kind': 'omni'}})
    assert caught.value.field == 'from'


def test_a_robot_of_a_world_file_is_found_and_driven(flat: PhysSim) -> None:
    flat.load('boxes')
    robot = flat.find_robot('robot/0')
    start = robot.truth().pose.pose.position.x
    robot.drive(0.1)
    flat.run(1.0)
    assert robot.truth().pose.pose.position.x > start + 0.05
    with pytest.raises(UnknownName, match="nearest is 'robot/0'"):
        flat.find_robot('robt/0')
