# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The part of Nav2, played: what the nodes of nav2_bringup and slam_toolbox expect of a robot.

Nav2 has no wheels, so these tests do what its nodes do: subscribe with their QoS, and look
transforms up as a buffer of tf2 does. Each names the source that it plays; those of Nav2 are in
ros-navigation/navigation2, that of slam_toolbox in SteveMacenski/slam_toolbox. Frames are those of
`nav2_bringup/params/nav2_params.yaml`: map, odom, base_footprint (AMCL) and base_link (costmaps).
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any

from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from physsim_ros.testing import PhysSim
import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan

from .driver import yaw_of
from .test_frames import heard
from ..built_interfaces import import_built
from ...client import Client, KEPT, set_parameter, stamp_of

# rmw_qos_profile_sensor_data, rclcpp::SystemDefaultsQoS, and rclcpp::ClockQoS.
SENSOR_DATA = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
SYSTEM_DEFAULTS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
CLOCK = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
# Of `transform_tolerance` of costmaps, the least of those of nodes that look up the newest pose
# [ns], and of `source_timeout` of the collision monitor.
TOLERANCE, SOURCE_TIMEOUT = 300_000_000, 1_000_000_000


class Buffer:
    """Transforms as a buffer of tf2 has them: it interpolates, and never extrapolates."""

    def __init__(self, client: Client) -> None:
        self.moving = heard(client, '/tf')
        self.fixed = heard(client, '/tf_static', KEPT)

    def chain(self, target: str, source: str) -> list[str]:
        """Return the frames from a source up to its ancestor, the target; each has one parent."""
        parents: dict[str, set[str]] = {}
        for each in (*self.moving, *self.fixed):
            parents.setdefault(each.child_frame_id, set()).add(each.header.frame_id)
        frames = [source]
        while frames[-1] != target:
            (parent,) = parents[frames[-1]]
            frames.append(parent)
        return frames

    def can_transform(self, target: str, source: str, stamp: int | None = None) -> bool:
        """Return whether a lookup succeeds, at a stamp [ns] or at the latest common time."""
        frames = self.chain(target, source)[:-1]
        stamps = [
            [stamp_of(each) for each in self.moving if each.child_frame_id == frame]
            for frame in frames
            if frame not in {each.child_frame_id for each in self.fixed}
        ]
        return all(each and (stamp is None or each[0] <= stamp <= each[-1]) for each in stamps)

    @property
    def newest(self) -> int:
        return stamp_of(self.moving[-1])


@pytest.fixture
def burger(request: pytest.FixtureRequest, start: Callable[..., PhysSim]) -> PhysSim:
    """Give a test the shipped world of a robot with plain names, whose frame is the map."""
    import_built('tf2_msgs', request)
    physsim = start(frame_id='map', robots_in_past='freeze')
    physsim.load('burger')
    # Robots have their topics from the first frame on.
    physsim.step()
    return physsim


def test_every_scan_can_be_placed_as_amcl_and_costmaps_do(burger: PhysSim) -> None:
    client = Client(burger)
    buffer, scans = Buffer(client), client.listen(LaserScan, '/scan', SENSOR_DATA)
    burger.find_robot('burger/0').drive(0.15, 0.5)
    burger.run(3.0)
    assert len(scans) >= 14
    for scan in scans:
        frame, stamp = scan.header.frame_id, stamp_of(scan)
        # nav2_amcl/src/amcl_node.cpp: initMessageFilters and getOdomPose at the stamp of the scan,
        # addNewScanner and updateFilter from its frame to base_footprint.
        assert buffer.can_transform('odom', 'base_footprint', stamp)
        assert buffer.can_transform('base_footprint', frame, stamp)
        # nav2_costmap_2d/plugins/obstacle_layer.cpp: the message filter of an observation source.
        assert buffer.can_transform('odom', frame, stamp)
    # nav2_costmap_2d/src/costmap_2d_ros.cpp, on_activate: base_link in odom, at the latest time.
    assert buffer.can_transform('odom', 'base_link')
    assert buffer.chain('odom', 'base_link') == ['base_link', 'base_footprint', 'odom']


def test_nothing_is_from_the_future_or_older_than_nodes_tolerate(burger: PhysSim) -> None:
    client = Client(burger)
    buffer = Buffer(client)
    # rclcpp/src/rclcpp/time_source.cpp: best effort; the node itself has use_sim_time.
    clocks = client.listen(Clock, '/clock', CLOCK)
    scans = client.listen(LaserScan, '/scan', SENSOR_DATA)
    burger.run(1.0)
    for _ in range(60):
        burger.step()
        now = client.node.get_clock().now().nanoseconds
        assert now == stamp_of(clocks[-1])
        # nav2_util/src/robot_utils.cpp, getCurrentPose, with the tolerance of a costmap.
        assert now - TOLERANCE < buffer.newest <= now
        # nav2_collision_monitor/src/source.cpp: a source that is older than its timeout counts as
        # lost, and the robot is stopped.
        assert now - SOURCE_TIMEOUT < stamp_of(scans[-1]) <= now


def test_odometry_is_in_the_frames_and_of_the_times_of_tf(burger: PhysSim) -> None:
    client = Client(burger)
    buffer = Buffer(client)
    # nav2_util/src/odometry_utils.cpp, OdomSmoother: the twist is that of the robot itself.
    odometry = client.listen(Odometry, '/odom', SYSTEM_DEFAULTS)
    burger.find_robot('burger/0').drive(0.15, 0.5)
    burger.run(2.0)
    moving = {stamp_of(each): each.transform for each in buffer.moving}
    for odom in odometry:
        assert (odom.header.frame_id, odom.child_frame_id) == ('odom', 'base_footprint')
        pose, transform = odom.pose.pose, moving[stamp_of(odom)]
        assert (pose.position.x, pose.position.y) == (
            transform.translation.x,
            transform.translation.y,
        )
        assert pose.orientation == transform.rotation
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.15, abs=0.01)
    assert abs(odometry[-1].twist.twist.linear.y) < 1e-6


def test_the_map_is_there_for_who_comes_late_in_the_frame_of_amcl(burger: PhysSim) -> None:
    client = Client(burger)
    burger.run(1.0)
    # nav2_amcl/src/amcl_node.cpp, initPubSub, and nav2_costmap_2d/plugins/static_layer.cpp:
    # transient local, reliable. handleMapMessage: the frame of the map; convertMap: 0 is free, 100
    # is occupied.
    maps = client.listen(OccupancyGrid, '~/map', KEPT)
    burger.until(lambda: maps)
    # Kept for the next one, who needs no frame.
    later = client.listen(OccupancyGrid, '~/map', KEPT)
    client.spin_until(lambda: later)
    grid = later[-1]
    assert grid.header.frame_id == 'map'
    assert {0, 100} <= set(grid.data) <= {-1, 0, 100}
    info = grid.info
    # The robot is within the map: "Robot is out of bounds of the costmap" otherwise.
    x, y = burger.pose('burger/0')[:2]
    origin = info.origin.position
    assert origin.x < x < origin.x + info.width * info.resolution
    assert origin.y < y < origin.y + info.height * info.resolution


@pytest.mark.parametrize('robot', ['turtlebot3_burger', 'turtlebot4', 'omni', 'car', 'tractor'])
def test_slam_toolbox_counts_as_many_beams_as_there_are(flat: PhysSim, robot: str) -> None:
    scan = flat.robot(robot).scan()
    turn = scan.angle_max - scan.angle_min
    # src/laser_utils.cpp, LaserAssistant::makeLaser: whether the last beam is next to the first.
    is_360 = abs(turn - math.tau) < scan.angle_increment - 1.5e-6
    if turn > 6.10865 and round(turn / scan.angle_increment) + 1 == len(scan.ranges):
        is_360 = False
    # lib/karto_sdk/include/karto_sdk/Karto.h, LaserRangeFinder::Update; another number is refused
    # as "LaserRangeScan contains ... range readings, expected ...".
    assert round(turn / scan.angle_increment) + (not is_360) == len(scan.ranges)


def test_time_goes_on_stands_still_in_the_past_and_jumps_once_by_a_reset(burger: PhysSim) -> None:
    client = Client(burger)
    buffer, scans = Buffer(client), client.listen(LaserScan, '/scan', SENSOR_DATA)
    clocks = client.listen(Clock, '/clock', SYSTEM_DEFAULTS)
    burger.run(3.0)
    # `robots_in_past` is freeze: nobody sees the look back.
    burger.rewind(2.0)
    burger.run(1.0)
    burger.seek(3.0)
    burger.run(1.0)
    times = [stamp_of(each) for each in clocks]
    assert times == sorted(times)
    count, moved, looked = len(clocks), len(buffer.moving), len(scans)
    # tf2_ros/src/buffer.cpp, onTimeJump: the buffers of C++ are cleared by a jump back.
    client.call('~/reset')
    burger.run(2.0)
    times = [stamp_of(each) for each in clocks[count:]]
    assert times == sorted(times)
    assert times[0] < 100_000_000
    # Nothing of the time before comes after the jump.
    for each in (*buffer.moving[moved:], *scans[looked:]):
        assert stamp_of(each) <= times[-1]
    assert len(scans) - looked >= 9
    fresh = [each for each in buffer.moving[moved:] if stamp_of(each) > 0]
    stamps = [stamp_of(each) for each in fresh]
    assert stamps == sorted(stamps)


def test_a_navigator_reaches_its_goal_by_transforms_alone(burger: PhysSim) -> None:
    """A localiser and a controller of 20 Hz, with the frames and topics of Nav2's."""
    client = Client(burger)
    buffer = Buffer(client)
    publisher = client.node.create_publisher(Twist, '/cmd_vel', 1)
    set_parameter(burger, 'bounds', [])
    start, goal = burger.pose('burger/0'), (-0.5, 0.4)

    def pose() -> tuple[float, float, float]:
        # map to odom is where the robot was spawned: odometry begins at 0.
        transform: Any = buffer.moving[-1].transform
        x, y = transform.translation.x, transform.translation.y
        return start[0] + x, start[1] + y, yaw_of(transform.rotation)

    def is_there() -> bool:
        x, y, yaw = pose()
        away, aside = math.hypot(goal[0] - x, goal[1] - y), math.atan2(goal[1] - y, goal[0] - x)
        command = Twist()
        turn = math.remainder(aside - yaw, math.tau)
        command.linear.x = min(0.2, away) * max(0.0, math.cos(turn))
        command.angular.z = 2.0 * turn
        publisher.publish(command)
        burger.run(0.05)
        # xy_goal_tolerance of the goal checker.
        return away < 0.25

    burger.step()
    burger.until(is_there, timeout=15.0)
    x, y, _ = burger.pose('burger/0')
    assert math.hypot(goal[0] - x, goal[1] - y) < 0.3
