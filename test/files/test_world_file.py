# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A saved world loads again to the bit; a world that is written by hand loads, too."""

import itertools
from pathlib import Path
from types import SimpleNamespace
from typing import Any
import unicodedata

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files import save_world, text_of
from physsim_ros.model.colors import color_of
from physsim_ros.model.errors import BadWorldFile, WorldFull
from physsim_ros.model.requests import Anchor, Command, Configure, Release
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pytest
import yaml

from .world_files import assert_round_trip, COLORS, load, loaded, restored, save, write
from ..building import body, BOX, DISC, ELL, pose, SHAPES, spawn, twist

# Round trips


@pytest.mark.parametrize(
    'said',
    [{}, {'gravity': (0.1, -1 / 3), 'damping': 0.3, 'iterations': 17, 'density': 2.2,
          'bounds': (-1 / 3, 0.0, 7.7, 1e3), 'friction': 0.7, 'datum': (48.1, 11.6),
          'elasticity': 1.0, 'command_timeout': 0.0, 'floor_friction': 0.3, 'seed': 7}],
)  # fmt: skip
def test_an_empty_world_and_its_settings_round_trip(said: dict[str, Any], folder: Path) -> None:
    assert_round_trip(World(settings=WorldSettings(**said)), folder)


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


@pytest.mark.parametrize(
    'said',
    [*({'color': color} for color in COLORS.values()),
     {'mass': 1 / 3}, {'density': 1e-3}, {'friction': 0.1 + 0.2}, {'elasticity': 2 / 3},
     {'group': -(2**31)}, {'group': 7}, {'label': 'm₁: "#{x}"\n\ufeff 2'},
     {'velocity': (1e-7, 1e5)}, {'spin': -1e5},
     {'forces': [{'force': [1 / 3, -2], 'at': [0.1, 1e-7], 'axes': 'body'}, {'force': [0, 1]}]},
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


def test_no_more_of_a_world_is_written_than_its_text_may_be_long() -> None:
    world = World()
    spawn(world, 'a/0', DISC)
    state = world.save()
    text = text_of(state, world.physics_rate)
    assert text_of(state, world.physics_rate, longest=len(text)) == text
    endless = SimpleNamespace(
        lesson=None, settings=state.settings, bodies=itertools.cycle(state.bodies)
    )
    endless.at_rate = lambda _: endless
    with pytest.raises(WorldFull, match=f'longer than {len(text)} characters'):
        text_of(endless, world.physics_rate, longest=len(text))


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


def test_a_wrench_that_has_ended_acts_no_more_when_it_is_loaded(folder: Path) -> None:
    world = World(settings=WorldSettings(command_timeout=0.01))
    spawn(world, 'a/0', DISC)
    world.apply(Command(names=('a/0',), wrenches=((1.0, 2.0, 3.0),)))
    world.step(3)

    assert_round_trip(world, folder)
    again = restored(load(save(world, folder)))
    for each in (world, again):
        each.step(1)
    assert (again.snapshot().twists == world.snapshot().twists).all()


def test_a_body_with_a_mass_round_trips_though_the_worlds_density_has_changed(
    folder: Path,
) -> None:
    world = World()
    spawn(world, 'a/0', DISC, mass=2.0)
    world.apply(Configure(changes={'density': 2.0}))

    assert_round_trip(world, folder)
    again = restored(load(save(world, folder)))
    assert again.digest() == world.digest()


def test_what_is_loaded_is_saved_as_the_same_file_before_it_has_stepped(folder: Path) -> None:
    # Contacts of which the world that has not stepped knows nothing, and the rebuilt one does.
    world = World()
    for number in range(2):
        spawn(world, f'a/{number}', BOX, (0.5 * number, 0.0, 0.0))
    text = save(world, folder).read_text()

    again = restored(load(save(world, folder)))

    assert save(again, folder, 'again').read_text() == text


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


def test_the_heaviest_body_round_trips_where_it_rests(folder: Path) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, -1e3), bounds=(-8.0, 0.0, 8.0, 30.0)))
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0), mass=1e12)
    world.step(100)

    memory = world.save().memory
    assert memory is not None
    assert np.abs(memory.impulses).max() > 1e11
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
    assert len(lines) < len(WorldSettings.FIELDS) + 7


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
    text = 'format: 1\nbodies: [{name: ball/0, circle: {radius: 1}}]'
    world = loaded(text, folder, density=2.0)

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

    red, green, half = 1.0, 0.0, 128 / 255
    assert [each.color for each in world.snapshot().scene.bodies] == [
        (red, green, half, 1.0),
        (red, green, half, 0.0),
        (red, green, 0.5, 0.25),
    ]


def test_the_names_of_a_file_are_compared_in_one_spelling(folder: Path) -> None:
    decomposed = unicodedata.normalize('NFD', 'Würfel')
    body = f'- {{name: {decomposed}/0, circle: {{radius: 1}}}}\n'
    joint = f'- {{name: {decomposed}/1, kind: axle, a: Würfel/0, points: [[0, 0]]}}\n'
    text = f'format: 1\nbodies:\n{body}joints:\n{joint}'
    state = load(write(folder, text))
    assert [each.body.name for each in state.bodies] == ['Würfel/0']
    assert [each.name for each in state.joints] == ['Würfel/1']
    for entry in (body.replace(decomposed, 'Würfel'), body):
        with pytest.raises(BadWorldFile, match='twice'):
            load(write(folder, text.replace('joints:\n', f'{entry}joints:\n')))
