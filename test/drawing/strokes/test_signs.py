# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes that are signs: x, arrow, scribble, hatching."""

import math

import numpy as np
from physsim_ros.model.errors import BadProperty, NothingThere, NotRecognised
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Anchor, Delete, Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World
import pytest

from .ways import built, carry_out, cross, draw, scribble
from ...building import BOX, NOWHERE, spawn, spawning


@pytest.mark.parametrize('size', [0.3, 1.0, 5.0, 20.0])
@pytest.mark.parametrize(
    ('height', 'place'), [(2.0, (0.4, 0.3)), (0.1, (0.0, 0.12)), (0.1, (0.01, -0.14))]
)
def test_an_x_on_a_body_or_across_a_thin_one_anchors_it(
    world: World, height: float, place: Point, size: float
) -> None:
    spawn(world, 'a/0', Box(width=4.0 * size, height=height * size))

    reading = draw(world, cross(size * place[0], size * place[1], 0.2 * size))
    carry_out(world, reading)

    assert (reading.meaning, reading.subject) == ('anchor', 'a/0')
    assert isinstance(reading.requests[0], Anchor)
    assert world.snapshot().scene.bodies[0].anchored


def test_an_x_in_the_open_is_refused(world: World) -> None:
    with pytest.raises(NothingThere, match='an x anchors the body under it'):
        draw(world, cross(0.0, 0.0))


ARROW = np.array([(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)])


@pytest.mark.parametrize('strength', [9.81, 5.0])
@pytest.mark.parametrize('angle', [0.3, 2.0, -1.5, 3.1, math.pi / 2])
def test_an_arrow_in_the_open_turns_gravity_and_keeps_its_strength(
    strength: float, angle: float
) -> None:
    world = World(settings=WorldSettings(gravity=(0.6 * strength, -0.8 * strength)))
    cos, sin = math.cos(angle), math.sin(angle)

    reading = draw(world, ARROW @ np.array([(cos, sin), (-sin, cos)]))
    carry_out(world, reading)

    assert reading.meaning == 'gravity'
    x, y = world.settings.gravity
    assert math.hypot(x, y) == pytest.approx(strength, rel=1e-12)
    # rad: nearly upright and nearly level become so
    assert math.cos(math.atan2(y, x) - angle) > math.cos(0.11)
    assert (0.0 in (x, y)) == (angle in {-1.5, 3.1, math.pi / 2})


@pytest.mark.parametrize('head_first', [False, True])
def test_a_bowed_arrow_whose_head_is_a_closed_triangle_turns_gravity(
    world: World, head_first: bool
) -> None:
    share = np.linspace(0.0, 1.0, 20)
    shaft = np.column_stack((2.0 * share, share * (1.0 - share)))
    # From the end of the shaft to one corner, the tip, the other corner, and back.
    head = [(2.11, 0.22), (2.36, -0.18), (1.89, -0.22), (2.0, 0.0)]
    way = np.vstack((shaft, head))

    reading = draw(world, way[::-1] if head_first else way)

    assert reading.meaning == 'gravity'
    assert reading.confidence > 0.8


def test_an_arrow_upon_an_anchored_body_is_refused(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=2.0), anchored=True)

    with pytest.raises(NotRecognised, match='begins on a/0'):
        draw(world, ARROW)


def test_without_gravity_there_is_none_to_turn() -> None:
    with pytest.raises(BadProperty, match='no gravity'):
        draw(World(settings=NOWHERE), ARROW)


# Bodies, a scribble over them, and those that it deletes.
BOXES = [
    spawning('floor/0', Box(width=20.0, height=1.0), (0.0, -1.0, 0.0), anchored=True),
    spawning('box/0', BOX),
    spawning('box/1', BOX, (1.4, 0.0, 0.0)),
]
BALLS = [spawning(f'ball/{n}', Disc(radius=0.2), (0.7 * n, 0.0, 0.0)) for n in range(3)]
WALL = spawning('wall/0', Box(width=20.0, height=0.2), (0.0, -5.0, 0.0), anchored=True)
PAIR = [spawning(f'a/{n}', Disc(radius=0.4), (n - 0.5, 0.0, 0.0)) for n in range(2)]
SCRIBBLES = {
    'one of those that it touches': (BOXES, (0.0, 0.0, 1.3, 1.3), ['box/0']),
    'several': ([WALL, *BALLS], (0.7, 0.0, 2.2, 1.0), ['ball/0', 'ball/1', 'ball/2']),
    'a long wall': ([WALL, *BALLS], (3.0, -5.0, 1.0, 1.0), ['wall/0']),
    'from body to body': (PAIR, (0.0, 0.0, 1.6, 0.7), ['a/0', 'a/1']),
}


@pytest.mark.parametrize(('bodies', 'over', 'deleted'), SCRIBBLES.values(), ids=SCRIBBLES)
def test_a_scribble_deletes_what_it_covers_and_nothing_that_it_touches(
    world: World, bodies: list[Spawn], over: tuple[float, ...], deleted: list[str]
) -> None:
    for body in bodies:
        world.apply(body)

    reading = draw(world, scribble(*over))

    assert reading.meaning == 'deletion'
    assert reading.requests == tuple(Delete(name=name) for name in deleted)
    assert reading.subject == (deleted[0] if len(deleted) == 1 else '')


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
    built(reading)
    assert not any(isinstance(each, Delete) for each in zigzag.requests)


def test_a_scribble_in_the_open_is_refused(world: World) -> None:
    with pytest.raises(NothingThere, match='there are none'):
        draw(world, scribble(0.0, 0.0, 1.0, 1.0))


def test_hatching_makes_a_body_heavier_and_changes_nothing_else(world: World) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0), (0.0, 0.0, 0.0))
    # An axle that was drawn first waits for a second body, which is not the first again.
    points = ((0.5, 0.2),)
    world.apply(Join(name='drawn/0', kind=JointKind.AXLE, points=points, a='a/0', b=WORLD))
    before = world.snapshot().scene.bodies[0].total_mass
    lines = [(-0.6, -0.3), (-0.4, 0.3), (-0.2, -0.3), (0.0, 0.3)]

    reading = draw(world, lines)
    world.step(24)
    pose = world.snapshot().poses[0].tolist()
    carry_out(world, reading)

    assert reading.meaning == 'hatching'
    assert world.snapshot().poses[0].tolist() == pose
    (body,) = world.snapshot().scene.bodies
    assert body.total_mass == pytest.approx(before * 1.25**3)
