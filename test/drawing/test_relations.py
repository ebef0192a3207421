# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Relations of strokes: what does not matter to a reader does not change a reading."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
import itertools
import math

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, submit_reading
from physsim_ros.drawing.click import Tool
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Command, Delete, Join, Request, Spawn
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import rotated_each
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .strokes.ways import circle, round_arrow, scribble, square, Way, zigzag
from ..building import spawning

# A world in which things are drawn: its bodies, which are symmetric, and axles of these; strokes
# as (n, 3) float64: x, y [m], time [s].
Drawn = tuple[Sequence[Spawn | Join], list[Floats]]
# Samples and seconds of a stroke, and seconds between strokes.
_COUNT, _SECONDS, _PAUSE = 60, 0.6, 0.4
OVAL = circle(0.0, 0.0, 1.0) * (1.0, 0.9)
SHARE = np.linspace(0.0, 1.0, 30)
SAG = np.column_stack((4.5 * SHARE, -5.0 * SHARE * (1.0 - SHARE)))
OVER = np.column_stack((-0.55 * np.cos(math.pi * SHARE), 3.0 + 0.55 * np.sin(math.pi * SHARE)))
PLATE = [spawning('a/0', Box(width=6.0, height=4.0))]
BESIDE = [spawning(f'a/{n}', Disc(radius=0.5), (4.5 * n, 0.0, 0.0)) for n in range(2)]
PLANKS = [spawning(f'a/{n}', Box(width=4.0, height=0.8), (2.0 * n, 0.0, 0.0)) for n in range(2)]
MILL = [
    spawning('a/0', Box(width=4.0, height=0.8)),
    spawning('a/1', Box(width=0.8, height=4.0)),
    spawning('a/2', Disc(radius=0.6)),
]
ROTOR = [
    *MILL[:2],
    Join(name='axle/0', kind=JointKind.AXLE, points=((0.0, 0.0),), a='a/1', b='a/0'),
]
WEIGHTS = [
    spawning('wheel/0', Disc(radius=0.5), (0.0, 3.0, 0.0), anchored=True),
    *(spawning(f'a/{n}', Disc(radius=0.3), (n - 0.5, 0.0, 0.0)) for n in range(2)),
]
WHEEL = [
    spawning('a/0', Disc(radius=0.5)),
    Join(name='axle/0', kind=JointKind.AXLE, points=((0.0, 0.0),), a='a/0', b=WORLD),
]
CROSSED = [[(-1, -0.9), (1.1, 0.8)], [(-0.8, 1), (0.7, -0.9)]]
SHAFT, HEAD = [(0, 0), (3, 0.2)], [(2.2, 0.7), (3, 0.2), (2.3, -0.4)]
FOUR = [[(0, 0), (3, 0.1)], [(3, 0), (2.9, 1.6)], [(2.9, 1.5), (0.1, 1.6)], [(0, 1.5), (0, 0)]]
# Bodies, ways of the pen, and what the last one is: meaning, bodies and joints.
THINGS: dict[str, tuple[Sequence[Spawn | Join], Sequence[Way | Floats], str]] = {
    'disc': ([], [OVAL], 'disc'),
    'rectangle': ([], [[(0, 0), (3, 0.1), (2.9, 1.6), (0.1, 1.5), (0, 0)]], 'rectangle'),
    'polygon': ([], [[(0, 0), (3, 0), (1.2, 2.2), (0, 0)]], 'polygon'),
    'wall': ([], [[(0, 0), (2, 0.4), (3, 2)]], 'wall'),
    'hatching': (PLATE, [[(-1.5, -1), (1.5, 1)]], 'hatching'),
    'rod': (BESIDE, [[(0, 0), (4.5, 0.1)]], 'rod a/0 a/1'),
    'spring': (BESIDE, [zigzag((0.0, 0.0), (4.5, 0.0))], 'spring a/0 a/1'),
    'rope': (BESIDE, [SAG], 'rope a/0 a/1'),
    'rope over a wheel': (
        WEIGHTS, [np.vstack(([(-0.5, 0.1)], OVER, [(0.5, 0.1)]))], 'rope a/0 a/1 over wheel/0',
    ),
    'axle': (PLATE, [0.4 * OVAL], 'axle a/0 world'),
    'axle of two': (PLANKS, [0.2 * OVAL + (1.0, 0.0)], 'axle a/0 a/1'),
    'axle of three': (MILL, [0.2 * OVAL], 'axle a/0 a/1 a/2'),
    'axle that holds a rotor': (ROTOR, [0.2 * OVAL], 'axle a/0 world'),
    'weld': (PLANKS, [square(1.0, 0.0, 0.2)], 'pin a/0 a/1'),
    'x in one stroke': (PLATE, [[(-1, 0.8), (1, -0.9), (0.9, 0.8), (-1, -0.8)]], 'anchor'),
    'x of two lines': (PLATE, CROSSED, 'anchor'),
    'scribble': (BESIDE, [scribble(0.0, 0.0, 1.2, 1.0)], 'deletion a/0'),
    'arrow': ([], [[*SHAFT, *HEAD]], 'gravity'),
    'shaft and head': ([], [SHAFT, HEAD], 'gravity'),
    'arrow from a body': (BESIDE[:1], [[*SHAFT, *HEAD]], 'velocity a/0'),
    'round arrow': (WHEEL, [round_arrow(0.0, 0.0, 1.0, 4.0)], 'motor a/0 world'),
    'four lines': ([], FOUR, 'rectangle'),
}  # fmt: skip


def along(way: Floats | Way, count: int = _COUNT) -> Floats:
    """Return samples along a way at an even pace, (n, 3) float64."""
    points = np.array(way, dtype=np.float64)
    length = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    at = np.linspace(0.0, length[-1], count)
    places = [np.interp(at, length, axis) for axis in points.T]
    return np.column_stack((*places, np.linspace(0.0, _SECONDS, count)))


def placed(drawn: Drawn, turn: Callable[[Floats], Floats]) -> Drawn:
    """Return bodies and strokes moved by a function of places, which scales them evenly."""
    before, strokes = drawn
    origin, along = turn(np.array([(0.0, 0.0), (1.0, 0.0)]))
    size, yaw = math.dist(origin, along), math.atan2(*(along - origin)[::-1])
    moved: list[Spawn | Join] = []
    for each in before:
        if isinstance(each, Join):
            points = turn(np.array(each.points)).tolist()
            moved.append(replace(each, points=tuple(map(tuple, points))))
            continue
        (x, y), shape = turn(np.array([each.pose[:2]]))[0].tolist(), each.shape
        if isinstance(shape, Box):
            shape = Box(width=size * shape.width, height=size * shape.height)
        elif isinstance(shape, Disc):
            shape = Disc(radius=size * shape.radius)
        moved.append(replace(each, shape=shape, pose=(x, y, yaw)))
    return moved, [np.column_stack((turn(each[:, :2]), each[:, 2])) for each in strokes]


def each_stroke(change: Callable[[Floats], Floats]) -> Callable[[Drawn], Drawn]:
    """Return a relation that changes every stroke."""
    return lambda drawn: (drawn[0], [change(each) for each in drawn[1]])


def late(samples: Floats, slop: float) -> Floats:
    """Return samples of a touch screen: the first move arrives late, the others at its pace."""
    away = np.hypot(*(samples[:, :2] - samples[0, :2]).T)
    kept = np.maximum.accumulate(away) > slop * float(np.hypot(*np.ptp(samples[:, :2], axis=0)))
    received = np.vstack((samples[:1], samples[kept]))
    received[:, 2] = np.arange(len(received)) / 60.0
    return received


def trembling(samples: Floats, size: float) -> Floats:
    noise = np.random.default_rng(7).normal(0.0, size, (len(samples), 2))
    return samples + np.column_stack((noise, np.zeros(len(samples))))


def rounded(samples: Floats) -> Floats:
    """Return samples of a mouse, in whole pixels of a page of 1,000 for 8 m."""
    return np.column_stack((np.round(samples[:, :2] / 0.008) * 0.008, samples[:, 2]))


def in_pixels(samples: Floats, count: int) -> Floats:
    """Return samples in whole pixels of a stroke so small that it has so many of them."""
    pixel = float(np.hypot(*np.ptp(samples[:, :2], axis=0))) / count
    return np.column_stack((np.round(samples[:, :2] / pixel) * pixel, samples[:, 2]))


def hooked(samples: Floats) -> Floats:
    """Return samples with a flick of 5 % of the size where the pen is set down and lifted."""
    size = float(np.hypot(*np.ptp(samples[:, :2], axis=0)))
    flick = np.linspace((-0.02 * size, 0.045 * size, 0.0), (0.0, 0.0, 0.0), 6, endpoint=False)
    return np.vstack((samples[0] + flick, samples, samples[-1] - flick[::-1]))


def resting(samples: Floats) -> Floats:
    """Return samples of a pen that rests at both ends."""
    return np.vstack((samples[:1].repeat(40, 0), samples, samples[-1:].repeat(40, 0)))


def slanted(samples: Floats, slant: float) -> Floats:
    return samples + slant * samples[:, 1:2] * (1.0, 0.0, 0.0)


def backwards(samples: Floats) -> Floats:
    return np.column_stack((samples[::-1, :2], samples[:, 2]))


def slowly(samples: Floats) -> Floats:
    return samples * (1.0, 1.0, 4.0)


def every(samples: Floats, step: int) -> Floats:
    return np.vstack((samples[::step], samples[-1:]))


RELATIONS: dict[str, Callable[[Drawn], Drawn]] = {
    **{
        f'{share} of the samples': each_stroke(partial(every, step=step))
        for share, step in (('half', 2), ('a third', 3))
    },
    **{f'slop of {slop:.0%}': each_stroke(partial(late, slop=slop)) for slop in (0.1, 0.2, 0.35)},
    'a sample less': each_stroke(lambda it: np.delete(it, len(it) // 2, axis=0)),
    'slower': each_stroke(slowly),
    'equal times': each_stroke(lambda it: it * (1.0, 1.0, 0.0)),
    'by pen': each_stroke(lambda it: trembling(it, 0.004)),
    'by mouse': each_stroke(rounded),
    'by finger': each_stroke(lambda it: late(rounded(trembling(it, 0.008)), 0.2)),
    'in 25 pixels': each_stroke(partial(in_pixels, count=25)),
    'hooked': each_stroke(hooked),
    'resting': each_stroke(resting),
    **{
        f'slanted by {slant:.0%}': each_stroke(partial(slanted, slant=slant))
        for slant in (0.2, -0.2)
    },
    'moved': lambda drawn: placed(drawn, lambda xy: np.add(xy, (37.0, -21.0))),
    'smaller': lambda drawn: placed(drawn, lambda xy: 0.5 * xy),
    'turned': lambda drawn: placed(drawn, lambda xy: rotated_each(xy, 0.6)),
    'larger': lambda drawn: placed(drawn, lambda xy: 3.0 * xy),
    'mirrored': lambda drawn: placed(drawn, lambda xy: xy * (-1.0, 1.0)),
    'upside down': lambda drawn: placed(drawn, lambda xy: xy * (1.0, -1.0)),
    'strokes in another order': lambda drawn: (drawn[0], drawn[1][::-1]),
}
# A stroke from its end: an arrow in one stroke points elsewhere then, but is one.
RELATIONS['reversed'] = each_stroke(backwards)


def readings(drawn: Drawn) -> str:
    """Return the meaning of the last stroke, and what it concerns; '' where it is refused."""
    meaning, _ = drawn_into_a_world(drawn, _PAUSE)
    return meaning


def drawn_into_a_world(drawn: Drawn, pause: float) -> tuple[str, Scene]:
    """
    Return the meaning of the last stroke, '' where it is refused, and the scene after it.

    :param pause: between strokes [s]
    """
    before, strokes = drawn
    simulation = Simulation(speed=0.0)
    for request in before:
        simulation.requests.submit(request, topic='')
    frame = simulation.advance_frame()
    frame = simulation.apply_requests() or frame
    session, now, meaning = DrawingSession(DrawingSettings()), 0.0, ''
    for samples in strokes:
        began, now = now + pause, now + pause + float(np.ptp(samples[:, 2]))
        try:
            reading = session.stroke(samples, '', frame.snapshot, began=began)
        except Refusal:
            meaning = ''
            continue
        submit_reading(simulation, session, reading)
        frame = simulation.apply_requests() or frame
        assert all(answer.code == '' for answer in frame.answers), frame.answers
        meaning = ' '.join((reading.meaning, *concerned(reading.requests)))
    return meaning, frame.snapshot.scene


def concerned(requests: Sequence[Request]) -> list[str]:
    """Return the names of bodies that requests delete, move or join, in order."""
    names: set[str] = set()
    over: list[str] = []
    for each in requests:
        if isinstance(each, Join):
            names |= {each.a, each.b}
            over += [f'over {name}' for name in each.properties.over or ()]
        elif isinstance(each, Command):
            names |= {*each.names}
        elif isinstance(each, Delete):
            names.add(each.name)
    return [*sorted(names), *over]


@pytest.mark.parametrize('relation', ['', *RELATIONS])
@pytest.mark.parametrize('thing', THINGS)
def test_a_reading_stays_the_same(thing: str, relation: str) -> None:
    before, ways, meaning = THINGS[thing]
    drawn: Drawn = before, [along(way) for way in ways]

    assert readings(RELATIONS[relation](drawn) if relation else drawn) == meaning


# Bodies that are clicked: two wheels, the first on a bar, and one above them that stays.
CLICKED = [
    spawning('a/0', Disc(radius=0.5)),
    spawning('a/1', Disc(radius=0.4), (2.5, 0.3, 0.0)),
    spawning('bar/0', Box(width=8.0, height=0.2), (3.5, -0.6, 0.0), anchored=True),
    spawning('wheel/0', Disc(radius=0.5), (1.2, 3.0, 0.0), anchored=True),
]
HERE, OTHER, ABOVE, ASIDE = (0.1, 0.2), (2.4, 0.3), (1.5, 0.9), [(5.0, 3.0), (6.0, 3.3)]
# Tools, and the clicks that each of them gets.
CLICKS = {
    'circle circle_diameter wall': ASIDE,
    'rectangle': [*ASIDE, (5.8, 4.1)],
    'polygon': [*ASIDE, (5.4, 4.1), ASIDE[0]],
    'anchor pin axle delete': [HERE],
    'release': [(0.6, -0.6)],
    'spring rod rope chain gear': [HERE, OTHER],
    'pulley': [HERE, (1.2, 3.1), OTHER, OTHER],
    'rack': [HERE, (0.6, -0.55)],
    'slider velocity gravity force': [HERE, ABOVE],
    'knife': [(1.5, 0.2), (3.5, 0.6)],
}


def clicked(drawn: Drawn, tool: Tool) -> Floats:
    """
    Return the places of bodies a twentieth of a second after clicks of a tool, (n, 2) float64.

    :param drawn: bodies; clicks; and an arrow that is the gravity
    """
    before, (clicks, arrow) = drawn
    world = World(settings=WorldSettings(gravity=tuple((arrow[1] - arrow[0]).tolist()[:2])))
    for request in before:
        world.apply(request)
    session = DrawingSession(DrawingSettings(), tool)
    for x, y, *_ in clicks.tolist():
        requests = session.click((x, y), '', world.snapshot()).requests
    assert requests
    for request in requests:
        world.apply(request)
    world.step(12)
    return world.snapshot().centers


@pytest.mark.parametrize('relation', ['moved', 'turned', 'mirrored', 'upside down'])
@pytest.mark.parametrize('tool', [tool for tool in Tool if tool != Tool.NONE])
def test_clicks_of_a_tool_do_the_same_elsewhere(tool: Tool, relation: str) -> None:
    def changed(bodies: Sequence[Spawn | Join], *places: Floats) -> Drawn:
        return RELATIONS[relation]((bodies, [np.pad(each, ((0, 0), (0, 1))) for each in places]))

    (points,) = (each for tools, each in CLICKS.items() if tool in tools.split())
    clicks, gravity = np.array(points), np.array([(0.0, 0.0), (3.0, -9.0)])
    here = clicked((CLICKED, [clicks, gravity]), tool)
    there = clicked(changed(CLICKED, clicks, gravity), tool)

    _, (expected,) = changed((), here)
    # Contacts of the halves of a cut body are solved in another order [m].
    assert there == pytest.approx(expected[:, :2], abs=1e-5)


@pytest.mark.parametrize('tool', [Tool.SPRING, Tool.ROD, Tool.ROPE, Tool.PULLEY])
def test_a_joint_to_the_background_is_clicked_from_either_end(tool: Tool) -> None:
    over = [(1.2, 3.1)] if tool == Tool.PULLEY else []
    way, gravity = [HERE, *over, (3.0, 4.0)], np.array([(0.0, 0.0), (3.0, -9.0)])
    # The end of a rope past wheels is clicked twice.
    ways = [np.array(each + each[-1:] * len(over)) for each in (way, way[::-1])]
    here, there = (clicked((CLICKED, [clicks, gravity]), tool) for clicks in ways)
    assert (here == there).all()


def at(x: float, y: float, way: Floats) -> Floats:
    return way + np.array((x, y))


X = np.array([(-0.4, 0.35), (0.4, -0.35), (0.36, 0.33), (-0.4, -0.32)])
BOARD = np.array([(-1.5, -0.2), (1.5, -0.19), (1.48, 0.2), (-1.5, 0.19), (-1.5, -0.19)])
BOB, UP = 0.4 * OVAL, [(0.0, 3.0), (0.1, 0.05)]
CAR = [
    BOARD * (1.4, 2.5), at(-1.3, -0.5, 0.6 * OVAL), at(1.3, -0.5, 0.6 * OVAL),
    at(-1.3, -0.5, 0.15 * OVAL), at(1.3, -0.5, 0.15 * OVAL),
]  # fmt: skip
# Strokes, and the world that they make in any order: bodies, anchored ones with an !, and joints.
IN_ANY_ORDER: dict[str, tuple[Sequence[Way | Floats], str]] = {
    'rod, bob': ([UP, BOB], 'Disc, rod Disc world'),
    'rod to the rim, bob': ([[UP[0], (0.05, 0.3)], BOB], 'Disc, rod Disc world'),
    'rod to beside the rim, bob': ([[UP[0], (0.05, 0.45)], BOB], 'Disc, rod Disc world'),
    'ramp onto the lid of a box': ([[(-2, 1), (0, 0.28)], BOARD], 'Box Chain!'),
    'rope, bob': ([SAG, at(4.5, 0.0, BOB)], 'Disc, rope Disc world'),
    'spring, mass': ([zigzag((0.0, 3.0), (0.0, 0.1)), BOARD], 'Box, spring Box world'),
    'rod between two': ([[(0, 0), (3, 0.1)], BOB, at(3, 0, BOARD)], 'Box Disc, rod Box Disc'),
    'swing': ([[(-1, 3), (-1, 0)], [(1, 3), (1, 0)], BOARD], 'Box, rod Box world, rod Box world'),
    'two pendulums in a row': (
        [UP, BOB, [(0.1, 0.0), (1.5, -1.5)], at(1.5, -1.5, BOB)],
        'Disc Disc, rod Disc Disc, rod Disc world',
    ),
    'wheel and axle': ([OVAL, 0.2 * OVAL], 'Disc, axle Disc world'),
    'seesaw': ([BOARD, 0.1 * OVAL], 'Box, axle Box world'),
    'hinge': ([BOARD, at(2.5, 0.0, BOARD), at(1.25, 0.0, 0.1 * OVAL)], 'Box Box, axle Box Box'),
    'weld': ([BOARD, at(2.5, 0.0, BOARD), square(1.25, 0.0, 0.1)], 'Box Box, pin Box Box'),
    'car': (CAR, 'Box Disc Disc, axle Box Disc, axle Box Disc'),
    'motor, axle and rod of a plate': (
        [round_arrow(0.0, 0.0, 1.0, 4.0), 0.12 * OVAL, [(3, 4), (1.8, 0.1)], BOARD * (1.4, 2.5)],
        'Box, axle Box world, motor Box world, rod Box world',
    ),
    'body and x': ([BOARD * (1.0, 4.0), X], 'Box!'),
    'body and x of two lines': ([BOARD * (1.0, 5.0), *CROSSED], 'Box!'),
    'ball and ramp': ([[(-2, 1.5), (2, 0)], at(-1.5, 1.68, 0.32 * OVAL)], 'Chain! Disc'),
    'ball and the end of its ramp': (
        [[(-2, 1.5), (2, 0)], at(-1.85, 1.75, 0.32 * OVAL)], 'Chain! Disc',
    ),
    'box and the end of its floor': ([[(-3, 0), (1, 0)], at(1.0, 0.17, BOARD)], 'Box Chain!'),
    'ball and post': ([[(0, -2), (0, -0.35)], BOB], 'Chain! Disc'),
    'board and two posts': (
        [[(-1, -2), (-1, -0.17)], [(1, -2), (1, -0.17)], BOARD], 'Box Chain! Chain!',
    ),
    'dominoes': (
        [[(-1, 0), (3, 0)], *(BOARD[:, ::-1] + (0.8 * n, 1.52) for n in range(3))],
        'Box Box Box Chain!',
    ),
    'walls that cross': ([[(-2, -1), (2, 1)], [(-2, 1), (2, -1)]], 'Chain! Chain!'),
}  # fmt: skip


def described(scene: Scene) -> str:
    """Return the shapes of bodies, anchored ones with an !, and joints with these, sorted."""
    names = {
        each.name: type(each.shape).__name__ + '!' * each.anchored for each in scene.bodies
    } | {WORLD: WORLD}
    joints = (
        f'{each.kind} {" ".join(sorted((names[each.a], names[each.b])))}' for each in scene.joints
    )
    return ', '.join((' '.join(sorted(names[each] for each in scene.names)), *sorted(joints)))


@pytest.mark.parametrize('pause', [0.4, 1.5])
@pytest.mark.parametrize('thing', IN_ANY_ORDER)
def test_strokes_in_any_order_make_the_same_world(thing: str, pause: float) -> None:
    ways, world = IN_ANY_ORDER[thing]
    orders = list(itertools.permutations(range(len(ways))))
    # Of more than six orders, six that begin with each stroke.
    for order in orders[:: -(-len(orders) // 6)]:
        drawn: Drawn = [], [along(ways[number]) for number in order]
        assert described(drawn_into_a_world(drawn, pause)[1]) == world, order
