# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time stands still but for the test, and other nodes live in it."""

from __future__ import annotations

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from physsim_ros.testing import box, command, delete, disc, PhysSim, Refused
import pytest
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import Marker

G = 9.81


def test_time_stands_still_but_for_the_test(physsim: PhysSim) -> None:
    physsim.spawn(disc(at=(0.0, 5.0)))
    physsim.settle()
    assert physsim.time == 0.0
    physsim.step()
    assert physsim.time == pytest.approx(1 / 60, abs=1e-9)
    physsim.step(3)
    assert physsim.time == pytest.approx(4 / 60, abs=1e-9)
    physsim.run(1.0)
    assert physsim.time == pytest.approx(64 / 60, abs=1e-9)
    # m
    fallen = G * (64 / 60) ** 2 / 2
    assert physsim.pose('body/0').y == pytest.approx(5.0 - fallen, abs=1e-9)


def test_a_request_of_another_node_is_applied_while_time_is_paused(physsim: PhysSim) -> None:
    node = Node('other', context=physsim.context)
    publisher = node.create_publisher(Marker, '/physsim/spawn', 10)
    physsim.add(node)
    physsim.wait_until(publisher.get_subscription_count)
    publisher.publish(disc('ball/0', at=(0.0, 5.0)))
    physsim.wait_until(lambda: 'ball/0' in physsim.names)
    assert physsim.pose('ball/0').y == 5.0
    assert physsim.time == 0.0
    node.destroy_node()


@pytest.mark.parametrize('seconds', [-1.0, 0.001, math.nan, math.inf, -math.inf, 1e308])
def test_time_that_cannot_pass_is_no_time(physsim: PhysSim, seconds: float) -> None:
    with pytest.raises(ValueError, match=r' s\b'):
        physsim.run(seconds)
    assert physsim.time == 0.0


def test_time_does_not_go_on_by_less_than_nothing(physsim: PhysSim) -> None:
    with pytest.raises(ValueError, match='seek'):
        physsim.step(-1)
    with pytest.raises(ValueError, match='finite'):
        physsim.until(lambda: False, timeout=math.inf)
    physsim.step(0)
    physsim.run(0.0)
    assert physsim.time == 0.0


def test_until_stops_at_the_first_frame_in_which_it_is_so(physsim: PhysSim) -> None:
    physsim.spawn(disc(at=(0.0, 5.0)))
    physsim.until(lambda: physsim.pose('body/0').y < 2.5)
    # s: where a fall of 2.5 m is over, and not a frame later
    exact = math.sqrt(2 * 2.5 / G)
    assert exact <= physsim.time < exact + 1 / 60
    before = physsim.digest()
    physsim.until(lambda: True)
    assert physsim.digest() == before


def test_until_gives_up_after_its_timeout(physsim: PhysSim) -> None:
    physsim.spawn(disc('ball/0', at=(3.0, 50.0)))
    with pytest.raises(TimeoutError, match=r'(?s)0\.5.*ball/0 +3\.000 '):
        physsim.until(lambda: False, timeout=0.5)
    assert physsim.time == pytest.approx(0.5)
    with pytest.raises(TimeoutError):
        physsim.until(lambda: False)
    # s: ten more
    assert physsim.time == pytest.approx(10.5)


def test_until_gives_up_on_what_is_so_only_for_an_instant_in_between(physsim: PhysSim) -> None:
    asked = []
    with pytest.raises(TimeoutError):
        physsim.until(lambda: asked.append(physsim.time), timeout=0.1)
    assert asked == pytest.approx([number / 60 for number in range(7)], abs=1e-9)


def test_a_world_is_loaded_by_name_or_path(
    physsim: PhysSim, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim.load('demo')
    assert 'ramp/0' in physsim.names
    path = tmp_path / 'elsewhere' / 'one.yaml'
    path.parent.mkdir()
    path.write_text('format: 1\nbodies: [{name: a/0, circle: {radius: 1}}]\n')
    physsim.load(path)
    assert physsim.names == ('a/0',)
    physsim.spawn(delete('a/0'))
    physsim.load(str(path))
    assert physsim.names == ('a/0',)
    physsim.spawn(delete('a/0'))
    # As everywhere in Python, a path counts from where the interpreter works.
    monkeypatch.chdir(path.parent)
    physsim.load('one.yaml')
    assert physsim.names == ('a/0',)
    with pytest.raises(Refused) as refused:
        physsim.load('nowhere')
    assert refused.value.code == 'bad_world_file'
    assert physsim.names == ('a/0',)


def test_two_runs_of_a_world_give_the_same_bits(start: Callable[..., PhysSim]) -> None:
    worlds = start(), start()
    for world in worlds:
        world.load('demo')
        world.run(2.0)
    assert worlds[0].digest() == worlds[1].digest()


class Watch(Node):
    """Notes what time it is."""

    def __init__(self, context: Any) -> None:
        super().__init__('watch', context=context)
        self.stamps: list[int] = []
        self.times: list[int] = []
        self.ticks: list[int] = []
        self.create_subscription(MultiDOFJointState, '/physsim/states', self._see, 10)
        self.create_timer(0.25, lambda: self.ticks.append(self.get_clock().now().nanoseconds))

    def _see(self, states: MultiDOFJointState) -> None:
        self.stamps.append(Time.from_msg(states.header.stamp).nanoseconds)
        self.times.append(self.get_clock().now().nanoseconds)


def test_a_nodes_time_is_the_worlds(physsim: PhysSim) -> None:
    watch = Watch(physsim.context)
    physsim.add(watch)
    watch.stamps.clear()
    watch.times.clear()
    physsim.run(2.0)
    assert len(watch.stamps) == 120
    assert watch.times == watch.stamps
    # s: its timer goes by it too, from the first time that it heard of
    assert len(watch.ticks) in (7, 8)
    ticks = [tick * 1e-9 for tick in watch.ticks]
    assert [round(tick / 0.25) for tick in ticks] == list(range(1, len(ticks) + 1))


def test_what_a_frame_makes_a_node_ask_is_done_in_the_next(physsim: PhysSim) -> None:
    class Follower(Node):
        """Puts one body beside another."""

        def __init__(self) -> None:
            super().__init__('follower', context=physsim.context)
            self.publisher = self.create_publisher(MultiDOFJointState, '/physsim/command', 10)
            self.create_subscription(MultiDOFJointState, '/physsim/states', self.see, 10)

        def see(self, states: MultiDOFJointState) -> None:
            place = states.transforms[0].translation
            message = command('held/0', poses=[(place.x + 2.0, place.y, 0.0)])
            self.publisher.publish(message)

    physsim.spawn(disc('a/0'))
    physsim.spawn(box('held/0', at=(2.0, 0.0), text='{anchored: true}'))
    physsim.add(Follower())
    heights = []
    for _ in range(20):
        physsim.step()
        heights.append(physsim.pose('a/0').y)
        if len(heights) > 1:
            assert physsim.pose('held/0').y == heights[-2]


def test_a_publisher_of_the_tests_own_is_heard_before_the_next_frame(physsim: PhysSim) -> None:
    node = Node('own', context=physsim.context)
    publisher = node.create_publisher(MultiDOFJointState, '/physsim/command', 10)
    physsim.add(node)
    physsim.spawn(box('a/0'))
    for number in range(20):
        publisher.publish(command('a/0', poses=[(float(number), 0.0, 0.0)]))
        physsim.step()
        assert physsim.pose('a/0').x == number


class Echo(Node):
    """Answers every message with another, for ever."""

    def __init__(self, context: Any, name: str, hears: str, says: str) -> None:
        super().__init__(name, context=context)
        self.publisher = self.create_publisher(Float64, says, 10)
        self.create_subscription(Float64, hears, self.publisher.publish, 10)


def test_nodes_that_answer_each_other_for_ever_are_found_out(physsim: PhysSim) -> None:
    one = Echo(physsim.context, 'one', 'ping', 'pong')
    physsim.add(one)
    physsim.add(Echo(physsim.context, 'other', 'pong', 'ping'))
    one.publisher.publish(Float64())
    with pytest.raises(TimeoutError, match='keep answering'):
        physsim.step()
