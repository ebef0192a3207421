# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The example draw.py, as people start it, draws a drawing in a world as they start it."""

from __future__ import annotations

import json
import math
from pathlib import Path
import sys

import pytest

from ..outside import Outside, Program, ROOT


def draw(outside: Outside, *words: object) -> Program:
    return outside.start(sys.executable, ROOT / 'examples' / 'draw.py', *words)


def test_strokes_build_a_car_that_rolls(outside: Outside) -> None:
    with outside.start_world() as world:
        world.wait_for('ready')
        with draw(outside, 'car', '--at', -1, 0.5) as program:
            assert program.finish() == 0, program.lines
        seen = outside.run_program('watch', 1.5)
        assert world.interrupt() == 0
    assert 'ground: a wall of 15.5 m\n' in program.lines
    assert 'front axle: joined drawn/3 to drawn/1 by axle drawn/1\n' in program.lines
    first, last = seen['first'], seen['last']
    road, body, rear, front = (f'drawn/{number}' for number in range(4))
    assert set(first) == set(last) == {road, body, rear, front}
    # m
    assert last[body][0] > first[body][0] + 1.0
    assert last[road] == first[road]
    for wheel in (rear, front):
        assert math.dist(last[wheel], last[body]) == pytest.approx(
            math.dist(first[wheel], first[body]), abs=0.01
        )


def test_a_stroke_that_is_refused_is_told_and_the_others_are_drawn(
    outside: Outside, tmp_path: Path
) -> None:
    dot, line = [[0, 5], [0.0001, 5]], [[0, 1], [3, 1]]
    path = tmp_path / 'drawing.json'
    path.write_text(json.dumps({'strokes': [{'points': dot}, {'points': line}]}))
    with outside.start_world() as world:
        world.wait_for('ready')
        with draw(outside, path) as program:
            assert program.finish() == 1, program.lines
        assert world.interrupt() == 0
    assert '1: spawned drawn/0\n' in program.lines
    assert 'draw.py: 1 of 2 strokes were refused\n' in program.lines


def test_a_drawing_that_cannot_be_read_is_told_at_once(outside: Outside) -> None:
    with draw(outside, 'see-saw') as program:
        assert program.finish() == 1
    assert "nearest is 'seesaw'" in program.lines[-1]
    assert len(program.lines) == 1
