# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sessions: strokes that are one thing, other readings, joints that wait for their bodies."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
import itertools
import math
from typing import Any

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, Reading, submit_reading
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Frozen, NothingThere, NotRecognised, UnknownBody
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Command, Configure, Join, MoveBodies, Request, Spawn
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.model.transform import rotated_each
from physsim_ros.simulation.simulation import Simulation
import pytest

from .strokes.ways import round_arrow
from ..building import spawning

Way = Sequence[tuple[float, float]]


class Desk:
    """A standing world, and a person who draws into it."""

    def __init__(self, **settings: float) -> None:
        world = WorldSettings(gravity=(0.0, 0.0))
        self.simulation = Simulation(settings=world, speed=0.0)
        self.session = DrawingSession(DrawingSettings(**settings))
        self.now = 0.0
        self.frame = self.simulation.advance_frame()

    def spawn(self, *requests: Request) -> None:
        for request in requests:
            self.simulation.requests.submit(request, topic='t')
        self._settle()

    def draw(self, way: Way | Floats, *, after: float = 0.3, **said: Any) -> Reading:
        """Draw a stroke of 0.5 s, so long after the last one; what is said goes to the session."""
        points = np.array(way, dtype=np.float64)
        if len(points) < 20:
            sides = itertools.pairwise(points)
            points = np.vstack([np.linspace(a, b, 25) for a, b in sides])
        return self.draw_samples(points, after=after, **said)

    def draw_samples(self, points: Floats, *, after: float = 0.3, **said: Any) -> Reading:
        """Draw a stroke of no more than these samples."""
        times = np.linspace(0.0, 0.5, len(points))
        samples = np.column_stack((points, times))
        began, self.now = self.now + after, self.now + after + 0.5
        reading = self.session.stroke(samples, '', self.frame.snapshot, began=began, **said)
        self._submit(reading)
        return reading

    def instead(self, meaning: str = '') -> Reading:
        reading = self.session.instead(meaning)
        self._submit(reading)
        return reading

    @property
    def shapes(self) -> list[str]:
        return [type(each.shape).__name__ for each in self.scene.bodies]

    @property
    def scene(self) -> Scene:
        return self.simulation.world.snapshot().scene

    def _submit(self, reading: Reading) -> None:
        submit_reading(self.simulation, self.session, reading, topic='~/stroke')
        self._settle()

    def _settle(self) -> None:
        frame = self.simulation.apply_requests()
        if frame is not None:
            assert all(answer.code == '' for answer in frame.answers), frame.answers
            self.frame = frame


def circle(x: float, y: float, radius: float) -> Floats:
    angle = np.linspace(0.0, 2.0 * math.pi, 60)
    return np.column_stack((x + radius * np.cos(angle), y + radius * np.sin(angle)))


SQUARE = [
    [(0.0, 0.0), (2.0, 0.05)],
    [(2.0, 2.0), (0.0, 2.02)],
    [(2.02, 0.0), (2.0, 1.97)],
    [(0.0, 2.0), (0.03, 0.03)],
]
CIRCLE, DIAMETER = circle(0.0, 0.0, 1.0), [(-1.1, 0.0), (1.1, 0.0)]
PLATE = Box(width=6.0, height=4.0)


def off_by(share: float) -> list[Floats]:
    """Return the square with the ends of its sides off by a share of their length."""
    rng = np.random.default_rng(3)
    return [np.array(side) + 2.0 * share * rng.uniform(-0.7, 0.7, (2, 2)) for side in SQUARE]


TRIANGLE = [(0.0, 0.0), (3.0, 0.0), (1.5, 2.5), (0.0, 0.0)]
PLANK = [(0.0, 0.15), (2.0, 0.15), (2.0, -0.15), (0.0, -0.15), (0.0, 0.15)]
# Bodies, strokes in turn, the meaning of the last one, and the shapes and joints then.
GROUPS: dict[str, tuple[Sequence[Spawn], Sequence[Way | Floats], str, str, str]] = {
    'four lines in any order': ([], SQUARE, 'rectangle', 'Box', ''),
    'four lines whose ends miss by 2 %': ([], off_by(0.02), 'rectangle', 'Box', ''),
    'four lines whose ends miss by 8 %': ([], off_by(0.08), 'rectangle', 'Box', ''),
    'four lines beside a body': (
        [spawning('a/0', Box(width=2.0, height=0.3), (-0.9, 0.0, 0.0))],
        [*itertools.pairwise(PLANK)], 'rectangle', 'Box Box', '',
    ),
    'a circle, then a line through it': ([], [CIRCLE, DIAMETER], 'mark', 'Disc', ''),
    'a line, then a circle about it': ([], [DIAMETER, CIRCLE], 'disc', 'Disc', ''),
    'a line most of which lies beside the circle': (
        [], [CIRCLE, [(-2.4, 0.1), (2.4, 0.0)]], 'mark', 'Disc', '',
    ),
    'a line that begins within the circle': (
        [], [CIRCLE, [(-0.9, 0.1), (1.6, 0.0)]], 'mark', 'Disc', '',
    ),
    'a line from the middle of a disc': (
        [], [0.5 * CIRCLE, [(0.0, 0.0), (0.0, 1.5)]], 'rod', 'Disc', 'rod',
    ),
    'a line to a body at once after four': (
        [spawning('a/0', Disc(radius=0.3), (5.0, 1.0, 0.0))],
        [*SQUARE, [(1.9, 1.0), (5.0, 1.0)]], 'rod', 'Disc Box', 'rod',
    ),
    'lines between bodies': (
        [spawning(f'a/{i}', Disc(radius=0.3), (*at, 0.0)) for i, at in enumerate(TRIANGLE[:3])],
        [*itertools.pairwise(TRIANGLE)], 'rod', 'Disc Disc Disc', 'rod rod rod',
    ),
    'lines that cross in the open': (
        [], [[(0.0, 0.0), (3.0, 3.0)], [(0.0, 3.0), (3.0, 0.1)]], 'wall', 'Chain Chain', '',
    ),
    'lines that cross beside a wall': (
        [], [[(-0.5, 0.1), (0.5, 0.1)], [(-0.25, -0.44), (0.26, 0.44)],
             [(-0.23, 0.44), (0.25, -0.44)]], 'wall', 'Chain Chain Chain', '',
    ),
    'lines beside one another': (
        [], [[(0.0, 0.0), (3.0, 0.0)], [(0.0, 1.0), (3.0, 1.05)]], 'wall', 'Chain Chain', '',
    ),
    'sides of a square far from one another': (
        [], [[(-1.0, 0.5), (-1.0, 2.5)], [(0.5, -1.0), (2.5, -1.0)], [(4.0, 2.5), (4.0, 0.5)],
             [(2.5, 4.0), (0.5, 4.0)]], 'wall', 'Chain Chain Chain Chain', '',
    ),
    'an arrow from a body, its head first': (
        [spawning('a/0', Disc(radius=0.5))],
        [[(1.5, 0.5), (2.0, 0.0), (1.5, -0.5)], [(0.0, 0.0), (1.95, 0.0)]], 'velocity', 'Disc', '',
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    ('under', 'strokes', 'meaning', 'shapes', 'joints'), GROUPS.values(), ids=GROUPS
)
def test_strokes_in_turn_are_one_thing_or_several(
    under: Sequence[Spawn], strokes: Sequence[Way], meaning: str, shapes: str, joints: str
) -> None:
    desk = Desk()
    desk.spawn(*under)
    for stroke in strokes:
        last = desk.draw(stroke)

    assert last.meaning == meaning
    assert desk.shapes == shapes.split()
    assert [str(joint.kind) for joint in desk.scene.joints] == joints.split()


def test_four_lines_are_undone_as_one_gesture() -> None:
    desk = Desk()
    for side in SQUARE:
        desk.draw(side)

    desk.simulation.undo()
    assert desk.shapes == []


ARROW = [[(0.2, 0.0), (2.0, 0.1)], [(1.5, 0.5), (2.0, 0.1), (1.5, -0.4)]]
# Strokes on a plate of 6 m by 4 m or a disc, slowly one after the other, and what the last one is.
SLOWLY: dict[str, tuple[Shape, Sequence[Way], str]] = {
    'lines that cross': (PLATE, [[(-1, -1), (1, 1)], [(-1, 1), (1, -1)]], 'anchor'),
    'lines side by side': (PLATE, [[(-1, -1), (1, 1)], [(0, -1), (2, 1)]], 'hatching'),
    'hatching crosswise': (
        PLATE, [[(-1, -1), (1, 1)], [(0, -1), (2, 1)], [(0, 1), (2, -1)]], 'hatching',
    ),
    'an arrow': (Disc(radius=0.5), ARROW, 'velocity'),
}  # fmt: skip


@pytest.mark.parametrize('after', [0.3, 3.0])
@pytest.mark.parametrize(('shape', 'ways', 'meaning'), SLOWLY.values(), ids=SLOWLY)
def test_signs_on_a_body_may_be_drawn_slowly(
    shape: Shape, ways: Sequence[Way], meaning: str, after: float
) -> None:
    desk = Desk()
    desk.spawn(spawning('a/0', shape))
    for way in ways:
        last = desk.draw(way, after=after)

    assert last.meaning == meaning
    assert desk.shapes == [type(shape).__name__]


def test_an_x_at_once_after_its_solid_is_no_mark() -> None:
    desk = Desk()
    desk.draw(2.0 * CIRCLE)
    mark = desk.draw(SLOWLY['lines that cross'][1][0])
    last = desk.draw(SLOWLY['lines that cross'][1][1])

    assert (mark.meaning, last.meaning) == ('mark', 'anchor')


def test_a_rod_before_its_bob_is_undone_and_read_anew_with_it() -> None:
    desk = Desk()
    desk.draw([(0.0, 3.0), (0.0, 0.0)])
    reading = desk.draw(CIRCLE * (0.4, 0.25), after=3.0)
    joined = [str(each.kind) for each in desk.scene.joints]
    desk.instead('polygon')
    again = [str(each.kind) for each in desk.scene.joints], desk.shapes
    desk.simulation.undo()

    assert joined == ['rod']
    assert reading.message.endswith('; a rod from drawn/1 to world')
    assert reading.also == ('rod',)
    assert again == (['rod'], ['Polygon'])
    assert desk.shapes == ['Chain']


@pytest.mark.parametrize('strokes', [ARROW, [np.vstack((*ARROW, ARROW[0][1:]))]])
def test_an_arrow_just_before_its_body_is_its_velocity_and_gravity_instead(
    strokes: Sequence[Way],
) -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    for stroke in strokes:
        arrow = desk.draw(stroke)

    ball = desk.draw(0.5 * CIRCLE, after=3.0)
    moved = desk.frame.snapshot.twists[0, 0], desk.scene.settings.gravity
    desk.instead('gravity')
    turned = desk.frame.snapshot.twists[0, 0], desk.scene.settings.gravity
    again = desk.instead('disc')
    desk.simulation.undo()

    assert (arrow.meaning, ball.meaning, ball.also) == ('gravity', 'disc', ('velocity',))
    assert moved == (pytest.approx(1.8, abs=0.05), (0.0, -9.81))
    assert turned == (0.0, desk.scene.settings.gravity)
    assert turned[1][0] == pytest.approx(9.81, abs=0.05)
    assert again.also == ('velocity',)
    assert desk.shapes == []


@pytest.mark.parametrize('between', [circle(5.0, 5.0, 0.5), None])
def test_an_arrow_that_was_not_drawn_just_before_a_body_has_turned_gravity(
    between: Floats | None,
) -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    desk.draw(np.vstack((*ARROW, ARROW[0][1:])))
    if between is not None:
        desk.draw(between)
    ball = desk.draw(0.5 * CIRCLE, after=0.3 if between is not None else 11.0)

    assert ball.also == ()
    assert desk.scene.settings.gravity[0] == pytest.approx(9.81, abs=0.05)


@pytest.mark.parametrize('held', ['anchored', 'on an axle'])
def test_a_rope_over_a_wheel_may_be_drawn_before_its_weights(held: str) -> None:
    desk = Desk()
    wheel = spawning('wheel/0', Disc(radius=0.5), (0.0, 3.0, 0.0), anchored=held == 'anchored')
    desk.spawn(wheel)
    if held != 'anchored':
        desk.draw(circle(0.0, 3.0, 0.1))
    over = circle(0.0, 3.0, 0.55)[29::-1]
    desk.draw(np.vstack(([(-0.55, 0.0)], over, [(0.55, 0.0)])), after=2.0)
    for side in (-0.55, 0.55):
        desk.draw(circle(side, -0.1, 0.3), after=2.0)

    assert desk.shapes == ['Disc'] * 3
    (rope,) = (each for each in desk.scene.joints if each.kind is JointKind.ROPE)
    assert [guide.body for guide in rope.guides] == ['wheel/0']


@pytest.mark.parametrize('on_it', [(0.5, 0.25, 0.0), (0.5, -3.0, 0.0)])
def test_a_wall_that_bears_something_is_no_rod(on_it: tuple[float, float, float]) -> None:
    desk = Desk()
    desk.draw([(-3.0, 0.0), (3.0, 0.0)])
    desk.spawn(spawning('a/0', Box(width=0.4, height=0.4), on_it))
    desk.draw(circle(3.0, 0.0, 0.5), after=3.0)

    assert desk.shapes[0] == ('Chain' if on_it[1] > 0.0 else 'Box')


@pytest.mark.parametrize(('settings', 'after'), [({}, 1.0), ({'regroup': 0.0}, 0.3)])
def test_lines_drawn_slowly_or_without_regrouping_are_walls(
    settings: dict[str, float], after: float
) -> None:
    desk = Desk(**settings)
    for side in SQUARE:
        desk.draw(side, after=after)

    assert desk.shapes == ['Chain'] * 4


# Of two samples a line, with arms of unequal length.
ARMS = np.array([[(-0.5, -0.3), (0.3, 0.3)], [(-0.3, 0.4), (0.5, -0.5)]])
CROSSES = {
    'x': [np.linspace((-0.4, y), (0.4, -y), 25) for y in (-0.4, 0.4)],
    'x of two samples a line': ARMS,
    'plus of two samples a line': ARMS @ np.array([(1.0, 1.0), (-1.0, 1.0)]) / math.sqrt(2.0),
}


@pytest.mark.parametrize('lines', CROSSES.values(), ids=CROSSES)
def test_an_x_of_two_strokes_anchors_the_body_and_leaves_no_trace(lines: Sequence[Floats]) -> None:
    desk = Desk()
    desk.spawn(spawning('a/0', Box(width=2.0, height=2.0)))
    before = desk.scene.bodies[0].total_mass
    for line in lines:
        last = desk.draw_samples(line)

    assert last.meaning == 'anchor'
    (body,) = desk.scene.bodies
    assert body.anchored
    assert body.total_mass == before


@pytest.mark.parametrize('seed', range(12))
def test_two_lines_that_cross_within_both_are_an_x(seed: int) -> None:
    rng = np.random.default_rng(seed)
    at, there = rng.uniform(0.18, 0.82, 2)
    turn, angle = rng.uniform(0.0, 7.0), rng.uniform(0.5, math.pi - 0.5)
    share = np.linspace(0.0, 1.0, 30)
    lines = [
        length * np.outer(share - middle, (math.cos(heading), math.sin(heading)))
        for length, middle, heading in zip(
            rng.uniform(0.6, 1.0, 2), (at, there), (turn, turn + angle), strict=True
        )
    ]
    desk = Desk()
    desk.spawn(spawning('a/0', Disc(radius=1.5)))

    assert [desk.draw_samples(line).meaning for line in lines] == ['hatching', 'anchor']


SHAFT, TIP, BARBS = [(0.0, 0.0), (3.0, 0.0)], (3.05, 0.0), ((2.3, 0.45), (2.35, -0.4))
HEADS: dict[str, list[Way]] = {
    'two barbs': [[TIP, BARBS[0]], [TIP, BARBS[1]]],
    'two barbs towards the tip': [[BARBS[0], TIP], [BARBS[1], TIP]],
    'barbs in one stroke, then the side between them': [[BARBS[0], TIP, BARBS[1]], [*BARBS]],
    'closed': [[BARBS[0], TIP, BARBS[1], BARBS[0]]],
    'closed, from the tip on': [[TIP, *BARBS, TIP]],
    'filled': [[BARBS[0], TIP, BARBS[1], BARBS[0], (2.6, -0.25), (2.6, 0.2), (2.9, 0.0)]],
}


@pytest.mark.parametrize('shaft_first', [True, False])
@pytest.mark.parametrize('head', HEADS.values(), ids=HEADS)
def test_an_arrow_of_several_strokes_turns_gravity_and_leaves_nothing_else(
    head: list[Way], shaft_first: bool
) -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    for stroke in [SHAFT, *head] if shaft_first else [*head, SHAFT]:
        # A head that is filled is nothing by itself.
        with suppress(NotRecognised, NothingThere):
            desk.draw(stroke)

    x, y = desk.scene.settings.gravity
    assert math.atan2(y, x) == pytest.approx(0.0, abs=0.1)
    assert desk.shapes == []


def test_a_closed_head_may_be_as_large_as_its_shaft() -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    # The middle of the head is no nearer to the tip than to the tail.
    one, other = (0.8, 1.1), (0.65, -1.35)
    for stroke in (SHAFT, [one, (2.8, -0.1), other], [one, other]):
        desk.draw(stroke)

    x, y = desk.scene.settings.gravity
    assert math.atan2(y, x) == pytest.approx(0.0, abs=0.1)
    assert desk.shapes == []


def test_the_shaft_of_an_arrow_may_tremble() -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    share = np.linspace(0.0, 1.0, 120)
    desk.draw(np.column_stack((3.0 * share, 0.045 * np.sin(28.0 * math.pi * share))))
    desk.draw([BARBS[0], TIP, BARBS[1], BARBS[0]])

    x, y = desk.scene.settings.gravity
    assert math.atan2(y, x) == pytest.approx(0.0, abs=0.1)
    assert desk.shapes == []


@pytest.mark.parametrize('corners', [4, 5, 6, 60])
def test_a_line_and_a_body_at_its_end_are_no_arrow(corners: int) -> None:
    desk = Desk()
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    angle = np.linspace(0.0, 2.0 * math.pi, corners + 1)
    desk.draw(SHAFT)
    desk.draw(0.3 * np.column_stack((np.cos(angle), np.sin(angle))) + (3.3, 0.0))

    assert desk.scene.settings.gravity == (0.0, -9.81)
    assert len(desk.shapes) == 2


@pytest.mark.parametrize('gap', [-0.1, 0.0, 0.3, 0.5])
def test_a_shaft_that_ends_short_of_its_head_or_beyond_is_an_arrow_that_turns_gravity(
    gap: float,
) -> None:
    desk = Desk()
    desk.spawn(spawning('a/0', Disc(radius=0.5), (9.0, 9.0, 0.0)))
    desk.spawn(Configure(changes={'gravity': (0.0, -9.81)}))
    desk.draw([(0.0, 0.0), (3.0 - gap, 0.0)])

    assert desk.draw([(2.5, 0.5), (3.0, 0.02), (2.5, -0.4)]).meaning == 'gravity'
    assert desk.shapes == ['Disc']
    assert desk.simulation.settings.gravity == pytest.approx((9.81, 0.0), abs=0.2)


def test_the_runner_up_takes_the_place_of_the_reading() -> None:
    desk = Desk()
    desk.spawn(
        spawning('a/0', Disc(radius=0.5)), spawning('a/1', Disc(radius=0.5), (3.0, 0.0, 0.0))
    )
    first = desk.draw([(0.0, 0.0), (3.0, 0.0)])
    assert first.meaning == 'rod'

    second = desk.instead()

    assert second.meaning == first.guesses[1].meaning == 'wall'
    assert desk.scene.joints == ()
    assert desk.shapes[-1] == 'Chain'
    third = desk.instead('rod')
    assert third.meaning == 'rod'
    assert len(desk.shapes) == 2


def test_a_rope_is_a_chain_instead_which_is_undone_at_once() -> None:
    desk = Desk()
    desk.spawn(
        spawning('a/0', Disc(radius=0.5)), spawning('a/1', Disc(radius=0.5), (4.0, 0.0, 0.0))
    )
    turn = np.linspace(math.pi, 2.0 * math.pi, 50)
    slack = np.column_stack((2.0 + 2.0 * np.cos(turn), 1.5 * np.sin(turn)))
    assert desk.draw(slack).meaning == 'rope'

    chain = desk.instead('chain')

    assert chain.meaning == 'chain'
    links = desk.shapes[2:]
    assert set(links) == {'Box'}
    assert [joint.kind for joint in desk.scene.joints] == [JointKind.AXLE] * (len(links) + 1)
    # m: of 5.52 m as drawn, what lies outside of the discs.
    assert 0.3 * len(links) == pytest.approx(4.7, abs=0.3)
    assert desk.simulation.status.undo == 'undo spawn chain'
    desk.simulation.undo()
    assert (len(desk.simulation.world), desk.simulation.world.scene.joints) == (2, ())
    assert desk.simulation.status.redo == 'redo spawn chain'


def test_without_another_guess_nothing_is_read_instead() -> None:
    desk = Desk()
    with pytest.raises(NotRecognised):
        desk.session.instead()


def test_what_was_not_recognised_can_be_built_instead() -> None:
    desk = Desk(sketch_confidence=1.0)
    with pytest.raises(NotRecognised):
        desk.draw(circle(0.0, 0.0, 1.0))

    reading = desk.instead()

    assert reading.meaning == 'disc'
    assert desk.shapes == ['Disc']


CROSSED = [(-0.5, 0.0), (2.0, 0.0), (2.0, 2.0), (0.2, 2.0), (0.2, -0.5)]


def test_a_guess_that_the_world_cannot_have_changes_nothing() -> None:
    desk = Desk()
    assert desk.draw(CROSSED).meaning == 'rectangle'
    for meaning in ('anchor', ''):
        with pytest.raises(NothingThere):
            desk.session.instead(meaning)

    assert desk.draw([(-0.5, 1.0), (2.5, 1.0)]).meaning == 'mark'


@pytest.mark.parametrize('ways', [SQUARE, [CIRCLE, DIAMETER], [CROSSED]])
def test_a_reading_that_may_not_be_leaves_the_session_as_it_was(ways: list[Way]) -> None:
    def refuse(_reading: Reading) -> None:
        raise Frozen('somebody has locked it')

    def drawn(*, with_refused: bool) -> list[tuple[str, tuple[Request, ...], tuple[int, ...]]]:
        desk, readings = Desk(), []
        for way in ways:
            if with_refused:
                preview = desk.session.preview
                with pytest.raises(Frozen):
                    desk.draw(way, check=refuse)
                assert desk.session.preview == preview
                with suppress(Frozen, NotRecognised):
                    desk.session.instead(check=refuse)
            readings.append(desk.draw(way, after=0.3 - 0.8 * with_refused))
        return [(each.meaning, each.requests, each.amends) for each in readings]

    assert drawn(with_refused=True) == drawn(with_refused=False)


def plank(angle: float) -> Floats:
    """Return the outline of a plank about the origin, 4 m long, turned by an angle [rad]."""
    way = np.array([(-2.0, -0.15), (2.0, -0.15), (2.0, 0.15), (-2.0, 0.15), (-2.0, -0.15)])
    cos, sin = math.cos(angle), math.sin(angle)
    return np.asarray(way @ np.array([(cos, sin), (-sin, cos)]))


@pytest.mark.parametrize('blades', [1, 2, 3, 4])
def test_an_axle_drawn_on_each_blade_of_a_rotor_holds_all_on_the_background(blades: int) -> None:
    desk = Desk()
    for number in range(blades):
        desk.draw(plank(number * math.pi / blades), after=2.0)
        desk.draw(circle(0.0, 0.02 * number, 0.11), after=2.0)

    joints = [{each.a, each.b} for each in desk.scene.joints]
    assert [each.kind for each in desk.scene.joints] == [JointKind.AXLE] * blades
    held = {'world'}
    for _ in joints:
        held = held.union(*(each for each in joints if each & held))
    assert held == {'world', *(each.name for each in desk.scene.bodies)}


def test_one_axle_goes_through_all_movable_bodies_at_its_place() -> None:
    desk = Desk()
    for number in range(3):
        desk.draw(plank(number * math.pi / 3), after=2.0)
    reading = desk.draw(circle(0.0, 0.0, 0.11), after=2.0)

    assert reading.message == 'an axle between drawn/2, drawn/1 and drawn/0'
    assert [(each.a, each.b) for each in desk.scene.joints] == [
        ('drawn/2', 'drawn/1'), ('drawn/1', 'drawn/0'),
    ]  # fmt: skip


@pytest.mark.parametrize('order', list(itertools.permutations(range(3))))
def test_wheel_axle_and_round_arrow_are_a_driven_wheel_in_any_order(order: Sequence[int]) -> None:
    ways = circle(0.0, 0.0, 1.0), circle(0.0, 0.0, 0.12), round_arrow(0.0, 0.0, 0.5, 4.5)
    desk = Desk()
    for number in order:
        with suppress(NothingThere):
            desk.draw(ways[number], after=20.0)
    (wheel,) = desk.scene.bodies
    axle, motor = desk.scene.joints
    assert (axle.kind, motor.kind) == (JointKind.AXLE, JointKind.MOTOR)
    assert {axle.a, motor.a} == {wheel.name}
    assert math.isclose(motor.number('rate'), 4.5, rel_tol=0.05)


@pytest.mark.parametrize('size', [0.3, 1.0, 4.0])
@pytest.mark.parametrize('turn', [0.0, 2.0])
@pytest.mark.parametrize('high', [0.5, 1.0])
@pytest.mark.parametrize('apart', [0.1, 0.2, 0.5])
@pytest.mark.parametrize('back', [1, -1])
def test_lines_beside_each_other_are_no_outline_without_its_ends(
    size: float, turn: float, high: float, apart: float, back: int
) -> None:
    chevron = np.array([(-0.5, high), (0.0, 0.0), (0.5, high)])
    desk = Desk()
    for number in range(3):
        way = size * rotated_each(np.add(chevron, (0.0, number * apart)), turn)
        desk.draw(way[:: back**number])
    assert desk.shapes == ['Chain', 'Chain', 'Chain']


def test_a_round_arrow_drives_no_axle_outside_it() -> None:
    desk = Desk()
    desk.spawn(spawning('a/0', PLATE))
    with pytest.raises(NothingThere):
        desk.draw(round_arrow(-1.5, 0.0, 0.5, 4.5))
    desk.draw(circle(1.5, 0.0, 0.12))
    assert [each.kind for each in desk.scene.joints] == [JointKind.AXLE]


@pytest.mark.parametrize('other', [1e9, -1e9])
def test_strokes_that_began_by_two_clocks_are_no_thing_of_several_strokes(other: float) -> None:
    desk = Desk()
    desk.spawn(spawning('a/0', PLATE))
    desk.draw([(-0.5, -0.5), (0.5, 0.5)])
    desk.now += other
    assert desk.draw([(-0.5, 0.5), (0.5, -0.5)]).meaning == 'hatching'


def test_a_machine_is_copied_with_the_joints_among_its_bodies() -> None:
    sim = Simulation()
    for name, x in (('a/0', 0.0), ('b/0', 2.0), ('c/0', 4.0)):
        sim.perform(spawning(name, Disc(radius=0.3), (x, 1.0, 0.5)))
    joints = (
        Join(name='j/0', kind=JointKind.SPRING, points=((0, 1), (2, 1)), a='a/0', b='b/0'),
        Join(name='j/1', kind=JointKind.ROD, points=((2, 1), (4, 1)), a='b/0', b='c/0'),
        Join(name='j/2', kind=JointKind.ROPE, points=((0, 1), (0, 3)), a='a/0', b='world'),
    )
    for join in joints:
        sim.perform(join)
    # The spring is not as long as it was drawn.
    sim.perform(MoveBodies(names=('a/0',), by=(0.5, 0.0)))
    session = DrawingSession(DrawingSettings())

    requests = session.copy_machine(('a/0', 'b/0'), (10.0, 2.0), sim.world.snapshot())
    for request in requests:
        sim.perform(request)

    scene, poses = sim.world.scene, sim.world.snapshot().poses
    assert scene.names == ('a/0', 'b/0', 'c/0', 'drawn/0', 'drawn/1')
    assert poses[3:, :2].tolist() == [[10.5, 3.0], [12.0, 3.0]]
    assert poses[3:, 2].tolist() == [0.5, 0.5]
    spring, rope = scene.joints[3:]
    assert (spring.kind, spring.a, spring.b) == (JointKind.SPRING, 'drawn/0', 'drawn/1')
    assert spring.rest_length == 2.0
    assert (rope.kind, rope.a, rope.b) == (JointKind.ROPE, 'drawn/0', 'world')
    with pytest.raises(UnknownBody, match=r"'x/0'; nearest is '[abc]/0'"):
        session.copy_machine(('a/0', 'x/0'), (1.0, 0.0), sim.world.snapshot())


TRACTOR = {
    'links': [{'name': 'trailer', 'box': {'width': 0.4, 'height': 0.2}, 'at': [-0.6, 0]}],
    'joints': [{'name': 'hitch', 'kind': 'axle', 'a': 'trailer', 'points': [[-0.3, 0]]}],
}


@pytest.mark.parametrize('named', [('t/0',), ('t/0/trailer/0',), ('t/0/trailer/0', 't/0', 'b/0')])
def test_a_copy_of_a_robot_or_of_a_part_is_one_whole_robot_as_it_stands(named: Any) -> None:
    sim = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    sim.perform(spawning('t/0', Box(width=0.3, height=0.2), robot=TRACTOR))
    sim.perform(spawning('b/0', Disc(radius=0.1), (-1.0, 0.0, 0.0)))
    hook = (-0.9, 0.0), (-1.0, 0.0)
    sim.perform(Join(name='h/0', kind=JointKind.ROD, points=hook, a='t/0/trailer/0', b='b/0'))
    # The trailer is turned about the hitch.
    sim.perform(Command(names=('t/0', 't/0/trailer/0'), poses=[[0, 0, 0], [-0.3, -0.3, 1.57]]))
    before = sim.world.snapshot()

    for request in DrawingSession(DrawingSettings()).copy_machine(named, (5.0, 1.0), before):
        sim.perform(request)

    after = sim.world.snapshot()
    rows = {name: row for row, name in enumerate(after.scene.names)}
    new = rows.keys() - set(before.scene.names)
    (robot,) = (name for name in new if after.scene.bodies[rows[name]].robot is not None)
    assert len(new) == 2 + ('b/0' in named)
    for name in ('t/0', 't/0/trailer/0'):
        moved = after.poses[rows[name.replace('t/0', robot)]] - after.poses[rows[name]]
        assert moved == pytest.approx([5.0, 1.0, 0.0])
    joints = [each for each in after.scene.joints if each.name not in ('h/0', 't/0/hitch/0')]
    assert joints[0].name == f'{robot}/hitch/0'
    assert [each.kind for each in joints[1:]] == [JointKind.ROD] * ('b/0' in named)


def test_a_copy_has_all_properties_of_its_body_and_a_namespace_of_its_own() -> None:
    sim = Simulation()
    disc, belt = Disc(radius=0.3), {'surface_velocity': (1.0, 0.0), 'sensor': True}
    drive = {'drive': {'kind': 'omni'}}
    sim.perform(spawning('a/0', disc, mass=3.0, group=5, label='m', **belt))
    sim.perform(spawning('b/0', disc, (3.0, 0.0, 0.0), robot={**drive, 'namespace': 'tb'}))
    session = DrawingSession(DrawingSettings())

    for name in ('a/0', 'b/0'):
        for request in session.copy_machine((name,), (9.0, 0.0), sim.world.snapshot()):
            sim.perform(request)

    one, robot, copied, other = sim.world.scene.bodies
    assert copied == replace(one, name=copied.name)
    assert other == replace(robot, name=other.name, robot=Robot.from_mapping(drive))
