# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes that become joints: lines, zigzags, small circles and squares, round arrows."""

from collections.abc import Sequence
import math

import numpy as np
from physsim_ros.drawing.strokes.bodies_under import nearest_points
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Circle, Disc, Polygon
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World
import pytest

from .ways import carry_out, circle, draw, joined, round_arrow, square, Way, zigzag
from ...building import DISC, spawn, spawning

SHARE = np.linspace(0.0, 1.0, 100)
TREMBLING = 0.06 * np.sin(60.0 * SHARE)
# Bodies from (0, 0) to (4, 0), and some above one another.
BESIDE = [spawning('a/0'), spawning('b/0', DISC, (4.0, 0.0, 0.0))]
ABOVE = [spawning('a/0', DISC, (0.0, 4.0, 0.0), anchored=True), spawning('b/0')]
NEAR = [spawning('a/0', Disc(radius=0.25), (0.0, 2.0, 0.0)), spawning('b/0', Disc(radius=0.25))]
AT = np.arange(19)
# Covers the bodies at its ends, and deletes neither.
DENSE = np.column_stack((0.35 * np.where(AT % 2, 1.0, -1.0), 2.2 * AT / 18 - 0.1))
# Bodies that are there, a stroke, and the joint that it is: its kind and its bodies.
LINES: dict[str, tuple[Sequence[Spawn], Way | Floats, str, tuple[str, str]]] = {
    'a line': (BESIDE, [(0.3, 0.1), (3.8, -0.3)], 'rod', ('a/0', 'b/0')),
    'a line to nowhere': (BESIDE[:1], [(2.0, 3.0), (0.0, 0.0)], 'rod', ('a/0', WORLD)),
    'a trembling line': (
        BESIDE, np.column_stack((4.0 * SHARE, TREMBLING)), 'rod', ('a/0', 'b/0'),
    ),
    'a trembling bow': (
        BESIDE, np.column_stack((4.0 * SHARE, TREMBLING - 4.0 * SHARE * (1.0 - SHARE))),
        'rope', ('a/0', 'b/0'),
    ),
    'a bent line': (BESIDE, [(0.0, 0.0), (2.0, -1.2), (4.0, 0.0)], 'rope', ('a/0', 'b/0')),
    **{
        f'a line to nowhere that sags by {sag} m': (
            BESIDE[:1], np.column_stack((3.0 * SHARE, -sag * np.sin(math.pi * SHARE))),
            'rope', ('a/0', WORLD),
        )
        for sag in (0.5, 1.2, 2.0)
    },
    **{
        f'a zigzag of {teeth} teeth': (
            ABOVE, zigzag((0.0, 3.7), (0.1, 0.4), teeth), 'spring', ('b/0', 'a/0'),
        )
        for teeth in (4, 6, 12)
    },
    **{
        f'{teeth} flat round teeth': (
            BESIDE, np.column_stack((4.0 * SHARE, 0.45 * np.sin(math.pi * teeth * SHARE))),
            'spring', ('a/0', 'b/0'),
        )
        for teeth in (4, 5, 6)
    },
    # Its bends turn to alternate sides, too, but all lie on one side of it.
    'a brace': (
        BESIDE, [(0, 0), (0.4, 1), (1.5, 1), (2, 2), (2.5, 1), (3.6, 1), (4, 0)],
        'rope', ('a/0', 'b/0'),
    ),
    'a dense zigzag': (
        NEAR, [(0.0, -0.1), *map(tuple, DENSE), (0.0, 2.1)], 'spring', ('b/0', 'a/0'),
    ),
}  # fmt: skip


def populate(world: World, bodies: Sequence[Spawn]) -> None:
    for body in bodies:
        world.apply(body)


@pytest.mark.parametrize('order', [1, -1])
@pytest.mark.parametrize(('end', 'nearest'), [(-0.02, 'ball/0'), (-0.08, 'plank/0')])
def test_an_end_between_bodies_is_on_the_nearest_whichever_was_drawn_last(
    world: World, order: int, end: float, nearest: str
) -> None:
    spawn(world, 'a/0', Disc(radius=0.3), (2.0, 1.0, 0.0))
    bodies = [
        spawning('ball/0', Disc(radius=0.3), (0.0, 0.3, 0.0)),
        spawning('plank/0', Box(width=3.0, height=0.3), (0.0, -0.25, 0.0)),
    ]
    for body in bodies[::order]:
        world.apply(body)

    rod = draw(world, [(2.0, 1.0), (0.0, end)])
    wall = draw(world, [(-2.0, 0.5), (0.0, end)])
    arrow = draw(world, [(0, end), (-3, end), (-2.5, 0.4), (-3, end), (-2.5, -0.4)])

    assert (joined(rod).a, joined(rod).b) == ('a/0', nearest)
    surface = {'ball/0': 0.0, 'plank/0': -0.1}[nearest]
    assert wall.meaning == 'wall'
    assert wall.outline[-1].tolist() == pytest.approx([0.0, surface], abs=1e-9)
    assert arrow.subject == nearest


@pytest.mark.parametrize(('bodies', 'way', 'kind', 'ends'), LINES.values(), ids=LINES)
def test_a_line_from_body_to_body_is_a_joint(
    world: World, bodies: Sequence[Spawn], way: Way, kind: str, ends: tuple[str, str]
) -> None:
    populate(world, bodies)

    reading = draw(world, way)

    join = joined(reading)
    assert reading.meaning == join.kind == kind
    assert (join.a, join.b) == ends


@pytest.mark.parametrize(
    ('way', 'points', 'tolerance'),
    [
        ([(0.3, 0.1), (3.8, -0.3)], [(0.3, 0.1), (3.8, -0.3)], 0.03),
        # To the middle of one body, and onto the rim of the other.
        ([(0.1, 0.05), (3.4, 0.0)], [(0.0, 0.0), (3.5, 0.0)], 1e-3),
        ([(0.1, 0.05), (2.0, 3.0)], [(0.0, 0.0), (2.0, 3.0)], 0.01),
    ],
)
def test_the_ends_of_a_rod_are_where_they_were_drawn_or_in_the_middle_or_on_the_rim(
    world: World, way: Way, points: list[Point], tolerance: float
) -> None:
    populate(world, BESIDE)

    assert np.array(joined(draw(world, way)).points) == pytest.approx(
        np.array(points), abs=tolerance
    )


def test_a_line_between_two_anchored_bodies_is_a_wall(world: World) -> None:
    spawn(world, 'a/0', pose=(0.0, 0.0, 0.0), anchored=True)
    spawn(world, 'b/0', pose=(4.0, 0.0, 0.0), anchored=True)

    assert draw(world, [(0.3, 0.0), (3.7, 0.0)]).meaning == 'wall'


def test_a_rope_is_as_long_as_it_was_drawn(world: World) -> None:
    populate(world, BESIDE)
    turn = np.linspace(math.pi, 2.0 * math.pi, 50)

    carry_out(world, draw(world, np.column_stack((2.0 + 2.0 * np.cos(turn), 1.5 * np.sin(turn)))))

    (joint,) = world.snapshot().scene.joints
    assert joint.kind is JointKind.ROPE
    # m: half of an ellipse of 2 m and 1.5 m, by Ramanujan
    assert joint.rest_length == pytest.approx(5.52, rel=0.03)


UP = np.linspace(math.pi, 0.0, 30)


@pytest.mark.parametrize('order', [1, -1])
@pytest.mark.parametrize('joined', ['axle', 'anchored'])
def test_a_rope_that_is_drawn_around_a_wheel_runs_over_it(
    world: World, joined: str, order: int
) -> None:
    """Two weights on a wheel, as in Atwood's machine."""
    spawn(world, 'wheel/0', Disc(radius=0.5), (0.0, 4.0, 0.0), anchored=joined == 'anchored')
    if joined == 'axle':
        carry_out(world, draw(world, circle(0.0, 4.0, 0.1)))
    for name, x in (('a/0', -0.5), ('b/0', 0.5)):
        spawn(world, name, Box(width=0.4, height=0.4), (x, 1.0, 0.0))
    over = np.column_stack((0.55 * np.cos(UP), 4.0 + 0.55 * np.sin(UP)))

    reading = draw(world, np.vstack(([(-0.5, 1.1)], over, [(0.5, 1.1)]))[::order])
    carry_out(world, reading)

    assert reading.meaning == 'rope'
    assert reading.message.endswith(' over wheel/0')
    rope = world.snapshot().scene.joints[-1]
    (guide,) = rope.guides
    assert (guide.body, abs(guide.radius)) == ('wheel/0', 0.5)
    # From the middles of the bodies, two spans up to that of the wheel, and half of its rim.
    assert rope.rest_length == pytest.approx(2 * 3.0 + 0.5 * math.pi, abs=0.01)


@pytest.mark.parametrize('loose', [True, False])
def test_a_rope_that_sags_beside_a_disc_runs_over_no_wheel(world: World, loose: bool) -> None:
    populate(world, BESIDE)
    ball = (2.0, -0.9, 0.0) if loose else (2.0, 3.0, 0.0)
    spawn(world, 'ball/0', Disc(radius=0.3), ball, anchored=not loose)
    turn = np.linspace(math.pi, 2.0 * math.pi, 50)

    carry_out(world, draw(world, np.column_stack((2.0 + 2.0 * np.cos(turn), 1.5 * np.sin(turn)))))

    assert world.snapshot().scene.joints[-1].guides == ()


TURNS = math.tau * np.arange(7) / 7
SEVEN = tuple(zip(0.5 * np.cos(TURNS), 0.5 * np.sin(TURNS), strict=True))
# Bodies that are there, middle and radius of a circle, the axle's bodies, and its place: the
# middle of a round wheel, or else that of the circle.
AXLES: dict[str, tuple[Sequence[Spawn], tuple[float, float, float], tuple[str, str], Point]] = {
    'within a body': (
        [spawning('plank/0', Box(width=4.0, height=0.6))],
        (1.0, 0.0, 0.12), ('plank/0', WORLD), (1.0, 0.0),
    ),
    'over two bodies': (
        [spawning('car/0', Box(width=4.0, height=1.0)),
         spawning('wheel/0', Disc(radius=0.6), (1.2, -0.4, 0.0))],
        (1.25, -0.35, 0.15), ('wheel/0', 'car/0'), (1.2, -0.4),
    ),
    **{
        f'across the edge of a car, {low} m below, {beside} m beside': (
            [spawning('car/0', Box(width=3.0, height=1.0)),
             spawning('wheel/0', Disc(radius=0.5), (1.0, low, 0.0))],
            (1.0, max(low + beside, -0.55), 0.1), ('wheel/0', 'car/0'), (1.0, low),
        )
        for low in (-0.45, -0.5, -0.55)
        for beside in (-0.1, -0.05, 0.0, 0.05, 0.1)
    },
    'beside another body': (
        [spawning('wheel/0'), spawning('wall/0', Box(width=1.0, height=4.0), (0.98, 0.0, 0.0))],
        (0.4, 0.0, 0.1), ('wheel/0', WORLD), (0.4, 0.0),
    ),
    # Its middle lies 0.1 m below the chassis, its rim on the road.
    'half below the chassis, on a road': (
        [spawning('road/0', Box(width=10.0, height=1.0), (0.0, -0.5, 0.0), anchored=True),
         spawning('chassis/0', Box(width=3.0, height=0.5), (0.0, 0.75, 0.0)),
         spawning('wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))],
        (1.02, 0.38, 0.08), ('wheel/0', 'chassis/0'), (1.0, 0.4),
    ),
    **{
        f'of {radius} m over a gap of {gap} m': (
            [spawning('a/0', Box(width=2.0, height=0.5)),
             spawning('b/0', Box(width=2.0, height=0.5), (2.0 + gap, 0.0, 0.0))],
            (1.0 + gap / 2, 0.0, radius), ('b/0', 'a/0'), (1.0 + gap / 2, 0.0),
        )
        for gap, radius in ((0.05, 0.1), (0.1, 0.1), (0.1, 0.2))
    },
    'of a wheel with corners': (
        [spawning('road/0', Box(width=9.0, height=1.0), (0.0, -0.95, 0.0)),
         spawning('chassis/0', Box(width=3.0, height=0.5), (0.0, 0.3, 0.0)),
         spawning('wheel/0', Polygon(outline=SEVEN), (1.0, 0.0, 0.0))],
        (1.02, 0.01, 0.1), ('wheel/0', 'chassis/0'), (1.02, 0.01),
    ),
    'of a wheel beside another one': (
        [spawning('wheel/0', Disc(radius=0.4), (1.8, 0.4, 0.0)),
         spawning('wheel/1', Disc(radius=0.4), (1.0, 0.4, 0.0))],
        (1.0, 0.4, 0.08), ('wheel/1', WORLD), (1.0, 0.4),
    ),
}  # fmt: skip


@pytest.mark.parametrize(('bodies', 'ring', 'ends', 'place'), AXLES.values(), ids=AXLES)
def test_a_small_circle_is_an_axle(
    world: World,
    bodies: Sequence[Spawn],
    ring: tuple[float, float, float],
    ends: tuple[str, str],
    place: Point,
) -> None:
    populate(world, bodies)

    reading = draw(world, circle(*ring))
    carry_out(world, reading)

    a, b = ends
    assert reading.meaning == 'axle'
    assert reading.message == f'an axle between {a} and {"the background" if b == WORLD else b}'
    (joint,) = world.snapshot().scene.joints
    assert (joint.kind, {joint.a, joint.b}) == (JointKind.AXLE, {a, b})
    tolerance = 0.01 if place == ring[:2] else 1e-9
    assert world.snapshot().ends[0] == pytest.approx(np.array([place] * 2), abs=tolerance)


def test_a_circle_beside_or_between_bodies_that_it_hardly_overlaps_is_a_disc(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=0.5))
    spawn(world, 'b/0', Box(width=2.0, height=0.5), (2.4, 0.0, 0.0))

    assert draw(world, circle(1.2, 0.0, 0.21)).meaning == 'disc'


@pytest.mark.parametrize('radius', [0.5, 0.6, 0.9])
def test_a_wheel_drawn_over_a_car_is_a_disc(world: World, radius: float) -> None:
    spawn(world, 'car/0', Box(width=4.0, height=1.0))

    assert draw(world, circle(1.2, -0.4, radius)).meaning == 'disc'


def test_a_small_square_over_one_body_is_a_body(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0))
    assert draw(world, square(0.2, 0.0, 0.15)).meaning == 'rectangle'


@pytest.fixture
def wheeled(world: World) -> World:
    """Return a world with a wheel that turns about an axle on its chassis."""
    spawn(world, 'chassis/0', Box(width=3.0, height=0.5), (0.0, 0.5, 0.0))
    spawn(world, 'wheel/0', Disc(radius=0.4), (1.0, 0.4, 0.0))
    carry_out(world, draw(world, circle(1.0, 0.4, 0.08)))
    return world


PHASE = np.linspace(0.0, 60.0, len(round_arrow(1.0, 0.4, 0.6, 4.5)))
QUIVER = 0.015 * np.column_stack((np.sin(PHASE), np.cos(1.3 * PHASE)))


@pytest.mark.parametrize('tremor', [0.0, QUIVER], ids=['', 'trembling'])
@pytest.mark.parametrize('sweep', [4.5, -3.0, 2.4, 5.4])
def test_a_round_arrow_about_an_axle_is_a_motor_of_its_turn_a_second(
    wheeled: World, sweep: float, tremor: Floats | float
) -> None:
    reading = draw(wheeled, round_arrow(1.0, 0.4, 0.6, sweep) + tremor)
    carry_out(wheeled, reading)

    assert reading.meaning == 'motor'
    motor = wheeled.snapshot().scene.joints[-1]
    assert (motor.kind, motor.a, motor.b) == (JointKind.MOTOR, 'wheel/0', 'chassis/0')
    assert motor.properties.rate == pytest.approx(sweep, abs=0.3)


def test_a_second_round_arrow_changes_the_motor(wheeled: World) -> None:
    for sweep in (4.5, -3.0):
        carry_out(wheeled, draw(wheeled, round_arrow(1.0, 0.4, 0.6, sweep)))

    _, motor = wheeled.snapshot().scene.joints
    assert motor.properties.rate == pytest.approx(-3.0, abs=0.3)


def test_a_rod_to_the_exact_centre_of_a_disc_ends_a_radius_from_its_rim() -> None:
    (rim,) = nearest_points(Circle((1.0, 2.0), 0.5), (1.0, 2.0))

    assert math.dist(rim, (1.0, 2.0)) == 0.5
