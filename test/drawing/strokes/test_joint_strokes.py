# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes that become joints: lines, zigzags, small circles and squares, round arrows."""

import math

import numpy as np
from physsim_ros.model.errors import NothingThere, NotRecognised
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.simulation.world import World
import pytest

from .ways import carry_out, circle, draw, joined, round_arrow, square, zigzag
from ...building import DISC, spawn


def test_a_line_from_body_to_body_is_a_rod(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    reading = draw(world, [(0.3, 0.1), (3.8, -0.3)])

    assert reading.meaning == 'rod'
    assert reading.runner_up == 'wall'
    join = joined(reading)
    assert (join.kind, join.a, join.b) == (JointKind.ROD, 'a/0', 'b/0')
    assert join.points[0] == pytest.approx((0.3, 0.1), abs=0.03)


def test_the_ends_of_a_rod_go_to_the_middle_of_a_body_or_onto_its_rim(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0))
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0))

    (join,) = draw(world, [(0.1, 0.05), (3.4, 0.0)]).requests

    assert isinstance(join, Join)
    assert join.points[0] == (0.0, 0.0)
    assert join.points[1] == pytest.approx((3.5, 0.0), abs=1e-3)


@pytest.mark.parametrize('sag', [0.5, 1.2, 2.0])
def test_a_sagging_line_from_a_body_to_nowhere_is_a_rope(world: World, sag: float) -> None:
    spawn(world, 'bob/0', pose=(0.0, 0.0, 0.0))
    along = np.linspace(0.0, 1.0, 30)
    stroke = np.column_stack((3.0 * along, -sag * np.sin(np.pi * along)))

    reading = draw(world, stroke)

    assert (reading.meaning, reading.runner_up) == ('rope', 'wall')
    join = joined(reading)
    assert (join.kind, join.a, join.b) == (JointKind.ROPE, 'bob/0', 'world')
    length = np.hypot(*np.diff(stroke, axis=0).T).sum()
    assert join.properties.length == pytest.approx(length, rel=0.02)


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
    join = joined(reading)
    assert (join.kind, join.a, join.b) == (JointKind.SPRING, 'b/0', 'a/0')


def test_a_dense_spring_that_covers_the_bodies_at_its_ends_deletes_neither(world: World) -> None:
    spawn(world, 'a/0', Disc(radius=0.25), (0.0, 2.0, 0.0))
    spawn(world, 'b/0', Disc(radius=0.25), (0.0, 0.0, 0.0))
    at = np.arange(19)
    way = np.column_stack((0.35 * np.where(at % 2, 1.0, -1.0), 2.2 * at / 18 - 0.1))

    reading = draw(world, [(0.0, -0.1), *map(tuple, way), (0.0, 2.1)])

    assert reading.meaning == 'spring'


def test_a_circle_within_a_body_is_an_axle_to_the_background(world: World) -> None:
    spawn(world, 'plank/0', Box(width=4.0, height=0.6))

    reading = draw(world, circle(1.0, 0.0, 0.12))

    assert reading.meaning == 'axle'
    axle = joined(reading)
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
    axle = joined(reading)
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


def test_a_bent_line_from_body_to_body_is_a_rope(world: World) -> None:
    spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0))
    spawn(world, 'b/0', DISC, (4.0, 0.0, 0.0))

    assert draw(world, [(0.0, 0.0), (2.0, -1.2), (4.0, 0.0)]).meaning == 'rope'


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
