# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The meanings of strokes: bodies, walls, what several strokes make, and doubt."""

import math

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised, Refusal
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
from physsim_ros.simulation.world import World
import pytest

from .ways import ANGLE, built, carry_out, circle, draw, rectangle
from ..single_stroke import interpret_stroke
from ...building import spawn

# Bodies


def test_a_circle_in_the_open_is_a_disc(world: World) -> None:
    reading = draw(world, circle(3.0, 4.0, 0.5))

    assert reading.meaning == 'disc'
    assert reading.confidence > 0.85
    request = built(reading, Disc)
    assert request.shape.radius == pytest.approx(0.5, abs=0.01)
    assert request.pose == pytest.approx((3.0, 4.0, 0.0), abs=0.01)
    assert reading.subject == request.name == 'drawn/0'
    assert 'radius 0.49' in reading.message or 'radius 0.5' in reading.message


def test_a_crooked_rectangle_is_made_level(world: World) -> None:
    reading = draw(world, rectangle(0.0, 0.0, 3.0, 1.0, skew=0.1))

    assert reading.meaning == 'rectangle'
    request = built(reading, Box)
    assert request.pose[2] == 0.0
    assert request.shape.width == pytest.approx(3.0, abs=0.05)
    assert request.shape.height == pytest.approx(0.95, abs=0.05)


def test_raw_geometry_can_be_asked_for(world: World) -> None:
    reading = draw(world, rectangle(0.0, 0.0, 3.0, 1.0, skew=0.1), beautify=0.0)

    assert reading.meaning == 'rectangle'
    request = built(reading, Polygon)
    placed = {
        (round(x + request.pose[0], 2), round(y + request.pose[1], 2))
        for x, y in request.shape.outline
    }
    assert placed == {(0.0, 0.0), (3.0, 0.1), (3.0, 1.0), (0.0, 1.0)}


def test_a_triangle_is_a_polygon_about_its_centre_of_mass(world: World) -> None:
    reading = draw(world, [(0, 0), (3, 0.05), (0, 2), (0, 0)])

    assert reading.meaning == 'polygon'
    request = built(reading, Polygon)
    assert len(request.shape.outline) == 3
    assert request.shape.form.centroid == pytest.approx((0.0, 0.0), abs=1e-9)
    # The right angle is right.
    assert request.pose[:2] == pytest.approx((1.0, 0.68), abs=0.03)


def test_what_is_drawn_takes_velocity_and_colour_from_the_settings(world: World) -> None:
    reading = draw(
        world, circle(0, 0, 1), draw_velocity=(1.0, 2.0), draw_color=(1.0, 0.0, 0.0, 1.0)
    )

    request = built(reading)
    assert request.properties.velocity == (1.0, 2.0)
    assert request.color == (1.0, 0.0, 0.0, 1.0)


# Walls


def test_a_line_in_the_open_is_a_level_wall(world: World) -> None:
    reading = draw(world, [(0, 0), (5, 0.2)], wall_thickness=0.05)

    assert reading.meaning == 'wall'
    request = built(reading, Chain)
    assert request.properties.anchored
    assert request.shape.thickness == 0.05
    assert request.pose == pytest.approx((2.5, 0.1, 0.0), abs=0.01)


def test_a_steep_line_stays_steep_and_a_bent_one_bent(world: World) -> None:
    assert draw(world, [(0, 0), (4, 2)]).outline == pytest.approx(
        np.array([(0, 0), (4, 2)]), abs=0.02
    )
    assert draw(world, [(0, 2), (0.05, 0), (3, 0), (5, 1.5)]).outline == pytest.approx(
        np.array([(0.0, 2), (0.0, 0), (3, 0), (5, 1.5)]), abs=0.06
    )


def test_a_hill_is_a_wall_of_many_sides(world: World) -> None:
    x = np.linspace(0.0, 8.0, 100)
    hill = draw(world, np.column_stack((x, 2.0 * np.sin(math.pi * x / 8))))

    assert len(built(hill, Chain).shape.points) > 6


def test_a_wall_begins_where_another_ends(world: World) -> None:
    carry_out(world, draw(world, [(0, 0), (4, 0)]))

    reading = draw(world, [(4.1, 0.08), (6, 2)])

    assert reading.meaning == 'wall'
    assert reading.outline[0] == pytest.approx((4.0, 0.0), abs=1e-9)


def test_a_wall_goes_up_to_the_body_that_it_nearly_reaches(world: World) -> None:
    spawn(world, 'pillar/0', Box(width=1.0, height=4.0), (0.0, 0.0, 0.0), anchored=True)

    reading = draw(world, [(0.6, 1.0), (5.0, 1.0)])

    assert reading.meaning == 'wall'
    assert reading.outline[0] == pytest.approx((0.5, 1.0), abs=0.02)


def test_stairs_are_a_wall(world: World) -> None:
    steps = [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (3, 2), (3, 3)]

    assert draw(world, steps).meaning == 'wall'


@pytest.mark.slow
def test_what_is_drawn_is_the_likeliest_and_never_unlikely(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=2.0))
    rng = np.random.default_rng(7)
    view, settings = SceneQuery(world.snapshot()), DrawingSettings(sketch_confidence=0.3)
    readings = []
    for _ in range(1500):
        angle = np.linspace(0.0, 2 * math.pi, rng.integers(12, 60))
        ring = np.column_stack((np.cos(angle), rng.uniform(0.6, 1.0) * np.sin(angle)))
        ring += rng.normal(0.0, 0.04, ring.shape)
        try:
            readings.append(
                interpret_stroke(
                    rng.uniform(-0.8, 0.8, 2) + rng.uniform(0.1, 0.7) * ring, view, settings
                )
            )
        except Refusal:
            continue
    assert len(readings) > 500
    for reading in readings:
        # Whether there is a reading depends on its group: disc and polygon are both solids.
        best, *others = reading.guesses
        assert best.group_confidence >= max(0.3, *(each.group_confidence for each in others), 0.0)
        assert len(reading.guesses) <= 3


# Doubt


def test_every_guess_can_be_built_and_the_first_is_the_reading(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    reading = draw(world, [(0.3, 0.1), (3.8, -0.3)])

    assert [guess.meaning for guess in reading.guesses] == ['rod', 'wall']
    assert reading.guesses[0].build().requests == reading.requests
    assert isinstance(reading.guesses[1].build().requests[0], Spawn)


def test_below_the_confidence_asked_for_nothing_is_built_and_what_it_might_be_is_said(
    world: World,
) -> None:
    with pytest.raises(NotRecognised, match='disc') as caught:
        draw(world, circle(0.0, 0.0, 1.0), sketch_confidence=1.0)

    assert caught.value.field == 'poses'


@pytest.mark.parametrize(
    'way',
    [
        np.column_stack((np.sin(ANGLE), np.sin(2 * ANGLE))),
        np.column_stack((ANGLE * np.cos(2.5 * ANGLE), ANGLE * np.sin(2.5 * ANGLE))),
        np.column_stack((0.4 * (ANGLE - math.pi) + np.sin(ANGLE), np.cos(ANGLE))),
    ],
    ids=['an eight', 'a spiral', 'a pigtail'],
)
def test_what_is_no_figure_is_not_recognised(world: World, way: Floats) -> None:
    forms = classification_of(resample_stroke(way)).forms

    assert max((each.weight for each in forms), default=0.0) < 0.3
    with pytest.raises(NotRecognised):
        draw(world, way)


def test_a_stroke_of_a_hundred_thousand_samples_is_read(world: World) -> None:
    angle = np.linspace(0.0, 2.0 * math.pi, 100_000)
    trembling = np.random.default_rng(0).normal(0.0, 0.005, (100_000, 2))

    reading = draw(world, np.column_stack((np.cos(angle), np.sin(angle))) + trembling)

    assert reading.meaning == 'disc'
