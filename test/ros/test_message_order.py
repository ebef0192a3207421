# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages and calls are carried out in the order of their arrival, large ones too."""

from __future__ import annotations

from physsim_ros.testing import messages, PhysSim
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, message_of


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
    physsim.node.loop.apply_requests()
    names = physsim.node.frame.snapshot.scene.names
    assert [name for name in names if name == 'disc/7'] == ['disc/7']
    assert (len(names), names[-1]) == (200, 'disc/7')


def test_a_service_comes_behind_the_messages_that_were_sent_before(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/spawn_array', array(0, 1))
    clear = client.service(Trigger, '~/clear')
    client.publish('~/spawn_array', array(1))
    cleared = clear.call_async(Trigger.Request())
    client.spin_until(cleared.done)
    assert cleared.result().message == 'deleted 101 bodies'


def test_a_parameter_is_set_behind_the_messages_that_were_sent_before(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/spawn_array', array(9, 1))
    clients = [
        client.service(SetParameters, '~/set_parameters'),
        client.service(SetParametersAtomically, '~/set_parameters_atomically'),
    ]
    client.events.clear()
    for number in range(5):
        client.publish('~/spawn_array', array(number))
    density = [message_of('density', 5.0)]
    replies = [each.call_async(each.srv_type.Request(parameters=density)) for each in clients]
    client.spin_until(lambda: all(each.done() for each in replies))
    client.catch_up()
    topics = [event.name for event in client.events]
    assert topics == ['~/spawn_array'] * 500 + ['~/set_parameters'] * 2
    assert {each.body.density for each in physsim.node.simulation.world.save().bodies} == {1.0}


def test_an_array_is_one_gesture_and_keeps_its_place(physsim: PhysSim, client: Client) -> None:
    client.publish('~/spawn_array', array(0, 30))
    client.publish('~/spawn', messages.delete('disc/7'))
    client.publish('~/spawn', messages.disc('disc/99', at=(0.0, -5.0)))
    client.spin_until(lambda: len(physsim.node.simulation.requests) == 32)
    physsim.node.loop.apply_requests()
    assert len(physsim.names) == 30
    assert 'disc/7' not in physsim.names
    for left in (29, 30, 0):
        assert client.call('~/undo').success
        assert len(physsim.names) == left
