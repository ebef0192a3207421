# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The work of a stroke or a copy grows with what it is about, and not with a power of that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
import itertools
import tracemalloc

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, knife
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.bodies_under import joint_ends, wheels_passed
from physsim_ros.drawing.strokes.grouping import MOST_STROKES, MOST_TIME
from physsim_ros.drawing.strokes.waiting_joints import requests_with_waiting_joints
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_description import new_body
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Malformed, WorldFull
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Joint, Scene, Seat
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Pose
import pytest

from ..building import DISC
from ..work import calls_of

# Between 2, where work is proportional, and 4, where it grows by the square.
TWICE = 2.5
PIECES = 99
ALONG = np.linspace(0.0, 1.0, PIECES + 1)
WAVES = zip((4.0 * ALONG).tolist(), (0.3 * np.sin(40.0 * ALONG)).tolist(), strict=True)
WALL = Chain(points=tuple(WAVES), thickness=0.1)
SHARE = np.linspace(0.0, 1.0, 12)
STROKES = {
    'line': np.column_stack((0.05 + 3.9 * SHARE, 0.05 * SHARE, SHARE)),
    'scribble': np.column_stack((3.5 * SHARE, 0.4 * (-1.0) ** np.arange(12), SHARE)),
    'circle': np.column_stack((2.0 + 0.3 * np.cos(7 * SHARE), 0.3 * np.sin(7 * SHARE), SHARE)),
}


def crowd(count: int, shape: Shape, *, anchored: bool) -> Snapshot:
    """Return a scene of equal bodies at one place."""
    settings, properties = WorldSettings(), Properties(anchored=anchored)
    spawns = (
        Spawn(name=f'drawn/{each}', shape=shape, properties=properties) for each in range(count)
    )
    scene = Scene(
        bodies=tuple(new_body(each, settings, None)[0] for each in spawns), settings=settings
    )
    return Snapshot(
        step=0, stamp=0, scene=scene, poses=np.zeros((count, 3)), twists=np.zeros((count, 3))
    )


NOBODY = crowd(0, DISC, anchored=True)


def work(act: Callable[[], object]) -> Floats:
    """Return how often an act calls functions, of Python or C, and its greatest memory [bytes]."""
    tracemalloc.start()
    try:
        return np.array((calls_of(act), tracemalloc.get_traced_memory()[1]))
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize('kind', STROKES)
def test_a_stroke_over_twice_as_many_walls_is_twice_the_work(kind: str) -> None:
    def drawn(count: int) -> Floats:
        snapshot = crowd(count, WALL, anchored=True)

        def draw() -> None:
            DrawingSession(DrawingSettings()).stroke(STROKES[kind], '', snapshot, began=0.0)

        # Values that are kept of a scene are made first.
        draw()
        return work(draw)

    some, more = drawn(40), drawn(80)
    assert (more > some).all()
    assert (more <= TWICE * some).all()
    # The pieces of a wall are not looked at one by one.
    assert (more - some)[0] < 40 * PIECES


def saw(number: int) -> Floats:
    """Return a line of a saw: it begins where the one before it ends."""
    return np.array([(0.5 * each, 0.7 * (each % 2), 0.3 * each) for each in (number, number + 1)])


def test_a_stroke_is_read_with_the_newest_strokes_alone() -> None:
    session = DrawingSession(DrawingSettings())

    def draw(number: int) -> None:
        reading = session.stroke(saw(number), '', NOBODY, began=0.5 * number)
        assert reading.meaning == 'wall'

    calls = [calls_of(partial(draw, number)) for number in range(MOST_STROKES + 4)]

    grown = calls[:MOST_STROKES]
    assert grown == sorted(grown)
    # One stroke more would be a fifth more.
    assert max(calls) < 1.1 * grown[-1]


@pytest.mark.parametrize(('pause', 'meaning'), [(0.0, 'rectangle'), (0.003, 'wall')])
def test_a_stroke_is_read_by_itself_when_the_time_is_over(pause: float, meaning: str) -> None:
    looks = list[float]()

    def clock() -> float:
        looks.append(pause * len(looks))
        return looks[-1]

    session = DrawingSession(DrawingSettings(), clock=clock)
    # Lines that lead to a square make more groups than there is time for; their far ends, and
    # their loop, are those of no figure.
    corners = [(-8, 0), (-6, 0), (-4, 0), (-2, 0), (0, 0), (0, 1), (1, 1), (1, 0), (0, 0)]
    for number, ends in enumerate(itertools.pairwise(corners)):
        line = np.column_stack((np.array(ends, dtype=np.float64), (0.0, 0.2)))
        looks.clear()
        reading = session.stroke(line, '', NOBODY, began=0.5 * number)

    assert reading.meaning == meaning
    if pause:
        assert looks[-2] <= looks[0] + MOST_TIME < looks[-1]


def test_a_copy_of_twice_as_many_bodies_is_twice_the_work() -> None:
    def copied(count: int) -> Floats:
        session, snapshot = DrawingSession(DrawingSettings()), crowd(count, DISC, anchored=False)

        def copy(first: int) -> None:
            copies = session.copy_machine(snapshot.scene.names, (9.0, 0.0), snapshot)
            numbers = range(first, first + count)
            assert [each.name for each in copies] == [f'drawn/{number}' for number in numbers]

        copy(count)
        return work(lambda: copy(2 * count))

    assert (copied(400) <= TWICE * copied(200)).all()


def test_no_body_is_copied_twice_at_once() -> None:
    session, snapshot = DrawingSession(DrawingSettings()), crowd(3, DISC, anchored=False)
    with pytest.raises(Malformed, match='named twice'):
        session.copy_machine(('drawn/0', 'drawn/1', 'drawn/0'), (9.0, 0.0), snapshot)
    assert session.copy_machine(('drawn/0',), (9.0, 0.0), snapshot)[0].name == 'drawn/3'


BOX = Box(width=0.4, height=0.4)
ZIGZAG = Chain(points=tuple((0.1 * n, (-1.0) ** n) for n in range(1000)), thickness=0.02)
TEETH = ((0.01 * (n // 2) + 0.004 * (n % 2), 1.0 - 0.9 * (n % 2)) for n in range(998))
COMB = Polygon(outline=((0.0, 0.0), *TEETH, (5.0, 0.0)))
HEAP = Compound(element=Disc(radius=0.5), centers=tuple((0.001 * n, 0.0) for n in range(100)))
ACROSS = (-1.0, 0.5), (120.0, 0.51)


def query_of(shapes: Sequence[tuple[Shape, Pose]], joints: tuple[Joint, ...] = ()) -> SceneQuery:
    """Return a scene of bodies of these shapes at these poses, from which caches are made."""
    settings = WorldSettings()
    spawns = (Spawn(name=f'b/{number}', shape=shape) for number, (shape, _) in enumerate(shapes))
    bodies = tuple(new_body(each, settings, None)[0] for each in spawns)
    poses = np.array([pose for _, pose in shapes])
    scene = Scene(bodies=bodies, settings=settings, joints=joints)
    snapshot = Snapshot(step=0, stamp=0, scene=scene, poses=poses, twists=np.zeros_like(poses))
    return SceneQuery(snapshot)


@pytest.mark.parametrize(
    'shapes',
    [
        [(BOX, (0.5 * number, 0.5, 0.0)) for number in range(1000)],
        [(ZIGZAG, (0.0, 0.0, 0.0))],
        [(COMB, (0.0, 0.0, 0.0))],
        [(HEAP, (0.0, 0.5, 0.0))],
    ],
    ids=['boxes', 'chain', 'comb', 'heap'],
)
def test_a_cut_into_too_many_pieces_is_refused_with_little_work(shapes):
    query = query_of(shapes)

    def refuse() -> None:
        with pytest.raises(WorldFull):
            knife.cut(*ACROSS, query)

    # Values that are kept of a scene are made first.
    refuse()
    # As many as of a hundred boxes, each cut in two.
    assert calls_of(refuse) < 100_000


def test_a_cut_beside_twice_as_many_bodies_is_hardly_more_work() -> None:
    """Of bodies whose circles the stroke meets, and whose boxes it does not."""
    stick = Box(width=100.0, height=0.1)

    def beside(count: int) -> int:
        sticks = [(stick, (50.0, 1.0 + 0.11 * number, 0.0)) for number in range(count)]
        query = query_of([(BOX, (1.0, 0.5, 0.0)), *sticks])
        assert len(knife.cut(*ACROSS, query).pieces) == 2
        return calls_of(lambda: knife.cut(*ACROSS, query))

    assert beside(400) - beside(200) < 200 * 5


def test_a_joint_of_a_body_that_is_cut_is_compared_with_the_pieces_beside_it() -> None:
    line = Chain(points=tuple((0.1 * n, (-1.0) ** (n // 5)) for n in range(900)), thickness=0.02)

    def jointed(count: int) -> int:
        ends = [line.points[5 * number] for number in range(count)]
        joints = tuple(
            Joint(
                name=f'j/{number}',
                kind=JointKind.PIN,
                a='b/0',
                b='world',
                seat=Seat(*end, *end, 0.0, 0.0, 0.0, 0.0),
                properties=JointProperties(),
            )
            for number, end in enumerate(ends)
        )
        query = query_of([(line, (0.0, 0.0, 0.0))], joints)
        assert len(knife.cut(*ACROSS, query).pieces) > 100
        return calls_of(lambda: knife.cut(*ACROSS, query))

    # Of some 180 pieces, the circles of all.
    assert jointed(120) - jointed(60) < 60 * 2 * 1_000


def axle(number: int) -> Joint:
    """Return an axle that was drawn on the body of a number and on the background."""
    return Joint(
        name=f'drawn/{number}',
        kind=JointKind.AXLE,
        seat=Seat(0.0, 0.0, 0.5 * number, 0.5, 0.0, 0.0, 0.0, 0.0),
        properties=JointProperties(),
        a=f'b/{number}',
        b='world',
    )


def test_bodies_beside_twice_as_many_waiting_axles_are_twice_the_work() -> None:
    def spawned(count: int) -> int:
        query = query_of(
            [(BOX, (0.5 * number, 0.5, 0.0)) for number in range(count)],
            tuple(axle(number) for number in range(count)),
        )
        links = tuple(Spawn(name=f'c/{each}', shape=DISC, pose=(0, -9, 0)) for each in range(100))
        return calls_of(lambda: requests_with_waiting_joints(links, query, 0.1))

    assert spawned(100) <= TWICE * spawned(50)


def test_a_rope_among_twice_as_many_wheels_is_twice_the_work() -> None:
    def drawn(count: int) -> int:
        ends = [(BOX, (-1.0, 0.0, 0.0)), (BOX, (0.5 * count, 2.0, 0.0))]
        wheels = [(Disc(radius=0.1), (0.5 * number, 1.0, 0.0)) for number in range(count)]
        query = query_of([*wheels, *ends], tuple(axle(number) for number in range(count)))
        points = np.linspace((-1.0, 0.0), (0.5 * count, 2.0), 64)
        joints = joint_ends(points, query, 0.1)
        assert joints is not None
        return calls_of(lambda: wheels_passed(points, joints, query, 0.1))

    assert drawn(200) <= TWICE * drawn(100)
