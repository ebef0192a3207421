# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""physsim_draw, as people start it, draws a drawing into a world as they start it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from ..outside import Outside, Program

SQUARE = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 400">{}</svg>'
TWO = '<rect x="100" y="200" width="200" height="100"/><circle cx="200" cy="100" r="50"/>'


def draw(outside: Outside, *words: object) -> Program:
    return outside.start_installed('physsim_draw', *words)


def drawing(directory: Path, inside: str) -> Path:
    path = directory / 'drawing.svg'
    path.write_text(SQUARE.format(inside))
    return path


@pytest.fixture
def world(outside: Outside) -> Any:
    """Give a running world without gravity."""
    with outside.start_world(gravity='[0.0, 0.0]') as world:
        world.wait_for('ready')
        yield world
        assert world.interrupt() == 0


@pytest.mark.usefixtures('world')
def test_every_stroke_is_drawn_and_its_answers_are_told(outside: Outside, tmp_path: Path) -> None:
    with draw(outside, drawing(tmp_path, TWO), '--at', -1, 2) as program:
        assert program.finish() == 0, program.lines
    assert [line.split()[0] for line in program.lines] == ['1/2', '1/2', '2/2', '2/2']
    told = ''.join(program.lines)
    assert 'spawned drawn/0' in told
    assert 'spawned drawn/1' in told


@pytest.mark.usefixtures('world')
def test_a_stroke_that_is_refused_is_told_and_the_others_are_drawn(
    outside: Outside, tmp_path: Path
) -> None:
    dot = '<path d="M 10 10 L 10.01 10"/>'
    with draw(outside, drawing(tmp_path, dot + TWO), '--once') as program:
        assert program.finish() == 1
    assert program.lines[0].startswith('1/3  refused: ')
    assert 'spawned drawn/1' in ''.join(program.lines)
    assert '1 of 3 strokes were refused' in program.lines[-1]


def test_strokes_build_a_car_while_time_stands_still_and_then_it_rolls(outside: Outside) -> None:
    with outside.start_world() as world:
        world.wait_for('ready')
        with draw(outside, 'car', '--once', '--pause') as program:
            assert program.finish() == 0, program.lines
        seen = outside.run_program('watch', 1.5)
        assert world.interrupt() == 0
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


@pytest.mark.parametrize(
    ('words', 'told', 'code'),
    [
        (['see-saw'], "nearest is 'seesaw'", 1),
        (['--list'], 'pendulum', 0),
        (['car', '--world', '/nobody', '--patience', 0.5], 'no world at /nobody', 1),
        (['car', '--ros-args', '-p'], 'physsim_draw: Failed to parse ROS arguments', 1),
        (['car', '--speed', 0], 'no positive number', 2),
    ],
)
def test_what_cannot_be_drawn_is_told_at_once(
    outside: Outside, words: list[object], told: str, code: int
) -> None:
    with draw(outside, *words) as program:
        assert program.finish() == code
    assert told in ''.join(program.lines)
    assert 'Traceback' not in ''.join(program.lines)


def test_it_ends_when_it_is_interrupted_and_lets_time_go_on(
    outside: Outside, tmp_path: Path
) -> None:
    # The first is drawn in a moment, and the second would take half a minute.
    long = '<path d="M 10 300 H 110"/><path d="M 0 100 H 400"/>'
    with outside.start_world() as world:
        world.wait_for('ready')
        words = (drawing(tmp_path, long), '--scale', 0.05, '--speed', 0.7, '--pause')
        with draw(outside, *words) as program:
            program.wait_for('1/2')
            assert program.interrupt() == 130
        assert 'Traceback' not in ''.join(program.lines)
        # Waits for as much simulation time.
        outside.run_program('watch', 0.5)
        assert world.interrupt() == 0
