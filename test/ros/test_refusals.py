# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A request that cannot be applied is refused once, by its code, and changes nothing.

Messages that are refused before the world sees them are in `test_conversions.py` and
`test_marker_text.py`; of these there are some for each topic here.
"""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import Quaternion
from physsim_ros.testing import box, command, delete, disc, marker, PhysSim, point, polygon
import pytest
from rclpy.parameter import Parameter
from std_msgs.msg import Float64
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker

from .journey import clock_of, SECOND
from .messages import circle, DOWN, feedback, grid, MOVE, spoiled, stroke
from ..client import Client, Event

NAN, INF = math.nan, math.inf
FLAT = [(0, 0), (1, 0), (2, 0), (0, 0)]
PATH: dict[str, Any] = {'kind': 'path', 'points': [[0, 0], [4, 0]], 'speed': 1.0}


def joint(text: str) -> Marker:
    return marker(Marker.LINE_LIST, 'joint/0', points=[(0.4, 0.0)], text=text)


def plan() -> Any:
    return grid('#.', '.#')


TILTED = Quaternion(x=math.sin(0.05), w=math.cos(0.05))
SPAWNS: list[tuple[Marker, str, str]] = [
    (box('new/0', size=(INF, 1.0)), 'malformed', 'scale.x'),
    (box('new/0', text=r'{"\ud800": 1, "\ud800": 2}'), 'malformed', 'text'),
    (box('new/0', text=r'{"\ud800": 1}'), 'malformed', 'text'),
    (marker(Marker.TEXT_VIEW_FACING, 'new/0', text='\t'), 'bad_property', 'label'),
    (marker(Marker.TEXT_VIEW_FACING, 'new/0', scale=(1.0, 1.0, 0.0)), 'bad_size', 'scale.z'),
    (box('new/0', size=(0.0, 1.0)), 'bad_size', 'scale.x'),
    (polygon('new/0', outline=FLAT), 'bad_outline', 'points'),
    (spoiled(box('new/0'), 'pose.orientation', TILTED), 'not_planar', 'pose.orientation'),
    (box('new/0', frame='map'), 'unknown_frame', 'header.frame_id'),
    (box('new/0', frame='new/0'), 'unknown_frame', 'header.frame_id'),
    (box('new/0', text='{colour: red}'), 'unknown_property', 'colour'),
    (box('new/0', text='{friction: 11}'), 'bad_property', 'friction'),
    (box('new/0', at=(1e9, 0.0)), 'bad_property', 'pose'),
    (delete('new/0'), 'unknown_body', 'name'),
    (box('new/0', text='{anchored: true, velocity: [1, 0]}'), 'anchored', 'velocity'),
    (box('held/0', text='{velocity: [1, 0]}'), 'anchored', 'velocity'),
    (disc('new/0', actor={**PATH, 'start': {'gate': 'door/0'}}), 'unknown_body', 'gate'),
    (disc('new/0', actor={**PATH, 'kind': 'walk'}), 'bad_property', 'kind'),
    (disc('new/0', actor={**PATH, 'sped': 1}), 'unknown_property', 'sped'),
    (disc('new/0', actor={**PATH, 'points': [[0, 0], [1]]}), 'malformed', 'points'),
    (box('new/0', text='{medium: water, anchored: true}'), 'bad_property', 'medium'),
    (box('new/0', text='{medium: {density: .nan}}'), 'malformed', 'density'),
    (box('new/0', medium={'density': 1, 'depth': 0}), 'unknown_property', 'depth'),
]
JOINTS: list[tuple[Marker, str, str]] = [
    (joint('{kind: glue}'), 'bad_property', 'kind'),
    (joint('{kind: axle, stifness: 3}'), 'unknown_property', 'stifness'),
    (joint('{kind: axle, a: x/0}'), 'unknown_body', 'a'),
    (joint('{kind: spring}'), 'malformed', 'points'),
    (joint('kind: ['), 'malformed', 'text'),
    (delete('joint/0'), 'unknown_joint', 'name'),
]
# topic, message, code, field; of these without a subject
PLACES: list[tuple[str, Any, str, str]] = [
    ('~/anchor', point(NAN, 0), 'malformed', 'point'),
    ('~/anchor', point(0, INF), 'malformed', 'point'),
    ('~/anchor', point(0, 0, 'map'), 'unknown_frame', 'header.frame_id'),
    ('~/anchor', point(50, 50), 'nothing_there', 'point'),
    ('~/release', point(0, NAN), 'malformed', 'point'),
    ('~/release', point(0, 0, 'map'), 'unknown_frame', 'header.frame_id'),
    ('~/release', point(50, 50), 'nothing_there', 'point'),
    ('~/pin', point(50, 50), 'nothing_there', 'point'),
    ('~/axle', point(50, 50), 'nothing_there', 'point'),
    ('~/pin', point(5, 0), 'anchored', 'point'),
    ('~/axle', point(0, 0, 'map'), 'unknown_frame', 'header.frame_id'),
    ('clicked_point', point(50, 50), 'nothing_there', 'point'),
    ('clicked_point', point(5, 0), 'anchored', 'point'),
    ('clicked_point', point(0, 0, 'map'), 'unknown_frame', 'header.frame_id'),
    ('~/drag/feedback', feedback(DOWN, 9.0, 9.0), 'nothing_there', 'mouse_point'),
    ('~/drag/feedback', feedback(DOWN, NAN, 0.0), 'malformed', 'mouse_point'),
    ('~/drag/feedback', feedback(MOVE, 0.0, INF), 'malformed', 'mouse_point'),
    ('~/drag/feedback', feedback(DOWN, frame='nobody/0'), 'unknown_frame', 'header.frame_id'),
    ('~/drag/feedback', feedback(DOWN, hand='a\nb'), 'malformed', 'client_id'),
    (
        '~/drag/feedback',
        feedback(InteractiveMarkerFeedback.BUTTON_CLICK),
        'bad_property',
        'event_type',
    ),
    ('~/stroke', stroke((0, 0)), 'bad_size', 'poses'),
    ('~/stroke', stroke((0, 0), (NAN, 1), (2, 2)), 'malformed', 'poses'),
    ('~/stroke', stroke(*circle(0, 0, 1), frame='nobody/0'), 'unknown_frame', 'header.frame_id'),
    ('~/walls', spoiled(plan(), 'data', plan().data[:-1]), 'malformed', 'data'),
    ('~/walls', spoiled(plan(), 'info.resolution', 0.0), 'bad_size', 'resolution'),
    ('~/walls', spoiled(plan(), 'info.resolution', NAN), 'malformed', 'resolution'),
    (
        '~/walls',
        spoiled(plan(), 'header.frame_id', 'base_link'),
        'unknown_frame',
        'header.frame_id',
    ),
    (
        '~/walls',
        spoiled(plan(), 'info.origin.orientation.x', 1.0),
        'not_planar',
        'info.origin.orientation',
    ),
    # Just before the oldest step, after the newest one, and as far off as a clock tells.
    *(
        ('~/seek', clock_of(stamp), 'out_of_history', 'clock')
        for stamp in (-3_000_000, 1000 * SECOND, 2_000_000_000 * SECOND)
    ),
    ('~/speed', Float64(data=NAN), 'malformed', 'speed'),
    ('~/speed', Float64(data=INF), 'malformed', 'speed'),
    ('~/speed', Float64(data=65.0), 'bad_property', 'speed'),
    ('~/speed', Float64(data=-65.0), 'bad_property', 'speed'),
]
COMMANDS: list[tuple[Any, str, str]] = [
    (command('a/0', poses=[(0, 0, 0)], frame='map'), 'unknown_frame', 'header.frame_id'),
    (command('a/0', twists=[(0, 0, 0)], frame='map'), 'unknown_frame', 'header.frame_id'),
    (command('a/0', twists=[(1e9, 0, 0)]), 'bad_property', 'twist'),
    (command('a/0', wrenches=[(1e19, 0, 0)]), 'bad_property', 'wrench'),
    (command('new/0', poses=[(0, 0, 0)]), 'unknown_body', 'joint_names'),
    (command('held/0', twists=[(0, 0, 0)]), 'anchored', 'joint_names'),
    (command('held/0', wrenches=[(0, 0, 0)]), 'anchored', 'joint_names'),
]
# topic, message, subject, code, field
REQUESTS: list[tuple[str, Any, str, str, str]] = [
    *(('~/spawn', message, f'{message.ns}/{message.id}', *rest) for message, *rest in SPAWNS),
    ('~/spawn', box('anchor:a/0'), 'anchor:a/0', 'malformed', 'name'),
    *(('~/join', message, 'joint/0', *rest) for message, *rest in JOINTS),
    *((topic, message, '', *rest) for topic, message, *rest in PLACES),
    *(('~/command', message, message.joint_names[0], *rest) for message, *rest in COMMANDS),
    ('~/command', command('a/0', 'a/0'), '', 'malformed', 'joint_names'),
]


@pytest.fixture
def inhabited(physsim: PhysSim) -> PhysSim:
    """Give a world in which something moves and something is held."""
    physsim.spawn(box('a/0', text='{velocity: [1, 2], spin: 3}', lifetime=9.0))
    physsim.spawn(box('held/0', at=(5.0, 0.0), text='{anchored: true}'))
    physsim.command(command('a/0', wrenches=[(1.0, 0.0, 0.0)]))
    physsim.node.set_parameters([Parameter('tool', value='axle')])
    physsim.step(3)
    return physsim


def test_a_bad_request_is_refused_once_by_its_code_and_changes_nothing(
    inhabited: PhysSim, client: Client
) -> None:
    before = inhabited.digest()
    for topic, message, subject, code, field in REQUESTS:
        (event,) = client.ask(topic, message)
        assert event[:6] == (2, topic, subject, event.message, code, field), message
        assert event.message
        assert '\n' not in event.message
        assert inhabited.digest() == before, message


def test_a_refused_request_is_forgotten_when_the_world_goes_on(physsim: PhysSim) -> None:
    # The same world, with and without refusals, goes on to the same bits.
    def digests(client: Client | None) -> list[str]:
        physsim.spawn(box('held/0', size=(9.0, 1.0), text='{anchored: true}'))
        for number in range(5):
            physsim.spawn(disc(f'a/{number}', at=(0.1 * number, 1.0 + number)))
        found = []
        for topic, message, *_ in REQUESTS:
            if client is not None and topic != '~/speed':
                client.ask(topic, message)
            physsim.step()
            found.append(physsim.digest())
        return found

    first = digests(None)
    assert len(set(first)) == len(first)
    physsim.node.simulation.reset()
    assert digests(Client(physsim)) == first


def test_a_spawn_past_the_most_bodies_is_refused(physsim: PhysSim, client: Client) -> None:
    physsim.node.set_parameters([Parameter('max_bodies', value=2)])
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(3.0, 0.0)))
    before = physsim.digest()
    (event,) = client.ask('~/spawn', box('a/2', at=(6.0, 0.0)))
    assert event == Event(2, '~/spawn', 'a/2', event.message, 'world_full', '')
    assert event.message == 'the world would have 3 bodies; max_bodies is 2'
    assert physsim.digest() == before
    # A change in place is no spawn, and a deletion makes room.
    physsim.spawn(disc('a/1', at=(3.0, 0.0)))
    physsim.spawn(delete('a/0'))
    physsim.spawn(box('a/2', at=(6.0, 0.0)))
    assert physsim.names == ('a/1', 'a/2')


def test_refusals_are_answered_in_turn_with_all_else(physsim: PhysSim, client: Client) -> None:
    expected = []
    for number in range(60):
        good = number % 3 == 0
        late = number % 3 == 1
        message = box(f'a/{number}', at=(2.0 * number, 0.0), frame='map' if late else '')
        message.scale.x = 1.0 if good or late else -1.0
        client.publish('~/spawn', message)
        expected.append((f'a/{number}', 0 if good else 2))
    physsim.step()
    assert [(event.hardware_id, event.level) for event in client.events] == expected
