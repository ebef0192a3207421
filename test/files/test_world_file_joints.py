# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a world file, saved and written by hand."""

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from physsim_ros.files import (
    load_world,
    save_world,
)
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Command, Join, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World
import pytest

from .world_files import assert_round_trip, edited, load, RATE, restored, rewrite, save
from ..building import BOX, DISC, pose, spawn

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


def read_in(path: Path) -> WorldState:
    return load_world(path, settings=WorldSettings(), physics_rate=RATE)


def test_joints_round_trip_to_the_bit_in_the_middle_of_motion(tmp_path: Path) -> None:
    path = tmp_path / 'machine.yaml'
    path.write_text(MACHINE, encoding='utf-8')
    world = World()
    world.apply(Restore(state=read_in(path)))
    world.step(333)
    saved = save_world(world.save(), 'saved', world_dir=tmp_path, physics_rate=RATE)
    one, other = World(), World()
    one.apply(Restore(state=world.save()))
    other.apply(Restore(state=read_in(saved)))
    assert len(one.save().joints) == 5
    assert one.save().joints == other.save().joints == world.save().joints
    one.step(240)
    other.step(240)
    assert one.digest() == other.digest()


def test_a_joint_whose_points_somebody_edited_sits_at_the_new_ones(tmp_path: Path) -> None:
    world = World()
    path = tmp_path / 'machine.yaml'
    path.write_text(MACHINE, encoding='utf-8')
    world.apply(Restore(state=read_in(path)))
    saved = save_world(world.save(), 'saved', world_dir=tmp_path, physics_rate=RATE)
    text = saved.read_text(encoding='utf-8')
    edited = text.replace('"points": [[0.0, 2.0]]', '"points": [[0.25, 2.0]]')
    assert edited != text
    saved.write_text(edited, encoding='utf-8')
    joints = read_in(saved).joints
    assert joints[0].seat.ax == pytest.approx(-0.25)
    assert joints[1:] == world.save().joints[1:]


@pytest.mark.parametrize('kind', [JointKind.ROD, JointKind.SLIDER])
@pytest.mark.parametrize('x', [2.0, 2.0 + 1e-5])
def test_a_joint_whose_ends_have_come_together_round_trips(
    kind: JointKind, x: float, folder: Path
) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    spawn(world, 'b/0', DISC)
    line = ((0.0, 0.0), (2.0, 0.0))
    world.apply(Join(name='j/0', kind=kind, points=line, a='b/0', b='world'))
    world.apply(Command(names=('b/0',), poses=((x, 0.0, 0.0),)))

    assert_round_trip(world, folder)


def test_jointed_bodies_that_have_flown_further_than_anyone_may_ask_round_trip(
    folder: Path,
) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(2):
        spawn(world, f'b/{number}', DISC, (9.999e6 + number, 0.0, 0.0), velocity=(1e5, 0.0))
    world.apply(Join(name='j/0', kind=JointKind.AXLE, points=((9.999e6, 0.0),), a='b/0', b='b/1'))
    world.step(6)
    assert pose(world, 'b/0')[0] > 1e7

    assert len(world.save().joints) == 1
    assert_round_trip(world, folder)


def test_a_body_that_was_turned_in_the_file_about_a_pin_stays_turned(folder: Path) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    spawn(world, 'a/0', BOX)
    pin = Join(name='j/0', kind=JointKind.PIN, points=((0.0, 0.0),), a='a/0', b='world')
    world.apply(pin)

    again = edited(save(world, folder), {'at': [0.0, 0.0, 0.5]})

    again.step(120)
    assert pose(again, 'a/0') == pytest.approx((0.0, 0.0, 0.5), abs=1e-9)


def test_a_body_that_was_moved_in_the_file_below_another_ones_pin_stays_there(
    folder: Path,
) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    spawn(world, 'a/0', DISC, group=1)
    spawn(world, 'a/1', BOX, group=1)
    world.apply(Join(name='j/0', kind=JointKind.PIN, points=((0.0, 0.0),), a='a/0', b='a/1'))

    again = edited(save(world, folder), {'at': [0.25, 0.0, 0.0]}, 'a/1')

    again.step(120)
    assert pose(again, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert pose(again, 'a/1') == pytest.approx((0.25, 0.0, 0.0), abs=1e-9)


def geared(folder: Path, phase: float, ratio: float = 2.0) -> Path:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(2):
        spawn(world, f'a/{number}', DISC, (3.0 * number, 0.0, 40.0 * number))
        held = Join(
            name=f'axle/{number}',
            kind=JointKind.AXLE,
            points=((3.0 * number, 0.0),),
            a=f'a/{number}',
            b='world',
        )
        world.apply(held)
    said = JointProperties(phase=phase, ratio=ratio)
    points = ((0.0, 0.0),)
    gear = Join(name='j/0', kind=JointKind.GEAR, points=points, a='a/0', b='a/1', properties=said)
    world.apply(gear)
    world.step(240)
    assert_round_trip(world, folder)
    return save(world, folder)


def test_a_phase_that_was_changed_in_the_file_holds(folder: Path) -> None:
    path = geared(folder, 0.0)
    text = path.read_text()
    assert '"phase": 0.0' in text
    path.write_text(text.replace('"phase": 0.0', '"phase": 1.0'))

    world = restored(load(path))

    world.step(240)
    phase = 2.0 * pose(world, 'a/1')[2] - pose(world, 'a/0')[2]
    assert math.remainder(phase - 1.0, math.tau) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize('change', ['velocity', 'rate', 'gravity'])
def test_what_does_not_move_a_body_leaves_its_joints_where_they_were(
    change: str, folder: Path
) -> None:
    world = World()
    spawn(world, 'a/0', BOX)
    limits = JointProperties(lower=-2.0, upper=0.5)
    axle = Join(
        name='j/0',
        kind=JointKind.AXLE,
        points=((0.5, 0.0),),
        a='a/0',
        b='world',
        properties=limits,
    )
    world.apply(axle)
    world.step(60)
    path = save(world, folder)
    changes: dict[str, Callable[[dict[str, Any]], object]] = {
        'velocity': lambda content: content['bodies'][0].update(velocity=[0.0, 0.0]),
        'gravity': lambda content: content.update(gravity=[0.0, -5.0]),
        'rate': lambda _: None,
    }
    again = rewrite(path, changes[change], rate=480.0 if change == 'rate' else RATE)

    assert again.joints == world.save().joints


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
def test_a_joint_that_is_none_is_refused_by_name(tmp_path: Path, joint: str, field: str) -> None:
    path = tmp_path / 'bad.yaml'
    path.write_text(
        f'format: 1\nbodies: [{{name: b/0, circle: {{radius: 1}}}}]\njoints: [{joint}]\n',
        encoding='utf-8',
    )
    with pytest.raises(BadWorldFile) as caught:
        read_in(path)
    assert caught.value.field == field
