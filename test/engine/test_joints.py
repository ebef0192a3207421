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

"""Joints: which bodies they mean, what they hold, what is refused, and what is left of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Configure,
    Delete,
    DeleteAll,
    Join,
    Pin,
    Release,
    Restore,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.scene import Joint
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import Point
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, DISC, NOWHERE, pose, spawn, twist

KINDS = list(JointKind)
PROPERTIES: dict[JointKind, dict[str, Any]] = {
    JointKind.AXLE: {'lower': -1.0, 'upper': 2.0},
    JointKind.MOTOR: {'rate': -3.0, 'max_torque': 5.0},
    JointKind.SPRING: {'stiffness': 20.0, 'damping': 0.5, 'rest_length': 0.7},
    JointKind.ROPE: {'length': 2.5},
    JointKind.SLIDER: {'lower': -0.2, 'upper': 0.4},
    JointKind.GEAR: {'ratio': -2.0},
}


def joining(
    kind: JointKind | str, points: list[Point], name: str = 'joint/0', **said: Any
) -> Join:
    where = {key: said.pop(key) for key in ('a', 'b', 'frame') if key in said}
    return Join(
        name=name,
        kind=JointKind(kind),
        points=tuple(points),
        properties=JointProperties(**said),
        **where,
    )


def points_of(kind: JointKind) -> list[Point]:
    points: list[Point] = [(0.4, 0.0), (1.4, 0.0)]
    return points[: kind.points]


def pair() -> World:
    """Return a world of two boxes, a/0 below and a/1 above it at half a metre."""
    world = World()
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.3))
    spawn(world, 'a/1', BOX, (0.8, 0.0, -0.2))
    return world


def joints(world: World) -> tuple[Joint, ...]:
    return world.snapshot().scene.joints


def members(world: World) -> tuple[str, str]:
    (joint,) = joints(world)
    return joint.a, joint.b


# Which bodies


def test_the_two_topmost_bodies_under_the_point_are_joined() -> None:
    world = pair()
    spawn(world, 'a/2', BOX, (0.4, 0.0, 0.0))
    world.apply(joining('axle', [(0.4, 0.0)]))
    assert members(world) == ('a/2', 'a/1')


def test_the_only_body_under_the_point_is_joined_to_the_background() -> None:
    world = pair()
    world.apply(joining('axle', [(-0.3, 0.0)]))
    assert members(world) == ('a/0', 'world')


def test_what_was_joined_and_what_was_changed_is_said() -> None:
    world = pair()
    axle = joining('axle', [(0.4, 0.0)], a='a/0', b='world')
    assert world.apply(axle)[1] == 'joined a/0 to the background by axle joint/0'
    assert world.apply(axle)[1] == 'changed axle joint/0 of a/0 and the background'


def test_a_line_joins_the_bodies_at_its_ends() -> None:
    world = pair()
    world.apply(joining('spring', [(1.2, 0.0), (-0.3, 0.0)]))
    assert members(world) == ('a/1', 'a/0')


def test_a_line_from_the_ceiling_hangs_the_body_at_its_end() -> None:
    world = pair()
    world.apply(joining('rod', [(0.0, 5.0), (-0.3, 0.0)]))
    assert members(world) == ('a/0', 'world')
    assert world.snapshot().ends[0].tolist() == pytest.approx(np.array([(-0.3, 0), (0, 5)]))


def test_named_bodies_are_joined_wherever_the_points_are() -> None:
    world = pair()
    world.apply(joining('axle', [(7.0, 7.0)], a='a/0', b='a/1'))
    assert members(world) == ('a/0', 'a/1')


def test_points_may_be_given_in_the_frame_of_a_body() -> None:
    world = pair()
    world.apply(joining('axle', [(-0.4, 0.0)], a='a/0', b='world', frame='a/0'))
    x, y = world.snapshot().ends[0, 0]
    assert (x, y) == pytest.approx((-0.4 * math.cos(0.3), -0.4 * math.sin(0.3)))


@pytest.mark.parametrize(('request_', 'kind'), [(Pin, 'pin'), (Axle, 'axle')])
def test_a_click_gives_the_joint_the_lowest_free_name(request_: Any, kind: str) -> None:
    world = pair()
    names = [world.apply(request_(point=(0.4, 0.0)))[0] for _ in range(3)]
    world.apply(Unjoin(name=f'{kind}/1'))
    assert names == [f'{kind}/0', f'{kind}/1', f'{kind}/2']
    assert world.apply(request_(point=(0.4, 0.0)))[0] == f'{kind}/1'


# Constraints


@pytest.mark.parametrize('kind', [kind for kind in KINDS if kind.points == 1])
def test_a_joint_at_a_point_keeps_it_closed(kind: JointKind) -> None:
    world = pair()
    world.apply(joining(kind, points_of(kind)))
    if kind is JointKind.GEAR:
        return
    world.step(480)
    gap = world.snapshot().ends[0, 0] - world.snapshot().ends[0, 1]
    assert np.hypot(*gap) < 1e-4


def test_a_pin_keeps_bodies_from_turning_against_each_other() -> None:
    world = pair()
    world.apply(joining('pin', [(0.4, 0.0)]))
    world.apply(Command(names=('a/0',), twists=((0.0, 0.0, 5.0),)))
    world.step(480)
    assert pose(world, 'a/0')[2] - pose(world, 'a/1')[2] == pytest.approx(0.5, abs=1e-6)


def test_joined_bodies_pass_through_each_other_unless_they_collide() -> None:
    apart = []
    for collide in (False, True):
        world = World()
        spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0), anchored=True)
        spawn(world, 'a/1', DISC, (0.0, 2.0, 0.0))
        world.apply(joining('rope', [(0.0, 2.0), (0.0, 0.0)], length=5.0, collide=collide))
        world.step(480)
        apart.append(float(pose(world, 'a/1')[1]))
    assert apart[0] < 0.0
    assert apart[1] == pytest.approx(1.0, abs=0.01)


def test_a_joint_to_the_background_does_not_open_the_walls() -> None:
    world = World()
    world.apply(Configure(changes={'bounds': (-5.0, 0.0, 5.0, 10.0)}))
    spawn(world, 'a/0', DISC, (0.0, 1.0, 0.0))
    world.apply(joining('rope', [(0.0, 1.0), (0.0, 9.0)], a='a/0', b='world', length=20.0))
    world.step(480)
    assert pose(world, 'a/0')[1] > 0.48


@pytest.mark.parametrize(
    ('said', 'least', 'most'),
    [({'lower': 0.0, 'upper': 0.0}, -1e-3, 1e-3), ({'lower': 1e4}, 1.0, 1e4)],
)
def test_a_slider_may_have_limits_that_leave_no_way(
    said: dict[str, float], least: float, most: float
) -> None:
    world = pair()
    points = points_of(JointKind.SLIDER)
    world.apply(joining(JointKind.SLIDER, points, a='a/0', b='world', **said))
    before = pose(world, 'a/0')
    world.step(240)
    x, *_ = np.subtract(pose(world, 'a/0'), before)
    assert least < x < most


def test_a_joint_gives_no_more_than_its_greatest_force() -> None:
    world = World()
    spawn(world, 'a/0', BOX, mass=1.0)
    world.apply(joining('pin', [(0.0, 0.0)], max_force=4.0))
    world.step(240)
    assert -twist(world, 'a/0')[1] == pytest.approx(9.81 - 4.0, rel=0.02)


def test_the_force_of_a_joint_is_the_weight_that_hangs_on_it() -> None:
    world = World()
    spawn(world, 'a/0', BOX, mass=2.0)
    world.apply(joining('axle', [(0.0, 0.4)], a='a/0', b='world'))
    world.step(240)
    assert world.snapshot().forces.tolist() == pytest.approx([2.0 * 9.81], rel=1e-3)


def test_a_joint_breaks_where_it_is_loaded_too_much_and_that_is_told() -> None:
    sim = Simulation()
    spawn(sim.world, 'a/0', BOX, mass=1.0)
    sim.perform(joining('axle', [(0.0, 0.0)], break_force=5.0))
    answers = [answer for _ in range(3) for answer in sim.advance_frame().answers]
    (broken,) = [answer for answer in answers if answer.code == 'joint_broken']
    assert broken.subject == 'joint/0'
    assert joints(sim.world) == ()


def test_a_joint_that_is_strong_enough_does_not_break() -> None:
    world = World()
    spawn(world, 'a/0', BOX, mass=1.0)
    world.apply(joining('axle', [(0.0, 0.0)], break_force=15.0))
    world.step(480)
    assert world.take_broken() == []
    assert len(joints(world)) == 1


@pytest.mark.parametrize('height', [0.3, 5.1])
def test_what_breaks_lets_go_alike_however_steps_are_counted_out(height: float) -> None:
    worlds = []
    for _ in range(2):
        world = World(settings=WorldSettings(bounds=(-40.0, 0.0, 40.0, 90.0)))
        spawn(world, 'a/0', BOX, (0.0, 10.0, 0.0), velocity=(4.0, 0.0))
        spawn(world, 'a/1', BOX, (3.0, height, 0.3))
        ends = [(0.0, 10.0), (3.0, height)]
        world.apply(joining('rope', ends, length=4.0, break_force=60.0, a='a/0', b='a/1'))
        worlds.append(world)

    worlds[0].step(480)
    for _ in range(480):
        worlds[1].step(1)

    assert np.array_equal(*(world.snapshot().poses for world in worlds))
    assert worlds[0].take_broken() == worlds[1].take_broken() != []


def energies(world: World, steps: int) -> list[float]:
    """Return the energy after each step [J]."""
    found = []
    for _ in range(steps):
        world.step(1)
        now = world.snapshot()
        found.append(now.kinetic_energy + now.potential_energy + now.elastic_energy)
    return found


@pytest.mark.parametrize(
    ('said', 'least', 'most'),
    [
        # The stiffest that steps of 1/240 s can follow with 1 kg, 1 mm off: 0.0288 J, and once
        # more of that since the engine moves first and pulls then.
        ({'stiffness': 57600.0, 'rest_length': 1.999}, 0.0287, 0.0577),
        # It pulls with 1 N over all of the two metres but the last centimetre.
        ({'stiffness': 100.0, 'max_force': 1.0, 'rest_length': 0.0}, 1.99, 2.0),
        ({'stiffness': 0.0, 'max_force': 1e12, 'rest_length': 0.0}, 0.0, 0.0),
    ],
)
@pytest.mark.filterwarnings('error')
def test_the_energy_of_a_spring_is_that_of_the_one_which_the_engine_has(
    said: dict[str, Any], least: float, most: float
) -> None:
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', DISC, mass=1.0)
    world.apply(joining('spring', [(0.0, 0.0), (2.0, 0.0)], a='a/0', b='world', **said))
    assert least <= world.snapshot().elastic_energy <= most

    found = energies(world, 240)

    assert least <= min(found)
    assert max(found) <= most


def test_the_energy_of_springs_is_the_same_where_the_past_is_shown() -> None:
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', DISC)
    for number, stiffness in enumerate((1e4, 20.0)):
        line: list[Point] = [(0.0, 0.0), (0.0, 2.0)]
        said = {'stiffness': stiffness, 'rest_length': 1.9, 'a': 'a/0', 'b': 'world'}
        world.apply(joining('spring', line, f'spring/{number}', **said))
    world.step(48)
    shown = world.snapshot()

    again = World(settings=NOWHERE)
    again.resume(world.renew())

    assert shown.elastic_energy > 0.0
    assert again.snapshot().elastic_energy == shown.elastic_energy
    assert world.snapshot().elastic_energy == shown.elastic_energy


@pytest.mark.parametrize('stiffness', [1e5, 1e9])
def test_a_spring_that_is_too_stiff_is_refused_with_the_greatest_that_can_be_had(
    stiffness: float,
) -> None:
    world = World()
    spawn(world, 'a/0', Disc(radius=0.1), (0.0, 0.0, 0.0), mass=1.0)
    before, line = world.digest(), [(0.0, 0.0), (0.0, 1.0)]
    with pytest.raises(Refusal, match='57600 N/m') as caught:
        world.apply(joining('spring', line, stiffness=stiffness))
    assert (caught.value.code, caught.value.field) == ('bad_property', 'stiffness')
    assert world.digest() == before
    world.apply(joining('spring', line, stiffness=57600.0))


def test_springs_on_a_body_count_together() -> None:
    world = World()
    spawn(world, 'a/0', Disc(radius=0.1), (0.0, 0.0, 0.0), mass=1.0)
    line: list[Point] = [(0.0, 0.0), (0.0, 1.0)]
    world.apply(joining('spring', line, 'spring/0', stiffness=40000.0))
    with pytest.raises(Refusal, match='17600 N/m'):
        world.apply(joining('spring', line, 'spring/1', stiffness=20000.0))


def test_a_body_does_not_become_too_light_for_its_springs() -> None:
    world = World()
    spawn(world, 'a/0', Disc(radius=0.1), (0.0, 0.0, 0.0), mass=1.0)
    world.apply(joining('spring', [(0.0, 0.0), (0.0, 1.0)], stiffness=40000.0))
    before = world.digest()
    with pytest.raises(Refusal, match='28800 N/m'):
        spawn(world, 'a/0', Disc(radius=0.1), (0.0, 0.0, 0.0), mass=0.5)
    assert world.digest() == before


# Removal


@pytest.mark.parametrize('kind', KINDS)
def test_a_joint_goes_with_its_body(kind: JointKind) -> None:
    world = pair()
    world.apply(joining(kind, points_of(kind)))
    world.apply(Delete(name='a/1'))
    world.step(10)
    assert joints(world) == ()


def test_clearing_the_world_clears_its_joints() -> None:
    world = pair()
    world.apply(joining('axle', [(0.4, 0.0)]))
    world.apply(DeleteAll())
    assert joints(world) == ()


def test_a_joint_is_deleted_by_its_name_and_all_of_a_namespace_together() -> None:
    world = pair()
    for name in ('x/0', 'x/1', 'y/0'):
        world.apply(joining('axle', [(0.4, 0.0)], name))
    world.apply(Unjoin(name='x/0'))
    assert [joint.name for joint in joints(world)] == ['x/1', 'y/0']
    world.apply(UnjoinAll(namespace='x'))
    assert [joint.name for joint in joints(world)] == ['y/0']
    world.apply(UnjoinAll())
    assert joints(world) == ()


@pytest.mark.parametrize('kind', KINDS)
def test_a_body_that_is_changed_in_place_keeps_its_joints(kind: JointKind) -> None:
    world = pair()
    world.apply(joining(kind, points_of(kind), **PROPERTIES.get(kind, {})))
    before = joints(world)
    spawn(world, 'a/1', DISC, (0.8, 0.0, -0.2), mass=3.0)
    assert joints(world) == before
    world.step(60)
    assert np.isfinite(world.snapshot().poses).all()


@pytest.mark.parametrize('kind', KINDS)
def test_a_joint_waits_while_both_its_bodies_are_anchored(kind: JointKind) -> None:
    world = pair()
    world.apply(joining(kind, points_of(kind)))
    held = pose(world, 'a/0').tolist(), pose(world, 'a/1').tolist()
    world.apply(Anchor(point=(-0.3, 0.0)))
    world.apply(Anchor(point=(1.2, 0.0)))
    world.step(24)
    assert (pose(world, 'a/0').tolist(), pose(world, 'a/1').tolist()) == held
    world.apply(Release(point=(1.2, 0.0)))
    world.step(24)
    assert pose(world, 'a/0').tolist() == held[0]
    assert len(joints(world)) == 1


def test_a_command_of_a_yaw_does_not_wind_a_joint_up() -> None:
    world = World()
    spawn(world, 'a/0', BOX, spin=20.0)
    spawn(world, 'a/1', BOX, (0.8, 0.0, 0.0))
    world.apply(joining('pin', [(0.4, 0.0)]))
    world.step(480)
    x, y, yaw = pose(world, 'a/0').tolist()
    world.apply(Command(names=('a/0',), poses=((x, y, math.remainder(yaw, math.tau)),)))
    spin = twist(world, 'a/0')[2]
    world.step(1)
    assert twist(world, 'a/0')[2] == pytest.approx(spin, abs=1e-3)


def test_releasing_a_body_removes_the_pins_and_axles_there() -> None:
    world = pair()
    world.apply(Pin(point=(0.4, 0.0)))
    world.apply(Axle(point=(0.4, 0.0)))
    world.apply(joining('axle', [(1.2, 0.0)], a='a/1', b='world'))
    world.apply(Release(point=(0.4, 0.0)))
    assert [joint.name for joint in joints(world)] == ['joint/0']


def test_releasing_a_long_body_leaves_the_axles_farther_along_it() -> None:
    world = World()
    spawn(world, 'plank/0', Box(width=20.0, height=1.0))
    for x in (0.1, 2.4):
        world.apply(Axle(point=(x, 0.0)))
    world.apply(Release(point=(0.0, 0.0)))
    assert [joint.name for joint in joints(world)] == ['axle/1']


@pytest.mark.parametrize('kind', KINDS)
def test_what_is_asked_for_again_where_it_is_changes_nothing(kind: JointKind) -> None:
    world = pair()
    request = joining(kind, points_of(kind), a='a/0', b='a/1', **PROPERTIES.get(kind, {}))
    world.apply(request)
    before = world.digest()
    world.apply(request)
    assert world.digest() == before


def test_a_joint_that_is_changed_keeps_what_is_not_said() -> None:
    world = pair()
    world.apply(joining('spring', [(0.4, 0.0), (-0.3, 0.0)], stiffness=7.0, damping=1.0))
    world.apply(joining('spring', [(0.4, 0.1), (-0.3, 0.0)], stiffness=9.0))
    (joint,) = joints(world)
    assert (joint.properties.stiffness, joint.properties.damping) == (9.0, 1.0)


# The same bits


def machine() -> World:
    world = World()
    for number in range(6):
        spawn(world, f'a/{number}', Box(width=1.0, height=0.3), (number * 0.9, 3.0, 0.1 * number))
    spawn(world, 'ground/0', Box(width=40.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    for number, kind in enumerate(KINDS):
        request = joining(
            kind,
            [(number * 0.6, 3.0), (number * 0.6 + 0.9, 3.0)][: kind.points],
            f'joint/{number}',
            a=f'a/{number % 6}',
            b='world' if number % 3 == 0 else f'a/{(number + 1) % 6}',
            **PROPERTIES.get(kind, {}),
        )
        world.apply(request)
    return world


def test_worlds_of_the_same_requests_go_on_to_the_bit() -> None:
    one, other = machine(), machine()
    one.step(480)
    other.step(480)
    assert one.digest() == other.digest()


def test_worlds_of_the_same_state_go_on_to_the_bit() -> None:
    world = machine()
    world.step(200)
    state = world.save()
    one, other = World(), World()
    one.apply(Restore(state=state))
    other.apply(Restore(state=state))
    one.step(300)
    other.step(300)
    assert one.save().joints == state.joints
    assert one.digest() == other.digest()


def test_a_world_goes_on_from_a_checkpoint_to_the_bit() -> None:
    world = machine()
    world.step(200)
    key = world.renew()
    world.step(300)
    first = world.digest()
    world.resume(key)
    world.step(300)
    assert world.digest() == first


def test_scenes_are_the_same_object_until_a_joint_comes_or_goes() -> None:
    world = pair()
    before = world.snapshot().scene
    world.apply(joining('axle', [(0.4, 0.0)]))
    joined = world.snapshot().scene
    world.step(10)
    assert world.snapshot().scene is joined is not before


# Refused

REFUSED: dict[str, tuple[dict[str, Any], str, str]] = {
    'itself': ({'a': 'a/0', 'b': 'a/0'}, 'bad_property', 'b'),
    'the background first': ({'a': 'world', 'b': 'a/0'}, 'bad_property', 'a'),
    'a missing a': ({'a': 'x/0'}, 'unknown_body', 'a'),
    'a missing b': ({'a': 'a/0', 'b': 'x/0'}, 'unknown_body', 'b'),
    'two anchored bodies': ({'a': 'fix/0', 'b': 'fix/1'}, 'anchored', 'a'),
    'an anchored body and the background': ({'a': 'fix/0', 'b': 'world'}, 'anchored', 'a'),
    'nothing there': ({'points': [(50.0, 50.0)]}, 'nothing_there', 'points'),
    'an unknown frame': ({'frame': 'x/9'}, 'unknown_frame', 'header.frame_id'),
    'a point that is none': ({'points': [(math.nan, 0.0)]}, 'malformed', 'points'),
    'a point too many': ({'points': [(0.4, 0.0), (0.5, 0.0)]}, 'malformed', 'points'),
    'no point': ({'points': []}, 'malformed', 'points'),
    'no name': ({'name': 'joint'}, 'malformed', 'name'),
    'a rod without a length': (
        {'kind': 'rod', 'points': [(0.4, 0.0), (0.4, 0.0)]},
        'bad_size',
        'points',
    ),
    'a property of another kind': ({'stiffness': 3.0}, 'unknown_property', 'stiffness'),
    'a limit that is no number': ({'lower': math.inf}, 'malformed', 'lower'),
    'limits crossed': ({'lower': 2.0, 'upper': 1.0}, 'bad_property', 'lower'),
    'a ratio of nothing': ({'kind': 'gear', 'ratio': 0.0}, 'bad_property', 'ratio'),
    'a negative stiffness': (
        {'kind': 'spring', 'points': [(0.4, 0.0), (1.0, 0.0)], 'stiffness': -1.0},
        'bad_property',
        'stiffness',
    ),
    'a negative force': ({'break_force': -1.0}, 'bad_property', 'break_force'),
    'a word for a flag': ({'collide': 'yes'}, 'bad_property', 'collide'),
}


@pytest.mark.parametrize(('said', 'code', 'field'), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_joined_is_refused_and_changes_nothing(
    said: dict[str, Any], code: str, field: str
) -> None:
    world = pair()
    spawn(world, 'fix/0', BOX, (20.0, 0.0, 0.0), anchored=True)
    spawn(world, 'fix/1', BOX, (21.0, 0.0, 0.0), anchored=True)
    before = world.digest()
    values = {'kind': 'axle', 'points': [(0.4, 0.0)]} | said
    with pytest.raises(Refusal) as caught:
        world.apply(joining(values.pop('kind'), values.pop('points'), **values))
    assert (caught.value.code, caught.value.field) == (code, field)
    assert world.digest() == before


def test_an_unknown_joint_cannot_be_deleted() -> None:
    world = pair()
    before = world.digest()
    with pytest.raises(Refusal) as caught:
        world.apply(Unjoin(name='joint/9'))
    assert caught.value.code == 'unknown_joint'
    assert world.digest() == before


# Push and pull


@pytest.mark.parametrize('gravity', [-9.81, 9.81], ids=['hanging', 'standing'])
@pytest.mark.parametrize('kind', ['rod', 'spring'])
@pytest.mark.parametrize('reverse', [False, True], ids=['from above', 'from below'])
def test_a_rod_or_spring_under_a_weight_pushes_and_over_one_it_pulls(
    kind: str, gravity: float, *, reverse: bool
) -> None:
    world = World()
    world.apply(Configure(changes={'gravity': (0.0, gravity)}))
    spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0))
    spawn(world, 'a/1', DISC, (0.0, 4.0, 0.0), anchored=True)
    points = [(0.0, 4.0), (0.0, 0.0)]
    names = {'a': 'a/1', 'b': 'a/0'}
    if reverse:
        points, names = points[::-1], {'a': 'a/0', 'b': 'a/1'}
    said = {'stiffness': 200.0, 'damping': 5.0} if kind == 'spring' else {}
    world.apply(joining(kind, points, **names, **said))
    world.step(240)
    snapshot = world.snapshot()
    assert snapshot.forces == pytest.approx([DISC.form.area * abs(gravity)], rel=0.2)
    # Gravity upward presses the body against what is above it.
    assert snapshot.compressed.tolist() == [gravity > 0]
