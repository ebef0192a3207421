# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Latency of sensors and odometry: messages arrive later than their stamps, and repeatably."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from nav_msgs.msg import Odometry
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.testing import box, PhysSim
import pytest
from rclpy.time import Time
from sensor_msgs.msg import LaserScan

LASER = {'kind': 'laser', 'beams': 3, 'rate': 20.0}


class Listener(NodeWithoutQosEvents):
    """Notes the messages of a topic with the simulation times at which they came [s]."""

    def __init__(self, physsim: PhysSim, kind: type, topic: str) -> None:
        super().__init__(topic.strip('/').replace('/', '_'), context=physsim.context)
        self.heard: list[tuple[float, float]] = []
        self.messages: list[Any] = []
        self._physsim = physsim
        self.create_subscription(kind, topic, self._hear, 100)
        physsim.add(self)

    def _hear(self, message: Any) -> None:
        stamp = Time.from_msg(message.header.stamp).nanoseconds * 1e-9
        self.heard.append((stamp, self._physsim.time))
        self.messages.append(message)

    def take(self) -> list[tuple[float, float]]:
        """Return stamp and time of arrival of each message since the last call [s]."""
        heard, self.heard = self.heard, []
        return heard


@pytest.fixture
def late(flat: PhysSim) -> Listener:
    """Return a listener to a robot whose scans have a latency of 0.1 to 0.3 s."""
    flat.spawn(box('wall/0', at=(2.0, 0.0), size=(0.2, 4.0), anchored=True))
    flat.robot({'from': 'turtlebot3_burger', 'sensors': [{**LASER, 'latency': [0.1, 0.3]}]})
    return Listener(flat, LaserScan, '/robot_0/scan')


def test_scans_arrive_after_their_latency_with_the_stamp_of_their_measurement(
    flat: PhysSim, late: Listener
) -> None:
    flat.run(3.0)
    heard = late.take()
    delays = [arrival - stamp for stamp, arrival in heard]
    # To a publish period, and a scan that waits for one before it.
    assert min(delays) >= 0.1 - 1e-6
    assert max(delays) <= 0.3 + 2 / 60
    assert max(delays) - min(delays) > 0.1
    assert all(b[0] > a[0] for a, b in pairwise(heard))
    assert len(heard) == pytest.approx(3.0 * 20 - 0.2 * 20, abs=3)


def test_a_rewind_repeats_when_scans_arrive(flat: PhysSim, late: Listener) -> None:
    flat.run(3.0)
    first = late.take()
    flat.rewind(1.5)
    late.take()
    flat.run(1.5)
    assert late.take() == [each for each in first if each[1] > 1.5]


def test_a_reading_is_that_of_its_stamp(flat: PhysSim) -> None:
    robot = flat.robot(
        {
            'from': 'turtlebot3_burger',
            'odometry': {'latency': 0.2, 'rate': 60, 'slip': [0, 0]},
        }
    )
    late, prompt = (
        Listener(flat, Odometry, f'/robot_0/{topic}') for topic in ('odom', 'ground_truth')
    )
    robot.drive(0.3)
    flat.run(1.0)
    places = {
        stamp: message.pose.pose.position.x
        for (stamp, _), message in zip(prompt.heard, prompt.messages, strict=True)
    }
    assert len(late.heard) > 40
    for (stamp, arrival), message in zip(late.heard, late.messages, strict=True):
        assert arrival - stamp == pytest.approx(0.2, abs=1 / 60)
        assert message.pose.pose.position.x == pytest.approx(places[stamp], abs=1e-9)
