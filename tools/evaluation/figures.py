# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Figures as people mean them: paths of a pen before a hand has drawn them.

Each is about one metre across, about the origin; the hand moves, turns and sizes it.
"""

from __future__ import annotations

from dataclasses import dataclass
import itertools
import math

import numpy as np

from .outlines import Floats, nudged, POLYGONS, Random


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """
    A path of the pen.

    :param kind: what it is
    :param path: (n, 2) float64: from pen-down to pen-up, straight between the points; not closed
    :param closed: whether the pen goes back to where it began
    :param corners: how many it has, of which a reader should find every one; -1 where there are
        none to count
    :param thin: its width by its length, as far as that makes a hand careful
    :param smooth: whether its points only stand for a curve
    :param tail: the index of the tail of an arrow: 0 or -1
    """

    kind: str
    path: Floats
    closed: bool = False
    corners: int = -1
    thin: float = 1.0
    smooth: bool = False
    tail: int = 0


def disc(rng: Random) -> Figure:
    """Return a circle as people draw it: rarely as high as it is wide, often egg-shaped."""
    angle = np.linspace(0.0, 2.0 * math.pi, 120, endpoint=False)
    flat = 1.0 - abs(rng.normal(0.0, 0.1))
    egg = rng.normal(0.0, 0.035) * np.cos(2 * angle + rng.uniform(0, 7))
    lump = rng.normal(0.0, 0.015) * np.cos(3 * angle + rng.uniform(0, 7))
    radius = 0.5 * (1.0 + egg + lump)
    path = np.column_stack((radius * np.cos(angle), max(flat, 0.72) * radius * np.sin(angle)))
    return Figure(kind='disc', path=turned(path, rng.uniform(0, 7)), closed=True, smooth=True)


def rectangle(rng: Random) -> Figure:
    """
    Return a rectangle, its corners not quite where they should be.

    Sides lean by up to 8 degrees: it is a parallelogram and a trapezoid.
    """
    width = 1.0
    height = math.exp(rng.uniform(math.log(0.045), 0.0))
    path = np.array([(0, 0), (width, 0), (width, height), (0, height)], dtype=np.float64)
    lean, taper = np.tan(np.clip(rng.normal(0.0, 0.05, 2), -0.14, 0.14)).tolist()
    taper = min(max(taper, -0.25 * height), 0.25 * height)
    path[2:, 0] += lean * height
    path[2:, 1] += np.array((taper, -taper)) / 2
    path += rng.uniform(-0.03, 0.03, path.shape) * min(width, 2.0 * height)
    turn = rng.choice([rng.normal(0.0, 0.04), rng.uniform(0.0, 7.0)])
    if rng.random() < 0.5:
        path = path[:, ::-1]
    return Figure(kind='rectangle', path=turned(path, turn), closed=True, corners=4, thin=height)


def polygon(rng: Random) -> Figure:
    """Return one of the polygons that people draw."""
    path = POLYGONS[rng.integers(len(POLYGONS))](rng)
    path = path * (1.0, rng.uniform(0.75, 1.3)) if rng.random() < 0.5 else path
    path = turned(path, rng.uniform(0, 7))
    return Figure(kind='polygon', path=path, closed=True, corners=len(path))


def ramp(rng: Random) -> Figure:
    """Return a thin right triangle, as cars and balls go up and down."""
    height = rng.uniform(0.12, 0.4)
    path = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, height)])
    path = turned(path, rng.choice([rng.normal(0.0, 0.04), rng.uniform(0.0, 7.0)]))
    return Figure(kind='polygon', path=path, closed=True, corners=3, thin=height)


def line(rng: Random) -> Figure:
    """Return a straight line."""
    path = np.array([(-0.5, 0.0), (0.5, 0.0)])
    return Figure(kind='line', path=turned(path, rng.uniform(0, 7)), corners=2)


def bent_line(rng: Random) -> Figure:
    """Return a line with one to three bends, as of a wall, a step or a bowl."""
    count = int(rng.integers(1, 4))
    heading, here = 0.0, np.zeros(2)
    path = [here]
    sign = rng.choice([-1.0, 1.0])
    for number in range(count + 1):
        here = here + rng.uniform(0.5, 1.0) * np.array([math.cos(heading), math.sin(heading)])
        path.append(here)
        # A bowl goes on turning, stairs turn back; a whole turn would close it.
        sign = -sign if number % 2 or rng.random() < 0.3 else sign
        heading += sign * rng.uniform(0.6, 1.75)
    points = np.array(path)
    points /= np.ptp(points, axis=0).max()
    if _meets_itself(points) or math.dist(points[0], points[-1]) < 0.45:
        return bent_line(rng)
    return Figure(kind='line', path=turned(points, rng.uniform(0, 7)), corners=len(points))


def curve(rng: Random) -> Figure:
    """Return an open curve, as of a hill, a valley or a wave."""
    x = np.linspace(-0.5, 0.5, 100)
    if rng.random() < 0.5:
        bow = rng.uniform(0.12, 0.45)
        y = bow * np.cos(math.pi * x)
    else:
        y = rng.uniform(0.06, 0.16) * np.sin(2 * math.pi * (x * rng.uniform(1.0, 1.6)))
    path = np.column_stack((x, y))
    return Figure(kind='line', path=turned(path, rng.uniform(0, 7)), smooth=True)


def sag(rng: Random) -> Figure:
    """Return a line that sags, by 0.15 to 0.6 of the distance of its ends, one end higher."""
    share = np.linspace(0.0, 1.0, 60)
    depth, skew = rng.uniform(0.15, 0.6), rng.uniform(-0.2, 0.2)
    y = rng.normal(0.0, 0.2) * share - 4.0 * depth * share * (1.0 - share) * (1.0 + skew * share)
    return Figure(kind='line', path=turned(np.column_stack((share, y)), 0.0), smooth=True)


def zigzag(rng: Random) -> Figure:
    """Return a spring: teeth, sharp or round, with or without straight ends."""
    return _teeth(rng, int(rng.integers(6, 13)))


def short_zigzag(rng: Random) -> Figure:
    """Return a spring of five to eight swings: three or four teeth."""
    return _teeth(rng, int(rng.integers(5, 9)))


def _teeth(rng: Random, teeth: int) -> Figure:
    high = rng.uniform(0.07, 0.2)
    if rng.random() < 0.3:
        x = np.linspace(-0.5, 0.5, 30 * teeth)
        path = np.column_stack((x, high * np.sin(math.pi * teeth * (x + 0.5))))
        return Figure(kind='zigzag', path=turned(path, rng.uniform(0, 7)), smooth=True)
    lead = rng.choice([0.0, rng.uniform(0.05, 0.2)])
    x = np.linspace(-0.5 + lead, 0.5 - lead, teeth + 1)
    x[1:-1] += rng.uniform(-0.2, 0.2, teeth - 1) * (1.0 - 2.0 * lead) / teeth
    sign = np.where(np.arange(teeth + 1) % 2, 1.0, -1.0)
    y = high * sign * rng.uniform(0.75, 1.25, teeth + 1)
    if lead or rng.random() < 0.5:
        y[[0, -1]] = 0.0
    path = np.column_stack((x, y))
    if lead:
        path = np.vstack(((-0.5, 0.0), path, (0.5, 0.0)))
    return Figure(kind='zigzag', path=turned(path, rng.uniform(0, 7)))


def coil(rng: Random) -> Figure:
    """Return a spring drawn as loops."""
    loops = rng.integers(4, 9)
    angle = np.linspace(0.0, 2.0 * math.pi * loops, 40 * int(loops))
    radius = rng.uniform(0.06, 0.13)
    x = angle / angle[-1] - 0.5 - rng.uniform(0.7, 1.0) * radius * np.sin(angle)
    path = np.column_stack((x, radius * np.cos(angle) * rng.choice([-1.0, 1.0])))
    return Figure(kind='zigzag', path=turned(path, rng.uniform(0, 7)), smooth=True)


def cross(rng: Random) -> Figure:
    """Return an x in one stroke: a diagonal, along a side, the other diagonal."""
    high = rng.uniform(0.7, 1.35)
    path = np.array([(-0.5, high / 2), (0.5, -high / 2), (0.5, high / 2), (-0.5, -high / 2)])
    path += rng.uniform(-0.09, 0.09, path.shape)
    if rng.random() < 0.3:
        # Arms of unequal lengths.
        path *= rng.uniform(0.6, 1.4, (4, 1))
    if rng.random() < 0.15:
        # From the end of a diagonal back to the crossing, and along both arms of the other one.
        path = np.insert(path, 2, rng.normal(0.0, 0.03, 2), axis=0)
    if rng.random() < 0.4:
        path = _rounded(path, rng.uniform(0.03, 0.09))
    return _any_direction(path, rng)


def short_cross(rng: Random) -> Figure:
    """Return an x whose second line ends soon after it crosses the first, or begins late."""
    path = np.array([(-0.5, 0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, -0.5)])
    path = path * (1.0, rng.uniform(0.7, 1.35)) + rng.uniform(-0.07, 0.07, path.shape)
    short = rng.uniform(0.06, 0.25)
    path[3] = short * path[3] / float(np.hypot(*path[3]))
    if rng.random() < 0.4:
        path = _rounded(path, rng.uniform(0.02, 0.06))
    return _any_direction(path, rng)


def _any_direction(path: Floats, rng: Random) -> Figure:
    """Return an x that is begun at any of its ends."""
    path = path * (rng.choice([-1.0, 1.0]), rng.choice([-1.0, 1.0]))
    if rng.random() < 0.3:
        path = path[:, ::-1]
    return Figure(kind='x', path=turned(path, rng.normal(0.0, 0.15)))


def oval(rng: Random) -> Figure:
    """Return an oval, too long for a circle."""
    angle = np.linspace(0.0, 2.0 * math.pi, 120, endpoint=False)
    radius = 0.5 * (1.0 + rng.normal(0.0, 0.02) * np.cos(3 * angle + rng.uniform(0, 7)))
    flat = rng.uniform(0.25, 0.58)
    path = turned(np.column_stack((np.cos(angle), flat * np.sin(angle))), rng.uniform(0, 7))
    path *= radius[:, None]
    return Figure(kind='polygon', path=path, closed=True, thin=flat, smooth=True)


def pentagram(rng: Random) -> Figure:
    """Return a star of five points in one stroke of five lines."""
    angle = math.pi / 2 + 4.0 * math.pi / 5 * np.arange(6) + rng.normal(0.0, 0.06, 6)
    radius = 0.5 * rng.uniform(0.82, 1.18, 6)
    path = np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))
    path[-1] = path[0] + rng.normal(0.0, 0.05, 2)
    path = path * (1.0, rng.uniform(0.8, 1.2))
    return Figure(kind='polygon', path=turned(path, rng.uniform(0, 7)))


def check(rng: Random) -> Figure:
    """Return a check, a caret or a V; the arms of a check are bowed."""
    opening = rng.uniform(0.5, 1.7)
    short = rng.choice([1.0, rng.uniform(0.25, 0.7)])
    spread = 0.11 if short < 1.0 else 0.04
    first, second = (_bowed_arm(rng.normal(0.0, spread)) for _ in range(2))
    first = short * turned_about_origin(first[::-1], opening)
    path = np.vstack((first[:-1], second)) * (1.0, rng.choice([-1.0, 1.0]))
    return Figure(kind='line', path=turned(path, rng.uniform(0, 7)), corners=3)


def _bowed_arm(bow: float) -> Floats:
    """Return an arc from (0, 0) to (1, 0), as high as a share of its length."""
    arm = np.linspace(0.0, 1.0, 20)
    return np.column_stack((arm, 4.0 * min(max(bow, -0.2), 0.2) * arm * (1.0 - arm)))


def bracket(rng: Random) -> Figure:
    """Return a square bracket."""
    arms = rng.uniform(0.25, 0.6, 2)
    path = np.array([(arms[0], 1.0), (0.0, 1.0), (0.0, 0.0), (arms[1], 0.0)])
    path += rng.uniform(-0.04, 0.04, path.shape)
    return Figure(kind='line', path=turned(path, rng.normal(0.0, 0.3)), corners=4)


def brace(rng: Random) -> Figure:
    """Return a brace, round or with a sharp tip."""
    wide, nose = rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.3)
    y = np.array([0.5, 0.47, 0.4, 0.3, 0.15, 0.06, 0.0])
    x = np.array([wide, 0.4 * wide, 0.05 * wide, 0.0, 0.0, -0.4 * nose, -nose])
    if rng.random() < 0.3:
        # The tip is drawn to and fro, along two lines or a narrow loop.
        x[-2:], y[-2] = (-0.6 * nose, -2.0 * nose), rng.uniform(-0.03, 0.02)
    upper = np.column_stack((x, y))
    path = np.vstack((upper, upper[:-1][::-1] * (1.0, -1.0)))
    path = _rounded(path, 0.05) if rng.random() < 0.5 else path
    # Both halves lean back from the tip, or forth.
    path[:, 0] += rng.normal(0.0, 0.25) * np.abs(path[:, 1])
    path = path * (rng.choice([-1.0, 1.0]), rng.uniform(0.7, 1.4))
    return Figure(kind='line', path=turned(path, rng.normal(0.0, 0.3)), smooth=True)


def question_mark(rng: Random) -> Figure:
    """Return a question mark without its point: a hook, open by 17 % and more."""
    angle = np.linspace(math.radians(rng.uniform(150, 190)), math.radians(-70), 40)
    hook = 0.28 * np.column_stack((np.cos(angle), np.sin(angle))) + (0.0, 0.25)
    stem = np.array([(0.0, -0.1), (0.0, -0.25 - rng.uniform(0.0, 0.2))])
    path = np.vstack((hook, stem))
    return Figure(kind='line', path=turned(path, rng.normal(0.0, 0.2)), smooth=True)


def five_swings(rng: Random) -> Figure:
    """Return five lines to and fro, one too few for a scribble."""
    x = rng.uniform(0.4, 1.0) * np.linspace(-0.5, 0.5, 6) + rng.normal(0.0, 0.02, 6)
    y = 0.5 * np.where(np.arange(6) % 2, 1.0, -1.0) * rng.uniform(0.8, 1.0, 6)
    path = np.column_stack((x, rng.uniform(0.8, 1.3) * y))
    return Figure(kind='', path=turned(path, rng.uniform(0, 7)))


def trembling_line(rng: Random) -> Figure:
    """Return a line, straight or bowed, by a hand that trembles."""
    x = np.linspace(-0.5, 0.5, 200)
    bow = rng.choice([0.0, rng.uniform(0.1, 0.5)])
    y = 2.0 * bow * (0.25 - x * x)
    waves, phase = rng.uniform(3.0, 12.0), rng.uniform(0, 7)
    y += rng.uniform(0.005, 0.024) * np.sin(2 * math.pi * waves * x + phase)
    return Figure(
        kind='line', path=turned(np.column_stack((x, y)), rng.uniform(0, 7)), smooth=True
    )


def letter(rng: Random) -> Figure:
    """Return a letter or digit of straight lines, drawn without lifting the pen."""
    letters = (
        [(0, 0), (0, 1), (0.7, 0), (0.7, 1)],
        [(0, 1), (0.7, 1), (0, 0), (0.7, 0)],
        [(0, 0), (0.15, 1), (0.5, 0.3), (0.85, 1), (1, 0)],
        [(0, 1), (0.25, 0), (0.5, 0.7), (0.75, 0), (1, 1)],
        [(0.6, 1), (0, 0.35), (0.7, 0.35)],
        [(0, 1), (0.7, 1), (0.2, 0)],
        [(0, 0.8), (0.3, 1), (0.3, 0)],
    )
    path = nudged(rng, list(letters[rng.integers(len(letters))]))
    path = (path + rng.normal(0.0, 0.03, path.shape)) * (rng.uniform(0.6, 1.4), 1.0)
    return Figure(kind='line', path=turned(path, rng.normal(0.0, 0.15)), corners=len(path))


def pigtail(rng: Random) -> Figure:
    """Return a pigtail: a line with one loop in its middle."""
    share = np.linspace(0.0, 1.0, 100)
    angle = 2.0 * math.pi * np.clip((share - 0.3) / 0.4, 0.0, 1.0)
    radius = rng.uniform(0.12, 0.3)
    along = np.where(share < 0.5, np.minimum(share, 0.3), np.maximum(share, 0.7) - 0.4) - 0.3
    x = along / 0.3 * rng.uniform(0.4, 0.7) + radius * np.sin(angle)
    path = np.column_stack((x, radius * (1.0 - np.cos(angle)) * rng.choice([-1.0, 1.0])))
    return Figure(kind='', path=turned(path, rng.uniform(0, 7)), smooth=True)


def scribble(rng: Random) -> Figure:
    """Return a scribble: to and fro, or round and round."""
    # People make six swings and more.
    swings = int(rng.integers(7, 17))
    if rng.random() < 0.25:
        angle = np.linspace(0.0, 2.0 * math.pi * rng.uniform(3.1, 6.5), 300)
        radius = 0.3 + 0.15 * np.sin(angle * rng.uniform(0.2, 0.7) + rng.uniform(0, 7))
        drift = np.outer(angle / angle[-1] - 0.5, rng.uniform(-0.4, 0.4, 2))
        path = np.column_stack((radius * np.cos(angle), radius * np.sin(angle))) + drift
        return Figure(kind='scribble', path=turned(path, rng.uniform(0, 7)), smooth=True)
    # Of many swings it may go far, if each lies close to the one before it.
    x = np.linspace(-0.5, 0.5, swings) * rng.uniform(0.4, max(1.0, 0.13 * swings))
    uneven = rng.uniform(0.0, 1.3)
    x += rng.normal(0.0, 0.04 * uneven, swings)
    sign = np.where(np.arange(swings) % 2, 1.0, -1.0)
    y = sign * rng.uniform(0.5 - 0.25 * uneven, 0.5, swings)
    y += rng.normal(0.0, 0.05 * uneven, swings)
    path = np.column_stack((x + y * rng.uniform(-0.3, 0.3), y))
    if rng.random() < 0.5:
        path = _rounded(path, rng.uniform(0.01, 0.05))
    return Figure(kind='scribble', path=turned(path, rng.uniform(0, 7)))


def turned(path: Floats, angle: float) -> Floats:
    """Turn about the middle."""
    return turned_about_origin(path - (path.min(axis=0) + path.max(axis=0)) / 2, angle)


def turned_about_origin(path: Floats, angle: float) -> Floats:
    """Turn about the origin."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.asarray(path @ np.array([(cos, sin), (-sin, cos)]))


def _rounded(path: Floats, radius: float) -> Floats:
    """Cut the inner corners off by a curve."""
    parts = [path[:1]]
    for before, corner, after in zip(path[:-2], path[1:-1], path[2:], strict=True):
        start = corner + (before - corner) * min(2 * radius / math.dist(before, corner), 0.45)
        end = corner + (after - corner) * min(2 * radius / math.dist(after, corner), 0.45)
        share = np.linspace(0.0, 1.0, 9)[:, None]
        parts.append((1 - share) ** 2 * start + 2 * share * (1 - share) * corner + share**2 * end)
    return np.vstack((*parts, path[-1:]))


def _meets_itself(path: Floats) -> bool:
    """Tell whether an open path comes too near to itself."""
    dense = np.vstack([np.linspace(a, b, 12) for a, b in itertools.pairwise(path)])
    apart = np.hypot(*(dense[:, None] - dense[None]).transpose(2, 0, 1))
    sides = np.repeat(np.arange(len(path) - 1), 12)
    return bool((apart[np.abs(sides[:, None] - sides[None]) > 1] < 0.12).any())
