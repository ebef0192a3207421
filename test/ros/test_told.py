# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every request is answered where all can see it: services, parameters, messages of noise."""

from __future__ import annotations

from nav_msgs.msg import Path
from physsim_ros.ros import topics
from physsim_ros.ros.parameters import SPECS
from physsim_ros.ros.requests import request_topics
from physsim_ros.testing import disc, PhysSim
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, Event, message_of, parameter


def told(client: Client) -> list[Event]:
    """Return the events since the last time."""
    client.catch_up()
    events, client.events[:] = list(client.events), []
    return events


@pytest.mark.parametrize(
    'service', ['pause', 'play', 'rewind', 'fast_forward', 'fast_rewind', 'clear', 'reset']
)
def test_what_a_service_did_is_told_in_the_same_sentence(client: Client, service: str) -> None:
    response = client.call(f'~/{service}')
    assert response.success
    events = [event for event in told(client) if event.name == f'~/{service}']
    assert [(event.level, event.message, event.code) for event in events] == [
        (0, response.message, 'ok')
    ]


@pytest.mark.parametrize(
    ('service', 'code', 'word'),
    [
        ('step', 'running', 'pause'),
        ('undo', 'out_of_history', 'undo'),
        ('redo', 'out_of_history', 'redo'),
        ('load_world', 'bad_world_file', 'world_file'),
        ('save_world', 'bad_world_file', 'world_file'),
    ],
)
def test_why_a_service_did_nothing_is_told_in_the_same_sentence(
    physsim: PhysSim, client: Client, service: str, code: str, word: str
) -> None:
    before = physsim.digest()
    response = client.call(f'~/{service}')
    assert not response.success
    (event,) = told(client)
    assert (event.level, event.name, event.code) == (2, f'~/{service}', code)
    assert response.message == f'{code}: {event.message}'
    assert word in event.message
    assert physsim.digest() == before


def test_undo_and_redo_are_told_once(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(disc('a/0'))
    told(client)
    for service in ('undo', 'redo'):
        response = client.call(f'~/{service}')
        assert [event.message for event in told(client)] == [response.message]


def test_what_parameters_changed_or_refused_is_told(physsim: PhysSim, client: Client) -> None:
    long = 'p' * 100_000
    asked = [('speed', 2.0), ('speed', 1e9), (long, 1.0), ('a\x1b', 1.0), ('gravty', 1.0)]
    results = client.set_parameters(*(message_of(*each) for each in asked))
    assert [result.successful for result in results] == [True, False, False, False, False]
    events = told(client)
    assert [event.code for event in events] == [
        'ok',
        'bad_property',
        'unknown_property',
        'unknown_property',
        'unknown_property',
    ]
    assert events[0].message == results[0].reason == 'speed is 2.0'
    assert results[1].reason.endswith(events[1].message)
    assert events[1].field == 'speed'
    assert events[4].message == "there is no parameter 'gravty'; nearest is 'gravity'"
    for event, result in zip(events, results, strict=True):
        assert event.message.isprintable()
        assert event.field.isprintable()
        assert max(len(event.message), len(event.field), len(result.reason)) < 1000


def test_of_parameters_that_are_set_together_the_wrong_one_is_told(
    physsim: PhysSim, client: Client
) -> None:
    def values() -> dict[str, object]:
        return {name: parameter(physsim, name) for name in SPECS}

    before = values()
    others = [('speed', 1.5), ('density', 2.0), ('tool', 'pin')]
    for wrong in (
        ('snap', -1.0),
        ('gravty', 1.0),
        ('laser_angle', [1.0]),
        ('frame_id', 'map'),
        ('iterations', 'many'),
        ('bounds', [1.0, 0.0, -1.0, 2.0]),
    ):
        (alone,) = client.set_parameters(message_of(*wrong))
        (about_it,) = told(client)
        assert about_it.field == wrong[0]
        for place in range(len(others) + 1):
            asked = [*others[:place], wrong, *others[place:]]
            result = client.set_together(*(message_of(*each) for each in asked))
            # It is told as where it is set alone, and nothing is told of the others.
            assert (result.successful, result.reason) == (False, alone.reason)
            assert told(client) == [about_it]
            assert values() == before
    result = client.set_together(*(message_of(*each) for each in others))
    reasons = [event.message for event in told(client)]
    assert reasons == ['speed is 1.5', 'density is 2.0', "tool is 'pin'"]
    assert result.reason == ', '.join(reasons)


TOPICS = {
    Marker: '~/spawn',
    MarkerArray: '~/spawn_array',
    MultiDOFJointState: '~/command',
    Path: '~/stroke',
    Float64: '~/speed',
}
NOISE = b'\0\1\0\0' + b'\xff' * 16
# Of a number there is nothing to decode wrongly, and rclpy sends no more than it.
LARGE = [kind for kind in TOPICS if kind is not Float64]


def check_malformed(client: Client, kind: type, data: bytes) -> None:
    """Publish bytes on a topic, and check that they are answered and change nothing."""
    topic, physsim = TOPICS[kind], client.physsim
    told(client)
    before = physsim.digest(), physsim.node.simulation.speed
    client._publishers[topic].publish(data)  # noqa: SLF001 - what it sends is no message
    physsim.settle()
    (event,) = told(client)
    assert (event.level, event.name, event.code) == (2, topic, 'malformed')
    assert (physsim.digest(), physsim.node.simulation.speed) == before


@pytest.mark.parametrize(
    ('kind', 'data'),
    [
        *((kind, NOISE) for kind in LARGE),
        *((kind, serialize_message(kind())[:-3]) for kind in TOPICS),
    ],
)
def test_a_message_that_cannot_be_decoded_is_answered_and_counted(
    physsim: PhysSim, client: Client, kind: type, data: bytes
) -> None:
    client.ask(TOPICS[kind], kind())
    check_malformed(client, kind, data)
    assert physsim.node.request_topics.undecodable == 1


@pytest.mark.parametrize('kind', LARGE)
def test_a_message_that_is_too_large_is_refused_before_it_is_decoded(
    client: Client, monkeypatch: pytest.MonkeyPatch, kind: type
) -> None:
    client.ask(TOPICS[kind], kind())
    monkeypatch.setattr(topics, 'deserialize_message', lambda *_: pytest.fail('decoded'))
    most = request_topics.MOST_BYTES.get(kind, request_topics.MOST_BYTES_OF_ONE)
    check_malformed(client, kind, bytes(most + 1))
