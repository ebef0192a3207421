# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests are checked as far as they alone can tell; the world does not see the others."""

from dataclasses import fields, FrozenInstanceError
import functools
import itertools
import math
import re
from typing import Any

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import FARTHEST, FASTEST, HEAVIEST, LONGEST
from physsim_ros.model.errors import BadProperty, Malformed, Refusal, UnknownProperty
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    ChangeBody,
    Command,
    Configure,
    Cut,
    Delete,
    DeleteAll,
    DeleteBodies,
    DriveRobot,
    Grab,
    Join,
    KeepHand,
    LetGo,
    MoveBodies,
    MoveHand,
    Pin,
    Rejoin,
    Release,
    Request,
    Restore,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
import pytest

from ..building import refusal

DISC = Disc(radius=0.5)
REST = (0.0, 0.0, 0.0)
NOT_FINITE = [math.nan, math.inf, -math.inf]


def test_a_spawn_needs_a_name_and_a_shape_only():
    request = Spawn(name='a/0', shape=DISC)

    assert (request.pose, request.frame, request.color, request.lifetime) == (REST, '', None, 0.0)
    assert request.properties == Properties()


@pytest.mark.parametrize('name', ['', 'a', '/1', 'a/x', 'a' * 2000 + '/1'])
def test_a_spawn_under_no_name_is_malformed(name):
    assert refusal(Spawn, name=name, shape=DISC) == (Malformed, 'name')


@pytest.mark.parametrize('pose', [(), (0.0,), (0.0, 0.0), (0.0, 0.0, 0.0, 0.0), 'far'])
def test_a_pose_has_three_numbers(pose):
    with pytest.raises(Malformed, match=re.escape(f'pose needs 3 numbers, not {pose!r}')):
        Spawn(name='a/0', shape=DISC, pose=pose)


def arguments() -> dict[type[Request], dict[str, Any]]:
    """Return for each kind of request what its constructor needs."""
    hand, at = {'hand': 'mouse'}, {'point': (0.0, 0.0)}
    name, names = {'name': 'a/0'}, {'names': ('a/0',)}
    return {
        Spawn: {**name, 'shape': DISC},
        ChangeBody: name,
        MoveBodies: {**names, 'by': (0.0, 0.0)},
        Command: names,
        Anchor: at,
        Release: at,
        Delete: name,
        DeleteBodies: names,
        DeleteAll: {},
        Join: {**name, 'kind': JointKind.ROD, 'points': ((0.0, 0.0), (1.0, 0.0))},
        Cut: {'pieces': (ChangeBody(name='a/0'),)},
        Rejoin: {**name, 'a': 'a/0', 'b': 'world'},
        Unjoin: name,
        UnjoinAll: {},
        Pin: at,
        Axle: at,
        Grab: {**hand, **at},
        MoveHand: {**hand, **at},
        KeepHand: hand,
        LetGo: hand,
        DriveRobot: {**name, 'velocity': REST},
        Configure: {'changes': {}},
        Restore: {'state': WorldState(settings=WorldSettings())},
    }


def field_of(kind: type[Request], name: str) -> str:
    """Return the field that a refusal names, which is that of the message."""
    if kind is Command:
        arrays = {'poses': 'transforms', 'twists': 'twist', 'wrenches': 'wrench'}
        return {'names': 'joint_names', **arrays}.get(name, name)
    if issubclass(kind, Grab | MoveHand) and name in {'point', 'yaw'}:
        return 'mouse_point'
    return 'client_id' if name == 'hand' else name


@pytest.mark.parametrize('kind', arguments())
def test_a_field_of_another_type_is_malformed(kind):
    known = arguments()[kind]
    kind(**known)
    for each in fields(kind):
        for wrong in (object(), None):
            if wrong is None and each.default is None:
                continue
            with pytest.raises(Malformed) as refused:
                kind(**{**known, each.name: wrong})
            assert refused.value.field == field_of(kind, each.name)


def test_the_refusal_of_a_type_names_the_types_that_there_are():
    with pytest.raises(Malformed, match='shape must be of class Disc, Box, Polygon'):
        Spawn(name='a/0', shape='disc')
    with pytest.raises(Malformed, match='names must be a list of texts'):
        DeleteBodies(names='a/0')
    with pytest.raises(Malformed, match='each transforms needs 3 numbers'):
        Command(names=('a/0',), poses=(('1', '2', '3'),))


def test_a_point_or_pose_may_be_a_list_or_an_array():
    move = MoveBodies(names=['a/0'], by=np.array([1, 2]))

    assert repr(move) == "MoveBodies(names=('a/0',), by=(1.0, 2.0))"
    assert Spawn(name='a/0', shape=DISC, pose=[0, 1, np.float32(0.5)]).pose == (0.0, 1.0, 0.5)


def test_a_kind_of_joint_may_be_its_word():
    known: dict[str, Any] = {'name': 'a/0', 'points': ((0.0, 0.0), (1.0, 0.0))}
    assert Join(kind='rod', **known).kind is JointKind.ROD
    with pytest.raises(BadProperty, match="nearest is 'rod'"):
        Join(kind='rodd', **known)


def each_place(value: float) -> list[tuple[float, ...]]:
    """Return three numbers, of which one is the value, for each place of it."""
    return [tuple(value if k == place else 0.0 for k in range(3)) for place in range(3)]


@pytest.mark.parametrize(
    ('array', 'field', 'most'),
    [('poses', 'transforms', FARTHEST), ('twists', 'twist', FASTEST),
     ('wrenches', 'wrench', HEAVIEST)],
)  # fmt: skip
def test_a_command_takes_three_finite_numbers_of_each_body_in_their_range(array, field, most):
    def refused(kind: type[Refusal], *rows: object) -> None:
        assert refusal(Command, names=('a/0', 'a/1'), **{array: rows}) == (kind, field)

    for sign in (1.0, -1.0):
        for row in each_place(sign * most):
            command = Command(names=('a/0', 'a/1'), **{array: (REST, row)})
            assert getattr(command, array).tolist() == [list(REST), list(row)]
        for row in each_place(sign * math.nextafter(most, math.inf)):
            refused(BadProperty, REST, row)
    for value in NOT_FINITE:
        for row in each_place(value):
            refused(Malformed, REST, row)
    for other in ((), (1.0, 2.0), (1.0, 2.0, 3.0, 4.0)):
        refused(Malformed, other, other)
    refused(Malformed, REST)
    refused(Malformed, REST, REST, REST)


def test_a_velocity_is_at_most_the_fastest_in_any_direction():
    Command(names=('a/0',), twists=((0.6 * FASTEST, -0.8 * FASTEST, -FASTEST),))
    for twist in ((0.8 * FASTEST, 0.8 * FASTEST, 0.0), (1e308, 1e308, 0.0)):
        with pytest.raises(BadProperty):
            Command(names=('a/0',), twists=(twist,))


@pytest.mark.parametrize('velocity', [(math.nan, 0.0, 0.0), (0.0, math.inf, 0.0), (0.0, 1.0)])
def test_a_command_of_a_robot_is_three_finite_numbers(velocity):
    assert refusal(DriveRobot, name='a/0', velocity=velocity) == (Malformed, 'velocity')
    with pytest.raises(BadProperty):
        DriveRobot(name='a/0', velocity=(1e6, 0.0, 0.0))


def test_a_pose_of_a_spawn_is_finite_and_not_too_far():
    for pose in each_place(-FARTHEST):
        assert Spawn(name='a/0', shape=DISC, pose=pose).pose == pose
    for value, kind in (
        *((each, Malformed) for each in NOT_FINITE),
        (1.1 * FARTHEST, BadProperty),
    ):
        for pose in each_place(value):
            assert refusal(Spawn, name='a/0', shape=DISC, pose=pose) == (kind, 'pose')


@pytest.mark.parametrize(
    ('color', 'error'),
    [((0.0, 0.0, 0.0), Malformed), ((0.0,) * 5, Malformed), ((0.0, 0.0, math.nan, 1.0), Malformed),
     ((0.0, 0.0, 1.1, 1.0), BadProperty), ((-0.1, 0.0, 0.0, 1.0), BadProperty)],
)  # fmt: skip
def test_a_colour_has_four_channels_of_0_to_1(color, error):
    assert refusal(Spawn, name='a/0', shape=DISC, color=color) == (error, 'color')


def test_a_colour_of_whole_numbers_is_the_same_colour():
    assert repr(Spawn(name='a/0', shape=DISC, color=(0, 1, 0, 1)).color) == '(0.0, 1.0, 0.0, 1.0)'


@pytest.mark.parametrize(
    ('lifetime', 'error'),
    [(math.nan, Malformed), (math.inf, Malformed), (-1e-9, BadProperty), (-1.0, BadProperty),
     (math.nextafter(LONGEST, math.inf), BadProperty), (1e308, BadProperty)],
)  # fmt: skip
def test_a_lifetime_is_a_time(lifetime, error):
    assert refusal(Spawn, name='a/0', shape=DISC, lifetime=lifetime) == (error, 'lifetime')
    assert Spawn(name='a/0', shape=DISC, lifetime=LONGEST).lifetime == LONGEST


@pytest.mark.parametrize('kind', [Anchor, Release])
def test_a_point_is_finite_and_not_too_far(kind):
    assert kind(point=(FARTHEST, -FARTHEST)).frame == ''
    for value in NOT_FINITE:
        for point in ((value, 0.0), (0.0, value)):
            with pytest.raises(Malformed):
                kind(point=point)
    for point in ((), (1.0,), (1.0, 2.0, 3.0)):
        with pytest.raises(Malformed):
            kind(point=point)
    with pytest.raises(BadProperty):
        kind(point=(2 * FARTHEST, 0.0))


@pytest.mark.parametrize('arrays', [*itertools.product([(), (REST,)], repeat=3)])
def test_a_command_may_leave_any_array_empty(arrays):
    poses, twists, wrenches = arrays
    command = Command(names=('a/0',), poses=poses, twists=twists, wrenches=wrenches)
    of_command = command.poses, command.twists, command.wrenches
    assert [each.tolist() for each in of_command] == [[*map(list, each)] for each in arrays]


def test_a_command_does_not_change_with_the_arrays_that_it_was_made_of():
    poses = np.zeros((1, 3))
    command = Command(names=('a/0',), poses=poses)

    poses[:] = 7.0

    assert command == Command(names=('a/0',), poses=np.zeros((1, 3)))
    assert len({command, Command(names=('a/0',), poses=np.zeros((1, 3)))}) == 1
    assert command != Command(names=('a/0',), poses=poses)
    assert command != Delete(name='a/0')
    with pytest.raises(ValueError, match='read-only'):
        command.poses[0] = 7.0


def test_bodies_are_named_each_once():
    for names in ((), ('a/0', 'a/0')):
        for make in (DeleteBodies, functools.partial(MoveBodies, by=(1, 0))):
            with pytest.raises(Refusal):
                make(names=names)
    for names in ((), ('a/0', 'a/0'), ('a/0', 'b/0', 'a/0')):
        assert refusal(Command, names=names) == (Malformed, 'joint_names')


def test_a_property_that_there_is_not_cannot_be_unset():
    with pytest.raises(UnknownProperty, match="nearest is 'friction'"):
        ChangeBody(name='a/0', unset=('frictoin',))


def test_a_change_of_settings_names_settings():
    assert Configure(changes={'damping': 0.5}).changes == {'damping': 0.5}
    assert refusal(Configure, changes={'damping': 0.5, 'speed': 1.0}) == (BadProperty, 'speed')


def test_a_change_of_settings_has_values_that_settings_have():
    assert refusal(Configure, changes={'gravity': 'down'}) == (BadProperty, 'gravity')
    assert refusal(Configure, changes={'damping': math.nan}) == (Malformed, 'damping')
    assert refusal(Configure, changes={5: 1.0}) == (BadProperty, '5')
    assert Configure(changes={'bounds': None}).changes == {'bounds': None}


def lists_of(value: object) -> Any:
    """Return a value with lists in place of tuples, which others can change."""
    if isinstance(value, tuple | list):
        return [lists_of(each) for each in value]
    if isinstance(value, dict):
        return {key: lists_of(each) for key, each in value.items()}
    return value


def spoil(value: object) -> None:
    """Change all lists and mappings of a value."""
    if isinstance(value, list | dict):
        for each in value if isinstance(value, list) else value.values():
            spoil(each)
        value.clear()


SETTINGS = {name: getattr(WorldSettings(), name) for name in WorldSettings.FIELDS}
BOUNDS = {'bounds': (-1.0, -1.0, 1.0, 1.0), 'datum': (50.0, 8.0)}


@pytest.mark.parametrize('kind', arguments())
def test_no_request_changes_with_the_values_that_it_was_made_of(kind):
    known = {**arguments()[kind], **({'changes': SETTINGS | BOUNDS} if kind is Configure else {})}
    # The parts of a cut are requests themselves, and frozen.
    given = known if kind is Cut else lists_of(known)
    request = kind(**given)
    before = repr(request)

    spoil(given)

    assert repr(request) == before


def test_requests_are_frozen():
    for request in (
        Spawn(name='a/0', shape=DISC),
        Delete(name='a/0'),
        DeleteAll(),
        Anchor(point=(0.0, 0.0)),
        Command(names=('a/0',)),
        Configure(changes={}),
    ):
        with pytest.raises(FrozenInstanceError):
            setattr(request, fields(request)[0].name, 'b/0')
