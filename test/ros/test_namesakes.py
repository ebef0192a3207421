# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A second node of the world's name is told by both."""

from __future__ import annotations

from physsim_ros.testing import PhysSim
from rclpy.node import Node

from ..client import Client, Event
from ..outside import Outside

SECOND = 1_000_000_000


def namesakes(client: Client) -> list[Event]:
    client.physsim.settle()
    return [event for event in client.events if event.name == 'same_name']


def test_a_second_node_of_the_name_is_told_once_and_again_when_another_comes(
    physsim: PhysSim, client: Client
) -> None:
    physsim.node.start()
    nodes: list[Node] = []
    for second in range(6):
        # The second comes, stays, goes; then two come.
        if second == 1:
            nodes.append(Node('physsim', context=physsim.context))
        if second == 3:
            nodes.pop().destroy_node()
        if second == 4:
            nodes += [Node('physsim', context=physsim.context) for _ in range(2)]
        physsim.node.tick(second * SECOND)
        told = namesakes(client)
        assert len(told) == (0, 1, 1, 1, 2, 2)[second]
    for node in nodes:
        node.destroy_node()
    assert [event.code for event in told] == ['same_name'] * 2
    assert told[0].message.startswith('2 nodes are named /physsim')
    assert told[1].message.startswith('3 nodes are named /physsim')
    assert '__ns:=' in told[0].message


def test_a_node_of_that_name_in_another_namespace_is_no_namesake(
    physsim: PhysSim, client: Client
) -> None:
    other = Node('physsim', namespace='/other', context=physsim.context)
    physsim.node.start()
    physsim.node.tick(0)
    assert namesakes(client) == []
    other.destroy_node()


def test_both_worlds_tell_it(outside: Outside) -> None:
    with outside.start_world() as first, outside.start_world() as second:
        for world in (first, second):
            world.wait_for('2 nodes are named /physsim')
        assert second.interrupt() == 0
        assert first.interrupt() == 0
