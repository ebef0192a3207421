# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""World files that are full of one kind of thing, as long as wanted."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
import json
import math
from typing import Any

from physsim_ros.model.attraction import MOST_ATTRACTING
from physsim_ros.model.robots.drives import DRIVES
from physsim_ros.model.robots.sensors import SENSORS
from physsim_ros.model.robots.sensors.distance import MOST_BEAMS

# Lists of a world file, and entries in them.
Entries = Iterator[tuple[str, dict[str, Any]]]
# Yields the entries of a number, from 0.
KindOfFile = Callable[[int], Entries]
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


def pile(number: int) -> Entries:
    """Yield a disc that touches those around it."""
    x, y = place(number)
    yield 'bodies', disc(number, at=[round(0.7999 * x, 4), round(0.7999 * y, 4)])


def expiring(number: int) -> Entries:
    """Yield a disc that is removed at the same step as all others."""
    yield 'bodies', disc(number, lifetime=1.0)


def mix(number: int) -> Entries:
    """Yield one kind of thing after the other, as long as the topics are few enough."""
    kinds = [belts, media, people, forces, boxes, notes, driven_axles, robots, paths]
    yield from kinds[number % len(kinds)](number)


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


def of_kind(kind: str, points: int, **more: Any) -> KindOfFile:
    """Return a kind of file: each disc has a joint of a kind to the one before."""

    def entries(number: int) -> Entries:
        for which, entry in rods(number):
            own = {'kind': kind, 'points': entry.get('points', [])[:points], **more}
            yield which, entry | (own if which == 'joints' else {})

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


# By what the file is full of.
KINDS: Mapping[str, KindOfFile] = {
    'discs': discs,
    'discs that touch, under gravity': pile,
    'discs that expire at once': expiring,
    'belts, media, people, platforms, motors, robots': mix,
    'polygons of 1,000 corners': polygons,
    'chains of 1,000 points': chains,
    'compounds of 100 boxes': compounds,
    'solids of 333 triangles': triangles,
    'one-way boxes': boxes,
    'notes': notes,
    'bodies with 16 forces': forces,
    'belts': belts,
    'media, and bodies in them': media,
    '500 bodies that attract each other, and sensors': attraction,
    '50 robots with a sensor of each kind, and discs': sensors,
    '200 TurtleBots, and discs': robots,
    '200 arms of two links and motors, and discs': arms,
    '50 robots of 64 lasers of 10,000 beams, and discs': lasers,
    'paths of 1,000 points': paths,
    'pedestrians': people,
    'pedestrians by ORCA': orca,
    'rods': rods,
    'springs': of_kind('spring', 2),
    'driven sliders': of_kind('slider', 2, rate=1.0),
    'racks and pinions': of_kind('rack', 2),
    'gears': of_kind('gear', 1, ratio=-2.0),
    'motors': of_kind('motor', 1, rate=1.0),
    'axles with motors': driven_axles,
    'pins without names of bodies': pins,
    'ropes over 62 pulleys, without names of bodies': pulleys,
}

# Settings of a world that is full of a kind, beside or in place of those of all.
SETTINGS: Mapping[KindOfFile, Mapping[str, Any]] = {
    attraction: {'gravitation': 0.001},
    pile: {'gravity': [0, -9.81], 'floor_friction': 0, 'bounds': [-0.25, -0.25, 39.85, 200]},
}


def text_of(entries: KindOfFile, length: int) -> str:
    """
    Return the text of a file that is full of entries.

    :param length: of it, at least [characters]
    """
    lists: dict[str, list[str]] = {'bodies': [], 'joints': []}
    number = size = 0
    while size < length:
        for name, entry in entries(number):
            line = f'- {json.dumps(entry)}\n'
            lists[name].append(line)
            size += len(line)
        number += 1
    settings = {'gravity': [0, 0], 'floor_friction': 0.5} | SETTINGS.get(entries, {})
    head = ''.join(f'{name}: {json.dumps(value)}\n' for name, value in settings.items())
    parts = (f'{name}:\n{"".join(lines)}' for name, lines in lists.items() if lines)
    return f'format: 1\n{head}{"".join(parts)}'
