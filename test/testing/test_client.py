# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A request returns the answer that is its own, or raises it."""

from __future__ import annotations

from typing import Any

from physsim_ros.testing import (
    box,
    command,
    delete,
    disc,
    own_context,
    PhysSim,
    point,
    Refused,
)
from physsim_ros.testing.client import SettlingExecutor
import pytest
from rclpy.node import Node
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray


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
    # More answers than the topic of events keeps.
    markers = [disc(f'a/{number}', at=(2.0 * number, 0.0)) for number in range(1100)]
    assert physsim.spawn(MarkerArray(markers=markers)) == 'a/1099'
    assert len(physsim.names) == 1100


def test_an_array_that_is_refused_whole_is_refused_at_once(physsim: PhysSim) -> None:
    with pytest.raises(Refused, match='KiB') as caught:
        physsim.spawn(MarkerArray(markers=[box('a/1')] * 30_000))
    assert caught.value.code == 'malformed'
    assert physsim.names == ()


class Chatterbox(Node):
    """Asks for something with every frame that it sees."""

    def __init__(self, context: Any, name: str) -> None:
        super().__init__(f'chatterbox_{name[0]}', context=context)
        self._name = name
        self._publisher = self.create_publisher(MultiDOFJointState, '/physsim/command', 10)
        self.create_subscription(MultiDOFJointState, '/physsim/states', self._see, 10)

    def _see(self, _: MultiDOFJointState) -> None:
        self._publisher.publish(command(self._name, twists=[(0.0, 0.0, 0.0)]))


def test_answers_and_refusals_are_the_tests_own_whatever_other_nodes_ask(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(5.0, 0.0)))
    for other in ('nobody/0', 'a/0'):
        physsim.add(Chatterbox(physsim.context, other))
    for number in range(10):
        physsim.step()
        # Of theirs one is refused each time, and both wait to be answered when this is asked.
        assert physsim.command(command('a/1', poses=[(5.0, float(number), 0.0)])) == 'a/1'
        assert physsim.pose('a/1').y == number
        physsim.step()
        with pytest.raises(Refused, match='nobody/1'):
            physsim.command(command('nobody/1', twists=[(0.0, 0.0, 0.0)]))


def test_a_world_that_is_not_discovered_leaves_no_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    destroyed: list[str] = []
    destroy = Node.destroy_node

    def note(node: Node) -> None:
        destroyed.append(node.get_name())
        destroy(node)

    def fail(executor: SettlingExecutor, until: Any, complaint: str, *timeout: float) -> None:
        if complaint == 'the world was not discovered':
            raise TimeoutError(complaint)
        spin_until(executor, until, complaint, *timeout)

    spin_until = SettlingExecutor.spin_until
    monkeypatch.setattr(Node, 'destroy_node', note)
    monkeypatch.setattr(SettlingExecutor, 'spin_until', fail)
    with own_context(monkeypatch) as context, pytest.raises(TimeoutError):
        PhysSim(context)
    assert destroyed == ['physsim_test', 'physsim']
