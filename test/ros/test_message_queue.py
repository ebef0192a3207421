# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Large messages are taken at once and decoded in their order; too many are refused undecoded."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from types import SimpleNamespace
from typing import Any

from physsim_ros.model.errors import Busy
from physsim_ros.ros.requests import message_queue
from physsim_ros.testing import messages, PhysSim
import pytest
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client


def array(number: int, count: int = 100) -> MarkerArray:
    """Return an array of 20 KB, whose bodies lie apart."""
    return MarkerArray(
        markers=[
            messages.disc(f'disc/{number * count + each}', at=(2.0 * each, 2.0 * number))
            for each in range(count)
        ]
    )


def test_large_and_small_messages_are_carried_out_in_their_order(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/spawn', Marker(action=Marker.DELETEALL))
    client.publish('~/spawn_array', array(0))
    client.publish('~/spawn', messages.delete('disc/7'))
    client.publish('~/spawn_array', array(1))
    client.publish('~/spawn', messages.disc('disc/7', at=(0.0, -5.0)))
    physsim.settle()
    physsim.node.apply_requests()
    names = physsim.node.frame.snapshot.scene.names
    assert [name for name in names if name == 'disc/7'] == ['disc/7']
    assert (len(names), names[-1]) == (200, 'disc/7')


def test_a_service_comes_behind_the_messages_that_were_sent_before(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/spawn_array', array(0, 1))
    clear = client.node.create_client(Trigger, '/physsim/clear')
    client.spin_until(clear.service_is_ready)
    client.publish('~/spawn_array', array(1))
    cleared = clear.call_async(Trigger.Request())
    client.spin_until(cleared.done)
    assert cleared.result().message == 'deleted 101 bodies'


def test_a_parameter_is_set_behind_the_messages_that_were_sent_before(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/spawn_array', array(9, 1))
    clients = [
        client.node.create_client(SetParameters, '/physsim/set_parameters'),
        client.node.create_client(SetParametersAtomically, '/physsim/set_parameters_atomically'),
    ]
    client.spin_until(lambda: all(each.service_is_ready() for each in clients))
    client.events.clear()
    for number in range(5):
        client.publish('~/spawn_array', array(number))
    parameter = Parameter('density', value=5.0).to_parameter_msg()
    replies = [each.call_async(each.srv_type.Request(parameters=[parameter])) for each in clients]
    client.spin_until(lambda: all(each.done() for each in replies))
    physsim.node.apply_requests()
    physsim.settle()
    topics = [event.name for event in client.events]
    assert topics == ['~/spawn_array'] * 500 + ['~/set_parameters'] * 2
    assert {each.body.density for each in physsim.node.simulation.world.save().bodies} == {1.0}


def test_messages_that_are_too_many_are_refused_undecoded(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    client.ask('~/spawn_array', array(0, 1))
    client.events.clear()
    before = physsim.digest()
    monkeypatch.setattr(message_queue, 'MOST_WAITING', 0)
    client.publish('~/spawn_array', array(1))
    client.publish('~/spawn_array', array(2))
    client.publish('~/spawn', messages.disc('disc/9', at=(0.0, -5.0)))
    physsim.settle()
    physsim.node.apply_requests()
    physsim.settle()
    codes = [event.code for event in client.events]
    assert sorted(codes) == ['busy', 'busy'] + ['ok'] * 100
    assert physsim.digest() != before
    # None waits any more.
    assert {event.code for event in client.ask('~/spawn_array', array(3))} == {'ok'}


def test_small_messages_and_calls_behind_a_large_one_are_bounded_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(message_queue, 'MOST_WAITING', 2**17)
    tasks: list[Callable[[], None]] = []
    node: Any = SimpleNamespace(executor=SimpleNamespace(create_task=tasks.append))
    queue, handled, busy = message_queue.MessageQueue(node), [], 0
    queue.add_message(lambda _: handled.append(-1), bytes(message_queue.LARGE))
    for number in range(1000):
        call = partial(handled.append, number)
        try:
            if number % 2:
                queue.add_call(call)
            else:
                queue.add_message(lambda _, call=call: call(), bytes(12))
        except Busy:
            busy += 1
    while tasks:
        tasks.pop()()
    assert handled == list(range(-1, len(handled) - 1))
    # Half a kilobyte each is what they take.
    assert len(handled) < 2**17 / 500
    assert len(handled) + busy == 1001


def test_a_message_is_handled_in_pieces_and_those_behind_it_wait() -> None:
    tasks: list[Callable[[], None]] = []
    node: Any = SimpleNamespace(executor=SimpleNamespace(create_task=tasks.append))
    queue, handled = message_queue.MessageQueue(node), list[str]()
    queue.piece = 0.0

    def in_pieces(data: bytes) -> Iterator[None]:
        for number in range(3):
            handled.append(f'{data.decode()}{number}')
            yield

    queue.add_message(in_pieces, b'a')
    queue.add_message(lambda data: handled.append(data.decode()), b'b')
    queue.add_message(in_pieces, b'c')
    assert handled == ['a0']
    while tasks:
        # Between two pieces the executor does what else has come.
        assert len(tasks) == 1
        before = len(handled)
        tasks.pop()()
        assert len(handled) <= before + 1
    assert handled == ['a0', 'a1', 'a2', 'b', 'c0', 'c1', 'c2']
    queue.add_call(lambda: handled.append('d'))
    assert handled[-1] == 'd'


def test_an_array_in_pieces_is_one_gesture_and_keeps_its_place(
    physsim: PhysSim, client: Client
) -> None:
    physsim.node.requests.queue.piece = 0.0
    client.publish('~/spawn_array', array(0, 30))
    client.publish('~/spawn', messages.delete('disc/7'))
    client.publish('~/spawn', messages.disc('disc/99', at=(0.0, -5.0)))
    client.spin_until(lambda: len(physsim.node.simulation.requests) == 32)
    physsim.node.apply_requests()
    assert len(physsim.names) == 30
    assert 'disc/7' not in physsim.names
    for left in (29, 30, 0):
        assert client.call('~/undo').success
        assert len(physsim.names) == left
