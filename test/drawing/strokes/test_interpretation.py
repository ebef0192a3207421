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

"""The meanings of strokes, each in a world of its own."""

from collections.abc import Sequence
import itertools
import math
from typing import Any

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.interpretation import (
    Reading,
)
from physsim_ros.drawing.strokes.stroke_order import joined_strokes
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadProperty, NothingThere, NotRecognised, Refusal
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Anchor, Configure, Delete, Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
from physsim_ros.simulation.world import World
import pytest

from ..single_stroke import interpret_stroke
from ...building import body_at, DISC, NOWHERE, spawn

SETTINGS = DrawingSettings()
ANGLE = np.linspace(0.0, 2.0 * math.pi, 60)
Way = Sequence[tuple[float, float]]


@pytest.fixture
def world() -> World:
    """Return an empty world."""
    return World()


def draw(world: World, way: Way | Floats, **said: Any) -> Reading:
    """Read a stroke from point to point; what is said are settings of drawing."""
    points = np.array(way, dtype=np.float64)
    if len(points) < 40:
        sides = itertools.pairwise(points)
        points = np.vstack([np.linspace(a, b, 25, endpoint=False) for a, b in sides])
        points = np.vstack((points, way[-1]))
    before = world.digest()
    try:
        return interpret_stroke(points, SceneQuery(world.snapshot()), DrawingSettings(**said))
    finally:
        assert world.digest() == before


def carry_out(world: World, reading: Reading) -> None:
    for request in reading.requests:
        world.apply(request)


def circle(x: float, y: float, radius: float) -> Floats:
    return np.column_stack((x + radius * np.cos(ANGLE), y + radius * np.sin(ANGLE)))


def zigzag(start: tuple[float, float], end: tuple[float, float], teeth: int = 8) -> Way:
    (x0, y0), (x1, y1) = start, end
    length = math.dist(start, end)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    ways = [start]
    for number in range(1, teeth):
        share, aside = number / teeth, 0.1 * length * (-1) ** number
        ways.append(
            (
                x0 + share * (x1 - x0) - aside * uy,
                y0 + share * (y1 - y0) + aside * ux,
            )
        )
    return [*ways, end]


def cross(x: float, y: float, half: float = 0.2) -> Way:
    return [
        (x - half, y + half), (x + half, y - half), (x + half, y + half), (x - half, y - half),
    ]  # fmt: skip


def scribble(x: float, y: float, width: float, height: float) -> Way:
    return [(x + width * (n / 12 - 0.5), y + height * ((n % 2) - 0.5)) for n in range(13)]


def rectangle(x: float, y: float, width: float, height: float, skew: float = 0.0) -> Way:
    return [(x, y), (x + width, y + skew), (x + width, y + height), (x, y + height), (x, y)]


# Bodies


def test_a_circle_in_the_open_is_a_disc(world: World) -> None:
    reading = draw(world, circle(3.0, 4.0, 0.5))

    assert reading.meaning == 'disc'
    assert reading.confidence > 0.85
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Disc)
    assert request.shape.radius == pytest.approx(0.5, abs=0.01)
    assert request.pose == pytest.approx((3.0, 4.0, 0.0), abs=0.01)
    assert reading.subject == request.name == 'drawn/0'
    assert 'radius 0.49' in reading.message or 'radius 0.5' in reading.message


def test_a_crooked_rectangle_is_made_level(world: World) -> None:
    reading = draw(world, rectangle(0.0, 0.0, 3.0, 1.0, skew=0.1))

    assert reading.meaning == 'rectangle'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Box)
    assert request.pose[2] == 0.0
    assert request.shape.width == pytest.approx(3.0, abs=0.05)
    assert request.shape.height == pytest.approx(0.95, abs=0.05)


def test_a_tilted_rectangle_stays_tilted(world: World) -> None:
    cos, sin = math.cos(0.5), math.sin(0.5)
    way = [(cos * x - sin * y, sin * x + cos * y) for x, y in rectangle(0, 0, 3, 1)]

    (request,) = draw(world, way).requests

    assert isinstance(request, Spawn)
    assert request.pose[2] == pytest.approx(0.5, abs=0.01)


def test_nearly_a_square_is_a_square(world: World) -> None:
    (request,) = draw(world, rectangle(0.0, 0.0, 1.0, 0.94)).requests

    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Box)
    assert request.shape.width == request.shape.height


def test_raw_geometry_can_be_asked_for(world: World) -> None:
    reading = draw(world, rectangle(0.0, 0.0, 3.0, 1.0, skew=0.1), beautify=0.0)

    assert reading.meaning == 'rectangle'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Polygon)
    placed = {
        (round(x + request.pose[0], 2), round(y + request.pose[1], 2))
        for x, y in request.shape.outline
    }
    assert placed == {(0.0, 0.0), (3.0, 0.1), (3.0, 1.0), (0.0, 1.0)}


def test_a_triangle_is_a_polygon_about_its_centre_of_mass(world: World) -> None:
    reading = draw(world, [(0, 0), (3, 0.05), (0, 2), (0, 0)])

    assert reading.meaning == 'polygon'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Polygon)
    assert len(request.shape.outline) == 3
    assert request.shape.form.centroid == pytest.approx((0.0, 0.0), abs=1e-9)
    # The right angle is right.
    assert request.pose[:2] == pytest.approx((1.0, 0.68), abs=0.03)


def test_any_closed_outline_is_a_solid(world: World) -> None:
    kidney = np.column_stack((np.cos(ANGLE) + 0.4 * np.cos(2 * ANGLE), np.sin(ANGLE)))

    reading = draw(world, kidney)

    assert reading.meaning == 'polygon'
    carry_out(world, reading)
    assert body_at(world, (0.5, 0.5)) == 'drawn/0'


def test_what_is_drawn_takes_velocity_and_colour_from_the_settings(world: World) -> None:
    reading = draw(
        world, circle(0, 0, 1), draw_velocity=(1.0, 2.0), draw_color=(1.0, 0.0, 0.0, 1.0)
    )

    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert request.properties.velocity == (1.0, 2.0)
    assert request.color == (1.0, 0.0, 0.0, 1.0)


def test_names_go_on_from_the_highest(world: World) -> None:
    spawn(world, 'drawn/6', pose=(50.0, 0.0, 0.0))
    spawn(world, 'drawn/2', pose=(60.0, 0.0, 0.0))

    assert draw(world, circle(0, 0, 1)).subject == 'drawn/7'


# Walls


def test_a_line_in_the_open_is_a_level_wall(world: World) -> None:
    reading = draw(world, [(0, 0), (5, 0.2)], wall_thickness=0.05)

    assert reading.meaning == 'wall'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Chain)
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
    (request,) = draw(world, np.column_stack((x, 2.0 * np.sin(math.pi * x / 8)))).requests

    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Chain)
    assert len(request.shape.points) > 6


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


# Joints


def test_a_line_from_body_to_body_is_a_rod(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    reading = draw(world, [(0.3, 0.1), (3.8, -0.3)])

    assert reading.meaning == 'rod'
    assert reading.runner_up == 'wall'
    (join,) = reading.requests
    assert isinstance(join, Join)
    assert (join.kind, join.a, join.b) == (JointKind.ROD, 'a/0', 'b/0')
    assert join.points[0] == pytest.approx((0.3, 0.1), abs=0.03)


def test_the_ends_of_a_rod_go_to_the_middle_of_a_body_or_onto_its_rim(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    (join,) = draw(world, [(0.1, 0.05), (3.4, 0.0)]).requests

    assert isinstance(join, Join)
    assert join.points[0] == (0.0, 0.0)
    assert join.points[1] == pytest.approx((3.5, 0.0), abs=1e-3)


def test_a_line_from_a_body_to_nowhere_hangs_it_up(world: World) -> None:
    spawn(world, 'bob/0', pose=(0.0, 0.0, 0.0))

    (join,) = draw(world, [(2.0, 3.0), (0.0, 0.0)]).requests

    assert isinstance(join, Join)
    assert (join.kind, join.a, join.b) == (JointKind.ROD, 'bob/0', 'world')
    assert join.points[1] == pytest.approx((2.0, 3.0), abs=0.01)


def test_a_line_between_two_anchored_bodies_is_a_wall(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0), anchored=True)
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0), anchored=True)

    assert draw(world, [(0.3, 0.0), (3.7, 0.0)]).meaning == 'wall'


@pytest.mark.parametrize('teeth', [4, 6, 12])
def test_a_zigzag_from_body_to_body_is_a_spring(world: World, teeth: int) -> None:
    spawn(world, 'a/0', pose=(0.0, 4.0, 0.0), anchored=True)
    spawn(world, 'b/0', pose=(0.0, 0.0, 0.0))

    reading = draw(world, zigzag((0.0, 3.7), (0.1, 0.4), teeth))

    assert reading.meaning == 'spring'
    (join,) = reading.requests
    assert isinstance(join, Join)
    assert (join.kind, join.a, join.b) == (JointKind.SPRING, 'b/0', 'a/0')


def test_a_circle_within_a_body_is_an_axle_to_the_background(world: World) -> None:
    spawn(world, 'plank/0', Box(width=4.0, height=0.6))

    reading = draw(world, circle(1.0, 0.0, 0.12))

    assert reading.meaning == 'axle'
    (axle,) = reading.requests
    assert isinstance(axle, Join)
    assert (axle.kind, axle.b) == (JointKind.AXLE, 'world')
    assert axle.points[0] == pytest.approx((1.0, 0.0), abs=0.01)
    assert 'background' in reading.message


def test_a_small_circle_over_two_bodies_is_an_axle_in_the_middle_of_the_wheel(
    world: World,
) -> None:
    spawn(world, 'car/0', Box(width=4.0, height=1.0), (0.0, 0.0, 0.0))
    spawn(world, 'wheel/0', Disc(radius=0.6), (1.2, -0.4, 0.0))

    reading = draw(world, circle(1.25, -0.35, 0.15))

    assert reading.meaning == 'axle'
    (axle,) = reading.requests
    assert isinstance(axle, Join)
    assert (axle.kind, axle.a, axle.b) == (JointKind.AXLE, 'wheel/0', 'car/0')
    assert axle.points[0] == pytest.approx((1.2, -0.4), abs=1e-12)
    assert 'wheel/0 and car/0' in reading.message


@pytest.mark.parametrize('wheel', [-0.45, -0.5, -0.55])
@pytest.mark.parametrize('beside', [-0.1, -0.05, 0.0, 0.05, 0.1])
def test_a_small_circle_across_the_edge_of_a_car_is_an_axle_in_the_middle_of_its_wheel(
    world: World, wheel: float, beside: float
) -> None:
    spawn(world, 'car/0', Box(width=3.0, height=1.0), (0.0, 0.0, 0.0))
    spawn(world, 'wheel/0', Disc(radius=0.5), (1.0, wheel, 0.0))

    reading = draw(world, circle(1.0, max(wheel + beside, -0.55), 0.1))

    assert reading.message == 'an axle between wheel/0 and car/0'
    (request,) = reading.requests
    world.apply(request)
    (joint,) = world.snapshot().scene.joints
    assert {joint.a, joint.b} == {'wheel/0', 'car/0'}
    assert world.snapshot().ends[0] == pytest.approx(np.array([(1.0, wheel)] * 2), abs=1e-9)


def test_a_small_circle_beside_another_body_is_an_axle_to_the_background(world: World) -> None:
    spawn(world, 'wheel/0', Disc(radius=0.5), (0.0, 0.0, 0.0))
    spawn(world, 'wall/0', Box(width=1.0, height=4.0), (0.98, 0.0, 0.0))

    assert draw(world, circle(0.4, 0.0, 0.1)).message.endswith('wheel/0 and the background')


@pytest.mark.parametrize('radius', [0.5, 0.6, 0.9])
def test_a_wheel_drawn_over_a_car_is_a_disc(world: World, radius: float) -> None:
    spawn(world, 'car/0', Box(width=4.0, height=1.0))

    assert draw(world, circle(1.2, -0.4, radius)).meaning == 'disc'


# Signs


def test_an_x_on_a_body_anchors_it(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=2.0))

    reading = draw(world, cross(0.4, 0.3))
    carry_out(world, reading)

    assert reading.meaning == 'anchor'
    assert isinstance(reading.requests[0], Anchor)
    assert world.snapshot().scene.bodies[0].anchored


def test_an_x_across_a_thin_body_anchors_that(world: World) -> None:
    spawn(world, 'plank/0', Box(width=4.0, height=0.1))

    reading = draw(world, cross(0.0, 0.12))
    carry_out(world, reading)

    assert reading.subject == 'plank/0'
    assert world.snapshot().scene.bodies[0].anchored


def test_an_x_in_the_open_is_refused(world: World) -> None:
    with pytest.raises(NothingThere, match='an x anchors the body under it'):
        draw(world, cross(0.0, 0.0))


@pytest.mark.parametrize('angle', [0.3, 2.0, -1.5, 3.1])
def test_an_arrow_in_the_open_turns_gravity(world: World, angle: float) -> None:
    cos, sin = math.cos(angle), math.sin(angle)
    arrow = [(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)]

    reading = draw(world, [(cos * x - sin * y, sin * x + cos * y) for x, y in arrow])

    assert reading.meaning == 'gravity'
    (configure,) = reading.requests
    assert isinstance(configure, Configure)
    x, y = configure.changes['gravity']
    assert math.hypot(x, y) == pytest.approx(9.81, rel=1e-12)
    # rad: nearly upright and nearly level become so
    assert math.cos(math.atan2(y, x) - angle) > math.cos(0.11)
    assert (0.0 in (x, y)) == (angle in {-1.5, 3.1})


def test_an_arrow_upon_an_anchored_body_is_refused(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=2.0), anchored=True)

    with pytest.raises(NotRecognised, match='begins on a/0'):
        draw(world, [(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)])


def test_without_gravity_there_is_none_to_turn() -> None:
    with pytest.raises(BadProperty, match='no gravity'):
        draw(World(settings=NOWHERE), [(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)])


def test_gravity_keeps_its_strength() -> None:
    world = World(settings=WorldSettings(gravity=(3.0, -4.0)))

    carry_out(world, draw(world, [(0, 0), (0, 3), (0.4, 2.5), (0, 3), (-0.4, 2.5)]))

    assert world.settings.gravity == pytest.approx((0.0, 5.0), abs=1e-9)


def test_a_scribble_deletes_what_it_covers_and_nothing_that_it_touches(world: World) -> None:
    spawn(world, 'floor/0', Box(width=20.0, height=1.0), (0.0, -1.0, 0.0), anchored=True)
    spawn(world, 'box/0', Box(width=1.0, height=1.0), (0.0, 0.0, 0.0))
    spawn(world, 'box/1', Box(width=1.0, height=1.0), (1.4, 0.0, 0.0))

    reading = draw(world, scribble(0.0, 0.0, 1.3, 1.3))

    assert reading.meaning == 'deletion'
    assert reading.requests == (Delete(name='box/0'),)
    assert reading.subject == 'box/0'


def test_a_scribble_deletes_several_bodies_and_a_long_wall(world: World) -> None:
    spawn(world, 'wall/0', Box(width=20.0, height=0.2), (0.0, -5.0, 0.0), anchored=True)
    for number in range(3):
        spawn(world, f'ball/{number}', Disc(radius=0.2), (0.7 * number, 0.0, 0.0))

    several = draw(world, scribble(0.7, 0.0, 2.2, 1.0))
    long = draw(world, scribble(3.0, -5.0, 1.0, 1.0))

    assert [request.name for request in several.requests if isinstance(request, Delete)] == [
        'ball/0', 'ball/1', 'ball/2',
    ]  # fmt: skip
    assert long.requests == (Delete(name='wall/0'),)


def test_a_scribble_from_body_to_body_deletes_both(world: World) -> None:
    spawn(world, 'a/0', Disc(radius=0.4), (-0.5, 0.0, 0.0))
    spawn(world, 'a/1', Disc(radius=0.4), (0.5, 0.0, 0.0))

    reading = draw(world, scribble(0.0, 0.0, 1.6, 0.7))

    assert reading.requests == (Delete(name='a/0'), Delete(name='a/1'))


@pytest.mark.parametrize('size', [0.7, 1.4, 3.0])
def test_a_pentagram_and_a_zigzag_of_five_lines_over_a_body_delete_nothing(
    world: World, size: float
) -> None:
    spawn(world, 'a/0', Box(width=1.0, height=1.0))
    angle = math.pi / 2 + 0.8 * math.pi * np.arange(6)
    star = size * np.column_stack((np.cos(angle), np.sin(angle)))

    reading = draw(world, star)
    zigzag = draw(world, [(size * (n / 5 - 0.5), 0.4 * size * (-1) ** n) for n in range(6)])

    assert reading.meaning == 'polygon'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert not any(isinstance(each, Delete) for each in zigzag.requests)


def test_a_scribble_in_the_open_is_refused(world: World) -> None:
    with pytest.raises(NothingThere, match='there are none'):
        draw(world, scribble(0.0, 0.0, 1.0, 1.0))


# Several strokes


@pytest.mark.parametrize('order', [(0, 1, 2, 3), (2, 0, 3, 1), (3, 1, 0, 2)])
def test_four_lines_in_any_order_and_direction_are_a_rectangle(
    world: World, order: tuple[int, ...]
) -> None:
    corners = np.array([(0, 0), (2.0, 0.05), (1.95, 1), (0.03, 1.02), (0, 0)])
    sides = [np.linspace(*corners[[side, side + 1]], 20) for side in range(4)]
    strokes = [sides[side][:: 1 if side % 2 else -1] for side in order]

    reading = interpret_stroke(joined_strokes(strokes), SceneQuery(world.snapshot()), SETTINGS)

    assert reading.meaning == 'rectangle'


def test_two_lines_across_each_other_on_a_body_are_an_x(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=2.0))
    lines = [np.linspace((-0.3, -0.3), (0.3, 0.3), 20), np.linspace((-0.3, 0.3), (0.3, -0.3), 20)]

    for strokes in (lines, lines[::-1], [lines[0], lines[1][::-1]]):
        reading = interpret_stroke(joined_strokes(strokes), SceneQuery(world.snapshot()), SETTINGS)
        assert reading.meaning == 'anchor'


def test_a_shaft_and_a_head_are_an_arrow_in_two_strokes_and_in_three(world: World) -> None:
    shaft = np.linspace((0.0, 0.0), (0.0, -3.0), 40)
    left, right = (np.linspace((0.0, -3.0), (x, -2.4), 15) for x in (-0.4, 0.4))
    head = np.vstack((left[::-1], right))

    for strokes in ([shaft, head], [head, shaft], [shaft, left, right], [right, shaft, left]):
        reading = interpret_stroke(joined_strokes(strokes), SceneQuery(world.snapshot()), SETTINGS)
        assert reading.meaning == 'gravity'
        (request,) = reading.requests
        assert isinstance(request, Configure)
        assert request.changes['gravity'] == pytest.approx((0.0, -9.81), abs=1e-9)


def test_seven_lines_are_a_polygon(world: World) -> None:
    corners = [(math.cos(a), math.sin(a)) for a in 2.0 * math.pi * np.arange(8) / 7]
    sides = [np.linspace(a, b, 15) for a, b in itertools.pairwise(corners)]

    reading = interpret_stroke(
        joined_strokes(sides[::2] + sides[1::2]), SceneQuery(world.snapshot()), SETTINGS
    )

    assert reading.meaning == 'polygon'
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, Polygon)
    assert len(request.shape.outline) == 7


# Doubt


def test_every_guess_can_be_built_and_the_first_is_the_reading(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    reading = draw(world, [(0.3, 0.1), (3.8, -0.3)])

    assert [guess.meaning for guess in reading.guesses] == ['rod', 'wall']
    assert reading.guesses[0].build().requests == reading.requests
    (wall,) = reading.guesses[1].build().requests
    assert isinstance(wall, Spawn)
    assert isinstance(wall.shape, Chain)


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
    ],
    ids=['an eight', 'a spiral'],
)
def test_what_is_no_figure_is_not_recognised(world: World, way: Floats) -> None:
    with pytest.raises(NotRecognised):
        draw(world, way)


@pytest.mark.parametrize(
    'way', [[], [(1, 1)], [(0, 0), (math.nan, 1), (1, 1)], [(1, 1)] * 100, [(0, 0), (1e8, 0)]]
)
def test_what_is_no_stroke_is_refused(world: World, way: Way) -> None:
    samples = np.array(way, dtype=np.float64).reshape(-1, 2)

    with pytest.raises(Refusal) as caught:
        interpret_stroke(samples, SceneQuery(world.snapshot()), SETTINGS)

    assert caught.value.code in {'malformed', 'bad_size'}


def test_a_stroke_of_a_hundred_thousand_samples_is_read(world: World) -> None:
    angle = np.linspace(0.0, 2.0 * math.pi, 100_000)
    trembling = np.random.default_rng(0).normal(0.0, 0.005, (100_000, 2))

    reading = draw(world, np.column_stack((np.cos(angle), np.sin(angle))) + trembling)

    assert reading.meaning == 'disc'


def test_a_wheel_half_below_its_chassis_gets_an_axle_to_it_and_none_to_the_road(
    world: World,
) -> None:
    spawn(world, 'road/0', Box(width=10.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    spawn(world, 'chassis/0', Box(width=3.0, height=0.5), (0.0, 0.75, 0.0))
    # m: its middle lies 0.1 below the chassis, its rim on the road
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))

    reading = draw(world, circle(1.02, 0.38, 0.08))
    carry_out(world, reading)

    assert reading.meaning == 'axle'
    (joint,) = world.snapshot().scene.joints
    assert (joint.kind, joint.a, joint.b) == (JointKind.AXLE, 'wheel/0', 'chassis/0')
    assert (joint.seat.ax, joint.seat.ay) == pytest.approx((0.0, 0.0))


def test_a_wheel_beside_another_one_turns_about_the_background(world: World) -> None:
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.8, 0.4, 0.0))
    spawn(world, 'wheel/1', Disc(radius=0.4), (1.0, 0.4, 0.0))

    carry_out(world, draw(world, circle(1.0, 0.4, 0.08)))

    (joint,) = world.snapshot().scene.joints
    assert joint.b == 'world'


def square(x: float, y: float, half: float) -> Way:
    return [
        (x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half),
        (x - half, y - half),
    ]  # fmt: skip


def round_arrow(x: float, y: float, radius: float, sweep: float, start: float = -1.0) -> Floats:
    """Return an arc about a point, from an angle by an angle, with a head of two barbs."""
    turn = start + np.linspace(0.0, sweep, 60)
    arc = np.column_stack((x + radius * np.cos(turn), y + radius * np.sin(turn)))
    tip, ahead = arc[-1], arc[-1] - arc[-3]
    ahead /= np.hypot(*ahead)
    aside = np.array((-ahead[1], ahead[0]))
    barbs = [tip + radius * 0.35 * (-ahead + side * aside) for side in (0.8, -0.8)]
    head = np.vstack(
        [np.linspace(a, b, 8) for a, b in ((tip, barbs[0]), (barbs[0], tip), (tip, barbs[1]))]
    )
    return np.vstack((arc, head))


def test_a_small_square_over_two_bodies_welds_them(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0), (0.0, 0.0, 0.0))
    spawn(world, 'b/0', Box(width=2.0, height=1.0), (1.6, 0.0, 0.0))

    reading = draw(world, square(0.8, 0.0, 0.15))
    carry_out(world, reading)

    assert reading.meaning == 'pin'
    (joint,) = world.snapshot().scene.joints
    assert joint.kind is JointKind.PIN
    assert {joint.a, joint.b} == {'a/0', 'b/0'}


def test_a_small_square_over_one_body_is_a_body(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0), (0.0, 0.0, 0.0))
    assert draw(world, square(0.2, 0.0, 0.15)).meaning == 'rectangle'


def test_a_curved_line_from_body_to_body_is_a_rope_as_long_as_it_was_drawn(world: World) -> None:
    spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0))
    spawn(world, 'b/0', DISC, (4.0, 0.0, 0.0))
    turn = np.linspace(math.pi, 2.0 * math.pi, 50)

    reading = draw(world, np.column_stack((2.0 + 2.0 * np.cos(turn), 1.5 * np.sin(turn))))
    carry_out(world, reading)

    (joint,) = world.snapshot().scene.joints
    assert joint.kind is JointKind.ROPE
    # m: half of an ellipse of 2 m and 1.5 m, by Ramanujan
    assert joint.rest_length == pytest.approx(5.52, rel=0.03)


def test_an_arrow_from_a_body_is_its_velocity(world: World) -> None:
    spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0))

    reading = draw(world, [(0.0, 0.0), (3.0, 1.0), (2.5, 1.1), (3.0, 1.0), (2.7, 0.6)])
    carry_out(world, reading)

    assert reading.meaning == 'velocity'
    assert world.snapshot().twists[0] == pytest.approx((3.0, 1.0, 0.0), abs=0.05)


@pytest.mark.parametrize('sweep', [4.5, -3.0, 2.4, 5.4])
def test_a_round_arrow_about_an_axle_is_a_motor_of_its_turn_a_second(
    world: World, sweep: float
) -> None:
    spawn(world, 'chassis/0', Box(width=3.0, height=0.5), (0.0, 0.5, 0.0))
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))
    carry_out(world, draw(world, circle(1.0, 0.4, 0.08)))

    reading = draw(world, round_arrow(1.0, 0.4, 0.6, sweep))
    carry_out(world, reading)

    assert reading.meaning == 'motor'
    motor = world.snapshot().scene.joints[-1]
    assert (motor.kind, motor.a, motor.b) == (JointKind.MOTOR, 'wheel/0', 'chassis/0')
    assert motor.properties.rate == pytest.approx(sweep, abs=0.3)


def test_a_trembling_round_arrow_is_a_motor(world: World) -> None:
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))
    carry_out(world, draw(world, circle(1.0, 0.4, 0.08)))
    arrow = round_arrow(1.0, 0.4, 0.6, 4.5)
    phase = np.linspace(0.0, 60.0, len(arrow))

    reading = draw(world, arrow + 0.015 * np.column_stack((np.sin(phase), np.cos(1.3 * phase))))

    assert reading.meaning == 'motor'


def test_a_trembling_straight_line_between_two_bodies_is_a_rod_and_a_bow_a_rope(
    world: World,
) -> None:
    spawn(world, 'a/0', Disc(radius=0.3), (0.0, 0.0, 0.0))
    spawn(world, 'b/0', Disc(radius=0.3), (3.0, 0.0, 0.0))
    share = np.linspace(0.0, 1.0, 100)
    trembling = 0.06 * np.sin(60.0 * share)

    assert draw(world, np.column_stack((3.0 * share, trembling))).meaning == 'rod'
    sagging = trembling - 3.2 * share * (1.0 - share)
    assert draw(world, np.column_stack((3.0 * share, sagging))).meaning == 'rope'


def test_a_wheel_with_corners_half_below_its_chassis_gets_its_axle_to_it(world: World) -> None:
    spawn(world, 'road/0', Box(width=9.0, height=1.0), (0.0, -0.95, 0.0))
    spawn(world, 'chassis/0', Box(width=3.0, height=0.5), (0.0, 0.3, 0.0))
    angle = np.linspace(0.0, 2.0 * math.pi, 8)[:-1]
    corners = tuple(zip(0.5 * np.cos(angle), 0.5 * np.sin(angle), strict=True))
    spawn(world, 'wheel/0', Polygon(outline=corners), (1.0, 0.0, 0.0))

    carry_out(world, draw(world, circle(1.02, 0.01, 0.1)))

    (joint,) = world.snapshot().scene.joints
    assert (joint.a, joint.b) == ('wheel/0', 'chassis/0')


def test_a_second_round_arrow_changes_the_motor(world: World) -> None:
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))
    carry_out(world, draw(world, circle(1.0, 0.4, 0.08)))
    carry_out(world, draw(world, round_arrow(1.0, 0.4, 0.6, 4.5)))

    carry_out(world, draw(world, round_arrow(1.0, 0.4, 0.6, -3.0)))

    _, motor = world.snapshot().scene.joints
    assert motor.properties.rate == pytest.approx(-3.0, abs=0.3)


def test_a_round_arrow_about_nothing_is_refused(world: World) -> None:
    with pytest.raises((NothingThere, NotRecognised)):
        draw(world, round_arrow(1.0, 0.4, 0.6, 4.5))


def test_hatching_makes_a_body_heavier(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0), (0.0, 0.0, 0.0))
    before = world.snapshot().scene.bodies[0].total_mass
    lines = [(-0.6, -0.3), (-0.4, 0.3), (-0.2, -0.3), (0.0, 0.3)]

    reading = draw(world, lines)
    carry_out(world, reading)

    assert reading.meaning == 'hatching'
    (body,) = world.snapshot().scene.bodies
    assert body.total_mass == pytest.approx(before * 1.25**3)
