# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The forms of strokes are recognised, drawn by ruler and by many hands."""

from collections.abc import Sequence
import math

import numpy as np
from physsim_ros.drawing.geometry import spaced
from physsim_ros.drawing.strokes.features import swings_of
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.stages import Form
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
import pytest
from tools.evaluation import arrows, figures
from tools.evaluation.figures import Figure, turned
from tools.evaluation.hands import drawn, hand
from tools.evaluation.hands import stroke as drawn_by_anybody

ANGLE = np.linspace(0.0, 2.0 * math.pi, 80)
CIRCLE = np.column_stack((np.cos(ANGLE), np.sin(ANGLE)))
STAR = np.array([(math.cos(a), math.sin(a)) for a in np.arange(6) * 0.8 * math.pi])
RULED: dict[str, tuple[str, Floats]] = {
    'circle': ('disc', CIRCLE),
    'flat circle': ('disc', CIRCLE * (1.0, 0.75)),
    'circle of 12 samples': ('disc', CIRCLE[::7]),
    'circle of 9 uneven samples': ('disc', CIRCLE[[0, 9, 20, 29, 40, 48, 59, 68, 78]]),
    'circle with a gap': ('disc', CIRCLE[:74]),
    'circle, drawn on': ('disc', np.vstack((CIRCLE, CIRCLE[1:9]))),
    'circle, twice round': ('disc', np.vstack((CIRCLE, 1.04 * CIRCLE[1:70]))),
    'oval': ('oval', CIRCLE * (1.0, 0.5)),
    'thin oval': ('oval', CIRCLE * (1.0, 0.3)),
    'square, twice round': ('rectangle', np.array([(0, 0), (0, 1), (1, 1), (1, 0)] * 2)),
    'square, ends crossing': (
        'rectangle',
        np.array([(0.02, -0.1), (0, 1), (1, 1), (1, 0), (-0.08, 0.02)]),
    ),
    'pentagram': ('polygon', STAR),
    'square': ('rectangle', np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])),
    'plank': ('rectangle', np.array([(0, 0), (9, 0), (9, 0.4), (0, 0.4), (0, 0)])),
    'tilted': ('rectangle', np.array([(0, 0), (3, 1), (2.5, 2.5), (-0.5, 1.5), (0, 0)])),
    'triangle': ('polygon', np.array([(0, 0), (2, 0), (1, 1.5), (0, 0)])),
    'wedge': ('polygon', np.array([(0, 0), (4, 0), (4, 0.8), (0, 0)])),
    'rhombus': ('polygon', np.array([(0, 0), (2, 0), (3, 1.5), (1, 1.5), (0, 0)])),
    'hexagon': ('polygon', np.array([(math.cos(a), math.sin(a)) for a in range(7)])),
    'kidney': (
        'polygon',
        np.column_stack((np.cos(ANGLE) + 0.4 * np.cos(2 * ANGLE), np.sin(ANGLE))),
    ),
    'line': ('line', np.array([(0, 0), (3, 1)])),
    'corner': ('line', np.array([(0, 0), (3, 0), (3, 2)])),
    'bowl': ('line', np.array([(0, 1), (0, 0), (2, 0), (2, 1)])),
    'hill': ('line', CIRCLE[:41]),
    'zigzag': ('zigzag', np.array([(n, 0.6 * (-1) ** n) for n in range(9)])),
    'x': ('x', np.array([(0, 0), (1, 1), (1, 0), (0, 1)])),
    'x, joined below': ('x', np.array([(0, 1), (1, 0), (0, 0), (1, 1)])),
    'x, going back': ('x', np.array([(0, 1), (1, 0), (0.5, 0.5), (1, 1), (0, 0)])),
    'arrow': ('arrow', np.array([(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)])),
    'arrow, head first': (
        'arrow',
        np.array([(2.5, 0.4), (3, 0), (2.5, -0.4), (3, 0), (0, 0)]),
    ),
    'arrow, closed head': (
        'arrow',
        np.array([(0, 0), (3, 0), (2.5, 0.4), (2.5, -0.4), (3, 0)]),
    ),
    'scribble': ('scribble', np.array([(0.1 * n, n % 2) for n in range(14)])),
    'round scribble': (
        'scribble',
        np.vstack([CIRCLE[:-1] + np.array((0.05 * turn, 0.0)) for turn in range(4)]),
    ),
}


def forms_drawn(way: Floats) -> Sequence[Form]:
    """Return the forms of a stroke, the likeliest first."""
    return classification_of(resample_stroke(way)).forms


@pytest.mark.parametrize(('primitive', 'way'), RULED.values(), ids=RULED)
def test_what_is_drawn_by_ruler_is_recognised(primitive: str, way: Floats) -> None:
    best, *others = forms_drawn(way)

    assert best.name == primitive
    assert best.weight > 0.6
    assert best.weight > 2 * max((other.weight for other in others), default=0.0)


@pytest.mark.parametrize(
    ('draw', 'least'),
    [
        (figures.disc, 38),
        (figures.rectangle, 35),
        (figures.polygon, 38),
        (figures.line, 38),
        (figures.bent_line, 36),
        (figures.zigzag, 37),
        (figures.cross, 38),
        (arrows.arrow, 35),
        (figures.scribble, 38),
    ],
)
def test_of_forty_hands_nearly_all_are_read(draw, least: int) -> None:
    random = np.random.default_rng(40)
    right = 0
    for _ in range(40):
        figure: Figure = draw(random)
        found = forms_drawn(drawn_by_anybody(figure, random))
        right += bool(found) and found[0].name == figure.kind

    assert right >= least


def test_thin_planks_by_strangers_are_rectangles() -> None:
    random = np.random.default_rng(41)
    planks: list[Figure] = []
    while len(planks) < 100:
        figure = figures.rectangle(random)
        planks += [figure] if figure.thin < 0.2 else []
    strokes = [drawn(each, hand(random, each, 'strangers'), random) for each in planks]
    found = [forms_drawn(each) for each in strokes]

    assert sum(bool(each) and each[0].name == 'rectangle' for each in found) >= 92


def test_geometry_comes_with_it() -> None:
    center, rim = forms_drawn(3.0 * CIRCLE + (5.0, 7.0))[0].points
    assert center == pytest.approx((5.0, 7.0), abs=0.01)
    assert math.dist(center, rim) == pytest.approx(3.0, abs=0.02)

    (crossing,) = forms_drawn(RULED['x'][1])[0].points
    assert crossing == pytest.approx((0.5, 0.5), abs=0.02)

    tail, tip = forms_drawn(RULED['arrow, head first'][1])[0].points
    assert tail == pytest.approx((0.0, 0.0), abs=0.03)
    assert tip == pytest.approx((3.0, 0.0), abs=0.06)

    corners = forms_drawn(RULED['plank'][1])[0].points
    for corner in RULED['plank'][1]:
        # m, of a plank of 9 m
        assert np.hypot(*(corners - corner).T).min() < 0.1


@pytest.mark.parametrize(
    ('name', 'fits'),
    [
        ('oval', {'ellipse error': 0.0, 'aspect': 0.5}),
        ('square', {'rectangle error': 0.0, 'sides error': 0.0, 'corners': 4.0}),
        ('triangle', {'sides error': 0.0, 'corners': 3.0}),
    ],
)
def test_an_outline_has_the_measures_of_all_fits(name: str, fits: dict[str, float]) -> None:
    measures = classification_of(resample_stroke(RULED[name][1])).fits

    # Shares of the size, and corners.
    assert {each: measures[each] for each in fits} == pytest.approx(fits, abs=0.001)


def test_a_pentagram_is_a_solid_of_ten_corners_and_an_oval_is_fine_enough_to_roll() -> None:
    star = forms_drawn(STAR)[0].points
    radii = np.hypot(*star.T)

    assert len(star) == 10
    # m: the inner corners of a pentagram lie on a circle of 0.382 of its radius
    assert np.sort(radii) == pytest.approx([0.382] * 5 + [1.0] * 5, abs=0.04)

    oval = forms_drawn(CIRCLE * (1.0, 0.5))[0].points
    assert len(oval) >= 32
    # m: half axes
    assert np.abs(oval).max(axis=0) == pytest.approx((1.0, 0.5), abs=0.01)


@pytest.mark.parametrize(('aspect', 'form'), [(0.62, 'disc'), (0.5, 'oval')])
def test_a_flat_circle_is_a_disc_and_the_other_form_is_offered(aspect: float, form: str) -> None:
    angle = np.linspace(0.0, 2.0 * math.pi, 60)
    flat = np.column_stack((np.cos(angle), aspect * np.sin(angle)))

    first, second, *_ = classification_of(resample_stroke(flat)).forms

    assert first.name == form
    assert {first.name, second.name} == {'disc', 'oval'}


def test_swings_are_counted_and_measured_across_their_advance() -> None:
    swings = swings_of(resample_stroke(np.array([(n, 1.5 * (-1) ** n) for n in range(9)])).points)

    assert swings.count == 8
    # m, and shares: corners of a stroke of 128 points are a little cut off.
    assert swings.height == pytest.approx(3.0, rel=0.05)
    assert swings.spread == pytest.approx(1 / 3 / 0.23, rel=0.1)
    assert swings.steady == pytest.approx(1.0, abs=0.01)


def test_a_brace_whose_tip_is_retraced_is_a_line_and_a_pigtail_no_x() -> None:
    upper = np.array([(0.2, 1.0), (0.05, 0.9), (0.0, 0.7), (0.0, 0.1), (-0.1, -0.04), (-0.5, 0.0)])
    brace = np.vstack((upper, upper[-2::-1] * (1.0, -1.0)))
    loop = 0.3 * np.column_stack((np.sin(ANGLE), 1.0 - np.cos(ANGLE)))
    pigtail = np.vstack(([(-0.7, 0.0)], loop, [(0.7, 0.0)]))

    assert forms_drawn(brace)[0].name == 'line'
    found = forms_drawn(pigtail)
    assert not any(each.name == 'x' and each.weight > 0.1 for each in found)


@pytest.mark.parametrize(
    'arms', [(0.6, 1.4, 1.0, 0.8), (1.4, 0.7, 0.6, 1.2), (1.0, 1.0, 0.6, 0.6)]
)
def test_an_x_of_unequal_arms_is_no_arrow(arms: tuple[float, ...]) -> None:
    ends = np.array([(-1, 1), (1, -1), (1, 1), (-1, -1)]) * np.array(arms)[:, None]

    best, *others = forms_drawn(ends)

    assert best.name == 'x'
    assert not any(each.name == 'arrow' and each.weight > 0.2 for each in others)


@pytest.mark.parametrize('height', [0.2, 0.4, 0.6, 1.0])
def test_a_thin_wedge_is_no_plank(height: float) -> None:
    wedge = np.array([(0, 0), (4, 0), (4, height), (0, 0)])

    best = forms_drawn(wedge)[0]

    assert best.name == 'polygon'
    assert best.weight > 0.7


@pytest.mark.parametrize(('corners', 'form'), [(7, 'polygon'), (8, 'polygon'), (60, 'disc')])
def test_a_regular_polygon_of_flat_corners_is_no_disc(corners: int, form: str) -> None:
    random = np.random.default_rng(corners)
    angle = np.linspace(0.0, 2.0 * math.pi, corners + 1)
    found = []
    for _ in range(40):
        path = np.column_stack((np.cos(angle), np.sin(angle)))
        path[1:-1] += random.normal(0.0, 0.02, (corners - 1, 2)) if form == 'polygon' else 0.0
        samples = spaced(turned(path, random.uniform(0.0, 7.0)), 200)
        found.append(forms_drawn(samples + random.normal(0.0, 0.005, samples.shape))[0].name)

    assert found.count(form) >= 39


@pytest.mark.parametrize('closing', [-0.1, -0.05, 0.1, 0.17])
@pytest.mark.parametrize('slip', [0.0, 0.1])
def test_a_circle_with_a_gap_or_an_overlap_is_a_disc(closing: float, slip: float) -> None:
    angle = np.linspace(0.0, 2.0 * math.pi * (1.0 + closing), 50)
    # The end lies inside of the beginning, as of a spiral.
    radius = 1.0 - slip * np.clip(np.linspace(-2.0, 1.0, 50), 0.0, 1.0)
    way = radius[:, None] * np.column_stack((np.cos(angle), 0.85 * np.sin(angle)))

    assert forms_drawn(way)[0].name == 'disc'
