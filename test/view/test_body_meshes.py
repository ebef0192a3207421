# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies in the picture: where they are, how large, of which colour and shape."""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.media import Medium
from physsim_ros.model.shapes import (
    Box,
    Chain,
    Compound,
    contains,
    contains_each,
    Disc,
    Polygon,
    Triangles,
)
from physsim_ros.view.body_mesh import body_mesh
import pytest

from .picture_file import BLUE, body, COLOR_TOLERANCE, frame, RED, scene, TOLERANCE, unpack


def test_a_box_has_the_place_turn_size_and_colour_that_were_asked_for(recording):
    recording.draw(frame(scene(body()), [(-3.0, 4.0, math.pi / 2)]))

    box = recording.shape('world/bodies/box/0')
    assert box.bounds == pytest.approx((-3.5, 3.0, -2.5, 5.0), abs=TOLERANCE)
    assert box.color_at(-3.0, 4.0) == pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert box.color_at(-3.6, 4.0) is None


def test_bodies_that_look_alike_are_one_entity_and_each_has_its_own_size_and_name(recording):
    sizes = (0.45, 0.5, 0.54)
    discs = [body(f'ball/{n}', Disc(radius=size)) for n, size in enumerate(sizes)]

    recording.draw(frame(scene(*discs), [(4.0 * n, 1.0, 9.0) for n in range(3)]))

    (drawn,) = recording.shapes('world/bodies/ball/0')
    for number, (size, disc) in enumerate(zip(sizes, drawn, strict=True)):
        box = (4 * number - size, 1 - size, 4 * number + size, 1 + size)
        assert disc.bounds == pytest.approx(box, abs=0.002 * size)
    assert [*recording.last('world/bodies/ball/0', 'name')] == ['ball/0', 'ball/1', 'ball/2']


def test_every_body_has_its_name_and_label_at_its_centre(recording):
    both = scene(body('box/0'), body('box/1', label='m1'))

    recording.draw(*(frame(both, [(0, 0, 0), (step, 2, 0)], step=4 * step) for step in range(7)))
    recording.draw(frame(scene(body('box/0')), [(0, 0, 0)], step=28))

    names = recording.rows('world/names', 'Points3D:labels')
    assert [*names[0].value] == ['box/0', 'box/1']
    rows = recording.rows('world/names', 'Points3D:positions')
    assert [row.frame for row in rows] == [0, 6, 7]
    assert rows[1].value[:, :2].tolist() == [[0, 0], [6, 2]]
    # And its label, as long as it has one.
    labels = recording.rows('world/labels', 'Points3D:labels')
    assert [[*row.value] for row in labels] == [['m1'], []]
    places = recording.rows('world/labels', 'Points3D:positions')
    assert [row.value[0, :2].tolist() for row in places[:-1]] == [[0, 2], [6, 2]]
    assert not len(places[-1].value)


def test_a_disc_is_round(recording):
    recording.draw(frame(scene(body(shape=Disc(radius=100.0))), [(0, 0, 0)]))

    disc = recording.shape('world/bodies/box/0')
    reach = np.hypot(*disc.corners.T)
    rim = disc.corners[reach > 99.9]
    angles = np.sort(np.arctan2(rim[:, 1], rim[:, 0]))
    # The middle of a chord: half a pixel within a circle of 400 pixels.
    assert 1 - math.cos(np.diff(angles).max() / 2) < 0.5 / 400


def test_every_body_has_an_outline_that_is_darker_than_it(recording):
    star = Polygon(outline=((0, 0), (4, 0), (4, 4), (2, 1), (0, 4)))
    recording.draw(frame(scene(body(shape=star)), [(0, 0, 0)]))

    drawn = recording.shape('world/bodies/box/0')
    fill, edge = drawn.color_at(2.0, 0.5), drawn.color_at(2.0, 0.005)
    assert fill == pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert all(dark <= light for dark, light in zip(edge, fill, strict=True))
    assert edge[0] < 0.7 * fill[0]


def test_a_mark_on_a_disc_shows_that_it_rolls(recording):
    disc = scene(body(shape=Disc(radius=1.0)))

    recording.draw(frame(disc, [(0, 0, 0)]), frame(disc, [(0, 0, math.pi / 2)], step=4))

    (first,), (second,) = recording.shapes('world/bodies/box/0')
    assert first.color_at(0.5, 0.003) != first.color_at(0.003, 0.5)
    assert second.color_at(0.003, 0.5) == first.color_at(0.5, 0.003)
    assert second.color_at(0.5, 0.003) == pytest.approx(RED, abs=COLOR_TOLERANCE)


@pytest.mark.parametrize(
    'shape',
    [
        Polygon(outline=((0, 0), (4, 0), (0, 2))),
        Polygon(outline=((0, 0), (0, 2), (4, 0))),
        Polygon(outline=((0, 0), (2, 0), (2, 2), (1, 0.5))),
        Triangles(vertices=((0, 0), (1, 0), (0, 1), (2, 0), (3, 0), (2, -1))),
        Chain(points=((0, 0), (4, 0), (4, 3)), thickness=0.2),
        Compound(element=Box(width=0.2, height=0.2), centers=((-1, 0), (1, 0))),
    ],
    ids=['ramp', 'clockwise', 'concave', 'triangles', 'chain', 'compound'],
)
def test_a_shape_is_filled_where_it_is_and_nowhere_else(recording, shape):
    recording.draw(frame(scene(body(shape=shape)), [(5.0, 1.0, 0.4)]))

    drawn = recording.shape('world/bodies/box/0')
    grid = np.random.default_rng(7).uniform(-1.3, 4.3, (2000, 2))
    there = grid @ np.array([[math.cos(0.4), math.sin(0.4)], [-math.sin(0.4), math.cos(0.4)]])
    filled = [drawn.color_at(x, y) is not None for x, y in there + np.array((5.0, 1.0))]
    expected = contains_each(shape.form, *grid.T)
    # Points within a hundredth of an edge may lie on either side of a chord.
    assert np.mean(filled != expected) < 0.005


def test_a_later_body_lies_above_an_earlier_one(recording):
    two = scene(body('a/0', color=RED), body('a/1', color=BLUE), body('a/2', color=RED))

    recording.draw(frame(two, [(0, 0, 0), (0.5, 0, 0), (0.7, 0, 0)]))

    ((first, last),) = recording.shapes('world/bodies/a/0')
    assert first.z < recording.shape('world/bodies/a/1').z < last.z


@pytest.mark.parametrize('shape', [Box(width=2.0, height=1.0), Disc(radius=1.0)])
def test_an_anchored_body_bears_an_anchor_and_a_free_one_does_not(recording, shape):
    both = scene(body(shape=shape, anchored=True), body('box/1', color=BLUE))
    recording.draw(frame(both, [(3.0, 4.0, 0.0), (9.0, 4.0, 0.0)]))

    anchored, free = recording.shape('world/bodies/box/0'), recording.shape('world/bodies/box/1')
    # The shank of the anchor is upright, in the middle of the body.
    assert anchored.color_at(3.001, 4.001) != pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert free.color_at(9.001, 4.001) == pytest.approx(BLUE, abs=COLOR_TOLERANCE)


def test_the_anchor_of_a_concave_body_lies_on_the_body(recording):
    horseshoe = Polygon(outline=((0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)))

    recording.draw(frame(scene(body(shape=horseshoe, anchored=True)), [(0, 0, 0)]))

    drawn = recording.shape('world/bodies/box/0')
    inked = drawn.corners[(drawn.colors[:, :3] > 0.99).all(axis=1)]
    assert len(inked)
    assert contains_each(horseshoe.form, *inked.T).all()


def pool(flow, shape=None, **changes):
    water = Medium(density=2.0, flow=flow)
    shape = shape or Box(width=9.0, height=6.0)
    return body('pool/0', shape, anchored=True, sensor=True, medium=water, **changes)


def inked(drawn):
    """Return the corners that have another colour than the body, (k, 2) [m]."""
    return drawn.corners[np.abs(drawn.colors - RED).max(axis=1) > COLOR_TOLERANCE]


def test_still_water_has_neither_arrows_nor_an_anchor(recording):
    recording.draw(frame(scene(pool((0.0, 0.0))), [(0, 0, 0)]))

    outline = {(x, y) for x in (-4.5, 4.5) for y in (-3.0, 3.0)}
    assert {(x, y) for x, y in inked(recording.shape('world/bodies/pool/0')).tolist()} == outline


@pytest.mark.parametrize('flow', [(2.0, 0.0), (0.0, -0.1), (-3.0, 4.0)])
def test_water_has_arrows_along_its_flow_that_turn_with_it(recording, flow):
    recording.draw(frame(scene(pool(flow)), [(5.0, 1.0, math.pi / 2)]))

    corners = inked(recording.shape('world/bodies/pool/0')) - (5.0, 1.0)
    # Outline and places of the arrows are symmetric; their barbs lie ahead.
    x, y = corners.mean(axis=0) / np.hypot(*corners.mean(axis=0))
    speed = math.hypot(*flow)
    assert (x, y) == pytest.approx((-flow[1] / speed, flow[0] / speed), abs=1e-3)


def test_the_arrows_of_a_flow_lie_in_its_region(recording):
    river = Chain(points=((0, 0), (12, 0), (12, 9)), thickness=2.0)
    recording.draw(frame(scene(pool((1.0, 1.0), river)), [(0, 0, 0)]))

    corners = recording.shape('world/bodies/pool/0').corners
    still = body_mesh(pool((0.0, 0.0), river), 1.0).vertices
    assert len(corners) > len(still)
    # Half the width of a line, and float32.
    assert all(contains(river.form.pieces, x, y, slack=0.04) for x, y in corners.tolist())


def test_a_sensor_is_translucent(recording):
    recording.draw(frame(scene(body(sensor=True), body('box/1')), [(0, 0, 0), (5, 0, 0)]))

    factors = [
        unpack(recording.last(f'world/bodies/box/{n}', 'Mesh3D:albedo_factor'))[0, 3]
        for n in (0, 1)
    ]
    assert factors[0] < 0.5
    assert factors[1] == 1
