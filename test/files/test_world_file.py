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

"""World files: what is saved loads again to the bit; what cannot or must not be is refused."""

import base64
import json
import math
import os
from pathlib import Path
from typing import Any
import zlib

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files import (
    find_world,
    hides_shipped,
    load_mapping,
    load_world,
    PARAMETERS,
    save_world,
    SETTINGS,
    shipped_worlds,
    user_worlds,
)
from physsim_ros.files.base64_array import pack
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.colors import color_of
from physsim_ros.model.errors import BadWorldFile, Malformed
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Anchor, Command, Configure, Join, Release, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.ros.parameters import SPECS
from physsim_ros.simulation.world import World
import pytest
import yaml

from ..building import body, BOX, DISC, ELL, G, pose, SHAPES, spawn, stack, twist

RATE = 240.0
COLORS = {
    'exact in hexadecimal': (1.0, 128 / 255, 0.0, 1.0),
    'see-through': (0.0, 51 / 255, 1.0, 51 / 255),
    'no hexadecimal': (0.1, 0.2, 0.3, 0.4),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return an empty world directory, which has something beside it."""
    folder = tmp_path / 'worlds'
    folder.mkdir()
    return folder


def write(folder: Path, text: str, name: str = 'w.yaml') -> Path:
    path = folder / name
    path.write_text(text, encoding='utf-8')
    return path


def load(path: Path, *, rate: float = RATE, **settings: Any) -> WorldState:
    return load_world(path, settings=WorldSettings(**settings), physics_rate=rate)


def loaded(text: str, folder: Path, **settings: Any) -> World:
    """Return a world that goes on from a file of that text."""
    return restored(load(write(folder, text), **settings))


def restored(state: WorldState) -> World:
    world = World(physics_rate=RATE)
    world.apply(Restore(state=state))
    return world


def save(world: World | WorldState, folder: Path, name: str = 'w') -> Path:
    state = world.save() if isinstance(world, World) else world
    return save_world(state, name, world_dir=folder, physics_rate=RATE)


def refusal_of(text: str, folder: Path, **settings: Any) -> BadWorldFile:
    with pytest.raises(BadWorldFile) as refused:
        load(write(folder, text), **settings)
    assert str(refused.value).startswith('w.yaml')
    assert len(str(refused.value)) < 1000
    return refused.value


def assert_round_trip(world: World, folder: Path) -> None:
    """Assert that a world goes on alike from its file and from itself, to the bit."""
    state = world.save()

    path = save(state, folder)
    again = load(path)

    assert again == state
    # And once more, since what is loaded may be saved.
    assert load(save(again, folder, 'again')) == state
    assert (folder / 'again.yaml').read_text() == path.read_text()
    one, other = restored(state), restored(again)
    assert one.digest() == other.digest()
    one.step(120)
    other.step(120)
    assert one.digest() == other.digest()


# Round trips


def test_an_empty_world_round_trips(folder: Path) -> None:
    assert_round_trip(World(), folder)


def test_settings_round_trip(folder: Path) -> None:
    settings = WorldSettings(
        gravity=(0.1, -1 / 3), damping=0.3, iterations=17, bounds=(-1 / 3, 0.0, 7.7, 1e3),
        density=2.2, friction=0.7, elasticity=1.0, command_timeout=0.0,
    )  # fmt: skip

    assert_round_trip(World(settings=settings), folder)


def test_how_many_bodies_a_world_may_hold_is_not_the_files_to_say(folder: Path) -> None:
    path = save(World(settings=WorldSettings(max_bodies=3)), folder)

    assert load(path, max_bodies=7).settings.max_bodies == 7
    assert 'max_bodies' not in path.read_text()


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize('role', [{}, {'anchored': True}, {'kinematic': True}, {'sensor': True}])
def test_every_shape_round_trips_in_every_role(
    shape: Any, role: dict[str, bool], folder: Path
) -> None:
    world = World()
    motion = {} if role.get('anchored') else {'velocity': (1 / 3, -0.1), 'spin': 0.7}
    spawn(world, 'a/0', shape, (1 / 3, -2 / 7, 0.3), **role, **motion)
    world.step(37)

    assert_round_trip(world, folder)


@pytest.mark.parametrize('color', COLORS.values(), ids=COLORS.keys())
def test_every_colour_round_trips(color: tuple[float, ...], folder: Path) -> None:
    world = World()
    spawn(world, 'a/0', DISC, color=color)

    assert_round_trip(world, folder)


@pytest.mark.parametrize(
    'said',
    [{'mass': 1 / 3}, {'density': 1e-3}, {'friction': 0.1 + 0.2}, {'elasticity': 2 / 3},
     {'group': -(2**31)}, {'group': 7}, {'velocity': (1e-7, 1e5)}, {'spin': -1e5},
     {'lifetime': 1 / 240}, {'lifetime': 1e7 + 1 / 240}, {'lifetime': 1e9}],
)  # fmt: skip
def test_every_property_round_trips(said: dict[str, Any], folder: Path) -> None:
    world = World()
    world.step(5)
    spawn(world, 'a/0', ELL, (0.1, 0.2, 0.3), **said)

    assert_round_trip(world, folder)


@pytest.mark.parametrize(
    'name',
    ['a b/1', 'true/1', '1/1', '球/-3', "it's/0", 'a: b/0', '#x/1', '[x]/2', 'null/0', '1e5/1',
     '"/1', '-/0', '\u20ac/1'],
)  # fmt: skip
def test_every_name_round_trips(name: str, folder: Path) -> None:
    world = World()
    spawn(world, name, DISC)

    assert_round_trip(world, folder)


def test_a_wrench_round_trips_for_as_long_as_it_has_left(folder: Path) -> None:
    world = World()
    for number in range(4):
        spawn(world, f'a/{number}', ELL, (9.0 * number, 0.0, 0.3), mass=1 / 3)
    world.apply(Command(names=('a/1', 'a/0'), wrenches=((0.1, 2.0, 3.0), (1.0, 0.0, 0.0))))
    world.step(50)
    world.apply(Configure(changes={'command_timeout': 0.0}))
    world.apply(Command(names=('a/2',), wrenches=((0.0, 0.0, -10.0),)))
    world.step(7)

    steps = [state.wrench_steps for state in world.save().bodies]
    assert steps == [63, 63, None, None]
    assert_round_trip(world, folder)


@pytest.mark.parametrize('rate', [60.0, 240.0, 480.0, 10_000.0])
def test_a_wrench_acts_for_as_many_seconds_at_any_rate(rate: float, folder: Path) -> None:
    world = World()
    spawn(world, 'a/0', ELL)
    world.apply(Command(names=('a/0',), wrenches=((0.1, 2.0, 3.0),)))
    world.step(24)
    path = save(world, folder)

    (state,) = load(path, rate=rate).bodies
    assert state.wrench_steps == round(0.4 * rate)

    # As files of before have it.
    path.write_text(path.read_text().replace('"seconds": 0.4', '"steps": 96'))
    (state,) = load(path, rate=rate).bodies
    assert state.wrench_steps == 96


def test_a_world_round_trips_in_the_middle_of_contacts(folder: Path) -> None:
    world = World(settings=WorldSettings(bounds=(-8.0, 0.0, 8.0, 30.0)))
    stack(world, 5)
    for number, shape in enumerate(SHAPES.values()):
        spawn(world, f'mix/{number}', shape, (1.5 * number - 5.0, 7.0 + number, 0.4 * number))
    spawn(world, 'peg/0', DISC, (1.0, 3.0, 0.0))
    world.apply(Anchor(point=(1.0, 3.0)))

    for _ in range(6):
        world.step(40)
        assert_round_trip(world, folder)


def test_the_heaviest_body_round_trips_where_it_rests(folder: Path) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, -1e3), bounds=(-8.0, 0.0, 8.0, 30.0)))
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0), mass=1e12)
    world.step(100)

    memory = world.save().memory
    assert memory is not None
    assert np.abs(memory.impulses).max() > 1e12
    assert_round_trip(world, folder)


def test_a_kinematic_body_that_is_held_round_trips_and_is_kinematic_when_let_go(
    folder: Path,
) -> None:
    world = World()
    spawn(world, 'lift/0', BOX, kinematic=True, velocity=(1.0, 0.0))
    world.apply(Anchor(point=(0.0, 0.0)))

    assert_round_trip(world, folder)

    again = restored(load(save(world, folder)))
    again.apply(Release(point=(0.0, 0.0)))
    again.step(60)
    assert pose(again, 'lift/0').tolist() == [0.0, 0.0, 0.0]


def test_what_has_fallen_further_than_anyone_may_ask_round_trips(folder: Path) -> None:
    world = World(physics_rate=60.0, settings=WorldSettings(gravity=(0.0, -1e4)))
    spawn(world, 'a/0', ELL, (0.0, 0.0, 0.3), spin=1.0)
    spawn(world, 'a/1', DISC, (0.0, 5.0, 0.0))
    world.step(60 * 60)
    assert pose(world, 'a/0')[1] < -1e7
    assert twist(world, 'a/0')[1] < -1e5

    path = save_world(world.save(), 'w', world_dir=folder, physics_rate=60.0)

    assert load(path, rate=60.0) == world.save()


def test_files_are_small_and_one_line_a_body(folder: Path) -> None:
    world = World()
    for number in range(3):
        spawn(world, f'a/{number}', ELL, (3.0 * number, 0.0, 0.1))

    lines = save(world, folder).read_text().splitlines()

    assert sum(line.startswith('  - ') for line in lines) == 3
    assert lines[0] == 'format: 1'
    # Settings, bodies, and a line of what the engine remembers.
    assert len(lines) < 20


def test_what_is_saved_is_plain_yaml(folder: Path) -> None:
    world = World(settings=WorldSettings(bounds=(-8.0, 0.0, 8.0, 30.0)))
    spawn(world, 'a/0', DISC, (1.0, 2.0, 0.3), color=COLORS['exact in hexadecimal'], mass=2.0)

    content = yaml.safe_load(save(world, folder).read_text())

    assert content['bounds'] == [-8.0, 0.0, 8.0, 30.0]
    (entry,) = content['bodies']
    assert entry['name'] == 'a/0'
    assert entry['circle'] == {'radius': 0.5}
    assert entry['at'] == [1.0, 2.0, 0.3]
    assert entry['color'] == '#ff8000'
    assert entry['mass'] == 2.0
    assert 'density' not in entry


@settings(deadline=None, max_examples=40)
@given(
    numbers=st.tuples(*[st.floats(-1e6, 1e6) for _ in range(3)]),
    velocity=st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4)),
    radius=st.floats(1e-3, 1e3),
    color=st.tuples(*[st.floats(0.0, 1.0) for _ in range(4)]),
)
def test_any_numbers_round_trip(
    numbers: Any, velocity: Any, radius: float, color: Any, tmp_path_factory: Any
) -> None:
    world = World()
    spawn(world, 'a/0', Disc(radius=radius), numbers, velocity=velocity, color=color)
    world.step(3)

    state = world.save()

    assert load(save(state, tmp_path_factory.getbasetemp())) == state


# By hand


def test_the_shortest_file_is_an_empty_world_with_the_settings_that_hold(folder: Path) -> None:
    state = load(write(folder, 'format: 1'), gravity=(0.0, -1.0), friction=0.9)

    assert state.bodies == ()
    assert state.settings == WorldSettings(gravity=(0.0, -1.0), friction=0.9)


def test_a_body_needs_a_name_and_a_shape_only(folder: Path) -> None:
    world = loaded(
        """
        format: 1
        bodies:
          - {name: ball/0, circle: {radius: 1}}
        """,
        folder,
        density=2.0,
    )

    ball = body(world, 'ball/0')
    assert (ball.shape, ball.density, ball.mass) == (Disc(radius=1.0), 2.0, None)
    assert ball.color == color_of('ball/0')
    assert pose(world, 'ball/0').tolist() == [0.0, 0.0, 0.0]


def test_the_example_of_the_contract_loads(folder: Path) -> None:
    world = loaded(
        """
format: 1
gravity: [0, -9.81]
bounds: [-10, 0, 10, 12]
bodies:
  - {name: ramp/0, polygon: [[0, 0], [4, 0], [0, 2]], at: [-6, 0], anchored: true}
  - {name: ball/0, circle: {radius: 0.5}, at: [-5.5, 3], velocity: [1, 0], elasticity: 0.8, color: '#4c78a8'}
  - {name: box/0, box: {width: 1, height: 0.5}, at: [2, 1, 0.3]}
joints: []
        """,  # noqa: E501
        folder,
    )

    assert world.snapshot().scene.names == ('ramp/0', 'ball/0', 'box/0')
    assert body(world, 'ramp/0').anchored
    assert twist(world, 'ball/0').tolist() == [1.0, 0.0, 0.0]
    assert body(world, 'ball/0').color == (76 / 255, 120 / 255, 168 / 255, 1.0)
    assert pose(world, 'box/0').tolist() == [2.0, 1.0, 0.3]
    assert world.settings.bounds == (-10.0, 0.0, 10.0, 12.0)
    world.step(240)


def test_every_shape_can_be_written_by_hand(folder: Path) -> None:
    world = loaded(
        """
        format: 1
        bodies:
          - {name: a/0, circle: {radius: 0.5}}
          - {name: a/1, box: {width: 1, height: 2}, at: [3, 0]}
          - {name: a/2, polygon: [[0, 0], [1, 0], [0, 1]], at: [6, 0]}
          - {name: a/3, chain: {points: [[0, 0], [1, 0], [1, 1]], thickness: 0.1}, at: [9, 0]}
          - {name: a/4, triangles: [[0, 0], [1, 0], [0, 1]], at: [12, 0]}
          - {name: a/5, compound: {circle: {radius: 0.1}, centers: [[0, 0], [1, 0]]}, at: [15, 0]}
          - {name: a/6, compound: {box: {width: 1, height: 1}, centers: [[0, 0]]}, at: [18, 0]}
        """,
        folder,
    )

    kinds = [type(each.shape).__name__ for each in world.snapshot().scene.bodies]
    assert kinds == ['Disc', 'Box', 'Polygon', 'Chain', 'Triangles', 'Compound', 'Compound']
    assert world.snapshot().poses[:, 0].tolist() == [0.0, 3.0, 6.0, 9.0, 12.0, 15.0, 18.0]


def test_no_bounds_are_no_walls(folder: Path) -> None:
    assert load(write(folder, 'format: 1\nbounds: []')).settings.bounds is None
    kept = load(write(folder, 'format: 1'), bounds=(0.0, 0.0, 1.0, 1.0))
    assert kept.settings.bounds == (0.0, 0.0, 1.0, 1.0)


def test_colours_are_written_in_three_ways(folder: Path) -> None:
    world = loaded(
        """
        format: 1
        bodies:
          - {name: a/0, circle: {radius: 1}, color: '#ff0080'}
          - {name: a/1, circle: {radius: 1}, color: '#FF008000'}
          - {name: a/2, circle: {radius: 1}, color: [1, 0, 0.5, 0.25]}
        """,
        folder,
    )

    colors = [each.color for each in world.snapshot().scene.bodies]
    assert colors == [
        (1.0, 0.0, 128 / 255, 1.0),
        (1.0, 0.0, 128 / 255, 0.0),
        (1.0, 0.0, 0.5, 0.25),
    ]


# Edited by hand after it was saved


def edited(path: Path, changes: dict[str, Any], name: str = 'a/0') -> World:
    content = yaml.safe_load(path.read_text())
    for entry in content['bodies']:
        if entry['name'] == name:
            entry.update(changes)
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    return restored(load(path))


@pytest.fixture
def flying(folder: Path) -> Path:
    """Return the file of an off-centre body in flight, with a wrench on it, and another."""
    world = World()
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    spawn(world, 'a/1', DISC, (9.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    world.apply(Command(names=('a/0',), wrenches=((0.5, 0.0, 0.1),)))
    world.step(24)
    return save(world, folder)


def test_a_body_that_was_moved_in_the_file_is_where_the_file_says(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'at': [7.0, 8.0, 0.9]})

    assert pose(world, 'a/0') == pytest.approx((7.0, 8.0, 0.9), abs=1e-12)
    assert twist(world, 'a/0') == pytest.approx(twist(before, 'a/0'), abs=1e-12)
    assert np.array_equal(pose(world, 'a/1'), pose(before, 'a/1'))
    # The wrench goes on for as long as it had left.
    assert world.save().bodies[0].wrench_steps == 120 - 24


def test_a_velocity_that_was_changed_in_the_file_holds(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'velocity': [0.0, 0.0], 'spin': 0.0})

    assert pose(world, 'a/0') == pytest.approx(pose(before, 'a/0'), abs=1e-12)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_shape_or_colour_that_was_changed_in_the_file_keeps_the_motion(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'circle': {'radius': 2.0}, 'color': '#ff0000'}, 'a/1')

    assert body(world, 'a/1').shape == Disc(radius=2.0)
    assert np.array_equal(pose(world, 'a/1'), pose(before, 'a/1'))
    assert np.array_equal(twist(world, 'a/1'), twist(before, 'a/1'))


def test_another_gravity_in_the_file_keeps_the_true_velocities(flying: Path) -> None:
    before = restored(load(flying))

    content = yaml.safe_load(flying.read_text()) | {'gravity': [5.0, 0.0]}
    flying.write_text(yaml.safe_dump(content))
    world = restored(load(flying))

    assert world.snapshot().twists == pytest.approx(before.snapshot().twists, abs=1e-12)
    world.step(24)
    assert twist(world, 'a/1') == pytest.approx(twist(before, 'a/1') + np.array((0.5, 0, 0)))


def test_another_physics_rate_keeps_the_true_velocities(flying: Path) -> None:
    before = restored(load(flying))

    state = load(flying, rate=1000.0)
    world = World(physics_rate=1000.0)
    world.apply(Restore(state=state))

    assert world.snapshot().twists == pytest.approx(before.snapshot().twists, abs=1e-12)
    world.step(500)
    before.step(120)
    # The free one flies exactly, at any rate.
    assert pose(world, 'a/1') == pytest.approx(pose(before, 'a/1'), abs=1e-9)


def test_a_body_that_was_anchored_in_the_file_needs_no_more_than_that(folder: Path) -> None:
    world = World()
    spawn(world, 'a/0', DISC, (1.0, 2.0, 0.3))
    path = save(world, folder)

    again = edited(path, {'anchored': True})

    assert body(again, 'a/0').anchored
    again.step(24)
    assert pose(again, 'a/0').tolist() == [1.0, 2.0, 0.3]


@pytest.fixture
def resting(folder: Path) -> Path:
    """Return the file of a stack at rest, with what the engine remembers of its contacts."""
    world = World(settings=WorldSettings(bounds=(-8.0, 0.0, 8.0, 30.0)))
    stack(world, 5)
    world.step(960)
    return save(world, folder)


def remembering(path: Path, changes: dict[str, Any]) -> WorldState:
    content = yaml.safe_load(path.read_text())
    content['memory'].update(changes)
    path.write_text(yaml.safe_dump({k: v for k, v in content.items() if v is not None}))
    return load(path)


def packed(*rows: object, kind: type = np.int64) -> str:
    return pack(np.array(rows, dtype=kind))


@pytest.mark.parametrize(
    ('changes', 'field'),
    [
        ({'walls': -1}, 'walls'),
        ({'walls': 2.5}, 'walls'),
        ({'walls': True}, 'walls'),
        ({'walls': None}, 'walls'),
        ({'following': 2**62}, 'following'),
        ({'following': 'many'}, 'following'),
        ({'ids': 'none of them'}, 'ids'),
        ({'ids': None}, 'ids'),
        ({'ids': base64.b64encode(zlib.compress(b'five!')).decode()}, 'ids'),
        ({'pairs': packed(1, 2, 3)}, 'pairs'),
        ({'pairs': packed(1, 2)}, 'memory'),
        ({'hashes': packed(1)}, 'memory'),
        ({'impulses': packed((1.0, 2.0), kind=np.float64)}, 'memory'),
        ({'impulses': packed(*[(math.nan, 0.0)] * 10, kind=np.float64)}, 'memory'),
        ({'impulses': packed(*[(math.inf, 0.0)] * 10, kind=np.float64)}, 'memory'),
        ({'ids': [1, 2]}, 'ids'),
        ({'impulse': packed(1)}, 'impulse'),
    ],
)
def test_a_memory_that_is_none_is_refused(
    changes: dict[str, Any], field: str, resting: Path
) -> None:
    assert remembering(resting, {}).memory is not None
    with pytest.raises(BadWorldFile) as refused:
        remembering(resting, changes)
    assert refused.value.field == field


def test_a_memory_without_one_of_its_keys_is_refused(resting: Path) -> None:
    content = yaml.safe_load(resting.read_text())
    for key in content['memory']:
        left = {name: value for name, value in content['memory'].items() if name != key}
        resting.write_text(yaml.safe_dump(content | {'memory': left}))
        with pytest.raises(BadWorldFile) as refused:
            load(resting)
        assert refused.value.field == key


@pytest.mark.parametrize(
    'ids', [(), (1, 2), (-1, 0, 1, 2, 3), (0, 1, 2, 3, 10**9), (20, 20, 21, 22, 23)]
)
def test_a_memory_of_other_bodies_is_none(ids: tuple[int, ...], resting: Path) -> None:
    state = remembering(resting, {'ids': packed(*ids)})
    assert state.memory is None
    restored(state).step(10)


def test_a_memory_in_which_walls_and_bodies_share_numbers_is_none(resting: Path) -> None:
    first = remembering(resting, {}).memory
    assert first is not None
    state = remembering(resting, {'walls': int(first.ids[0])})
    assert state.memory is None
    restored(state).step(10)


def test_the_memory_may_be_deleted(resting: Path) -> None:
    content = yaml.safe_load(resting.read_text())
    del content['memory']
    resting.write_text(yaml.safe_dump(content))
    state = load(resting)
    assert state.memory is None
    assert len(state.bodies) == 5


def test_a_body_that_is_gone_or_edited_leaves_no_memory(resting: Path) -> None:
    content = yaml.safe_load(resting.read_text())
    fewer = content | {'bodies': content['bodies'][:-1]}
    resting.write_text(yaml.safe_dump(fewer))
    assert load(resting).memory is None
    content['bodies'][0]['at'] = [3.0, 3.0, 0.0]
    resting.write_text(yaml.safe_dump(content))
    assert load(resting).memory is None


def test_a_body_that_was_cut_into_pieces_leaves_no_memory(resting: Path) -> None:
    content = yaml.safe_load(resting.read_text())
    lowest = content['bodies'][0]
    width, height = lowest.pop('box').values()
    # As wide, as high and as heavy at both ends, so that it goes on from where it was.
    points = [[share * width, 0.0] for share in (-0.4, -0.2, 0.0, 0.2, 0.4)]
    lowest['chain'] = {'points': points, 'thickness': height}
    resting.write_text(yaml.safe_dump(content))
    state = load(resting)
    assert state.bodies[0].motion is not None
    assert state.memory is None
    restored(state).step(10)


@settings(deadline=None)
@given(
    ids=st.lists(st.integers(0, 20), min_size=5, max_size=5, unique=True),
    pairs=st.lists(
        st.tuples(st.integers(-(2**63), 2**63 - 1), st.integers(0, 30)), min_size=8, max_size=8
    ),
    impulses=st.lists(
        st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)), min_size=8, max_size=8
    ),
    walls=st.integers(21, 36),
)
def test_whatever_is_remembered_the_world_goes_on(
    ids: list[int],
    pairs: list[tuple[int, int]],
    impulses: list[tuple[float, float]],
    walls: int,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    folder = tmp_path_factory.mktemp('remembered')
    world = World(settings=WorldSettings(bounds=(-8.0, 0.0, 8.0, 30.0)))
    stack(world, 5)
    world.step(240)
    path = save(world, folder)
    state = remembering(
        path,
        {
            'ids': packed(*ids),
            'pairs': packed(*pairs),
            'hashes': packed(*range(8), kind=np.uint64),
            'impulses': packed(*impulses, kind=np.float64),
            'walls': walls,
            'following': 40,
        },
    )
    assert state.memory is not None
    going = restored(state)
    going.step(20)
    assert np.isfinite(going.snapshot().poses).all()


# Refusals of what files say

HEAD = 'format: 1\nbodies:\n'
REFUSED = {
    'nothing': ('', 'format'),
    'no format': ('gravity: [0, 0]', 'format'),
    'another format': ('format: 2', 'format'),
    'a format in words': ('format: one', 'format'),
    'a true format': ('format: true', 'format'),
    'no format at all': ('format:', 'format'),
    'half a character': ('format: 1\n"\\ud800": 1', 'world_file'),
    'an unknown key': ('format: 1\ngravitation: [0, 0]', 'gravitation'),
    'a setting that is not the files': ('format: 1\nmax_bodies: 7', 'max_bodies'),
    'a key of another kind': ('format: 1\n5: 3', '5'),
    'joints': ('format: 1\njoints: [{name: joint/0}]', 'points'),
    'a setting out of range': ('format: 1\ndamping: 2', 'damping'),
    'a setting of another kind': ('format: 1\niterations: many', 'iterations'),
    'a setting without a value': ('format: 1\ngravity:', 'gravity'),
    'gravity that is not finite': ('format: 1\ngravity: [0, .nan]', 'gravity'),
    'three bounds': ('format: 1\nbounds: [0, 0, 1]', 'bounds'),
    'bodies that are none': ('format: 1\nbodies: 3', 'bodies'),
    'bodies by name': ('format: 1\nbodies: {a/0: {circle: {radius: 1}}}', 'bodies'),
    'bodies in words': ('format: 1\nbodies: [a/0]', 'bodies'),
    'a body without a name': (HEAD + '  - {circle: {radius: 1}}', 'name'),
    'a name that is none': (HEAD + '  - {name: ball, circle: {radius: 1}}', 'name'),
    'a name of another kind': (HEAD + '  - {name: [a/0], circle: {radius: 1}}', 'name'),
    'an empty name': (HEAD + '  - {name: "", circle: {radius: 1}}', 'name'),
    'a name twice': (HEAD + '  - {name: a/0, circle: {radius: 1}}\n' * 2, 'name'),
    'no shape': (HEAD + '  - {name: a/0}', 'shape'),
    'two shapes': (HEAD + '  - {name: a/0, circle: {radius: 1}, box: {width: 1, height: 1}}',
                   'shape'),
    'an unknown shape': (HEAD + '  - {name: a/0, disc: {radius: 1}}', 'disc'),
    'a circle in a number': (HEAD + '  - {name: a/0, circle: 3}', 'circle'),
    'a circle without a radius': (HEAD + '  - {name: a/0, circle: {}}', 'radius'),
    'a circle with a diameter': (HEAD + '  - {name: a/0, circle: {diameter: 1}}', 'diameter'),
    'a radius that is not finite': (HEAD + '  - {name: a/0, circle: {radius: .inf}}', 'radius'),
    'a radius in words': (HEAD + '  - {name: a/0, circle: {radius: wide}}', 'radius'),
    'a radius of nothing': (HEAD + '  - {name: a/0, circle: {radius: 0}}', 'radius'),
    'a box without a height': (HEAD + '  - {name: a/0, box: {width: 1}}', 'height'),
    'a polygon in words': (HEAD + '  - {name: a/0, polygon: triangle}', 'polygon'),
    'a polygon by name': (HEAD + '  - {name: a/0, polygon: {a: [0, 0]}}', 'polygon'),
    'a polygon that crosses itself': (
        HEAD + '  - {name: a/0, polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]}', 'points'),
    'a corner of one number': (HEAD + '  - {name: a/0, polygon: [[0, 0], [1], [1, 1]]}',
                               'polygon'),
    'a corner in words': (HEAD + '  - {name: a/0, polygon: [[0, 0], [a, b], [1, 1]]}', 'polygon'),
    'a chain without points': (HEAD + '  - {name: a/0, chain: {thickness: 1}}', 'points'),
    'a chain without thickness': (HEAD + '  - {name: a/0, chain: {points: [[0, 0], [1, 0]]}}',
                                  'thickness'),
    'a compound of nothing': (HEAD + '  - {name: a/0, compound: {centers: [[0, 0]]}}', 'shape'),
    'a compound of polygons': (
        HEAD + '  - {name: a/0, compound: {polygon: [[0, 0], [1, 0], [0, 1]], centers: [[0, 0]]}}',
        'polygon'),
    'a place of one number': (HEAD + '  - {name: a/0, circle: {radius: 1}, at: [0]}', 'at'),
    'a place of four numbers': (HEAD + '  - {name: a/0, circle: {radius: 1}, at: [0, 0, 0, 0]}',
                                'at'),
    'a place in words': (HEAD + '  - {name: a/0, circle: {radius: 1}, at: here}', 'at'),
    'a yaw in words': (HEAD + '  - {name: a/0, circle: {radius: 1}, at: [0, 0, x]}', 'at'),
    'a place too far': (HEAD + '  - {name: a/0, circle: {radius: 1}, at: [0, 1e8]}', 'pose'),
    'a colour of seven digits': (HEAD + '  - {name: a/0, circle: {radius: 1}, color: "#1234567"}',
                                 'color'),
    'a colour with spaces': (HEAD + '  - {name: a/0, circle: {radius: 1}, color: "#12 34 56"}',
                             'color'),
    'a colour by name': (HEAD + '  - {name: a/0, circle: {radius: 1}, color: red}', 'color'),
    'a colour that is too bright': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, color: [2, 0, 0, 1]}', 'color'),
    'a lifetime in words': (HEAD + '  - {name: a/0, circle: {radius: 1}, lifetime: long}',
                            'lifetime'),
    'a lifetime without end': (HEAD + '  - {name: a/0, circle: {radius: 1}, lifetime: 1e308}',
                               'lifetime'),
    'an unknown property': (HEAD + '  - {name: a/0, circle: {radius: 1}, weight: 1}', 'weight'),
    'a property out of range': (HEAD + '  - {name: a/0, circle: {radius: 1}, friction: -1}',
                                'friction'),
    'a property without a value': (HEAD + '  - {name: a/0, circle: {radius: 1}, mass: }', 'mass'),
    'mass and density': (HEAD + '  - {name: a/0, circle: {radius: 1}, mass: 1, density: 1}',
                         'mass'),
    'an anchored body that moves': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, anchored: true, velocity: [1, 0]}',
        'velocity'),
    'an anchored body with saved motion': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, anchored: true, velocity: [1, 0], '
        'motion: [0, 0, 0, 1, 0, 0, true]}', 'velocity'),
    'a wrench for an anchored body': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, anchored: true, '
        'wrench: {force: [1, 0], torque: 0}}', 'joint_names'),
    'a wrench out of range': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, wrench: {force: [1e300, 0], torque: 0}}',
        'wrench'),
    'a wrench without a torque': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, wrench: {force: [1, 0]}}', 'torque'),
    'a wrench for half a step': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, '
        'wrench: {force: [1, 0], torque: 0, steps: 0.5}}', 'steps'),
    'a wrench until long ago': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, '
        'wrench: {force: [1, 0], torque: 0, steps: -1}}', 'steps'),
    'a wrench of seconds in words': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, '
        'wrench: {force: [1, 0], torque: 0, seconds: some}}', 'seconds'),
    'a wrench of less than no time': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, '
        'wrench: {force: [1, 0], torque: 0, seconds: -1}}', 'seconds'),
    'a wrench for more than 300 years': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, '
        'wrench: {force: [1, 0], torque: 0, steps: 10000000000000000}}', 'steps'),
    'a wrench in words': (HEAD + '  - {name: a/0, circle: {radius: 1}, wrench: hard}', 'wrench'),
    'six numbers of motion': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, motion: [0, 0, 0, 0, 0, true]}', 'motion'),
    'motion in words': (HEAD + '  - {name: a/0, circle: {radius: 1}, motion: fast}', 'motion'),
    'motion with a word at the end': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, motion: [0, 0, 0, 0, 0, 0, no]}', 'motion'),
    'motion that is not finite': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, motion: [.nan, 0, 0, 0, 0, 0, true]}',
        'motion'),
    'motion out of this world': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, at: [1e300, 0], '
        'motion: [1e300, 0, 0, 0, 0, 0, false]}', 'motion'),
    'a motion that only the node writes': (
        HEAD + '  - {name: a/0, circle: {radius: 1}, at: [1e300, 0], '
        'motion: [0, 0, 0, 0, 0, 0, true]}', 'pose'),
    'a body too many': (HEAD + '  - {name: a/0, circle: {radius: 1}}\n'
                        '  - {name: a/1, circle: {radius: 1}}', ''),
}  # fmt: skip


@pytest.mark.parametrize(('text', 'field'), REFUSED.values(), ids=REFUSED.keys())
def test_a_file_that_says_nonsense_is_refused_and_says_where(
    text: str, field: str, folder: Path
) -> None:
    refusal = refusal_of(text, folder, max_bodies=1)

    assert refusal.code == 'bad_world_file'
    assert refusal.field == field


NO_YAML = {
    'an open brace': '{',
    'a tab': '\tformat: 1',
    'two colons': 'a: b: c',
    'no mapping': '[format, 1]',
    'one word': 'format',
    'a control character': 'format: 1\n#\x07',
    'two documents': 'format: 1\n---\nformat: 1',
    'an unknown alias': 'format: *one',
    'a tag': 'format: !!python/object:os.system 1',
    'a date in a tag': 'format: !!timestamp soon',
    'a number in a tag': 'format: !!int ""',
    'a key that is a list': '{[1, 2]: 3}',
    'a key twice': 'format: 1\nformat: 1',
    'a number of thousands of digits': 'format: ' + '9' * 10_000,
    'nested too deep': '[' * 20_000,
    'indented too deep': '- ' * 20_000,
}


@pytest.mark.parametrize('text', NO_YAML.values(), ids=NO_YAML.keys())
def test_what_is_no_yaml_mapping_is_refused(text: str, folder: Path) -> None:
    assert refusal_of(text, folder).field == 'world_file'


def test_an_unknown_key_names_the_nearest(folder: Path) -> None:
    assert "'gravity'" in str(refusal_of('format: 1\ngravty: [0, 0]', folder))
    text = HEAD + '  - {name: a/0, circle: {radius: 1}, elastic: 1}'
    refusal = refusal_of(text, folder)
    assert "'elasticity'" in str(refusal)
    assert "'a/0'" in str(refusal)


@pytest.mark.parametrize(
    ('text', 'line'),
    [
        ('format: 1\nbodies:\n\t- {}', 3),
        ('format: 1\nformat: 1', 2),
        ('format: 1\n# é\x07', 2),
        ('format: 1\ngravity: !!int ""\n\n', 2),
        ('format: 1\ngravity: [0,\n\n', 2),
        ('format: 1\n---\nformat: 1', 2),
    ],
)
def test_what_is_no_yaml_says_in_which_line(text: str, line: int, folder: Path) -> None:
    assert str(refusal_of(text, folder)).endswith(f', line {line}')


def test_a_text_of_one_line_says_no_line() -> None:
    with pytest.raises(Malformed) as refused:
        load_mapping('a: b: c', field='text')
    assert 'line' not in str(refused.value)


def test_a_parameter_of_the_node_is_told_from_a_word_that_means_nothing(folder: Path) -> None:
    assert 'parameter of the node' in str(refusal_of('format: 1\nspeed: 2', folder))
    refusal = refusal_of('format: 1\nflavour: 2', folder)
    assert str(refusal) == "w.yaml: there is no property 'flavour'"


def test_the_parameters_that_no_file_holds_are_all_the_others_of_the_node() -> None:
    assert set(SPECS) - set(SETTINGS) == PARAMETERS


@pytest.mark.parametrize(
    ('text', 'which'),
    [
        ('bodies: [{name: a/0, circle: {radius: 1}}, {circle: {radius: 1}}]', 'body number 2: '),
        ('bodies: []\njoints: [{kind: axle}]', 'joint number 1: '),
        ('bodies: []\njoints: [{name: 7, kind: axle}]', 'joint 7: '),
    ],
)
def test_what_has_no_name_is_told_by_its_number(text: str, which: str, folder: Path) -> None:
    assert which in str(refusal_of(f'format: 1\n{text}', folder))


def test_a_refusal_says_which_body_it_is(folder: Path) -> None:
    bodies = ''.join(f'  - {{name: a/{k}, circle: {{radius: {3 - k}}}}}\n' for k in range(5))

    assert "body 'a/3'" in str(refusal_of(HEAD + bodies, folder))


def test_a_value_that_unfolds_without_end_is_refused_at_once(folder: Path) -> None:
    layers = ['a0: &a0 [x, x, x, x, x, x, x, x, x]']
    layers += [f'a{k}: &a{k} [{", ".join([f"*a{k - 1}"] * 9)}]' for k in range(1, 30)]
    name = ', '.join(layers)
    refusal_of(f'format: 1\nbodies: [{{name: {{{name}}}, circle: {{radius: 1}}}}]', folder)

    merges = ['m0: &m0 {mass: 1}']
    merges += [
        f'm{k}: &m{k} {{!!merge x: [{", ".join([f"*m{k - 1}"] * 9)}]}}' for k in range(1, 30)
    ]
    refusal_of('format: 1\n' + '\n'.join(merges), folder)


def test_a_mapping_that_holds_itself_is_refused(folder: Path) -> None:
    refusal_of('format: &a [*a]', folder)
    refusal_of('format: 1\nbodies: &a [*a]', folder)
    refusal_of('format: 1\nbodies: [&a {name: *a, circle: {radius: 1}}]', folder)


# Refusals of files


def test_a_file_that_is_not_there_is_refused(folder: Path) -> None:
    with pytest.raises(BadWorldFile):
        load(folder / 'nothing.yaml')
    for name in ('nothing', 'nothing.yaml', 'sub/nothing', '/nothing.yaml', '.', '..', '../..'):
        with pytest.raises(BadWorldFile):
            find_world(name, world_dir=folder, confined=False)


def test_where_a_world_is_not_there_those_that_are_are_named(folder: Path) -> None:
    write(folder, 'format: 1', 'mine.yaml')
    write(folder, 'format: 1', '.hidden.yaml')
    with pytest.raises(BadWorldFile) as refused:
        find_world('nothere', world_dir=folder, confined=True)
    for path in shipped_worlds().glob('*.yaml'):
        assert path.stem in str(refused.value)
    assert 'mine' in str(refused.value)
    assert 'hidden' not in str(refused.value)


def test_a_directory_is_no_world(folder: Path) -> None:
    (folder / 'sub.yaml').mkdir()

    with pytest.raises(BadWorldFile):
        load(folder / 'sub.yaml')
    with pytest.raises(BadWorldFile):
        find_world('sub', world_dir=folder, confined=True)
    with pytest.raises(BadWorldFile):
        save(World(), folder, 'sub')


def test_a_file_that_is_no_text_is_refused(folder: Path) -> None:
    path = folder / 'w.yaml'
    path.write_bytes(b'format: 1\n\xff\xfe')

    with pytest.raises(BadWorldFile) as refused:
        load(path)
    assert 'w.yaml' in str(refused.value)


@pytest.mark.skipif(os.geteuid() == 0, reason='root may read everything')
def test_a_file_that_may_not_be_read_is_refused(folder: Path) -> None:
    path = write(folder, 'format: 1')
    path.chmod(0)

    with pytest.raises(BadWorldFile):
        load(path)


@pytest.mark.parametrize('name', ['', 'a' * 5000, 'a\0b', 'a\0b.yaml', '\ud800'])
@pytest.mark.parametrize('confined', [False, True])
def test_a_name_that_no_file_can_have_is_refused(
    *, name: str, confined: bool, folder: Path
) -> None:
    with pytest.raises(BadWorldFile) as refused:
        find_world(name, world_dir=folder, confined=confined)
    assert refused.value.field == 'world_file'
    with pytest.raises(BadWorldFile) as refused:
        save(World(), folder, name)
    assert refused.value.field == 'world_file'
    assert list(folder.iterdir()) == []


# Places of files


def test_a_plain_name_is_a_file_of_the_world_directory_before_a_shipped_one(folder: Path) -> None:
    shipped = find_world('demo', world_dir=folder, confined=True)
    assert find_world('demo.yaml', world_dir=folder, confined=True) == shipped
    own = write(folder, 'format: 1', 'demo.yaml')

    assert shipped == shipped_worlds() / 'demo.yaml'
    assert find_world('demo', world_dir=folder, confined=True) == own


@pytest.mark.parametrize(
    ('name', 'hides'),
    [('demo', True), ('demo.yaml', True), ('sub/demo.yaml', False), ('own', False)],
)
def test_only_what_the_name_of_a_shipped_world_now_means_hides_that(
    folder: Path, name: str, hides: bool
) -> None:
    (folder / 'sub').mkdir()
    saved = save(World(), folder, name)

    assert hides_shipped(saved, world_dir=folder) is hides
    meant = find_world('demo', world_dir=folder, confined=True)
    assert (meant.resolve() == saved) is hides


def test_saving_over_a_shipped_world_hides_none() -> None:
    worlds = shipped_worlds()

    assert not hides_shipped(worlds / 'demo.yaml', world_dir=worlds)


def test_a_path_is_below_the_world_directory(folder: Path) -> None:
    (folder / 'sub').mkdir()
    path = write(folder / 'sub', 'format: 1', 'x.yaml')

    for name in ('sub/x.yaml', 'sub/../sub/x.yaml', './sub/x.yaml', str(path)):
        found = find_world(name, world_dir=folder, confined=True)
        assert found.resolve() == path.resolve()


def test_the_shipped_demo_loads_and_runs(folder: Path) -> None:
    path = find_world('demo', world_dir=folder, confined=True)

    world = restored(load(path))

    assert len(world) >= 20
    world.step(240)
    assert np.isfinite(world.snapshot().poses).all()
    assert_round_trip(world, folder)


@pytest.mark.parametrize('path', sorted(shipped_worlds().glob('*.yaml')),
                         ids=lambda path: path.stem)  # fmt: skip
def test_every_shipped_world_loads_by_its_name(path: Path, folder: Path) -> None:
    assert find_world(path.stem, world_dir=folder, confined=True) == path
    assert load(path).bodies


def test_a_file_outside_is_read_where_nobody_confines(folder: Path) -> None:
    outside = write(folder.parent, 'format: 1', 'outside.yaml')

    for name in ('../outside.yaml', str(outside)):
        found = find_world(name, world_dir=folder, confined=False)
        assert found.resolve() == outside.resolve()
        with pytest.raises(BadWorldFile) as refused:
            find_world(name, world_dir=folder, confined=True)
        assert 'outside' in str(refused.value)


def test_a_link_that_leads_outside_is_not_followed_where_confined(folder: Path) -> None:
    outside = write(folder.parent, 'format: 1', 'outside.yaml')
    (folder / 'link.yaml').symlink_to(outside)
    (folder / 'sub').symlink_to(folder.parent, target_is_directory=True)

    for name in ('link', 'link.yaml', 'sub/outside.yaml'):
        assert find_world(name, world_dir=folder, confined=False).is_file()
        with pytest.raises(BadWorldFile):
            find_world(name, world_dir=folder, confined=True)
        with pytest.raises(BadWorldFile):
            save(World(), folder, name)
    assert outside.read_text() == 'format: 1'


def test_a_link_within_the_directory_is_followed(folder: Path) -> None:
    path = write(folder, 'format: 1', 'real.yaml')
    (folder / 'link.yaml').symlink_to(path)

    assert find_world('link', world_dir=folder, confined=True).read_text() == 'format: 1'
    save(World(), folder, 'link')
    assert path.read_text().startswith('format: 1\ngravity')


def test_links_in_a_circle_are_refused(folder: Path) -> None:
    (folder / 'a.yaml').symlink_to(folder / 'b.yaml')
    (folder / 'b.yaml').symlink_to(folder / 'a.yaml')

    with pytest.raises(BadWorldFile):
        find_world('a', world_dir=folder, confined=True)
    with pytest.raises(BadWorldFile):
        save(World(), folder, 'a')


# Saving


def test_a_world_is_saved_under_a_name_or_a_path(folder: Path) -> None:
    (folder / 'sub').mkdir()

    assert save(World(), folder, 'mine') == (folder / 'mine.yaml').resolve()
    assert save(World(), folder, 'sub/x.yaml') == (folder / 'sub' / 'x.yaml').resolve()
    assert save(World(), folder, str(folder / 'abs.yaml')) == (folder / 'abs.yaml').resolve()
    assert sorted(path.name for path in folder.rglob('*')) == [
        'abs.yaml', 'mine.yaml', 'sub', 'x.yaml'
    ]  # fmt: skip


def test_the_directory_of_worlds_is_made_when_a_world_is_saved(tmp_path: Path) -> None:
    folder = tmp_path / 'data' / 'worlds'

    with pytest.raises(BadWorldFile):
        save(World(), folder, '../outside')
    assert list(tmp_path.iterdir()) == []

    assert save(World(), folder, 'mine').is_file()


def test_the_worlds_of_a_user_are_in_the_data_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('HOME', str(tmp_path))
    for data, base in (
        (str(tmp_path / 'data'), tmp_path / 'data'),
        ('', tmp_path / '.local/share'),
        ('relative', tmp_path / '.local/share'),
    ):
        monkeypatch.setenv('XDG_DATA_HOME', data)
        assert user_worlds() == base / 'physsim_ros' / 'worlds'


@pytest.mark.parametrize(
    'name',
    ['.bashrc', '.w.yaml', '.ssh/w.yaml', 'sub/.w.yaml', 'w.yml', 'w.world', 'w.YAML', 'w.yaml.sh',
     'hidden.yaml', 'hiding/w.yaml', 'w\n.yaml', 'w\x1b[2J.yaml'],
)  # fmt: skip
def test_only_visible_yaml_files_are_read_and_written(name: str, folder: Path) -> None:
    for directory in ('sub', '.ssh'):
        (folder / directory).mkdir()
    (folder / 'hidden.yaml').symlink_to('.secret.yaml')
    (folder / 'hiding').symlink_to('.ssh')
    for place in (
        '.bashrc',
        '.w.yaml',
        '.ssh/w.yaml',
        'sub/.w.yaml',
        'w.yml',
        '.secret.yaml',
        'w\n.yaml',
    ):
        write(folder, 'format: 1', place)
    before = {path: path.is_file() and path.read_text() for path in folder.rglob('*')}

    with pytest.raises(BadWorldFile):
        save(World(), folder, name)
    with pytest.raises(BadWorldFile):
        find_world(name, world_dir=folder, confined=True)

    assert {path: path.is_file() and path.read_text() for path in folder.rglob('*')} == before


@pytest.mark.parametrize(
    'text',
    ['', 'format: 2', 'services: {}', '[format, 1]', 'name: format\nbodies: 1', '{format: [1]}',
     '- format: 1', 'inner: {format: 1}', 'alias ll=ls', '\x00', '{' * 10_000],
)  # fmt: skip
def test_what_is_no_world_file_is_not_written_over(text: str, folder: Path) -> None:
    path = write(folder, text, 'compose.yaml')

    with pytest.raises(BadWorldFile) as refused:
        save(World(), folder, 'compose')

    assert 'no world file' in str(refused.value)
    assert path.read_text() == text


@pytest.mark.parametrize('text', ['format: 1', '# My world\n{bodies: [], format: 1}'])
def test_a_world_file_that_is_written_over_keeps_its_mode(text: str, folder: Path) -> None:
    path = write(folder, text)
    for mode in (0o600, 0o664):
        path.chmod(mode)
        save(World(), folder)
        assert path.stat().st_mode & 0o777 == mode


@pytest.mark.parametrize('kind', ['FIFO', 'device', 'directory', 'of the kernel', 'huge'])
def test_what_is_no_plain_file_is_refused_at_once(kind: str, folder: Path) -> None:
    path = folder / 'w.yaml'
    if kind == 'FIFO':
        os.mkfifo(path)
    elif kind == 'directory':
        path.mkdir()
    elif kind == 'huge':
        with path.open('w') as file:
            file.truncate(2**40)
    else:
        path.symlink_to('/dev/zero' if kind == 'device' else '/proc/self/environ')

    for read in (load, lambda path: find_world(str(path), world_dir=folder, confined=False)):
        if kind in ('of the kernel', 'huge') and read is not load:
            continue
        with pytest.raises(BadWorldFile) as refused:
            read(path)
        assert len(str(refused.value)) < 300
    with pytest.raises(BadWorldFile):
        save(World(), folder)


def test_a_world_file_of_the_working_directory_is_read_at_start(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(folder.parent, 'format: 1', 'mine.yaml')
    monkeypatch.chdir(folder.parent)

    for name in ('mine.yaml', './mine.yaml'):
        found = find_world(name, world_dir=folder, confined=False)
        assert found.resolve() == path.resolve()
        with pytest.raises(BadWorldFile):
            find_world(name, world_dir=folder, confined=True)


@pytest.mark.parametrize(
    'name', ['$(touch x)/0', 'a: b/0', '`id`/0', '\uffff/0', '😀/0', 'a\\"b/0']
)
def test_names_are_quoted(name: str, folder: Path) -> None:
    world = World()
    spawn(world, name, DISC)
    assert_round_trip(world, folder)

    text = save(world, folder).read_text()

    # YAML cannot have a noncharacter as it is.
    quoted = json.dumps(name, ensure_ascii=name == '\uffff/0')
    assert f'"name": {quoted}' in text


@pytest.mark.parametrize(
    'name', ['../w.yaml', '/w.yaml', 'sub/../../w.yaml', '.', './', '../worlds']
)
def test_nothing_is_written_outside_the_directory(name: str, folder: Path) -> None:
    (folder / 'sub').mkdir()
    before = sorted(folder.parent.rglob('*'))

    with pytest.raises(BadWorldFile):
        save(World(), folder, name)

    assert sorted(folder.parent.rglob('*')) == before
    assert not Path('/w.yaml').exists()


def test_nothing_is_written_into_a_directory_that_is_not_there(folder: Path) -> None:
    with pytest.raises(BadWorldFile):
        save(World(), folder, 'sub/w.yaml')

    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    ('module', 'function'), [(os, 'fsync'), (Path, 'replace'), (os, 'fchmod')]
)
def test_a_failing_write_leaves_the_old_file_and_nothing_else(
    module: Any, function: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World()
    path = save(world, folder)
    old = path.read_text()
    spawn(world, 'a/0', DISC)

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(module, function, fail)
    with pytest.raises(BadWorldFile) as refused:
        save(world, folder)
    monkeypatch.undo()

    assert 'No space left' in str(refused.value)
    assert list(folder.iterdir()) == [path]
    assert path.read_text() == old


def test_a_bug_in_the_middle_of_a_write_leaves_the_old_file(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World()
    path = save(world, folder)
    old = path.read_text()

    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr('physsim_ros.files.world_file.text_of', fail)
    spawn(world, 'a/0', DISC)
    with pytest.raises(ZeroDivisionError):
        save(world, folder)

    assert path.read_text() == old
    assert list(folder.iterdir()) == [path]


def test_saving_replaces_what_was_there(folder: Path) -> None:
    world = World()
    save(world, folder)
    spawn(world, 'a/0', DISC, (0.0, -G, 0.0))

    path = save(world, folder)

    assert load(path) == world.save()
    assert list(folder.iterdir()) == [path]


# Text of YAML


@pytest.mark.parametrize(
    ('text', 'value'),
    [('1e5', 1e5), ('1E-3', 1e-3), ('.5', 0.5), ('-1.', -1.0), ('+2', 2), ('010', 10), ('08', 8),
     ('1_000', '1_000'), ('1:30', '1:30'), ('0x10', '0x10'), ('yes', 'yes'), ('on', 'on'),
     ('No', 'No'), ('true', True), ('FALSE', False), ('~', None), ('', None), ('null', None),
     ('2026-01-01', '2026-01-01'), ('=', '='), ('<<', '<<'), ('.inf', float('inf')),
     ('-.INF', float('-inf')), ("'1'", '1'), ('"true"', 'true'), ('1.5.2', '1.5.2'), ('.', '.'),
     ('e5', 'e5'), ('!!float 1', 1.0), ('!!str 1', '1'), ('!!int "7"', 7)],
)  # fmt: skip
def test_plain_words_are_read_as_in_yaml_1_2(text: str, value: object) -> None:
    result = load_mapping(f'key: {text}', field='text')['key']

    assert result == value
    assert type(result) is type(value)


def test_not_a_number_is_read_as_one() -> None:
    assert np.isnan(load_mapping('key: .nan', field='text')['key'])


@pytest.mark.parametrize('text', ['', '   ', '# nothing', '---', '{}', 'null'])
def test_no_text_is_an_empty_mapping(text: str) -> None:
    assert load_mapping(text, field='text') == {}


@settings(deadline=None, max_examples=300)
@given(text=st.text(st.sampled_from('{}[]:,-!&*#|>%@`"\'?~ \n\tab01.e<=é'), max_size=40))
def test_any_text_is_a_mapping_or_malformed(text: str) -> None:
    try:
        value = load_mapping(text, field='text')
    except Malformed:
        return

    assert isinstance(value, dict)


@settings(deadline=None, max_examples=150)
@given(
    content=st.recursive(
        st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=3)),
        lambda inner: st.one_of(
            st.lists(inner, max_size=3),
            st.dictionaries(
                st.sampled_from(['name', 'circle', 'radius', 'polygon', 'at', 'motion', 'wrench',
                                 'color', 'mass', 'force', 'torque', 'compound', 'centers']),
                inner, max_size=3,
            ),
        ),
        max_leaves=12,
    )
)  # fmt: skip
def test_any_nested_junk_is_loaded_or_refused(content: object, tmp_path_factory: Any) -> None:
    folder = tmp_path_factory.getbasetemp()
    for text in (
        yaml.safe_dump(content),
        yaml.safe_dump({'format': 1, 'bodies': content}),
        yaml.safe_dump({'format': 1, 'bodies': [content]}),
    ):
        path = write(folder, text, 'junk.yaml')
        try:
            state = load(path)
        except BadWorldFile:
            continue
        restored(state).step(1)


# Joints


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
    content = yaml.safe_load(path.read_text())
    if change == 'velocity':
        content['bodies'][0]['velocity'] = [0.0, 0.0]
    elif change == 'gravity':
        content['gravity'] = [0.0, -5.0]
    path.write_text(yaml.safe_dump(content))

    again = load(path, rate=480.0 if change == 'rate' else RATE)

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
