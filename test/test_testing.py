# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The pytest plugin, as other people's tests use it: their own node, no waiting, the same bits."""

from __future__ import annotations

from importlib.metadata import entry_points
import json
import math
import os
from pathlib import Path
import re
import subprocess
import sys
from typing import Any

from physsim_ros.testing import own_context, PhysSim, Refused, UnknownName
import pytest
from rclpy.node import Node
from rclpy.time import Time
from rerun import chunk
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import MarkerArray

from .client import Client
from .messages import box, command, delete, disc, point

pytest_plugins = ['pytester']

G = 9.81
ROBOT = """
import pytest
from geometry_msgs.msg import Wrench
from physsim_ros.testing import Refused
from rclpy.node import Node
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker


class Robot(Node):
    'Sees where its box is, and pushes it to x = 3.'

    def __init__(self, context):
        super().__init__('robot', context=context)
        self.publisher = self.create_publisher(MultiDOFJointState, '/physsim/command', 10)
        self.create_subscription(MultiDOFJointState, '/physsim/states', self.see, 10)
        self.create_timer(0.1, self.tick)
        self.seen = self.ticks = 0

    def see(self, states):
        self.seen += 1
        index = list(states.joint_names).index('box/0')
        x = states.transforms[index].translation.x
        v = states.twist[index].linear.x
        message = MultiDOFJointState(joint_names=['box/0'], wrench=[Wrench()])
        message.wrench[0].force.x = 40.0 * (3.0 - x) - 12.0 * v
        self.publisher.publish(message)

    def tick(self):
        self.ticks += 1


def box(namespace, x, y, width=1.0, text=''):
    marker = Marker(ns=namespace, type=Marker.CUBE, text=text)
    marker.pose.position.x, marker.pose.position.y = x, y
    marker.scale.x, marker.scale.y = width, 1.0
    return marker


def test_robot_pushes_the_box(physsim):
    physsim.spawn(box('floor', 0.0, -0.5, 50.0, '{anchored: true, friction: 0.1}'))
    physsim.spawn(box('box', 0.0, 0.5))
    physsim.spawn(box('other', 1.5, 0.5))
    robot = Robot(context=physsim.context)
    physsim.add(robot)
    physsim.until(lambda: physsim.pose('box/0').x > 2.0, timeout=30.0)
    physsim.run(1.0)
    assert robot.seen >= 60
    assert robot.ticks >= 9
    assert physsim.pose('other/0').x > 2.9
    print('DIGEST', physsim.digest(), robot.seen, robot.ticks)


def test_another_world_is_empty(physsim):
    assert physsim.names == ()
    with pytest.raises(Refused) as caught:
        physsim.anchor((0.0, 0.0))
    assert caught.value.code == 'nothing_there'
"""
# Says what is imported where nobody asks for a world.
WITHOUT = """
import sys


def test_nothing_of_ros_is_imported():
    heads = {name.partition('.')[0] for name in sys.modules}
    assert 'physsim_ros.testing' in sys.modules
    ros = {each for each in heads if each.startswith(('rclpy', 'rosidl', 'rpyutils', 'ament'))}
    messages = {each for each in heads if each.endswith(('_msgs', '_interfaces', '_srvs'))}
    assert ros | messages | (heads & {'pymunk', 'numpy', 'rerun', 'yaml'}) == set()
    assert {each for each in sys.modules if each.startswith('physsim_ros.')} == {
        'physsim_ros.testing'
    }
"""


def run_pytest(directory: Path, *words: str, **environment: str) -> str:
    """Run the tests of somebody else's project, and return what was printed."""
    # Where the package is installed the plugin comes by itself, as for everybody.
    found = entry_points(group='pytest11', name='physsim')
    plugin = [] if found else ['-p', 'physsim_ros.testing']
    # colcon hands its arguments on by this variable, which is inherited.
    inherited = {name: value for name, value in os.environ.items() if name != 'PYTEST_ADDOPTS'}
    done = subprocess.run(
        [sys.executable, '-m', 'pytest', '-s', '-p', 'no:cacheprovider', *plugin, *words],
        cwd=directory,
        env=inherited | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=200,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


# As somebody else's project


def test_somebody_elses_robot_is_tested_with_the_same_bits_every_time(tmp_path: Path) -> None:
    (tmp_path / 'test_robot.py').write_text(ROBOT)
    digests = []
    for _ in range(2):
        printed = run_pytest(tmp_path)
        assert '2 passed' in printed
        digests += re.findall(r'DIGEST .*', printed)
    print(digests[0])  # noqa: T201 - for who reads the log
    assert len(digests) == 2
    assert digests[0] == digests[1]


def test_without_the_fixture_nothing_of_ros_is_imported(tmp_path: Path) -> None:
    (tmp_path / 'test_without.py').write_text(WITHOUT)
    # Other plugins of this environment import what they like.
    printed = run_pytest(tmp_path, '-p', 'physsim_ros.testing', PYTEST_DISABLE_PLUGIN_AUTOLOAD='1')
    assert '1 passed' in printed


def test_the_plugin_is_installed_with_the_package() -> None:
    (found,) = entry_points(group='pytest11', name='physsim')
    assert found.value == 'physsim_ros.testing'


FAILS = """
import pytest
from physsim_ros.testing import PhysSim
from visualization_msgs.msg import Marker


@pytest.fixture
def falling(physsim: PhysSim) -> PhysSim:
    physsim.load('ball')
    return physsim


def test_it_rises(falling: PhysSim) -> None:
    falling.run(1.0)
    falling.anchor((0.0, falling.pose('ball/0').y))
    falling.until(lambda: falling.pose('ball/0').y > 9.0, timeout=0.5)


def test_it_falls(falling: PhysSim) -> None:
    falling.run(0.5)
"""
BALL = 'format: 1\nbodies: [{name: ball/0, circle: {radius: 1}, at: [0, 5]}]\n'


def test_a_failed_test_tells_where_things_are_and_keeps_its_recording(
    pytester: pytest.Pytester,
) -> None:
    # The file beside the test is found from any working directory.
    directory = pytester.mkdir('elsewhere')
    (directory / 'test_it.py').write_text(FAILS)
    (directory / 'ball.yaml').write_text(BALL)
    done = pytester.runpytest_subprocess('elsewhere', '--basetemp', 'kept')
    done.assert_outcomes(passed=1, failed=1)
    printed = done.stdout.str()
    assert 'not so within 0.5 simulated seconds' in printed
    assert re.search(r'ball/0 +0\.000 +0\.0\d\d ', printed)
    (path,) = re.findall(r'^recording: (.*)$', printed, re.MULTILINE)
    # Only the failed one, from its first frame to its last.
    assert [str(each) for each in pytester.path.rglob('*.rrd')] == [path]
    steps = recorded_steps(Path(path))
    assert steps[0] <= 4
    assert steps == list(range(steps[0], 4 * 90 + 1, 4))


def test_a_recording_of_the_past_holds_what_happened(physsim: PhysSim, tmp_path: Path) -> None:
    physsim.load('demo')
    physsim.run(0.5)
    physsim.spawn(disc('late/0', at=(0.0, 20.0)))
    physsim.run(0.5)
    expected = physsim.digest()
    physsim.record_past(tmp_path / 'past.rrd')
    assert physsim.digest() == expected


def recorded_steps(path: Path) -> list[int]:
    steps: set[int] = set()
    for each in chunk.RrdReader(path).stream():
        table = each.to_record_batch()
        if 'sim_time' in table.schema.names:
            stamps = table.column('sim_time').cast('int64').to_pylist()
            # ns, at 240 Hz
            steps |= {round(stamp * 240e-9) for stamp in stamps}
    return sorted(steps)


# Driving


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


@pytest.mark.parametrize('seconds', [-1.0, 0.001, math.nan, math.inf, -math.inf, 1e308])
def test_time_that_cannot_pass_is_no_time(physsim: PhysSim, seconds: float) -> None:
    with pytest.raises(ValueError, match=r' s\b'):
        physsim.run(seconds)
    assert physsim.time == 0.0


def test_time_does_not_go_on_by_less_than_nothing(physsim: PhysSim) -> None:
    with pytest.raises(ValueError, match='seek'):
        physsim.step(-1)
    with pytest.raises(ValueError, match='for ever'):
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


def test_two_runs_of_a_world_give_the_same_bits(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    digests = []
    for _ in range(2):
        with (
            own_context(monkeypatch) as context,
            PhysSim(context, world_dir=str(tmp_path)) as world,
        ):
            world.load('demo')
            world.run(2.0)
            digests.append(world.digest())
    assert digests[0] == digests[1]


# Asking


def test_requests_return_the_name_of_the_body(physsim: PhysSim) -> None:
    assert physsim.spawn(box('a/0')) == 'a/0'
    assert physsim.spawn(MarkerArray(markers=[box('a/1', at=(3, 0)), box('a/2', at=(6, 0))])) == (
        'a/2'
    )
    assert physsim.spawn(MarkerArray()) == ''
    assert physsim.anchor((0.0, 0.0)) == 'a/0'
    assert physsim.anchor((3, 0)) == 'a/1'
    assert physsim.release(point(0.0, 0.0, 'a/1')) == 'a/1'
    assert physsim.command(command('a/2', twists=[(1, 0, 0)])) == 'a/2'


def test_a_refusal_is_raised_with_its_code_and_field(physsim: PhysSim) -> None:
    with pytest.raises(Refused) as caught:
        physsim.spawn(box(size=(-1.0, 1.0)))
    assert (caught.value.code, caught.value.field) == ('bad_size', 'scale.x')
    assert str(caught.value).startswith('bad_size: ')
    for ask, code in (
        (lambda: physsim.anchor((0.0, 0.0)), 'nothing_there'),
        (lambda: physsim.release(point(0.0, 0.0, 'map')), 'unknown_frame'),
        (lambda: physsim.command(command('a/9')), 'unknown_body'),
    ):
        with pytest.raises(Refused) as caught:
            ask()
        assert caught.value.code == code


def test_the_first_refusal_of_an_array_is_raised_and_the_rest_is_done(physsim: PhysSim) -> None:
    markers = [
        box('a/0'),
        delete('z/1'),
        box('a/1', size=(0.0, 1.0)),
        box('a/2', at=(5.0, 0.0)),
    ]
    with pytest.raises(Refused) as caught:
        physsim.spawn(MarkerArray(markers=markers))
    assert caught.value.code == 'unknown_body'
    assert physsim.names == ('a/0', 'a/2')


def test_a_large_array_is_answered_whole(physsim: PhysSim) -> None:
    markers = [disc(f'a/{number}', at=(2.0 * number, 0.0)) for number in range(2000)]
    assert physsim.spawn(MarkerArray(markers=markers)) == 'a/1999'
    assert len(physsim.names) == 2000


class Chatterbox(Node):
    """Asks for something with every frame that it sees."""

    def __init__(self, context: Any, name: str) -> None:
        super().__init__('chatterbox', context=context)
        self._name = name
        self._publisher = self.create_publisher(MultiDOFJointState, '/physsim/command', 10)
        self.create_subscription(MultiDOFJointState, '/physsim/states', self._see, 10)

    def _see(self, _: MultiDOFJointState) -> None:
        self._publisher.publish(command(self._name, twists=[(0.0, 0.0, 0.0)]))


def test_the_answer_is_the_tests_own_whatever_other_nodes_ask(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(5.0, 0.0)))
    physsim.add(Chatterbox(physsim.context, 'nobody/0'))
    for number in range(10):
        physsim.step()
        # Theirs is refused each time, and waits to be when this is asked.
        assert physsim.command(command('a/1', poses=[(5.0, float(number), 0.0)])) == 'a/1'
        assert physsim.pose('a/1').y == number


def test_the_refusal_is_the_tests_own_whatever_other_nodes_ask(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.add(Chatterbox(physsim.context, 'a/0'))
    for _ in range(10):
        physsim.step()
        with pytest.raises(Refused):
            physsim.command(command('nobody/0', twists=[(0.0, 0.0, 0.0)]))


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
    with pytest.raises(TimeoutError, match='without end'):
        physsim.step()


# Other nodes


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


# Reading


def test_pose_and_twist_are_by_name(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(5.0, 6.0, 0.7), text='{velocity: [1, 2], spin: 3}'))
    pose, twist = physsim.pose('a/1'), physsim.twist('a/1')
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((5.0, 6.0, 0.7))
    assert (twist.vx, twist.vy, twist.spin) == pytest.approx((1.0, 2.0, 3.0))
    for read in (physsim.pose, physsim.twist, physsim.contacts):
        with pytest.raises(UnknownName, match=r"^there is no body 'a/2'; nearest is 'a/\d'$"):
            read('a/2')
    with pytest.raises(UnknownName, match=r"^there is no joint 'a/2'; there are none$"):
        physsim.force('a/2')


def test_contacts_tell_of_the_last_frame(physsim: PhysSim) -> None:
    assert physsim.contacts() == []
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(disc('a/0', at=(-2.0, 0.5), text='{mass: 3, elasticity: 0}'))
    physsim.spawn(disc('a/1', at=(2.0, 5.0)))
    physsim.run(0.5)
    (contact,) = physsim.contacts()
    assert (contact.a, contact.b) == ('floor/0', 'a/0')
    # N s: what carries 3 kg for a sixtieth of a second
    assert contact.impulse == pytest.approx((0.0, 3 * G / 60), rel=1e-3, abs=1e-9)
    # m: within the engine's contact slop
    assert contact.point == pytest.approx((-2.0, 0.0), abs=0.01)
    assert contact.normal == pytest.approx((0.0, 1.0), abs=1e-9)
    assert physsim.contacts('a/0') == physsim.contacts('floor/0') == [contact]
    assert physsim.contacts('a/1') == []


def test_contacts_with_the_walls_are_with_the_world(physsim: PhysSim, tmp_path: Path) -> None:
    (tmp_path / 'room.yaml').write_text('format: 1\nbounds: [-3, 0, 3, 9]\nelasticity: 0\n')
    physsim.load('room')
    physsim.spawn(disc('a/0', at=(0.0, 0.5)))
    physsim.run(0.2)
    (contact,) = physsim.contacts()
    assert (contact.a, contact.b) == ('a/0', 'world')
    assert contact.impulse[1] < 0


def test_contacts_name_bodies_as_they_were_then(physsim: PhysSim) -> None:
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(disc('a/0', at=(0.0, 0.5)))
    physsim.run(0.2)
    physsim.node.simulation.reset()
    assert physsim.names == ()
    assert [(each.a, each.b) for each in physsim.contacts()] == [('floor/0', 'a/0')]


def test_energy_is_that_of_all_bodies(physsim: PhysSim) -> None:
    physsim.spawn(disc('a/0', diameter=2.0, at=(0.0, 3.0), text='{mass: 2, velocity: [3, 4]}'))
    physsim.spawn(disc('a/1', diameter=2.0, at=(9.0, 1.0), text='{mass: 4, spin: 2}'))
    # J: ½mv² + mgh, and ½(½mr²)ω² + mgh
    expected = (2 * 25 / 2 + 2 * G * 3.0) + (4 * 1.0 / 2 * 2**2 / 2 + 4 * G * 1.0)
    assert physsim.energy() == pytest.approx(expected)
    physsim.run(0.5)
    assert physsim.energy() == pytest.approx(expected)


# Recording


def test_a_recording_holds_every_frame_since_it_began(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = tmp_path / 'failed.rrd'
    with own_context(monkeypatch) as context, PhysSim(context, world_dir=str(tmp_path)) as world:
        world.spawn(disc('a/0', at=(0.0, 5.0)))
        world.step(10)
        world.record(path)
        world.run(2.0)
        ended = world.node.simulation.world.step_count
    steps: set[int] = set()
    for each in chunk.RrdReader(path).stream():
        table = each.to_record_batch()
        if 'sim_time' in table.schema.names:
            stamps = table.column('sim_time').cast('int64').to_pylist()
            # ns, at 240 Hz
            steps |= {round(stamp * 240e-9) for stamp in stamps}
    assert ended == 4 * 130
    # It begins with the frame that is shown at that time.
    assert steps == set(range(4 * 10, ended + 1, 4))


# Alone


def test_no_other_process_hears_a_world_or_is_heard_by_it(
    physsim: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = Client(physsim)
    path = Path(__file__).parent / 'elsewhere' / 'intruder.py'
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    monkeypatch.setenv('ROS_DOMAIN_ID', str(physsim.context.get_domain_id()))
    with subprocess.Popen([sys.executable, path], stdout=subprocess.PIPE, text=True) as intruder:
        while intruder.poll() is None:
            physsim.step()
        assert intruder.returncode == 0
        assert intruder.stdout is not None
        # Its own second node and nobody else: discovery works on this domain.
        assert json.loads(intruder.stdout.read()) == {'heard': 1, 'nodes': ['first', 'second']}
    assert client.events == []
    assert physsim.names == ()
    assert 'first' not in physsim.node.get_node_names()


def test_two_worlds_of_one_process_do_not_see_each_other(
    physsim: PhysSim, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    with own_context(monkeypatch) as context, PhysSim(context, world_dir=str(tmp_path)) as other:
        physsim.spawn(box('a/0'))
        other.spawn(box('b/0'))
        physsim.step(3)
        assert (physsim.names, other.names) == (('a/0',), ('b/0',))
        assert other.time == 0.0
