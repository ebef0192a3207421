# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
A stroke as geometry: evenly spaced, without hooks, closed or open, and its corners.

Law: the samples' own spacing and number have no say. A click has no speed, and a mouse that is
read 200 times a second draws the same square as one that is read 20 times.

Corners are looked for where the pen turns within a short way, as ShortStraw does (Wolin, Eoff and
Hammond, 2008). Which of them are meant is decided by all of them at once: the fewest straight
sides that explain the way.
"""

from __future__ import annotations

from dataclasses import dataclass
import itertools
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.errors import BadSize, Malformed
from physsim_ros.core.outlines import cross
from physsim_ros.core.requests import FARTHEST
from physsim_ros.core.shapes import SMALLEST
from physsim_ros.core.snapshot import Floats

# Points of an evenly spaced stroke: a dozen for each side of a star of five points.
COUNT = 128
# Where more are needed, for the ends of something narrow: so many times more.
FINER = 4
FINELY = FINER * (COUNT - 1) + 1
# A hook is no longer than this share of the stroke's size, and turns by more than that [rad].
HOOK, HOOK_TURN = 0.1, 1.2
# What may be cut off a closed stroke at either end, where it was drawn twice, in shares of its
# length; and the gap there from which on it is not worth asking whether it is closed.
TWICE, GAP = 0.14, 0.18
# How much of a way has to be cut off to be worth a gap of one metre.
KEEPING = 0.6
# Smoothing before corners are looked for, and the arms of the angle there [points].
SMOOTHING, ARM = 1.2, 5
# The least turn that may be a corner, and the least that is one [rad].
CANDIDATE_TURN, CORNER_TURN = 0.3, 0.42
# The greatest turn at which two sides still meet in a point [rad].
SHARPEST = 2.6
# The most candidates that are weighed against one another.
CANDIDATES = 28
# What a corner has to save to be worth it: mean square distance, in shares of the size squared.
CORNER_COST = 0.0075**2
# What is left of an end that is bent off is no longer than this share of the length.
STUB = 0.07
# How near to the gap in a closed way a side that only bridges it begins and ends, in shares of
# the length, and how far its ends may slip past one another.
SEAM, SLIP = 0.03, 0.045
# How far straight sides may be from an open way, root mean square, before it counts as a curve;
# and how far the points of a curve are. Both in shares of its size.
CURVED, FINE = 0.013, 0.006
# Narrow outlines are made at least that wide, in shares of their length, but at most so many
# times wider.
WIDE, WIDEST = 0.3, 10.0
# A straight side gets at least that share of its length from one end to the other.
ASTRAY = 0.75


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stroke:
    """
    A stroke, evenly spaced.

    :param points: (COUNT, 2) float64: the whole way, hooks cut off [m]
    :param outline: (FINELY - 1, 2) float64: the way closed, the first point not repeated, what
        was drawn twice cut off [m]; None where the ends lie far apart
    :param gap: between the ends, in shares of the length
    :param size: diagonal of the rectangle around it [m]
    :param length: of its way [m]
    """

    points: Floats
    outline: Floats | None
    gap: float
    size: float
    length: float


def stroke(samples: Floats) -> Stroke:
    """
    Make a stroke of a pen's samples.

    :param samples: (n, 2) float64: x, y [m]; or (n, 3), the third column the time of each, which
        puts them in order
    :raises Malformed: there are none, or one is not finite
    :raises BadSize: all are in one place, or one is too far away
    """
    way = spaced(_without_hooks(spaced(_checked(samples), FINELY)), FINELY)
    points = way[::FINER]
    outline, gap = _outline(points, way)
    return Stroke(
        points=points,
        outline=outline,
        gap=gap,
        size=float(np.hypot(*np.ptp(points, axis=0))),
        length=float(np.hypot(*np.diff(points, axis=0).T).sum()),
    )


def spaced(way: Floats, count: int = COUNT) -> Floats:
    """Return points along a way, the same distance apart."""
    length = np.zeros(len(way))
    np.cumsum(np.hypot(*np.diff(way, axis=0).T), out=length[1:])
    at = np.linspace(0.0, length[-1], count)
    return np.column_stack((np.interp(at, length, way[:, 0]), np.interp(at, length, way[:, 1])))


def smoothed(points: Floats, width: float, *, closed: bool) -> Floats:
    """Return points with what is shorter than a few of them taken out."""
    reach = math.ceil(3 * width)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    kernel /= kernel.sum()
    if closed:
        first, last = points[-reach:], points[:reach]
    else:
        # Mirrored about the ends, which so stay where they are.
        first = 2 * points[0] - points[reach:0:-1]
        last = 2 * points[-1] - points[-2 : -reach - 2 : -1]
    padded = np.vstack((first, points, last))
    return np.column_stack([np.convolve(axis, kernel, 'valid') for axis in padded.T])


def widened(outline: Floats) -> tuple[Floats, Floats]:
    """
    Return a closed way, made so wide that corners at its narrow ends can be told apart.

    :return: the way, evenly spaced; and the (2, 2) matrix that makes points of it narrow again
    """
    away = outline - outline.mean(axis=0)
    squares, axes = np.linalg.eigh(away.T @ away)
    aspect = math.sqrt(max(float(squares[0]), 0.0) / float(squares[1]))
    stretch = min(max(WIDE / max(aspect, 1e-6), 1.0), WIDEST)
    # Straight lines stay straight.
    wide = axes @ np.diag((stretch, 1.0)) @ axes.T
    narrow: Floats = axes @ np.diag((1.0 / stretch, 1.0)) @ axes.T
    way = outline @ wide
    return spaced(np.vstack((way, way[:1])), COUNT + 1)[:-1], narrow


def turns(points: Floats, arm: int, *, closed: bool) -> NDArray[np.float64]:
    """
    Return by how much the way turns at each point, seen over arms of some points [rad].

    Towards the ends of an open way the arms get shorter; the ends themselves do not turn.
    """
    count = len(points)
    at = np.arange(count)
    reach = np.full(count, arm) if closed else np.minimum(arm, np.minimum(at, count - 1 - at))
    a = points - points[at - reach]
    b = points[(at + reach) % count] - points
    result: NDArray[np.float64] = np.arctan2(cross(a, b), (a * b).sum(axis=1))
    return result


def corners(points: Floats, *, closed: bool, gap: float = 0.0) -> list[int]:
    """
    Return which points are corners; of an open way, the ends are.

    :param points: (n, 2) float64: evenly spaced; of a closed way, the first not repeated
    :param gap: in shares of a closed way, what at its end was not drawn
    """
    count = len(points)
    smooth = smoothed(points, SMOOTHING, closed=closed)
    turn = np.abs(turns(smooth, ARM, closed=closed))
    places = _peaks(turn, closed=closed)
    if not closed:
        inner = places[(places > 2) & (places < count - 3)]
        return _meant(smooth, np.array([0, *inner, count - 1]))
    if len(places) < 2:
        return list(map(int, places))
    # Opened at the sharpest corner, which certainly is one.
    start = places[turn[places].argmax()]
    way = np.roll(smooth, -start, axis=0)
    opened = np.array([*np.sort((places - start) % count), count])
    chosen = _meant(np.vstack((way, way[:1])), opened)
    at = sorted((each + int(start)) % count for each in chosen[:-1])
    return _without_seam(smooth, at, gap)


def vertices(points: Floats, at: list[int], *, closed: bool) -> Floats:
    """
    Return where the sides between corners meet: sharp, however round the pen took them.

    :param at: the corners, as `corners` returns them
    """
    count, total = len(at), len(points)
    found = points[at].copy()
    if count < 2:
        return found
    lines = []
    for first, last in zip(at, at[1:] + at[:1], strict=True):
        span = (last - first) % total
        # The fifths next to the corners may be round.
        rows = np.arange(first + span // 5, first + span - span // 5 + 1) % total
        lines.append(line(points[rows]))
    if not closed:
        for corner, (middle, along, _) in ((0, lines[0]), (-1, lines[-2])):
            found[corner] = middle + along * ((found[corner] - middle) @ along)
    for corner in range(0 if closed else 1, count if closed else count - 1):
        (p, u, _), (q, v, _) = lines[corner - 1], lines[corner]
        sine = float(cross(u, v))
        # Nearly parallel lines meet anywhere.
        if abs(sine) > 0.3:
            found[corner] = p + u * (cross(q - p, v) / sine)
    return found


def side_error(outline: Floats, at: list[int]) -> float:
    """Return how far a closed way lies from the sides between its corners, root mean square."""
    way = np.vstack((outline, outline[: at[0] + 1]))
    ends = np.array([*at, at[0] + len(outline)])
    return math.sqrt(float(np.diagonal(_errors(way, ends), 1).sum()) / len(outline))


def bends_of(drawn: Stroke) -> Floats:
    """Return the ends and bends of a line."""
    at = _without_stubs(drawn.points, corners(drawn.points, closed=False))
    return vertices(drawn.points, at, closed=False)


def _without_stubs(points: Floats, at: list[int]) -> list[int]:
    """Return the corners of an open way without ends that are too short to be meant."""
    kept = list(at)
    for _ in range(2):
        # From the other end in the second round, and so the right way round after both.
        kept.reverse()
        if len(kept) > 2:
            a, b = np.diff(points[kept[-3:]], axis=0)
            bent = abs(math.atan2(float(cross(a, b)), float(a @ b))) > HOOK_TURN / 2
            if abs(kept[-1] - kept[-2]) < (STUB + HOOK * bent / 2) * (len(points) - 1):
                kept.pop()
    return kept


def simplified(drawn: Stroke, bends: Floats) -> Floats | None:
    """
    Return a curve as few enough points, or None where straight sides explain it.

    :param bends: (n, 2) float64: ends and bends of the sides
    """
    way = smoothed(drawn.points, SMOOTHING, closed=False)
    off = np.min([_off(way, *side) for side in itertools.pairwise(bends)], axis=0)
    if math.sqrt(float((off**2).mean())) <= CURVED * drawn.size:
        return None
    return _traced(way, FINE * drawn.size)


def traced(outline: Floats) -> Floats:
    """Return a closed way as few enough points."""
    way = spaced(np.vstack((outline, outline[:1])), COUNT + 1)[:-1]
    way = smoothed(way, SMOOTHING, closed=True)
    size = float(np.hypot(*np.ptp(way, axis=0)))
    # From one of the points that lie farthest out.
    way = np.roll(way, -int(((way - way.mean(axis=0)) ** 2).sum(axis=1).argmax()), axis=0)
    return _traced(np.vstack((way, way[:1])), FINE * size)[:-1]


def _traced(way: Floats, tolerance: float) -> Floats:
    """Keep the points without which a way would be too far off: Ramer, Douglas and Peucker."""
    kept, parts = {0, len(way) - 1}, [(0, len(way) - 1)]
    while parts:
        first, last = parts.pop()
        off = _off(way[first : last + 1], way[first], way[last])
        furthest = first + int(off.argmax())
        if off.max() > tolerance:
            kept.add(furthest)
            parts += [(first, furthest), (furthest, last)]
    return way[sorted(kept)]


def _off(points: Floats, start: Floats, end: Floats) -> Floats:
    """Return how far points lie from a segment [m]."""
    along = end - start
    share = np.clip((points - start) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
    away = points - start - share[:, None] * along
    result: Floats = np.hypot(away[:, 0], away[:, 1])
    return result


def rectangle(corners: Floats) -> Floats:
    """Return the rectangle that is nearest to four corners, in their order."""
    middle = corners.mean(axis=0)
    sides = np.roll(corners, -1, axis=0) - corners
    # Four times its angle is the same for all sides of a rectangle; the long ones count most.
    quadruple = (sides[:, 0] + 1j * sides[:, 1]) ** 4
    quadruple /= np.maximum(np.abs(quadruple), 1e-300) ** 0.5
    angle = float(np.angle(quadruple.sum())) / 4
    axes = np.array(((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))))
    local = (corners - middle) @ axes.T
    signs = np.where(local >= 0, 1.0, -1.0)
    nearest: Floats = middle + (signs * np.abs(local).mean(axis=0)) @ axes
    return nearest


def line(points: Floats) -> tuple[Floats, Floats, float]:
    """Return the straight line nearest to points: its middle, its direction, how far off [m]."""
    middle = points.mean(axis=0)
    away = points - middle
    (xx, xy), (_, yy) = (away.T @ away).tolist()
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    least = (xx + yy) / 2 - math.hypot((xx - yy) / 2, xy)
    direction = np.array((math.cos(angle), math.sin(angle)))
    return middle, direction, math.sqrt(max(least, 0.0) / len(points))


def _checked(samples: Floats) -> Floats:
    """Return the samples' places, those that repeat the one before left out."""
    if len(samples) == 0:
        raise Malformed('the stroke has no samples', field='poses')
    if samples.shape[1] > 2 and (np.diff(samples[:, 2]) < 0.0).any():
        # They came in another order than the pen went.
        samples = samples[np.argsort(samples[:, 2], kind='stable')]
    places = samples[:, :2]
    if not np.isfinite(places).all():
        raise Malformed('a sample of the stroke is not finite', field='poses')
    if np.abs(places).max() > FARTHEST:
        raise BadSize(f'the stroke reaches further than {FARTHEST:g} m', field='poses')
    if np.hypot(*np.ptp(places, axis=0)) < SMALLEST:
        raise BadSize(
            f'the stroke is smaller than {SMALLEST:g} m: a point draws nothing', field='poses'
        )
    return places


def _without_hooks(way: Floats) -> Floats:
    """Cut off the flicks of a pen that was set down before it rested, or lifted late."""
    points = way[::FINER]
    first, last = _hook(points), len(points) - 1 - _hook(points[::-1])
    return way[FINER * first : FINER * last + 1] if last - first > len(points) // 2 else way


def _hook(points: Floats) -> int:
    """Return how many points at the beginning are a hook."""
    size = float(np.hypot(*np.ptp(points, axis=0)))
    step = float(np.hypot(*np.diff(points, axis=0).T).mean())
    reach = int(HOOK * size / step)
    if reach < 2:
        return 0
    at = np.arange(1, reach + 1)
    a = points[at] - points[0]
    b = points[at + np.maximum(at, 4)] - points[at]
    turn = np.abs(np.arctan2(cross(a, b), (a * b).sum(axis=1)))
    sharpest = int(turn.argmax())
    # Where it still gets sharper at the end, what turns is longer than a hook.
    return sharpest + 1 if turn[sharpest] > HOOK_TURN and sharpest < reach - 1 else 0


def _outline(points: Floats, way: Floats) -> tuple[Floats | None, float]:
    """
    Return the closed way that a stroke makes, if it makes one, and the gap in it.

    :param points: evenly spaced
    :param way: the same, with more points
    """
    count = len(points)
    step = float(np.hypot(*np.diff(points, axis=0).T).mean())
    ends = int(TWICE * count)
    head, tail = points[:ends], points[-ends:]
    apart = np.hypot(*(head[:, None] - tail[None]).transpose(2, 0, 1))
    # Points that are cut off before a place of the head, and after one of the tail.
    cut = np.arange(ends)[:, None] + np.arange(ends)[None, ::-1]
    best = int((apart + KEEPING * step * cut).argmin())
    first, last = divmod(best, ends)
    gap = float(apart[first, last]) / (step * (count - 1))
    if gap > GAP:
        return None, gap
    once = way[FINER * first : FINER * (count - ends + last) + 1]
    return spaced(np.vstack((once, once[:1])), FINELY)[:-1], gap


def _peaks(turn: NDArray[np.float64], *, closed: bool) -> NDArray[np.intp]:
    """Return where the way turns most, at most so many places."""
    around = np.pad(turn, 2, mode='wrap' if closed else 'constant')
    highest = np.max([around[:-4], around[1:-3], around[3:-1], around[4:]], axis=0)
    places = np.flatnonzero((turn >= highest) & (turn > CANDIDATE_TURN))
    if len(places) > CANDIDATES:
        places = np.sort(places[np.argsort(-turn[places])[:CANDIDATES]])
    return places


def _meant(way: Floats, places: NDArray[np.intp]) -> list[int]:
    """
    Return those of the places at which sides begin and end that are meant, the ends among them.

    Dynamic programming over all choices; a corner has to pay for itself, and what is left of
    corners that hardly turn is dropped.
    """
    count = len(places)
    if count > 2:
        errors = _errors(way, places)
        size2 = float((np.ptp(way, axis=0) ** 2).sum())
        cost = CORNER_COST * size2 * len(way)
        total = np.full(count, np.inf)
        total[0] = 0.0
        before = np.zeros(count, dtype=np.intp)
        for end in range(1, count):
            ways = total[:end] + errors[:end, end] + cost
            before[end] = ways.argmin()
            total[end] = ways[before[end]]
        chosen = [count - 1]
        while chosen[-1] > 0:
            chosen.append(int(before[chosen[-1]]))
        places = places[chosen[::-1]]
    kept: list[int] = places.tolist()
    while len(kept) > 2:
        ends = way[kept]
        a, b = np.diff(ends, axis=0)[:-1], np.diff(ends, axis=0)[1:]
        turn = np.abs(np.arctan2(cross(a, b), (a * b).sum(axis=1)))
        if turn.min() > CORNER_TURN:
            break
        kept.pop(int(turn.argmin()) + 1)
    return kept


def _without_seam(way: Floats, at: list[int], gap: float) -> list[int]:
    """Drop the corners of a side that only bridges the ends of a closed way, and was not drawn."""
    count = len(way)
    near = round(SEAM * count)
    # The gap is at the end; a side that bridges it begins there and ends at the beginning.
    bridge = [each for each in at if each >= count * (1.0 - gap / (1.0 + gap)) - near]
    first, last = bridge[0] if bridge else at[0], at[0] if bridge else at[-1]
    if len(at) < 4 or first == last or last > near:
        return at
    kept = [each for each in at if each > last and each < first]
    into, out = way[first] - way[kept[-1]], way[kept[0]] - way[last]
    turn = abs(math.atan2(float(cross(into, out)), float(into @ out)))
    if turn > SHARPEST or (turn < CORNER_TURN and gap > SLIP):
        # The sides beside it run on, or back, beside one another: what is between was meant.
        return at
    return [*kept, first] if turn > CORNER_TURN else kept


def _errors(way: Floats, places: NDArray[np.intp]) -> NDArray[np.float64]:
    """
    Return how badly one straight side explains the way between each two places.

    :return: (k, k) float64: sum of squared distances from the straight line that is nearest [m²]
    """
    x, y = (way - way.mean(axis=0)).T
    sums = np.zeros((5, len(way) + 1))
    np.cumsum((x, y, x * x, x * y, y * y), axis=1, out=sums[:, 1:])
    # The point next to a corner may be round.
    first = sums[:, places + 1][:, :, None]
    last = sums[:, places][:, None, :]
    number = np.maximum(places[None, :] - places[:, None] - 1, 1)
    sx, sy, sxx, sxy, syy = last - first
    xx, xy, yy = sxx - sx * sx / number, sxy - sx * sy / number, syy - sy * sy / number
    least = np.maximum((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)
    # Back on its own line a way leaves no distance from it, but gets nowhere.
    ends = way[places]
    chord = np.hypot(*(ends[None] - ends[:, None]).transpose(2, 0, 1))
    steps = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))))[places]
    astray = np.maximum(ASTRAY * (steps[None] - steps[:, None]) - chord, 0.0)
    wrong: NDArray[np.float64] = least + number * astray**2
    return wrong
