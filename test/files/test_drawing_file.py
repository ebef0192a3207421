# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawing files are read as they are, or refused with the field that is wrong."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as some
from physsim_ros.files import BadDrawing, drawings, load_drawing
from physsim_ros.model.settings import MOST_SAMPLES
import pytest

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
    max_leaves=20,
)


@settings(deadline=None)
@given(content=ANY | some.fixed_dictionaries({'strokes': some.lists(ANY)}))
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
