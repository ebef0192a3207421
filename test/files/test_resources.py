# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shipped files: titles; robots by name and with changes; drawings, or refusals of them."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as some
from physsim_ros.files import (
    BadDrawing,
    drawings,
    load_drawing,
    shipped_robots,
    spawn_from,
    title_of,
    with_shipped_robot,
)
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.robots import Robot
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.shapes import Box, Disc
import pytest

from .world_files import write
from ..source_tree import ROOT


@pytest.mark.parametrize(
    ('text', 'title'),
    [
        ('# A pendulum,\n# swung. And more.\nformat: 1', 'A pendulum, swung'),
        ('# A pendulum\nformat: 1\nbodies: [{label: "Hi. there"}]', 'A pendulum'),
        ('format: 1\n# A comment of a key. More.\n', 'own'),
        (f'# {"long " * 100}. More.', 'own'),
        ('format: 1', 'own'),
        ('# .\n', 'own'),
        ('', 'own'),
    ],
)
def test_a_title_is_the_first_sentence_of_a_file_or_its_name(
    folder: Path, text: str, title: str
) -> None:
    assert title_of(write(folder, text, 'own.yaml')) == title


def test_the_title_of_a_file_that_cannot_be_read_is_its_name(folder: Path) -> None:
    (folder / 'own.yaml').symlink_to('own.yaml')

    assert title_of(folder / 'own.yaml') == 'own'


def test_the_shipped_robots_are_those_that_the_interface_names():
    page = (ROOT / 'docs' / 'interface' / 'properties.md').read_text(encoding='utf-8')
    assert f'(`{"`, `".join(shipped_robots())}`' in page


@pytest.mark.parametrize('name', shipped_robots())
def test_a_shipped_robot_is_a_body_by_its_name_alone(name):
    spawn = spawn_from({'name': 'robot/0', 'robot': name})

    assert spawn.properties.robot == Robot.from_mapping(spawn.properties.robot.entry())
    properties = spawn.properties
    assert properties.anchored or properties.mass > 0.0
    assert spawn.color is not None


def test_a_body_keeps_what_it_says_itself():
    spawn = spawn_from(
        {
            'name': 'tb3/0',
            'box': {'width': 1, 'height': 1},
            'density': 2.0,
            'robot': {'from': 'turtlebot3_burger', 'drive': {'max_speed': 1}, 'sensors': []},
        }
    )

    assert spawn.shape == Box(width=1.0, height=1.0)
    assert (spawn.properties.mass, spawn.properties.density) == (None, 2.0)
    assert spawn.properties.robot.drive.max_speed == 1.0
    assert spawn.properties.robot.drive.track == 0.16
    assert spawn.properties.robot.sensors == ()


def test_a_sensor_is_changed_by_its_name():
    changes = {'scan': {'beams': 90, 'noise': 0}, 'imu': {'name': 'imu/data'}}
    entry = {'robot': {'from': 'turtlebot3_burger', 'sensors': changes}}
    shipped = Robot.from_mapping(with_shipped_robot({'robot': 'turtlebot3_burger'}, [])['robot'])

    laser, imu, wheels = Robot.from_mapping(with_shipped_robot(entry, [])['robot']).sensors

    assert (laser.beams, laser.noise, laser.range) == (90, 0.0, shipped.sensors[0].range)
    assert (imu.name, imu.rate) == ('imu/data', shipped.sensors[1].rate)
    assert wheels == shipped.sensors[2]


def test_a_drive_of_another_kind_keeps_nothing_of_the_shipped_one():
    entry = {'robot': {'from': 'car', 'drive': {'kind': 'omni'}}}

    robot = Robot.from_mapping(with_shipped_robot(entry, [])['robot'])

    assert robot.drive.entry() == Robot.from_mapping({'drive': {'kind': 'omni'}}).drive.entry()


def test_a_body_without_a_shape_of_its_own_has_that_of_the_robot():
    assert spawn_from({'name': 'tb3/0', 'robot': 'turtlebot3_burger'}).shape == Disc(radius=0.105)


@pytest.mark.parametrize(
    ('robot', 'refusal', 'field'),
    [
        ('turtlebot3_burgr', BadProperty, 'robot'),
        ('../worlds/demo', BadProperty, 'robot'),
        ({'from': 3}, BadProperty, 'from'),
        ({'from': 'car', 'drv': {}}, UnknownProperty, 'drv'),
        ({'from': 'car', 'drive': {'speed': 1}}, UnknownProperty, 'speed'),
        ({'from': 'turtlebot4', 'sensors': {'scn': {'beams': 9}}}, BadProperty, 'sensors'),
        ({'from': 'turtlebot4', 'sensors': {'scan': 9}}, BadProperty, 'sensors'),
        ({'from': 'turtlebot4', 'sensors': {'scan': {'beam': 9}}}, UnknownProperty, 'beam'),
        ({'drive': {'kind': 'omni'}, 'sensors': {'scan': {}}}, BadProperty, 'sensors'),
        (['car'], BadProperty, 'robot'),
    ],
)
def test_what_is_no_robot_is_refused(robot, refusal, field):
    with pytest.raises(refusal) as caught:
        spawn_from({'name': 'a/0', 'circle': {'radius': 1}, 'robot': robot})

    assert caught.value.field == field


def test_the_nearest_robot_is_named():
    with pytest.raises(BadProperty, match="nearest is 'turtlebot3_burger'"):
        with_shipped_robot({'robot': 'turtlebot_burger'}, [])


LINE = [[0, 0], [1.5, 2]]


def written(directory: Path, content: Any) -> str:
    path = directory / 'drawing.json'
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return str(path)


def one(**stroke: Any) -> dict[str, Any]:
    return {'strokes': [{'points': LINE}, stroke]}


def test_each_point_is_a_sample_and_a_name_is_told(tmp_path: Path) -> None:
    (first, line), (second, _) = load_drawing(written(tmp_path, one(name='rod', points=LINE)))
    assert (first, second) == ('', 'rod')
    assert line.tolist() == [[0.0, 0.0, 0.0], [1.5, 2.0, 0.0]]


def test_a_name_cannot_write_to_the_terminal_but_its_letters(tmp_path: Path) -> None:
    (_, (name, _)) = load_drawing(written(tmp_path, one(name='\x1b[2J\ud800', points=LINE)))
    assert name == r'\x1b[2J\ud800'


@pytest.mark.parametrize(
    ('content', 'field'),
    [
        *(([], 'strokes'), (3, 'strokes'), ({}, 'strokes'), ({'strokes': {}}, 'strokes')),
        ({'strokes': []}, 'strokes'),
        ({'strokes': [{'points': LINE}] * 1001}, 'strokes'),
        ({'strokes': [LINE]}, 'strokes[0]'),
        (one(points=LINE, name=1), 'strokes[1].name'),
        (one(), 'strokes[1].points'),
        (one(points=LINE[:1]), 'strokes[1].points'),
        (one(points=[[0, 0]] * (MOST_SAMPLES + 1)), 'strokes[1].points'),
        (one(points=[[0, 0], 1]), 'strokes[1].points[1]'),
        *(
            (one(points=[[0, 0], point]), 'strokes[1].points[1]')
            for point in (
                *([1], [1, 2, 3], ['1', '2'], [[1], [2]], [True, 1], [None, 1]),
                *([float('nan'), 1], [float('inf'), 1], [1, 1.1e7], [10**400, 1]),
            )
        ),
    ],
)
def test_what_is_no_drawing_is_refused_with_its_field(
    tmp_path: Path, content: Any, field: str
) -> None:
    with pytest.raises(BadDrawing) as refused:
        load_drawing(written(tmp_path, content))
    assert (refused.value.code, refused.value.field) == ('bad_drawing', field)


@pytest.mark.parametrize(
    'text', ['', 'svg', '[' * 100_000, '{"a":' * 100_000, '9' * 5000, ' ' * (2**20 + 1)]
)
def test_what_is_no_json_or_too_large_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(BadDrawing, match='cannot read'):
        load_drawing(written(tmp_path, text))


def test_a_file_that_is_not_there_or_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'latin.json').write_bytes(b'["\xe9"]')
    os.mkfifo(tmp_path / 'pipe.json')
    for name in ('latin.json', 'pipe.json', 'none.json', '.', 'a\0.json', 'a' * 300 + '.json'):
        with pytest.raises(BadDrawing, match='cannot read'):
            load_drawing(str(tmp_path / name))
    for name in ('', '..', 'a\0', 'a' * 300):
        with pytest.raises(BadDrawing, match='cannot read'):
            load_drawing(name)
    with pytest.raises(BadDrawing, match="nearest is 'seesaw'"):
        load_drawing('see-saw')


ANY = some.recursive(
    some.none() | some.booleans() | some.floats() | some.integers() | some.text(),
    lambda each: (
        some.lists(each)
        | some.dictionaries(some.sampled_from(['strokes', 'points', 'name']), each)
    ),
    max_leaves=8,
)


@settings(deadline=None)
@given(content=ANY | some.fixed_dictionaries({'strokes': some.lists(ANY, max_size=4)}))
def test_any_json_is_a_drawing_or_refused(
    tmp_path_factory: pytest.TempPathFactory, content: Any
) -> None:
    path = written(tmp_path_factory.getbasetemp(), content)
    try:
        strokes = load_drawing(path)
    except BadDrawing:
        return
    assert strokes


@pytest.mark.parametrize('name', drawings())
def test_the_shipped_drawings_lie_in_a_world_of_16_by_10_metres(name: str) -> None:
    for stroke, points in load_drawing(name):
        assert stroke
        assert (points[:, :2] >= 0.0).all()
        assert (points[:, :2] <= (16.0, 10.0)).all()
