# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The pytest plugin, as other people's tests use it: their own node, no waiting, the same bits."""

from __future__ import annotations

from importlib.metadata import entry_points
from pathlib import Path
import re

from physsim_ros import testing
from physsim_ros.testing import disc, own_context, PhysSim, Refused
import pytest
from rerun import chunk

from ..outside import run_python
from ..source_tree import blocks_of

pytest_plugins = ['pytester']
PLUGIN = 'physsim_ros.testing.plugin'

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
    assert not {'physsim_ros.testing.world', 'physsim_ros.ros'} & set(sys.modules)
"""


def run_pytest(directory: Path, *words: str, **environment: str) -> str:
    """Run the tests of somebody else's project, and return what was printed."""
    # An installed package brings its plugin by itself, as for everybody.
    found = entry_points(group='pytest11', name='physsim')
    plugin = [] if found else ['-p', PLUGIN]
    options = ('-s', '-p', 'no:cacheprovider', *plugin)
    # colcon hands its arguments on by this variable, which is inherited.
    variables = {'PYTEST_ADDOPTS': ''} | environment
    return run_python('-m', 'pytest', *options, *words, cwd=directory, **variables)


@pytest.mark.slow
def test_a_robot_of_others_is_tested_with_the_same_bits_every_time(tmp_path: Path) -> None:
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
    printed = run_pytest(tmp_path, '-p', PLUGIN, PYTEST_DISABLE_PLUGIN_AUTOLOAD='1')
    assert '1 passed' in printed


def test_the_plugin_is_installed_with_the_package() -> None:
    (found,) = entry_points(group='pytest11', name='physsim')
    assert found.value == PLUGIN


def test_all_public_names_are_listed() -> None:
    listed = dir(testing)
    assert {'PhysSim', 'own_context', *testing.__all__} <= set(listed)
    assert listed == sorted(listed)


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
    assert 'DeprecationWarning' not in printed
    assert 'write_footer' not in printed
    assert 'not true within 0.5 simulated seconds' in printed
    assert re.search(r'ball/0 +0\.000 +0\.0\d\d ', printed)
    # The traceback ends at the line of the test.
    assert 'test_it.py:16: TimeoutError' in printed or 'test_it.py:17: TimeoutError' in printed
    assert 'testing/world.py' not in printed
    (path,) = re.findall(r'^recording: (.*)$', printed, re.MULTILINE)
    # Only the failed one, from its first frame to its last.
    assert [str(each) for each in pytester.path.rglob('*.rrd')] == [path]
    steps = recorded_steps(Path(path))
    assert steps[0] <= 4
    assert steps == list(range(steps[0], 4 * 90 + 1, 4))


FREED = """
import gc
import weakref

worlds = []


def test_a_world_is_used(physsim):
    worlds.append(weakref.ref(physsim.node))


def test_the_world_of_the_test_before_is_freed():
    gc.collect()
    assert worlds[0]() is None
"""


@pytest.mark.slow
def test_a_world_is_freed_after_its_test(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(FREED)
    pytester.runpytest_subprocess().assert_outcomes(passed=2)


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
    assert ended == 4 * 130
    # It begins with the frame that is shown at that time.
    assert recorded_steps(path) == list(range(4 * 10, ended + 1, 4))


def test_a_recording_that_cannot_be_written_is_refused(physsim: PhysSim, tmp_path: Path) -> None:
    taken = tmp_path / 'taken.rrd'
    taken.write_text('no recording')
    for path in (tmp_path / 'missing' / 'a.rrd', taken):
        with pytest.raises(Refused, match=str(path)) as refused:
            physsim.record(path)
        assert refused.value.code == 'record_failed'
        assert physsim.recording is None
    assert taken.read_text() == 'no recording'


def test_the_tests_in_the_documents_pass(pytester: pytest.Pytester) -> None:
    blocks = blocks_of('README.md', 'python') + blocks_of('docs/testing.md', 'python')
    tests = [block for block in blocks if 'def test_' in block]
    for number, test in enumerate(tests):
        (pytester.path / f'test_{number}.py').write_text(test)
    assert len(tests) == 5
    pytester.runpytest_subprocess().assert_outcomes(passed=5)
