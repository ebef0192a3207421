# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Things that people draw in several strokes: an x or an arrow of two, a square of four lines.

Lines that should meet miss one another by 2 to 8 % of the thing, and shafts of arrows end short of
their heads.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Chain, Disc
from physsim_ros.model.snapshot import Snapshot

from . import arrows, figures, strangers
from .outlines import Floats, Random


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Thing:
    """
    A thing of several strokes.

    :param paths: of the pen, (n, 2) float64 each [m]
    :param under: the bodies that it is drawn over
    :param right: tells whether the world is as it should be
    :param kind: of all paths together, as that of a figure; '' where they are no sign
    :param tail: of an arrow, (2,) float64 [m]
    """

    paths: Sequence[Floats]
    under: Sequence[Spawn] = ()
    right: Callable[[Snapshot], bool]
    kind: str = ''
    tail: Floats | None = None


def line(*points: tuple[float, float] | Floats) -> Floats:
    return np.array(points, dtype=np.float64)


def placed_at_random(rng: Random, *paths: Floats, turn: float = 7.0) -> list[Floats]:
    """Return paths turned and sized together, about the origin."""
    angle, size = rng.uniform(0.0, turn), rng.uniform(0.6, 3.0)
    cos, sin = size * math.cos(angle), size * math.sin(angle)
    return [path @ np.array(((cos, sin), (-sin, cos))) for path in paths]


def _x(rng: Random) -> list[Floats]:
    """Return two lines that cross, their arms of unequal length, in any order."""
    half = rng.uniform(0.7, 1.3) * math.pi / 4
    ends = rng.uniform(0.3, 0.6, 4)
    angles = np.array((half, half + math.pi, -half, math.pi - half)) + rng.normal(0.0, 0.08, 4)
    points = np.column_stack((ends * np.cos(angles), ends * np.sin(angles)))
    lines = [points[:2], points[2:]]
    return lines if rng.random() < 0.5 else lines[::-1]


def _body_under(paths: Sequence[Floats], rng: Random) -> Spawn:
    """Return a box under all of some paths, 1.2 to 3 times as large."""
    x, y = rng.uniform(1.2, 3.0) * np.ptp(np.vstack(paths), axis=0) * rng.uniform(1.0, 1.3, 2)
    middle = np.vstack(paths)
    at = (middle.min(axis=0) + middle.max(axis=0)) / 2
    return Spawn(name='a/0', shape=Box(width=float(x), height=float(y)), pose=(*at.tolist(), 0.0))


def _anchoring(turn: float) -> Callable[[Random, str], Thing]:
    def thing(rng: Random, _half: str) -> Thing:
        lines = (figures.turned_about_origin(path, turn) for path in _x(rng))
        paths = placed_at_random(rng, *lines, turn=0.2)
        body = _body_under(paths, rng)

        def right(snapshot: Snapshot) -> bool:
            (found, *others) = snapshot.scene.bodies
            mass = body.shape.form.area * snapshot.scene.settings.density
            same = math.isclose(found.total_mass, mass, rel_tol=1e-6)
            return found.anchored and same and not others and not snapshot.scene.joints

        return Thing(paths=paths, under=(body,), right=right, kind='x')

    return thing


def _shaft_and_head(rng: Random, half: str) -> list[Floats]:
    return (strangers if half == 'strangers' else arrows).shaft_and_head(rng)


def _closed_head(rng: Random, head: Floats) -> list[Floats]:
    """Return a head with a side between its barbs, begun at any of its corners."""
    first = int(rng.integers(3))
    corners = np.roll(head, first, axis=0)
    return [np.vstack((corners, corners[0] + rng.normal(0.0, 0.02, 2)))]


def _filled_head(rng: Random, head: Floats) -> list[Floats]:
    """Return a head that is filled to and fro, after its outline or without it."""
    one, tip, other = head
    share = np.linspace(1.0, 0.1, int(rng.integers(5, 9)))[:, None]
    sides = np.where(np.arange(len(share))[:, None] % 2, one - tip, other - tip)
    filling = tip + share * sides
    outline = _closed_head(rng, head)[0]
    return [np.vstack((outline, filling)) if rng.random() < 0.5 else filling]


def _head_of_two(rng: Random, head: Floats) -> list[Floats]:
    """Return a head of two barbs, or of both barbs and the side between them."""
    one, tip, other = head
    if rng.random() < 0.3:
        return [head, line(one, other) + rng.normal(0.0, 0.02, (2, 2))]
    barbs = [line(tip, end) + rng.normal(0.0, 0.015, (2, 2)) for end in (one, other)]
    return [barb[::-1] if rng.random() < 0.3 else barb for barb in barbs]


def _other_arrow(head_of: Callable[[Random, Floats], list[Floats]]) -> Callable[..., Thing]:
    """Return a function that draws an arrow; its head is none of two barbs in one stroke."""

    def thing(rng: Random, half: str) -> Thing:
        shaft, head = _shaft_and_head(rng, half)
        return _gravity_arrow(rng, half, [shaft, *head_of(rng, head)])

    return thing


def _gravity_arrow(rng: Random, half: str, parts: list[Floats] | None = None) -> Thing:
    parts = _shaft_and_head(rng, half) if parts is None else parts
    paths = placed_at_random(rng, *parts)
    shaft = paths[0][-1] - paths[0][0]

    def right(snapshot: Snapshot) -> bool:
        x, y = snapshot.scene.settings.gravity
        along = (x * shaft[0] + y * shaft[1]) / float(np.hypot(*shaft)) / math.hypot(x, y)
        return along > math.cos(0.4) and not snapshot.scene.bodies

    if shaft[1] < -0.7 * float(np.hypot(*shaft)):
        # Gravity is downwards already.
        return _gravity_arrow(rng, half, parts)
    ordered = paths if rng.random() < 0.7 else [*paths[1:], paths[0]]
    return Thing(paths=ordered, right=right, kind='arrow', tail=paths[0][0])


def _velocity_arrow(rng: Random, half: str) -> Thing:
    paths = placed_at_random(rng, *_shaft_and_head(rng, half))
    tail, tip = paths[0][[0, -1]]
    radius = float(np.hypot(*(tip - tail))) * rng.uniform(0.2, 0.5)
    body = Spawn(name='a/0', shape=Disc(radius=radius), pose=(*tail.tolist(), 0.0))

    def right(snapshot: Snapshot) -> bool:
        x, y, _ = snapshot.twists[0].tolist()
        off = float(np.hypot(*(np.array((x, y)) - (tip - tail))))
        alone = len(snapshot.scene.bodies) == 1 and not snapshot.scene.joints
        return alone and off < 0.3 * float(np.hypot(*(tip - tail)))

    return Thing(paths=paths, under=(body,), right=right, kind='arrow', tail=tail)


def _four_lines(rng: Random, _half: str) -> Thing:
    high = rng.uniform(0.4, 1.0)
    corners = line((0, 0), (1, 0), (1, high), (0, high))
    sides = [corners[[side, (side + 1) % 4]] for side in range(4)]
    off = rng.uniform(0.02, 0.08)
    sides = [side + off * rng.uniform(-0.7, 0.7, (2, 2)) for side in sides]
    order = rng.permutation(4) if rng.random() < 0.5 else np.arange(4)
    paths = placed_at_random(rng, *(sides[each] for each in order.tolist()), turn=0.1)
    return Thing(paths=paths, right=lambda snapshot: _shapes(snapshot) == {Box: 1})


def _crossing_walls(rng: Random, _half: str) -> Thing:
    return Thing(
        paths=placed_at_random(rng, *_x(rng)),
        right=lambda snapshot: _shapes(snapshot) == {Chain: 2},
        kind='x',
    )


def _meeting_walls(rng: Random, _half: str) -> Thing:
    """Return a T or an L of two walls, or two beside each other."""
    at, length = rng.uniform(0.0, 1.0), rng.uniform(0.5, 1.0)
    angle = rng.uniform(1.1, 2.0)
    foot = line((at, 0.02), (at + length * math.cos(angle), length * math.sin(angle)))
    paths = placed_at_random(rng, line((0, 0), (1, 0)), foot)
    return Thing(paths=paths, right=lambda snapshot: _shapes(snapshot) == {Chain: 2})


def _marked_circle(rng: Random, _half: str) -> Thing:
    angle = np.linspace(0.0, 2.0 * math.pi, 60)
    circle = 0.5 * np.column_stack((np.cos(angle), np.sin(angle)))
    circle[-1] = circle[0]
    reach = rng.uniform(0.45, 1.2, 2)
    high = rng.uniform(-0.15, 0.15)
    mark = line((-reach[0], high), (reach[1], high))
    paths = placed_at_random(rng, circle, mark)
    return Thing(paths=paths, right=lambda snapshot: _shapes(snapshot) == {Disc: 1})


def _line_with_bob(rng: Random, half: str) -> Thing:
    """Return a line and a body at its end, which are no arrow: a pendulum."""
    shaft, _ = _shaft_and_head(rng, half)
    size = rng.uniform(0.15, 0.5)
    bob = (figures.disc, figures.rectangle, figures.polygon)[rng.integers(3)](rng)
    outline = bob.path / np.hypot(*np.ptp(bob.path, axis=0)) * size
    outline = np.add(np.vstack((outline, outline[:1])), (0.5 + 0.3 * size, 0.0))
    paths = placed_at_random(rng, shaft, outline)
    return Thing(
        paths=paths if rng.random() < 0.5 else paths[::-1],
        right=lambda snapshot: snapshot.scene.settings.gravity == (0.0, -9.81),
    )


def _shapes(snapshot: Snapshot) -> dict[type, int]:
    """Return the number of bodies of each shape; joints count as such."""
    found = Counter(type(body.shape) for body in snapshot.scene.bodies)
    found.update(type(joint) for joint in snapshot.scene.joints)
    return dict(found)


THINGS: dict[str, Callable[[Random, str], Thing]] = {
    'x of two lines, on a body': _anchoring(0.0),
    '+ of two lines, on a body': _anchoring(math.pi / 4),
    'arrow of shaft and head': _gravity_arrow,
    'the same, tail on a body': _velocity_arrow,
    'rectangle of four lines': _four_lines,
    'two walls that cross': _crossing_walls,
    'two walls that meet': _meeting_walls,
    'circle with a line through it': _marked_circle,
    # Behind the others, whose random numbers depend on their places.
    'arrow with a closed head': _other_arrow(_closed_head),
    'arrow with a filled head': _other_arrow(_filled_head),
    'arrow in three strokes': _other_arrow(_head_of_two),
    'line with a bob at its end': _line_with_bob,
}
