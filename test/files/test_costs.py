# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file costs the world's thread what its length says, whatever it is full of; so do steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import gc
from itertools import pairwise
import json
import math
import time
from typing import Any

from physsim_ros import Robot, Simulation
from physsim_ros.files import load_mapping, state_from
from physsim_ros.model.actors import ACTORS
from physsim_ros.model.attraction import MOST_ATTRACTING
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots.drives import DRIVES
from physsim_ros.model.robots.sensors import SENSORS
from physsim_ros.model.robots.sensors.distance import MOST_BEAMS
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import SHAPES
import pytest

# Length of a file, a quarter of the greatest that a page may send, and of a part [characters].
WHOLE, PART = 2**18, 2**16
# CPU time of the whole by that of the part: 4 where work is proportional, 16 by the square.
MOST = 8.0
# Greatest CPU time for which a checkpoint or an undo stops the world's thread [s]; a busy machine
# may take twice as long.
LONGEST_PART = 0.25
# CPU time of the part below which the ratio says nothing [s].
LEAST = 0.02
Entries = Iterator[tuple[str, dict[str, Any]]]
TURNS = [math.tau * number / 1000 for number in range(1000)]
ROUND = [[round(0.2 * math.cos(turn), 5), round(0.2 * math.sin(turn), 5)] for turn in TURNS]
WAVE = [[round(0.06 * number, 2), round(math.sin(0.1 * number), 3)] for number in range(1000)]


def place(number: int) -> list[float]:
    """Return a place in rows of 100, half a metre apart [m]."""
    return [0.5 * (number % 100), 0.5 * (number // 100)]


def disc(number: int, **more: Any) -> dict[str, Any]:
    return {'name': f'b/{number}', 'circle': {'radius': 0.2}, 'at': place(number), **more}


def discs(number: int) -> Entries:
    yield 'bodies', disc(number)


def polygons(number: int) -> Entries:
    yield 'bodies', {'name': f'b/{number}', 'polygon': ROUND, 'at': place(number)}


def chains(number: int) -> Entries:
    chain = {'points': WAVE, 'thickness': 0.05}
    yield 'bodies', {'name': f'b/{number}', 'chain': chain, 'at': [0.0, 3.0 * number]}


def compounds(number: int) -> Entries:
    centers = [[round(0.2 * each, 1), 0.0] for each in range(100)]
    parts = {'box': {'width': 0.1, 'height': 0.1}, 'centers': centers}
    yield 'bodies', {'name': f'b/{number}', 'compound': parts, 'at': [0.0, 0.5 * number]}


def triangles(number: int) -> Entries:
    corners = [[0.2 * each + x, y] for each in range(333) for x, y in ((0, 0), (0.1, 0), (0, 0.1))]
    rounded = [[round(x, 1), y] for x, y in corners]
    yield 'bodies', {'name': f'b/{number}', 'triangles': rounded, 'at': [0.0, 0.5 * number]}


def boxes(number: int) -> Entries:
    """Yield a platform."""
    box = {'box': {'width': 0.4, 'height': 0.1}, 'one_way': [0, 1], 'anchored': True}
    yield 'bodies', {'name': f'b/{number}', **box, 'at': place(number)}


def notes(number: int) -> Entries:
    yield 'bodies', disc(number, label='a\n' * 20, sensor=True, anchored=True)


def forces(number: int) -> Entries:
    yield 'bodies', disc(number, forces=[{'force': [0, 1], 'at': [0.1, 0.0]}] * 16)


def belts(number: int) -> Entries:
    yield 'bodies', disc(number, belt=1.0, anchored=True)


def media(number: int) -> Entries:
    """Yield a region and a body in it."""
    more = {'anchored': True, 'sensor': True, 'medium': {'density': 2.0, 'gusts': 1.0}}
    yield 'bodies', disc(number, **(more if number % 2 else {}))


def attraction(number: int) -> Entries:
    yield 'bodies', disc(number, **({} if number < MOST_ATTRACTING else {'sensor': True}))


def sensors(number: int) -> Entries:
    """Yield a robot with a sensor of each kind, as long as the topics are few enough."""
    each = [{'kind': kind} for kind in SENSORS if kind != 'landmarks']
    seen = {'kind': 'landmarks', 'bodies': ['b/*']}
    robot = {'drive': {'kind': [*DRIVES][number % len(DRIVES)]}, 'sensors': [*each, seen]}
    yield 'bodies', disc(number, **({'robot': robot} if number < 50 else {}))


def robots(number: int) -> Entries:
    yield 'bodies', disc(number, **({'robot': 'turtlebot4'} if number < 200 else {}))


def arms(number: int) -> Entries:
    """Yield a robot of links, joints and motors, as long as the topics are few enough."""
    at = [3.0 * (number % 100), 3.0 * (number // 100)]
    yield 'bodies', {**disc(number, **({'robot': 'arm'} if number < 200 else {})), 'at': at}


def lasers(number: int) -> Entries:
    """Yield a robot of 64 scanners, as long as its topics are few enough."""
    scans = [{'kind': 'laser', 'name': f's{each}', 'beams': MOST_BEAMS} for each in range(64)]
    robot = {'drive': {'kind': 'omni'}, 'sensors': scans}
    yield 'bodies', disc(number, **({'robot': robot} if number < 50 else {}))


def paths(number: int) -> Entries:
    actor = {'kind': 'path', 'points': WAVE, 'speed': 1.0}
    yield 'bodies', disc(number, kinematic=True, actor=actor)


def people(number: int, kind: str = 'social_force') -> Entries:
    actor = {'kind': kind, 'points': [[1.0, 0.0], [5.0, 5.0]], 'repeat': 'loop'}
    # As far apart as in a street: of a dense crowd all see all, up to its size.
    x, y = place(number)
    yield 'bodies', disc(number, actor=actor, at=[6.0 * x, 6.0 * y])


def orca(number: int) -> Entries:
    yield from people(number, 'orca')


def rods(number: int) -> Entries:
    yield from discs(number)
    ends = {'a': f'b/{number}', 'b': f'b/{number - 1}' if number else 'world'}
    points = [place(number), place(max(number - 1, 0)) if number else [-1.0, 0.0]]
    yield 'joints', {'name': f'j/{number}', 'kind': 'rod', **ends, 'points': points}


def of_kind(kind: str, points: int, **more: Any) -> Callable[[int], Entries]:
    """Return what yields a disc with a joint of a kind to the one before."""

    def entries(number: int) -> Entries:
        for which, entry in rods(number):
            own = {'kind': kind, 'points': entry.get('points', [])[:points], **more}
            yield which, entry | (own if which == 'joints' else {})

    entries.__name__ = f'{kind}s'
    return entries


def driven_axles(number: int) -> Entries:
    """Yield a wheel on an axle by hand, with a motor."""
    yield from discs(number)
    motor = {'kind': 'axle', 'points': [place(number)], 'effort': 5.0, 'max_speed': 2.0}
    yield 'joints', {'name': f'j/{number}', **motor}


def pins(number: int) -> Entries:
    """Yield a joint by hand, whose body is found at its point."""
    yield from discs(number)
    yield 'joints', {'name': f'j/{number}', 'kind': 'pin', 'points': [place(number)]}


def pulleys(number: int) -> Entries:
    """Yield a rope by hand over 62 wheels, which are found at its points."""
    yield from discs(number)
    if number >= 64 and number % 4 == 0:
        points = [place(each) for each in range(number, number - 64, -1)]
        yield 'joints', {'name': f'j/{number}', 'kind': 'rope', 'points': points}


KINDS: list[Callable[[int], Entries]] = [
    discs,
    polygons,
    chains,
    compounds,
    triangles,
    boxes,
    notes,
    forces,
    belts,
    media,
    attraction,
    sensors,
    robots,
    arms,
    lasers,
    paths,
    people,
    orca,
    rods,
    of_kind('spring', 2),
    of_kind('slider', 2, rate=1.0),
    of_kind('rack', 2),
    of_kind('gear', 1, ratio=-2.0),
    of_kind('motor', 1, rate=1.0),
    driven_axles,
    pins,
    pulleys,
]


def text_of(entries: Callable[[int], Entries], length: int) -> str:
    """Return the text of a file of a length, full of entries."""
    lists: dict[str, list[str]] = {'bodies': [], 'joints': []}
    number = size = 0
    while size < length:
        for name, entry in entries(number):
            line = f'- {json.dumps(entry)}\n'
            lists[name].append(line)
            size += len(line)
        number += 1
    air = 'gravitation: 0.001\n' if entries is attraction else ''
    parts = (f'{name}:\n{"".join(lines)}' for name, lines in lists.items() if lines)
    return f'format: 1\ngravity: [0, 0]\nfloor_friction: 0.5\n{air}{"".join(parts)}'


def costs_of(entries: Callable[[int], Entries], length: int) -> dict[str, float]:
    """Return the CPU time of each thing that is done with a file of a length [s]."""
    costs: dict[str, float] = {}

    def note(what: str, act: Callable[[], Any]) -> Any:
        began = time.thread_time()
        found = act()
        costs[what] = time.thread_time() - began
        return found

    text, world = text_of(entries, length), Simulation()
    content = note('text', lambda: load_mapping(text, field='world'))
    state = note('bodies and joints', lambda: state_from(content, WorldSettings(), 240.0))
    note('world', lambda: world.begin(state))
    world.advance_frame()
    note('frame', world.advance_frame)
    costs |= costs_of_rebuilds(world, state)
    scanner = next((body.name for body in world.world.scene.bodies if body.robot), None)
    if entries is lasers and scanner is not None:
        # Those of one robot: a node reads them at their own rates.
        robot = Robot(world, scanner)
        note('readings', lambda: [robot.scan(f's{each}') for each in range(64)])
    return costs


def costs_of_rebuilds(world: Simulation, state: WorldState) -> dict[str, float]:
    """Return the CPU time of a checkpoint, and of the longest part of it and of an undo [s]."""
    cursor = world.past.cursor

    def parts_of(work: Iterator[object]) -> list[float]:
        times = [time.thread_time()]
        times += (time.thread_time() for _ in work)
        return [end - begin for begin, end in pairwise([*times, time.thread_time()])]

    checkpoint = parts_of(cursor.slices_of_keyframe())
    world.open_world(state)
    world.past.undo()
    # Steps have parts of their own, at most 50 ms each.
    undo = parts_of(iter(cursor.continue_work, False))
    return {'checkpoint': sum(checkpoint), 'longest part': max(*checkpoint, *undo)}


def least_costs(entries: Callable[[int], Entries], length: int) -> dict[str, float]:
    """Return the lesser of two measurements [s]: other programs make one longer, never shorter."""
    first, second = costs_of(entries, length), costs_of(entries, length)
    return {what: min(took, second[what]) for what, took in first.items()}


@pytest.fixture
def collected() -> Iterator[None]:
    """Have no garbage of other tests collected while a cost is measured."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def words_of(value: Any) -> Iterator[str]:
    """Yield the keys and texts of a value of JSON."""
    match value:
        case str():
            yield value
        case dict():
            for key, each in value.items():
                yield key
                yield from words_of(each)
        case list():
            for each in value:
                yield from words_of(each)


def test_each_kind_of_thing_is_in_a_file() -> None:
    entries = (entry for kind in KINDS for number in (0, 1, 2, 64) for _, entry in kind(number))
    used = {word for entry in entries for word in words_of(entry)}
    known = {*SHAPES, *ACTORS, *DRIVES, *SENSORS, *map(str, JointKind)}
    assert known <= used


@pytest.mark.slow
@pytest.mark.usefixtures('collected')
@pytest.mark.parametrize('entries', KINDS, ids=lambda entries: entries.__name__)
def test_a_file_four_times_as_long_takes_some_four_times_as_long(
    entries: Callable[[int], Entries],
) -> None:
    part, whole = (least_costs(entries, length) for length in (PART, WHOLE))
    row = ', '.join(f'{what} {1e3 * took:.0f} ms' for what, took in whole.items())
    print(f'{entries.__name__}: {row}')  # noqa: T201 - the table
    assert whole['longest part'] < LONGEST_PART
    for what, took in whole.items():
        assert took < MOST * max(part[what], LEAST), what
