# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every tool makes of clicks what a person meant, and refuses what nobody can have meant."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from physsim_ros.drawing.click import Tool
from physsim_ros.drawing.session import DrawingSession
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.tools import TOOLS
from physsim_ros.files import with_shipped_robot
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import (
    Anchored,
    BadOutline,
    BadProperty,
    BadSize,
    Malformed,
    NothingThere,
    Refusal,
    UnknownBody,
    UnknownFrame,
)
from physsim_ros.model.joints import JointKind
from physsim_ros.model.preview import NO_PREVIEW
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    ChangeBody,
    Command,
    Configure,
    Delete,
    Join,
    Pin,
    Release,
    Request,
    Spawn,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Disc, MOST_POINTS, Polygon, Shape
from physsim_ros.model.transform import Point, Pose
from physsim_ros.simulation.world import World
import pytest

from ..building import DISC, spawning

WEIGHTLESS = WorldSettings(gravity=(0.0, 0.0))
SIDE, TURN = (3.0, 1.0), 0.7
# Rounding of a few sums [m].
CLOSE = 1e-12
JOINING = (Tool.SPRING, Tool.ROD, Tool.ROPE)


def pen(tool: Tool, **settings: object) -> DrawingSession:
    return DrawingSession(DrawingSettings(**settings), tool)


def draw(
    tool: Tool, *points: Point, world: World | None = None, **settings: object
) -> tuple[Request, ...]:
    """Return the requests of the last of the clicks; those before have none."""
    world = World(settings=WEIGHTLESS) if world is None else world
    hand = pen(tool, **settings)
    *earlier, last = points
    for point in earlier:
        step = hand.click(point, '', world.snapshot())
        assert step.requests == ()
        assert 'next: ' in step.message
        assert hand.preview.points[-1] == point
    requests = hand.click(last, '', world.snapshot()).requests
    assert hand.preview == NO_PREVIEW
    return requests


def drawn(tool: Tool, *points: Point, **settings: object) -> Spawn:
    (request,) = draw(tool, *points, **settings)
    assert isinstance(request, Spawn)
    return request


def populated(*bodies: Spawn) -> World:
    world = World(settings=WEIGHTLESS)
    for body in bodies:
        world.apply(body)
    return world


def disc(name: str, x: float, y: float, **said: object) -> Spawn:
    return spawning(name, DISC, (x, y, 0.0), **said)


def corners(width: float, height: float) -> list[Point]:
    """Return the corners of a rectangle that begins at SIDE and is turned by TURN."""
    cos, sin = math.cos(TURN), math.sin(TURN)
    return [
        (SIDE[0] + cos * x - sin * y, SIDE[1] + sin * x + cos * y)
        for x, y in ((0.0, 0.0), (width, 0.0), (width, height), (0.0, height))
    ]


def test_there_is_a_function_for_every_tool_but_none() -> None:
    assert set(TOOLS) == set(Tool) - {Tool.NONE}


# Bodies


@pytest.mark.parametrize(
    ('tool', 'clicks', 'shape', 'pose'),
    [
        (Tool.CIRCLE, [(1, 2), (4, -2)], Disc(radius=5.0), (1, 2, 0)),
        (Tool.CIRCLE_DIAMETER, [(1, 2), (4, 6)], Disc(radius=2.5), (2.5, 4, 0)),
        # Its frame lies along it.
        (
            Tool.WALL,
            [(1, 1), (4, 5)],
            Chain(points=((-2.5, 0.0), (2.5, 0.0)), thickness=0.2),
            (2.5, 3, math.atan2(4, 3)),
        ),
    ],
)
def test_a_circle_or_a_wall_is_where_it_was_clicked(
    tool: Tool, clicks: Sequence[Point], shape: Shape, pose: Pose
) -> None:
    spawn = drawn(tool, *clicks, wall_thickness=0.2)
    assert (spawn.shape, spawn.pose) == (shape, pose)
    assert spawn.properties == Properties(**({'anchored': True} if tool == Tool.WALL else {}))


@pytest.mark.parametrize('height', [0.5, -0.5])
@pytest.mark.parametrize('along', [0.0, 1.0, 7.0])
def test_a_rectangle_may_be_turned_and_its_far_side_may_lie_on_either_hand(
    height: float, along: float
) -> None:
    outline = corners(2.0, height)
    start, end, _, far = outline
    click = far[0] + along * (end[0] - start[0]), far[1] + along * (end[1] - start[1])

    spawn = drawn(Tool.RECTANGLE, start, end, click)

    assert isinstance(spawn.shape, Box)
    assert spawn.shape.width == pytest.approx(2.0, abs=CLOSE)
    assert spawn.shape.height == pytest.approx(0.5, abs=1e-9)
    x, y, yaw = spawn.pose
    assert yaw == pytest.approx(TURN, abs=CLOSE)
    assert (x, y) == pytest.approx(
        ((outline[0][0] + outline[2][0]) / 2, (outline[0][1] + outline[2][1]) / 2), abs=1e-9
    )


@pytest.mark.parametrize('last', [(0.0, 0.0), (0.1, 0.1), (-0.149, 0.0)])
def test_a_polygon_is_closed_by_a_click_near_its_first_corner(last: Point) -> None:
    outline = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0)]

    spawn = drawn(Tool.POLYGON, *outline, last)

    assert isinstance(spawn.shape, Polygon)
    x, y, yaw = spawn.pose
    assert yaw == 0.0
    assert [(x + px, y + py) for px, py in spawn.shape.outline] == [
        pytest.approx(corner, abs=CLOSE) for corner in outline
    ]
    assert spawn.shape.form.centroid == pytest.approx((0.0, 0.0), abs=CLOSE)


def test_a_polygon_goes_on_past_what_is_not_near_enough_to_its_first_corner() -> None:
    hand = pen(Tool.POLYGON, snap=0.05)
    for point in ((0.0, 0.0), (2.0, 0.0), (1.0, 2.0), (0.0, 0.051)):
        assert hand.click(point, '', World().snapshot()).requests == ()
    (spawn,) = hand.click((0.0, 0.049), '', World().snapshot()).requests
    assert len(spawn.shape.outline) == 4


# A tenth of `snap` is the least length of a side.
@pytest.mark.parametrize(('apart', 'corners'), [(0.0, 3), (0.001, 3), (0.0999, 3), (0.1, 4)])
def test_a_corner_that_is_clicked_twice_is_one(apart: float, corners: int) -> None:
    clicks = (0.0, 0.0), (2.0, 0.0), (2.0, apart), (2.0, 2.0), (2.0, 2.0), (0.0, 0.0)
    assert len(drawn(Tool.POLYGON, *clicks, snap=1.0).shape.outline) == corners


def test_a_polygon_has_as_many_corners_as_an_outline_may_have_and_one_more_drops_it() -> None:
    angles = [math.tau * corner / MOST_POINTS for corner in range(MOST_POINTS)]
    around = [(50.0 * math.cos(angle), 50.0 * math.sin(angle)) for angle in angles]
    snapshot = World().snapshot()
    hand = pen(Tool.POLYGON)
    for point in around:
        hand.click(point, '', snapshot)

    with pytest.raises(BadOutline):
        hand.click((0.0, 0.0), '', snapshot)

    assert hand.preview == NO_PREVIEW
    for point in around:
        hand.click(point, '', snapshot)
    (spawn,) = hand.click(around[0], '', snapshot).requests
    assert len(spawn.shape.outline) == MOST_POINTS


@pytest.mark.parametrize(
    ('tool', 'points', 'properties'),
    [
        (Tool.CIRCLE, [(0, 0), (1, 0)], {'velocity': (3.0, -1.0)}),
        (Tool.CIRCLE_DIAMETER, [(0, 0), (1, 0)], {'velocity': (3.0, -1.0)}),
        (Tool.RECTANGLE, [(0, 0), (1, 0), (1, 1)], {'velocity': (3.0, -1.0)}),
        (Tool.POLYGON, [(0, 0), (1, 0), (1, 1), (0, 0)], {'velocity': (3.0, -1.0)}),
        (Tool.WALL, [(0, 0), (1, 0)], {'anchored': True}),
    ],
)
def test_what_is_drawn_takes_colour_and_if_it_moves_velocity_from_the_settings(
    tool: Tool, points: Sequence[Point], properties: dict[str, object]
) -> None:
    color = (1.0, 0.5, 0.0, 1.0)
    spawn = drawn(tool, *points, draw_velocity=(3.0, -1.0), draw_color=color)
    assert spawn.properties == Properties(**properties)
    assert spawn.color == color


# Names


def test_names_count_up_from_the_highest_in_the_world() -> None:
    world = populated(disc('drawn/4', 0.0, 0.0), disc('other/9', 0.0, 0.0))
    assert drawn(Tool.CIRCLE, (5, 5), (6, 5), world=world).name == 'drawn/5'


@pytest.mark.parametrize('tool', [Tool.WALL, Tool.ROPE])
def test_a_name_is_not_given_twice_and_joints_count_apart_from_bodies(tool: Tool) -> None:
    # The world has not heard of what was drawn: it may have lost or refused it.
    snapshot = populated(disc('drawn/1' if tool == Tool.ROPE else 'a/0', 0.0, 0.0)).snapshot()
    hand, names = pen(tool), []
    for _ in range(3):
        hand.click((0.0, 0.0), '', snapshot)
        (request,) = hand.click((3.0, 0.0), '', snapshot).requests
        names.append(request.name)
    assert names == ['drawn/0', 'drawn/1', 'drawn/2']


# Tools for bodies and joints that are there


def drawn_join(tool: Tool, points: tuple[Point, Point], a: str, b: str) -> Join:
    return Join(name='drawn/0', kind=JointKind(tool), points=points, a=a, b=b)


TWO = (0.25, 0.0), (2.75, 0.25)
AWAY = (0.25, 0.0), (0.0, 3.0)


@pytest.mark.parametrize(
    ('tool', 'clicks', 'request_'),
    [
        (Tool.ANCHOR, [(1, 2)], Anchor(point=(1, 2))),
        (Tool.RELEASE, [(1, 2)], Release(point=(1, 2))),
        (Tool.PIN, [(1, 2)], Pin(point=(1, 2))),
        (Tool.AXLE, [(1, 2)], Axle(point=(1, 2))),
        # The topmost body.
        (Tool.DELETE, [(9.2, 0.0)], Delete(name='b/1')),
        *((tool, TWO, drawn_join(tool, TWO, 'a/0', 'a/1')) for tool in JOINING),
        # To the background, whichever was clicked first.
        (Tool.SPRING, AWAY, drawn_join(Tool.SPRING, AWAY, 'a/0', 'world')),
        (Tool.SPRING, AWAY[::-1], drawn_join(Tool.SPRING, AWAY, 'a/0', 'world')),
        # The spin stays.
        (
            Tool.VELOCITY,
            [(0.25, 0.0), (0.25, -1.5)],
            Command(names=('a/0',), twists=((0.0, -1.5, 2.0),)),
        ),
    ],
)
def test_a_tool_acts_on_what_was_clicked(
    tool: Tool, clicks: Sequence[Point], request_: Request
) -> None:
    spinning = disc('a/0', 0.0, 0.0, velocity=(4.0, 0.0), spin=2.0)
    others = [disc('a/1', 3.0, 0.0), disc('b/0', 9.0, 0.0), disc('b/1', 9.4, 0.0)]
    assert draw(tool, *clicks, world=populated(spinning, *others)) == (request_,)


def test_a_joint_holds_the_place_that_was_clicked_though_the_body_has_moved_on() -> None:
    world = populated(disc('a/0', 0.0, 0.0, velocity=(4.0, 0.0), spin=1.0))
    hand = pen(Tool.ROD)
    hand.click((0.25, 0.0), '', world.snapshot())
    world.step(240)

    (join,) = hand.click((4.0, 3.0), '', world.snapshot()).requests

    x, y = 4.0 + 0.25 * math.cos(1.0), 0.25 * math.sin(1.0)
    assert join.points[0] == pytest.approx((x, y), abs=1e-9)
    assert join.points[1] == (4.0, 3.0)
    assert join.a == 'a/0'


@pytest.mark.parametrize(
    ('point', 'at'), [((0.25, 0.0), (0.25, 0.0)), ((0.05, 0.05), None)], ids=['arm', 'centre']
)
def test_an_arrow_of_the_tool_force_is_a_force_more(point: Point, at: Point | None) -> None:
    world = populated(disc('a/0', 0.0, 0.0, forces=({'force': (1.0, 0.0)},)))
    tip = point[0], point[1] - 0.5
    (request,) = draw(Tool.FORCE, point, tip, world=world)
    assert isinstance(request, ChangeBody)
    old, new = request.properties.forces
    assert (old.force, old.at) == ((1.0, 0.0), None)
    assert new.force == pytest.approx((0.0, -5.0))
    assert (new.at, new.axes) == (at, 'world')


def test_gravity_is_turned_along_an_arrow_and_stays_as_strong() -> None:
    world = World()
    (request,) = draw(Tool.GRAVITY, (1.0, 1.0), (1.3, 1.4), world=world)
    assert isinstance(request, Configure)
    assert set(request.changes) == {'gravity'}
    assert request.changes['gravity'] == pytest.approx((0.6 * 9.81, 0.8 * 9.81))


def test_without_a_tool_a_click_is_ignored() -> None:
    hand = pen(Tool.NONE)
    step = hand.click((math.nan, 0.0), 'nobody/0', World().snapshot())
    assert step.requests == ()
    assert 'ignored' in step.message


# Refusals


@pytest.mark.parametrize(
    ('tool', 'points', 'refusal'),
    [
        (Tool.CIRCLE, [(1, 1), (1, 1)], BadSize),
        (Tool.CIRCLE, [(1, 1), (1.005, 1)], BadSize),
        (Tool.CIRCLE, [(-9e6, 0), (9e6, 0)], BadSize),
        (Tool.CIRCLE_DIAMETER, [(1, 1), (1, 1.001)], BadSize),
        (Tool.RECTANGLE, [(1, 1), (1, 1)], BadSize),
        (Tool.RECTANGLE, [(0, 0), (4, 4), (2, 2)], BadSize),
        (Tool.RECTANGLE, [(0, 0), (4, 4), (2, 2.01)], BadSize),
        (Tool.POLYGON, [(0, 0), (0, 0)], BadOutline),
        (Tool.POLYGON, [(0, 0), (1, 0), (0, 0)], BadOutline),
        (Tool.POLYGON, [(0, 0), (1, 0), (2, 0), (0, 0)], BadOutline),
        (Tool.POLYGON, [(0, 0), (2, 2), (2, 0), (0, 2), (0, 0)], BadOutline),
        (Tool.WALL, [(1, 1), (1, 1)], BadSize),
        (Tool.DELETE, [(9, 9)], NothingThere),
        (Tool.SPRING, [(9, 9), (8, 8)], NothingThere),
        (Tool.ROD, [(0, 0), (0.1, 0)], BadProperty),
        (Tool.ROPE, [(0.5, 0), (0.501, 0)], BadSize),
        (Tool.CHAIN, [(0, 0), (0.4, 0)], BadSize),
        (Tool.VELOCITY, [(9, 9)], NothingThere),
        (Tool.VELOCITY, [(3, 0)], Anchored),
        (Tool.VELOCITY, [(0, 0), (0, 0)], BadSize),
        (Tool.VELOCITY, [(0, 0), (2e5, 0)], BadProperty),
        (Tool.GRAVITY, [(1, 1), (1, 1)], BadSize),
        (Tool.FORCE, [(9, 9)], NothingThere),
        (Tool.FORCE, [(0, 0), (0, 0)], BadSize),
        (Tool.KNIFE, [(0, 0), (3, 0)], NothingThere),
    ],
)
def test_a_gesture_that_is_nothing_is_refused_and_the_tool_starts_afresh(
    tool: Tool, points: Sequence[Point], refusal: type[Refusal]
) -> None:
    world = World()
    world.apply(disc('a/0', 0.0, 0.0))
    world.apply(disc('a/1', 3.0, 0.0, anchored=True))
    hand = pen(tool)
    *earlier, last = points
    for point in earlier:
        hand.click(point, '', world.snapshot())

    with pytest.raises(refusal) as refused:
        hand.click(last, '', world.snapshot())

    assert refused.type is refusal
    assert str(refused.value)
    assert hand.preview == NO_PREVIEW
    assert hand.click((0.0, 0.0), '', world.snapshot()) == pen(tool).click(
        (0.0, 0.0), '', world.snapshot()
    )


def test_without_gravity_there_is_none_to_turn() -> None:
    with pytest.raises(BadProperty, match='no gravity'):
        draw(Tool.GRAVITY, (0.0, 0.0))


@pytest.mark.parametrize('tool', [Tool.SPRING, Tool.VELOCITY])
def test_a_body_that_has_gone_since_it_was_clicked_is_missed(tool: Tool) -> None:
    world = populated(disc('a/0', 0.0, 0.0))
    hand = pen(tool)
    hand.click((0.0, 0.0), '', world.snapshot())
    world.apply(Delete(name='a/0'))
    with pytest.raises(UnknownBody, match='a/0'):
        hand.click((3.0, 0.0), '', world.snapshot())
    assert hand.preview == NO_PREVIEW


@pytest.mark.parametrize(
    ('point', 'frame', 'refusal'),
    [
        ((math.nan, 0.0), '', Malformed),
        ((0.0, math.inf), '', Malformed),
        ((1e8, 0.0), '', BadProperty),
        ((0.0, 0.0), 'nobody/0', UnknownFrame),
    ],
)
@pytest.mark.parametrize('tool', TOOLS)
def test_a_click_that_is_no_point_leaves_the_gesture_as_it_was(
    tool: Tool, point: Point, frame: str, refusal: type[Refusal]
) -> None:
    world = World()
    world.apply(disc('a/0', 0.0, 0.0))
    hand = pen(tool)
    hand.click((0.0, 0.0), '', world.snapshot())
    before = hand.preview
    with pytest.raises(refusal):
        hand.click(point, frame, world.snapshot())
    assert hand.preview == before


# Frames, time, and the tool in hand


def test_a_point_in_the_frame_of_a_body_is_fixed_to_the_world_at_the_click() -> None:
    world = populated(disc('a/0', 1.0, 2.0, velocity=(3.0, 0.0), spin=math.pi / 2))
    world.step(240)
    hand = pen(Tool.CIRCLE)
    hand.click((1.0, 0.0), 'a/0', world.snapshot())
    world.step(240)

    (spawn,) = hand.click((4.0, 4.0), '', world.snapshot()).requests

    assert spawn.pose == pytest.approx((4.0, 3.0, 0.0), abs=1e-9)
    assert spawn.shape.radius == pytest.approx(1.0, abs=1e-9)


def test_a_weight_hangs_on_a_chain_of_links_from_surface_to_nail() -> None:
    world = World()
    world.apply(disc('bob/0', 0.0, 0.0, mass=5.0))
    requests = draw(Tool.CHAIN, (0.0, 0.0), (0.0, 3.5), world=world, wall_thickness=0.1)
    links = [each for each in requests if isinstance(each, Spawn)]
    axles = [each for each in requests if isinstance(each, Join)]
    # Of 3 m, links of 0.3 m; the axles are at both ends, too.
    assert (len(links), len(axles)) == (10, 11)
    assert (axles[0].b, axles[-1].b) == ('bob/0', 'world')
    for request in requests:
        world.apply(request)
    world.step(480)
    # It hangs where it was, and turns about its end.
    assert world.snapshot().poses[0] == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
    world.apply(Command(names=('bob/0',), twists=np.array(((2.0, 0.0, 0.0),))))
    world.step(120)
    assert math.dist(world.snapshot().poses[0, :2], (0.0, 3.5)) == pytest.approx(3.5, abs=0.05)
    assert world.snapshot().poses[0, 0] > 0.3
    robot = Properties.from_mapping(with_shipped_robot({'robot': 'omni'}, ['robot']))
    place = (9.0, 0.0, 0.0)
    world.apply(Spawn(name='omni/0', shape=Disc(radius=0.2), pose=place, properties=robot))
    *_, axle, _ = draw(Tool.CHAIN, (9.0, 3.5), (9.0, 0.0), world=world)
    assert isinstance(axle, Join)


def test_gears_turn_at_the_ratio_of_their_radii() -> None:
    world = World()
    for name, x, radius in (('small/0', 0.0, 0.5), ('large/0', 1.5, 1.0)):
        world.apply(spawning(name, Disc(radius=radius), (x, 0.0, 0.0)))
        world.apply(Axle(point=(x, 0.0)))
    for request in draw(Tool.GEAR, (0.1, 0.0), (1.6, 0.0), world=world):
        world.apply(request)
    world.apply(Command(names=('small/0',), twists=np.array(((0.0, 0.0, 4.0),))))
    world.step(10)
    small, large = world.snapshot().twists[:, 2]
    assert small == pytest.approx(-2.0 * large, abs=1e-9)
    assert small > 0.5
    with pytest.raises(NothingThere):
        draw(Tool.GEAR, (0.1, 0.0), (9.0, 9.0), world=world)


def test_a_pinion_rolls_along_its_rack_wherever_that_is_clicked() -> None:
    for click in ((0.0, -0.6), (1.7, -0.55)):
        world = World()
        world.apply(spawning('pinion/0', Disc(radius=0.5)))
        pose, anchored = (0.0, -0.6, 0.0), Properties(anchored=True)
        bar = Box(width=4.0, height=0.2)
        world.apply(Spawn(name='bar/0', shape=bar, pose=pose, properties=anchored))
        (join,) = draw(Tool.RACK, (0.1, 0.1), click, world=world)
        world.apply(join)
        world.apply(Command(names=('pinion/0',), twists=np.array(((0.5, 0.0, -1.0),))))
        world.step(240)
        x, y, yaw = world.snapshot().poses[0]
        assert y == pytest.approx(0.0, abs=1e-3)
        assert x == pytest.approx(-0.5 * yaw, abs=1e-6)
        assert x > 0.3


def test_a_slider_moves_along_the_line_that_is_drawn() -> None:
    world = World(settings=WEIGHTLESS)
    world.apply(disc('block/0', 0.0, 0.0))
    (join,) = draw(Tool.SLIDER, (0.0, 0.0), (2.0, 2.0), world=world)
    world.apply(join)
    world.apply(Command(names=('block/0',), twists=np.array(((2.0, 0.0, 0.0),))))
    world.step(60)
    x, y, yaw = world.snapshot().poses[0]
    assert (x - y, yaw) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert x > 0.1


def test_another_tool_drops_what_is_half_drawn_and_the_same_one_keeps_it() -> None:
    hand, snapshot = pen(Tool.CIRCLE), World().snapshot()
    hand.click((0.0, 0.0), '', snapshot)
    hand.tool = Tool.CIRCLE
    assert hand.preview.points == ((0.0, 0.0),)
    hand.tool = Tool.WALL
    assert hand.preview == NO_PREVIEW
    assert hand.click((1.0, 0.0), '', snapshot).requests == ()


def test_a_half_drawn_polygon_shows_its_sides_and_where_a_click_closes_it() -> None:
    hand, snapshot = pen(Tool.POLYGON, snap=0.3), World().snapshot()
    for point in ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0)):
        hand.click(point, '', snapshot)
    sides, ring = hand.preview.lines
    assert sides == ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0))
    assert {round(math.hypot(*point), 12) for point in ring} == {0.3}
    assert ring[0] == pytest.approx(ring[-1])
    assert hand.preview.label == 'polygon'
