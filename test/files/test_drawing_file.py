# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawings are read as a browser shows them, and drawn as a pen goes along them."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.files import BadDrawing, find_drawing, load_drawing, Pace, shipped
from physsim_ros.model.arrays import Floats
from physsim_ros.ros.requests.decoders import MOST_SAMPLES
import pytest

# Rounding of the reader's own, in units of the file.
CLOSE = 1e-9


def svg(directory: Path, inside: str, root: str = 'viewBox="0 0 100 50"') -> Path:
    path = directory / 'drawing.svg'
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {root}>{inside}</svg>')
    return path


def lines(directory: Path, inside: str, root: str = 'viewBox="0 0 100 50"') -> list[Floats]:
    """Return the strokes of an SVG file in its own units, densely sampled."""
    pace = Pace(speed=1.0, rate=100.0)
    return [
        stroke[:, :2]
        for stroke in load_drawing(svg(directory, inside, root), scale=1.0, pace=pace)
    ]


def written(directory: Path, content: Any) -> Path:
    path = directory / 'drawing.json'
    path.write_text(json.dumps(content))
    return path


def passes(line: Floats, *points: tuple[float, float], within: float = CLOSE) -> bool:
    """Tell whether a line goes through points, one after the other."""
    at = 0
    for point in points:
        away = np.hypot(*(line[at:] - point).T)
        near = np.flatnonzero(away <= within)
        if not len(near):
            return False
        at += int(near[0])
    return True


# Every command of a path


@pytest.mark.parametrize(
    ('d', 'points'),
    [
        ('M 10 10 L 20 10 L 20 30', [(10, 40), (20, 40), (20, 20)]),
        ('m 10 10 l 10 0 l 0 20', [(10, 40), (20, 40), (20, 20)]),
        ('M10,10 20,10 20,30', [(10, 40), (20, 40), (20, 20)]),
        ('M 10 10 H 20 V 30', [(10, 40), (20, 40), (20, 20)]),
        ('m 10 10 h 10 v 20', [(10, 40), (20, 40), (20, 20)]),
        ('M 10 10 L 20 10 L 20 30 Z', [(10, 40), (20, 40), (20, 20), (10, 40)]),
    ],
)
def test_straight_lines_keep_their_corners(tmp_path: Path, d: str, points: Any) -> None:
    (line,) = lines(tmp_path, f'<path d="{d}"/>')
    assert passes(line, *points)
    assert line[0].tolist() == pytest.approx(points[0])
    assert line[-1].tolist() == pytest.approx(points[-1])


@pytest.mark.parametrize(
    ('d', 'points'),
    [
        # Bézier curves at a half: the mean of ends and control points, by de Casteljau.
        ('M 0 0 C 0 8 8 8 8 0', [(4, 50 - 6)]),
        ('M 0 0 C 0 8 8 8 8 0 S 16 -8 16 0', [(4, 50 - 6), (12, 50 + 6)]),
        ('M 0 0 Q 4 8 8 0', [(4, 50 - 4)]),
        ('M 0 0 Q 4 8 8 0 T 16 0', [(4, 50 - 4), (12, 50 + 4)]),
        ('M 0 0 q 4 8 8 0 t 8 0', [(4, 50 - 4), (12, 50 + 4)]),
        ('M 0 0 A 4 4 0 0 0 8 0', [(4, 50 - 4)]),
        ('M 0 0 A 4 4 0 0 1 8 0', [(4, 50 + 4)]),
        ('M 0 0 a 8 2 0 0 1 16 0', [(8, 50 + 2)]),
    ],
)
def test_curves_pass_where_they_should(tmp_path: Path, d: str, points: Any) -> None:
    (line,) = lines(tmp_path, f'<path d="{d}"/>')
    # Units: half a sample, and the chord of a 64th of a curve.
    assert passes(line, *points, within=0.02)


def test_a_pen_that_is_lifted_draws_another_stroke(tmp_path: Path) -> None:
    first, second = lines(tmp_path, '<path d="M 0 0 H 10 M 0 10 H 10 Z"/>')
    assert (first[:, 1] == 50).all()
    assert second[:, 1] == pytest.approx(40)


@pytest.mark.parametrize(
    'shape',
    [
        '<rect x="10" y="10" width="10" height="20"/>',
        '<polygon points="10,10 20,10 20,30 10,30"/>',
        '<polyline points="10,10 20,10 20,30 10,30 10,10"/>',
    ],
)
def test_shapes_are_outlines(tmp_path: Path, shape: str) -> None:
    (line,) = lines(tmp_path, shape)
    assert passes(line, (10, 40), (20, 40), (20, 20), (10, 20), (10, 40))


def test_a_circle_is_round(tmp_path: Path) -> None:
    (line,) = lines(tmp_path, '<circle cx="20" cy="20" r="5"/>')
    # Between two of 64 pieces of a quarter it lies this much inside.
    assert np.hypot(*(line - (20, 30)).T) == pytest.approx(
        5.0, abs=5.0 * (1 - math.cos(math.pi / 256))
    )
    assert line[0] == pytest.approx(line[-1])


# As editors write them


def test_transforms_of_groups_are_carried_out_from_the_inside(tmp_path: Path) -> None:
    inside = (
        '<g transform="translate(10 20)"><g transform="rotate(90)">'
        '<path transform="scale(2)" d="M 0 0 H 5"/></g></g>'
    )
    (line,) = lines(tmp_path, inside)
    assert passes(line, (10, 30), (10, 20))


def test_a_page_is_measured_in_its_own_units_whatever_its_size_on_paper(tmp_path: Path) -> None:
    for root in (
        'viewBox="0 0 100 50"',
        'width="100mm" height="50mm" viewBox="0 0 100 50"',
        'width="4in" viewBox="0 0 100 50"',
        'width="100%" height="100%" viewBox="0 0 100 50"',
        'width="100" height="50"',
    ):
        (line,) = lines(tmp_path, '<path d="M 10 10 H 20"/>', root)
        assert line[0] == pytest.approx((10, 40), abs=1e-6), root
        assert line[-1] == pytest.approx((20, 40), abs=1e-6), root


def test_a_page_may_begin_anywhere(tmp_path: Path) -> None:
    (line,) = lines(tmp_path, '<path d="M 10 10 H 20"/>', 'viewBox="5 -5 100 50"')
    assert line[0] == pytest.approx((5, 35), abs=1e-9)


def test_a_page_without_a_size_hangs_from_the_origin(tmp_path: Path) -> None:
    (line,) = lines(tmp_path, '<path d="M 10 10 H 20"/>', '')
    assert line[0] == pytest.approx((10, -10))


def test_what_a_browser_does_not_show_is_not_drawn(tmp_path: Path) -> None:
    inside = (
        '<defs><path id="p" d="M 0 0 H 5"/></defs><text x="1" y="2">words</text>'
        '<path style="display:none" d="M 0 0 H 9"/><path d=""/><path d="M 3 3"/>'
        '<use href="#p" x="10" y="10"/><path d="M 4 4 L 4 4"/>'
    )
    (line,) = lines(tmp_path, inside)
    assert passes(line, (10, 40), (15, 40))


# The pen


def test_the_pen_goes_at_its_speed_and_is_sampled_at_its_rate(tmp_path: Path) -> None:
    path = svg(tmp_path, '<path d="M 0 50 H 100"/>')
    (stroke,) = load_drawing(path, scale=0.1, pace=Pace(speed=2.0, rate=50.0))
    assert stroke[-1].tolist() == [10.0, 0.0, 5.0]
    assert len(stroke) == 251
    assert np.diff(stroke[:, 2]) == pytest.approx(1 / 50)


def test_small_things_are_drawn_with_enough_samples(tmp_path: Path) -> None:
    (stroke,) = load_drawing(svg(tmp_path, '<circle cx="1" cy="1" r="1"/>'))
    assert len(stroke) >= 30


def test_however_long_a_line_is_it_has_no_more_samples_than_a_stroke_may_have(
    tmp_path: Path,
) -> None:
    points = ' '.join(f'{x},{x % 2}' for x in range(20_000))
    (stroke,) = load_drawing(svg(tmp_path, f'<polyline points="{points}"/>'), scale=1.0)
    assert MOST_SAMPLES / 2 < len(stroke) <= MOST_SAMPLES
    assert stroke[-1, :2] == pytest.approx((19_999, 49))


def test_without_a_scale_a_hundred_units_of_a_page_are_a_metre(tmp_path: Path) -> None:
    (stroke,) = load_drawing(svg(tmp_path, '<path d="M 0 50 H 100"/>'))
    assert stroke[-1, 0] == pytest.approx(1.0)


# JSON


@pytest.mark.parametrize('wrapped', [False, True])
def test_json_is_in_metres_and_y_goes_up(tmp_path: Path, *, wrapped: bool) -> None:
    strokes = [[[0, 0], [1, 2], [3, 4]], [[5, 5], [6, 5]]]
    first, second = load_drawing(written(tmp_path, {'strokes': strokes} if wrapped else strokes))
    assert first[-1, :2].tolist() == [3.0, 4.0]
    assert passes(first[:, :2], (0, 0), (1, 2), (3, 4))
    assert second[0, :2].tolist() == [5.0, 5.0]


def test_strokes_that_have_times_keep_their_samples(tmp_path: Path) -> None:
    samples = [[0, 0, 10.0], [1, 2, 10.5], [3, 4, 12.0]]
    (stroke,) = load_drawing(written(tmp_path, [samples]), scale=2.0)
    assert stroke.tolist() == [[0.0, 0.0, 0.0], [2.0, 4.0, 0.5], [6.0, 8.0, 2.0]]


# Refusals


@pytest.mark.parametrize(
    'text',
    ['', 'hello', '<html/>', '<svg xmlns="http://www.w3.org/2000/svg"/>', '<svg><path/></svg>'],
)
def test_an_svg_without_strokes_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / 'bad.svg'
    path.write_text(text)
    with pytest.raises(BadDrawing, match=r'bad\.svg'):
        load_drawing(path)


@pytest.mark.parametrize(
    'content',
    [
        {},
        [],
        3,
        'words',
        [1, 2],
        [[1, 2]],
        [[[1], [2]]],
        [[[1, 2, 3, 4]]],
        [[[1, 2], [3]]],
        [[['a', 'b'], ['c', 'd']]],
        [[[math.nan, 1], [2, 3]]],
        [[[1, 1], [1, 1]]],
        # Not beside another one either.
        [[[0, 0], [1, 1]], [[5, 5]]],
        [[[5, 5, 0]]],
        [[[0, 0], [1e308, 1e308]]],
        [[[0, 0], [1.1e7, 0]]],
        [[[0, 0], [10**400, 0]]],
        [[[0, 0, 0], [1, 1, 1e300]]],
    ],
)
def test_json_that_is_no_list_of_strokes_is_refused(tmp_path: Path, content: Any) -> None:
    with pytest.raises(BadDrawing):
        load_drawing(written(tmp_path, content))


@pytest.mark.parametrize('root', ['0 0 0 10', '0 0 10', 'a b', ''])
def test_a_page_that_cannot_be_measured_is_refused(tmp_path: Path, root: str) -> None:
    with pytest.raises(BadDrawing, match=r'drawing\.svg'):
        load_drawing(svg(tmp_path, '<path d="M 0 0 H 5"/>', f'viewBox="{root}"'))


@pytest.mark.parametrize(
    'inside',
    [
        '<path transform="rotate(a)" d="M 0 0 H 5"/>',
        '<path transform="matrix(1)" d="M 0 0 H 5"/>',
        '<path d="M 0 0 H"/>',
        '<g id="g"><path d="M 0 0 H 5"/><use href="#g"/></g>',
    ],
)
def test_an_element_that_is_not_as_it_should_be_is_refused(tmp_path: Path, inside: str) -> None:
    with pytest.raises(BadDrawing, match=r'drawing\.svg'):
        load_drawing(svg(tmp_path, inside))


def test_brackets_in_brackets_without_end_are_refused(tmp_path: Path) -> None:
    path = tmp_path / 'drawing.json'
    path.write_text('[' * 100_000)
    with pytest.raises(BadDrawing, match='nested'):
        load_drawing(path)


@pytest.mark.parametrize(
    ('scale', 'pace'), [(1e308, Pace()), (1.0, Pace(speed=1e-320)), (-1e308, Pace(rate=1e308))]
)
def test_no_stroke_reaches_or_takes_for_ever(tmp_path: Path, scale: float, pace: Pace) -> None:
    with pytest.raises(BadDrawing, match='a stroke'):
        load_drawing(svg(tmp_path, '<path d="M 0 0 H 50"/>'), scale=scale, pace=pace)


def test_however_often_a_pen_is_sampled_a_stroke_is_no_longer_than_it_may_be(
    tmp_path: Path,
) -> None:
    (stroke,) = load_drawing(svg(tmp_path, '<path d="M 0 0 H 50"/>'), pace=Pace(rate=1e308))
    assert len(stroke) <= MOST_SAMPLES


def test_a_file_that_is_not_there_or_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadDrawing, match='no drawing'):
        find_drawing(str(tmp_path / 'nothing.svg'))
    with pytest.raises(BadDrawing, match='no drawing'):
        find_drawing('nothing')
    (tmp_path / 'latin.json').write_bytes(b'["\xe9"]')
    with pytest.raises(BadDrawing, match='cannot read'):
        load_drawing(tmp_path / 'latin.json')


@pytest.mark.parametrize(
    ('name', 'strokes'),
    [('car', 6), ('pendulum', 3), ('spring_and_mass', 3), ('seesaw', 5), ('catapult', 8)],
)
def test_the_shipped_drawings_are_found_by_name(name: str, strokes: int) -> None:
    path = find_drawing(name)
    assert path.parent == shipped('drawings')
    drawn = load_drawing(path)
    assert len(drawn) == strokes
    for stroke in drawn:
        assert (stroke[:, :2] >= 0.0).all()
        assert (stroke[:, :2] <= (16.0, 10.0)).all()
