# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of the node, as another process sees them that knows nothing of this package."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import PoseArray
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing import box, delete, PhysSim
import pytest
import rclpy
from rclpy.context import Context
from rclpy.parameter import Parameter
from rclpy.qos import HistoryPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

from ..client import Client, KEPT, stamp_of
from ..outside import Outside, ROOT, run_python

# One frame at 60 Hz; stamps are whole nanoseconds [ns].
PERIOD = 1e9 / 60.0


def rows_below(heading: str) -> list[list[str]]:
    """Return the cells of the table below a heading of the contract."""
    text = (ROOT / 'docs' / 'interface' / 'topics.md').read_text(encoding='utf-8')
    section = text.partition(f'\n## {heading}\n')[2].partition('\n#')[0]
    return [line.strip('|').split(' | ') for line in section.splitlines() if line[:3] == '| `']


def resolved(topic: str) -> str:
    """Return the name of a topic or service of the contract on the graph."""
    return f'/{topic.strip("` /")}'.replace('/~', '/physsim')


def type_name(cell: str) -> str:
    """Return a type of the contract as the graph names it."""
    return cell.strip('` ').replace('/', '/msg/')


TYPES = {resolved(topic): type_name(kind) for topic, kind, *_ in rows_below('Output')}
QOS = {resolved(topic): qos for topic, _, qos, *_ in rows_below('Output')}
REQUESTS = {resolved(topic): type_name(kind) for topic, kind, _ in rows_below('Requests')}
SERVICES = {resolved(name) for row in rows_below('Services') for name in row[0].split(', ')}
# In the order in which the program outside spawns them.
NAMES = ['ball/7', 'ball/6', 'ball/5']


@pytest.fixture(scope='module')
def seen(outside: Outside) -> dict[str, Any]:
    """Return all that a program outside saw of a running world."""
    with outside.start_world() as world:
        world.wait_for('ready')
        seen = outside.run_program('observe', *TYPES, '--', *REQUESTS)
        assert world.interrupt() == 0
        return seen


def test_a_plain_start_does_not_import_what_only_viewers_pages_and_maps_need() -> None:
    late = {'rerun', 'tornado', 'PIL', 'pyarrow', 'simulation_interfaces', 'rclpy.action'}
    check = f'import sys, physsim_ros.ros.node\nprint(*({late} & {{*sys.modules}}))'
    assert run_python('-c', check) == '\n'


def frames_of(stamps: list[int]) -> list[int]:
    """Return the numbers of frames, each of whose stamps is a multiple of the publish period."""
    frames = [round(stamp / PERIOD) for stamp in stamps]
    # ns: rounded to a whole one
    assert stamps == pytest.approx([frame * PERIOD for frame in frames], abs=0.51, rel=0)
    return frames


# Topics and services


def test_topics_have_the_types_and_qos_of_the_contract(seen: dict[str, Any]) -> None:
    for topic, type_ in TYPES.items():
        durability = 'TRANSIENT_LOCAL' if 'transient local' in QOS[topic] else 'VOLATILE'
        assert QOS[topic].startswith('reliable')
        assert seen['publishers'][topic] == [[type_, 'RELIABLE', durability]], topic
    for topic, type_ in REQUESTS.items():
        assert seen['subscriptions'][topic] == [[type_, 'RELIABLE', 'VOLATILE']], topic


def test_topics_have_the_depths_of_the_contract(physsim: PhysSim) -> None:
    # Discovery does not tell them, so they are looked at from inside.
    profiles = {each.topic_name: each.qos_profile for each in physsim.node.publishers}
    for topic, qos in QOS.items():
        assert profiles[topic].history == HistoryPolicy.KEEP_LAST
        assert qos.endswith(f' depth {profiles[topic].depth}'), topic
    # It publishes nothing else but what every node does.
    assert set(profiles) - {'/parameter_events', '/rosout'} == set(QOS)
    profiles = {each.topic_name: each.qos_profile for each in physsim.node.subscriptions}
    # It hears nothing else.
    assert set(profiles) == set(REQUESTS)
    for topic in REQUESTS:
        assert profiles[topic].history == HistoryPolicy.KEEP_ALL


def test_services_are_triggers(seen: dict[str, Any]) -> None:
    triggers = {name for name, (type_, *_) in seen['services'].items() if 'Trigger' in type_}
    assert triggers == SERVICES
    assert all(seen['services'][name] == ['std_srvs/srv/Trigger'] for name in SERVICES)


def test_services_answer_another_process(seen: dict[str, Any]) -> None:
    assert [success for success, _ in seen['calls']] == [True] * 4
    assert all(message for _, message in seen['calls'])


# Answers


def test_each_request_from_outside_is_answered_once(seen: dict[str, Any]) -> None:
    answers = [(level, name, who, values) for level, name, who, _, *values in seen['events']]
    good = [(0, '~/spawn', name, [['code', 'ok']]) for name in NAMES]
    bad = (2, '~/spawn', 'bad/0', [['code', 'unknown_shape'], ['field', 'type']])
    assert answers == [*good, bad]
    assert all(message for _, _, _, message, *_ in seen['events'])


# Streams; what they hold is in `test_publishers.py` and `test_encoders.py`.


def test_stamps_at_speed_1_are_successive_multiples_of_the_publish_period(
    seen: dict[str, Any],
) -> None:
    frames = frames_of(seen['stamps'])
    assert len(frames) >= 60
    assert frames == list(range(frames[0], frames[0] + len(frames)))


def test_the_clock_is_never_0_and_tells_each_frame(seen: dict[str, Any]) -> None:
    clocks = seen['clocks']
    assert 0 not in clocks
    frames = frames_of(clocks)
    assert frames == sorted(frames)
    # None is left out; a paused world tells its time again to who comes late.
    assert sorted(set(frames)) == list(range(frames[0], frames[-1] + 1))
    assert set(seen['stamps']) <= set(clocks)


def test_who_comes_late_sees_the_whole_picture(seen: dict[str, Any]) -> None:
    assert seen['late_running'] == seen['late_picture'] == seen['late_names'] == NAMES


# In this process, where time is in the test's hand


def test_a_world_at_time_0_tells_no_time(physsim: PhysSim, client: Client) -> None:
    clocks = client.listen(Clock, '/clock')
    physsim.spawn(box())
    assert clocks == []
    physsim.step(2)
    stamps = [stamp_of(each) for each in clocks]
    assert frames_of(stamps) == [1, 2]


def test_streams_tell_of_a_request_while_time_stands_still(
    physsim: PhysSim, client: Client
) -> None:
    poses = client.listen(PoseArray, '~/poses')
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    physsim.spawn(box('a/0', at=(1.0, 2.0)))
    assert len(poses[-1].poses) == 1
    assert [each.ns for each in pictures[-1].markers] == ['a']
    physsim.spawn(delete('a/0'))
    assert len(poses[-1].poses) == 0


def test_a_body_with_a_name_in_any_language_is_listed_by_it(
    physsim: PhysSim, client: Client
) -> None:
    states = client.listen(MultiDOFJointState, '~/states')
    for name in ('Kiste Ü/1', '箱/2', 'a b;c:d/e/-3', '🎱/8'):
        assert physsim.spawn(box(name)) == name
    physsim.step()
    assert list(states[-1].joint_names) == ['Kiste Ü/1', '箱/2', 'a b;c:d/e/-3', '🎱/8']


def test_a_world_in_a_namespace_has_its_topics_there(physsim: PhysSim) -> None:
    context = Context()
    words = ['--ros-args', '-r', '__ns:=/b']
    rclpy.init(context=context, args=words, domain_id=physsim.context.get_domain_id())
    values = {'viewer': 'none', 'world_file': 'boxes'}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = PhysSimNode(context=context, parameter_overrides=overrides)
    node.loop.advance_frame()
    published = {each.topic_name for each in node.publishers}
    robots = {topic for topic in published if 'robot_0' in topic}
    heard = {each.topic_name for each in node.subscriptions}
    node.destroy_node()
    rclpy.shutdown(context=context)
    assert published - robots - {'/rosout', '/parameter_events'} == {
        topic if topic == '/diagnostics' else f'/b{topic}' for topic in TYPES
    }
    assert '/b/robot_0/scan' in robots
    assert all(topic.startswith('/b/robot_0/') for topic in robots)
    assert heard >= {f'/b{topic}' for topic in REQUESTS}
