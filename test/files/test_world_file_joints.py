# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a world file, saved and written by hand."""

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Join
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World
import pytest

from .world_files import (
    assert_round_trip,
    edited,
    loaded,
    RATE,
    refusal_of,
    restored,
    rewrite,
    save,
)
from ..building import BOX, command, DISC, pose, spawn

MACHINE = """format: 1
bodies:
  - {name: arm/0, box: {width: 1, height: 0.1}, at: [0.5, 2]}
  - {name: arm/1, box: {width: 1, height: 0.1}, at: [1.5, 2]}
  - {name: ball/0, circle: {radius: 0.3}, at: [3, 2]}
joints:
  - {name: joint/0, kind: axle, a: arm/0, points: [[0, 2]], lower: -2}
  - {name: joint/1, kind: pin, points: [[1, 2]]}
  - {name: joint/2, kind: spring, a: arm/1, b: ball/0, points: [[2, 2], [3, 2]], stiffness: 30}
  - {name: joint/3, kind: rope, a: ball/0, b: world, points: [[3, 2], [3, 5]], length: 3.5}
  - {name: joint/4, kind: slider, a: ball/0, b: world, points: [[3, 2], [3, 3]], max_force: 2}
"""


@pytest.fixture
def weightless() -> World:
    """Return an empty world without gravity."""
    return World(settings=WorldSettings(gravity=(0.0, 0.0)))


def join(world: World, name: str, kind: str, *points: Point, a: str, b: str, **said: Any) -> None:
    kinds, properties = JointKind(kind), JointProperties(**said)
    world.apply(Join(name=name, kind=kinds, points=points, a=a, b=b, properties=properties))


HOIST = """format: 1
bodies:
  - {name: wheel/0, circle: {radius: 0.5}, at: [0, 5]}
  - {name: box/0, box: {width: 0.4, height: 0.4}, at: [-0.5, 2], mass: 2}
  - {name: box/1, box: {width: 0.4, height: 0.4}, at: [1.5, 2], mass: 3}
joints:
  - {name: joint/0, kind: axle, a: wheel/0, b: world, points: [[0, 5]]}
  - {name: joint/1, kind: rope, a: box/0, b: box/1, over: [wheel/0, world], rate: -0.3, lower: 2,
     points: [[-0.5, 2], [0, 5], [1.5, 5], [1.5, 2]]}
"""


def test_a_winch_over_a_wheel_round_trips_to_the_bit_while_it_winds(folder: Path) -> None:
    world = loaded(HOIST, folder)
    rope = world.save().joints[1]
    assert [guide.radius for guide in rope.guides] == [-0.5, 0.0]
    world.step(333)

    assert world.save().joints[1].rest_length == pytest.approx(rope.rest_length - 0.3 * 333 / RATE)
    assert_round_trip(world, folder)


PLANETARY = """format: 1
bodies:
  - {name: arm/0, box: {width: 1, height: 0.1}, at: [0, 0, 0.3]}
  - {name: planet/0, circle: {radius: 0.2}, at: [0.4, 0, 1], spin: 3}
joints:
  - {name: joint/0, kind: motor, a: arm/0, b: world, points: [[0, 0]], rate: 2}
  - {name: joint/1, kind: axle, a: planet/0, b: arm/0, points: [[0.4, 0]]}
  - {name: joint/2, kind: gear, a: planet/0, b: world, carrier: arm/0, ratio: -1,
     points: [[0.2, 0]]}
"""


def test_a_gear_about_a_carrier_round_trips_to_the_bit(folder: Path) -> None:
    world = loaded(PLANETARY, folder)
    gear = world.save().joints[2]
    assert gear.bodies == ('planet/0', 'world', 'arm/0')
    # Against the arm, the world is turned by -0.3 rad, and the planet by 0.7 rad.
    assert gear.seat.phase == pytest.approx(0.3 - (1.0 - 0.3))
    world.step(333)

    assert_round_trip(world, folder)


def test_a_joint_whose_points_somebody_edited_sits_at_the_new_ones(folder: Path) -> None:
    world = loaded(MACHINE, folder)

    def edit(content: dict[str, Any]) -> None:
        assert content['joints'][0]['points'] == [[0.0, 2.0]]
        content['joints'][0]['points'] = [[0.25, 2.0]]

    first, *others = rewrite(save(world, folder), edit).joints
    assert first.seat.ax == pytest.approx(-0.25)
    assert tuple(others) == world.save().joints[1:]


@pytest.mark.parametrize('kind', ['rod', 'slider'])
@pytest.mark.parametrize('x', [2.0, 2.0 + 1e-5])
def test_a_joint_whose_ends_have_come_together_round_trips(
    kind: str, x: float, weightless: World, folder: Path
) -> None:
    spawn(weightless, 'b/0', DISC)
    join(weightless, 'j/0', kind, (0.0, 0.0), (2.0, 0.0), a='b/0', b='world')
    command(weightless, 'b/0', pose=(x, 0.0, 0.0))

    assert_round_trip(weightless, folder)


def test_jointed_bodies_that_have_flown_further_than_anyone_may_ask_round_trip(
    weightless: World, folder: Path
) -> None:
    for number in range(2):
        place = (9.999e6 + number, 0.0, 0.0)
        spawn(weightless, f'b/{number}', DISC, place, velocity=(1e5, 0.0))
    join(weightless, 'j/0', 'axle', (9.999e6, 0.0), a='b/0', b='b/1')
    weightless.step(6)
    assert pose(weightless, 'b/0')[0] > 1e7

    assert len(weightless.save().joints) == 1
    assert_round_trip(weightless, folder)


def test_a_body_that_was_turned_in_the_file_about_a_pin_stays_turned(
    weightless: World, folder: Path
) -> None:
    spawn(weightless, 'a/0', BOX)
    join(weightless, 'j/0', 'pin', (0.0, 0.0), a='a/0', b='world')

    again = edited(save(weightless, folder), {'at': [0.0, 0.0, 0.5]})

    again.step(120)
    assert pose(again, 'a/0') == pytest.approx((0.0, 0.0, 0.5), abs=1e-9)


def test_a_body_that_was_moved_in_the_file_below_another_ones_pin_stays_there(
    weightless: World, folder: Path
) -> None:
    spawn(weightless, 'a/0', DISC, group=1)
    spawn(weightless, 'a/1', BOX, group=1)
    join(weightless, 'j/0', 'pin', (0.0, 0.0), a='a/0', b='a/1')

    again = edited(save(weightless, folder), {'at': [0.25, 0.0, 0.0]}, 'a/1')

    again.step(120)
    assert pose(again, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert pose(again, 'a/1') == pytest.approx((0.25, 0.0, 0.0), abs=1e-9)


def geared(world: World, ratio: float, phase: float) -> None:
    """Run a gear of two wheels, one of them turned by some turns."""
    for number in range(2):
        x = 3.0 * number
        spawn(world, f'a/{number}', DISC, (x, 0.0, 40.0 * number))
        join(world, f'axle/{number}', 'axle', (x, 0.0), a=f'a/{number}', b='world')
    join(world, 'j/0', 'gear', (0.0, 0.0), a='a/0', b='a/1', phase=phase, ratio=ratio)
    world.step(240)


def test_a_gear_whose_phase_is_that_of_many_turns_round_trips(
    weightless: World, folder: Path
) -> None:
    geared(weightless, 1e6, 1.0)
    assert_round_trip(weightless, folder)


def test_a_phase_that_was_changed_in_the_file_holds(weightless: World, folder: Path) -> None:
    geared(weightless, 2.0, 0.0)
    assert_round_trip(weightless, folder)

    def change(content: dict[str, Any]) -> None:
        assert content['joints'][2]['phase'] == 0.0
        content['joints'][2]['phase'] = 1.0

    world = restored(rewrite(save(weightless, folder), change))

    world.step(240)
    phase = 2.0 * pose(world, 'a/1')[2] - pose(world, 'a/0')[2]
    assert math.remainder(phase - 1.0, math.tau) == pytest.approx(0.0, abs=1e-6)


def standing(content: dict[str, Any]) -> None:
    content['bodies'][0]['velocity'] = [0.0, 0.0]


def lighter(content: dict[str, Any]) -> None:
    content['gravity'] = [0.0, -5.0]


@pytest.mark.parametrize(
    ('change', 'rate'), [(standing, RATE), (lighter, RATE), (lambda _: None, 480.0)]
)
def test_what_does_not_move_a_body_leaves_its_joints_where_they_were(
    change: Callable[[dict[str, Any]], None], rate: float, folder: Path
) -> None:
    world = World()
    spawn(world, 'a/0', BOX)
    join(world, 'j/0', 'axle', (0.5, 0.0), a='a/0', b='world', lower=-2.0, upper=0.5)
    world.step(60)

    assert rewrite(save(world, folder), change, rate=rate).joints == world.save().joints


@pytest.mark.parametrize(
    ('joint', 'field'),
    [
        ('{kind: axle, points: [[0, 0]]}', 'name'),
        ('{name: j/0, points: [[0, 0]]}', 'kind'),
        ('{name: j/0, kind: axle}', 'points'),
        ('{name: j/0, kind: axle, points: [[0, 0]], a: b/9}', 'a'),
        ('{name: j/0, kind: axle, points: [[0, 0]], seat: [1, 2]}', 'seat'),
        ('{name: j/0, kind: axle, points: [[0, 0]], glue: 1}', 'glue'),
        ('{name: j/0, kind: axle, points: [[9, 9]]}', 'points'),
    ],
)
def test_a_joint_that_is_none_is_refused_by_name(folder: Path, joint: str, field: str) -> None:
    text = f'format: 1\nbodies: [{{name: b/0, circle: {{radius: 1}}}}]\njoints: [{joint}]\n'
    assert refusal_of(text, folder).field == field


@pytest.mark.parametrize('over', [None, ()])
def test_a_rope_that_passes_nothing_is_saved_as_it_was_asked_for(over: Any, tmp_path: Path):
    world = World()
    spawn(world, 'a/0', DISC)
    properties = JointProperties(over=over)
    points = ((0.0, 0.0), (0.0, 3.0))
    world.apply(Join(name='r/0', kind=JointKind.ROPE, points=points, properties=properties))

    assert_round_trip(world, tmp_path)
