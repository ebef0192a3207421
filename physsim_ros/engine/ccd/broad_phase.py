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
Which fast bodies could meet anything: told by arrays, before each is looked at by itself.

Law: whoever is left out would not have been stopped. What matters is the way as it is seen from
the other: of a thousand balls that fall side by side only those near the floor are looked at.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.islands import ranges
from physsim_ros.model.arrays import Floats, Ints

Flags = NDArray[np.bool_]

# What is so many times larger, or faster, than the fast bodies mostly are, is not in the grid.
_ODD = 2.0
# So many pairs with such a body are looked at, at most.
_MOST_PAIRS = 1_000_000
# More cells than this, and their numbers would not fit.
_MOST_CELLS = 1e15
# So many boxes are compared with all bodies at once.
_BOXES = 1000
# For rounding.
_LESS = 1.0 - 1e-9


class Motions(NamedTuple):
    """
    What bodies do in the coming step, a row each.

    :ivar centers: (m, 2) float64: centres of mass, world [m]
    :ivar ways: (m, 2) float64: of these in the step [m]
    :ivar turns: (m,) float64: by how much they turn either way [rad]; 0 for discs
    :ivar outer: (m,) float64: greatest distance of a point from the centre [m]
    :ivar depth: (m,) float64: how far each may enter something unseen [m]
    :ivar group: (m,) int64: of bodies that pass through each other; 0 is none
    """

    centers: Floats
    ways: Floats
    turns: Floats
    outer: Floats
    depth: Floats
    group: Ints

    def at(self, rows: Ints | Flags) -> Motions:
        """Return these rows alone."""
        return Motions(
            self.centers[rows],
            self.ways[rows],
            self.turns[rows],
            self.outer[rows],
            self.depth[rows],
            self.group[rows],
        )


def could_meet(fast: Ints, motions: Motions, apart: Ints, boxes: Floats) -> Flags:
    """
    Tell which fast bodies could meet anything in the coming step.

    :param fast: (k,) rows of the fast bodies
    :param motions: of all bodies that are not fixed to the background, and are no sensors
    :param apart: (j, 2) rows of bodies that joints keep from colliding
    :param boxes: (b, 4) float64: left, bottom, right, top of all that is [m]
    :return: (k,)
    """
    length = np.hypot(*motions.ways.T)
    large, far = (_ODD * float(np.median(each[fast])) for each in (motions.outer, length))
    plain = (motions.outer <= large) & (length <= far)
    some, odd = fast[plain[fast]], fast[~plain[fast]]
    found = [
        _neighbours(some, np.flatnonzero(plain), motions),
        _all_pairs(fast, np.flatnonzero(~plain), motions),
        _all_pairs(odd, np.flatnonzero(plain), motions),
    ]
    pairs = [each for each in found if each is not None]
    if len(pairs) < len(found):
        return np.ones(len(fast), np.bool_)
    one, other = (np.concatenate(each) for each in zip(*pairs, strict=True))
    collide = _collide(one, other, motions, apart)
    one, other = one[collide], other[collide]
    meets = np.zeros(len(motions.outer), np.bool_)
    meets[fast] = _near_boxes(motions.at(fast), boxes)
    mine, theirs = motions.at(one), motions.at(other)
    seen = np.hypot(*(mine.ways - theirs.ways).T)
    meets[one[_meet(mine, theirs, seen)]] = True
    if not meets[fast].any():
        return np.zeros(len(fast), np.bool_)
    # Whoever is stopped is met by who follows.
    follow = _meet(mine, theirs, np.maximum(seen, length[one]))
    one, other = one[follow], other[follow]
    while (more := one[meets[other] & ~meets[one]]).size:
        meets[more] = True
    return meets[fast]


def _collide(one: Ints, other: Ints, motions: Motions, apart: Ints) -> Flags:
    """Tell which pairs do not pass through each other."""
    together: Flags = (motions.group[one] != 0) & (motions.group[one] == motions.group[other])
    left = np.flatnonzero(~together)
    if len(apart) and len(left):
        count = len(motions.outer)
        keys = np.concatenate((apart, apart[:, ::-1])) @ (count, 1)
        together[left] = np.isin(one[left] * count + other[left], keys)
    return ~together


def _near_boxes(mine: Motions, boxes: Floats) -> Flags:
    """Return (k,): whose way leads into one of the boxes."""
    ends = mine.centers + mine.ways
    low = np.minimum(mine.centers, ends) - mine.outer[:, None]
    high = np.maximum(mine.centers, ends) + mine.outer[:, None]
    least, most = low.min(axis=0, initial=np.inf), high.max(axis=0, initial=-np.inf)
    boxes = boxes[((boxes[:, :2] <= most) & (boxes[:, 2:] >= least)).all(axis=1)]
    meets = np.zeros(len(low), np.bool_)
    for first in range(0, len(boxes), _BOXES):
        last = first + _BOXES
        left, bottom, right, top = boxes[first:last].T
        inside = (low[:, :1] <= right) & (high[:, :1] >= left)
        inside &= (low[:, 1:] <= top) & (high[:, 1:] >= bottom)
        meets |= inside.any(axis=1)
    return meets


def _meet(mine: Motions, theirs: Motions, seen: Floats) -> Flags:
    """
    Tell which pairs come together by more than goes unseen.

    :param seen: (p,) float64: the way of the first as the second sees it, at most [m]
    """
    near = mine.outer + theirs.outer + seen
    length = seen + mine.turns * mine.outer + theirs.turns * near
    apart = np.hypot(*(mine.centers - theirs.centers).T)
    found: Flags = (apart * _LESS <= near) & (length >= mine.depth * _LESS)
    return found


def _all_pairs(fast: Ints, rows: Ints, motions: Motions) -> tuple[Ints, Ints] | None:
    """
    Return pairs of rows, one of each, that may come near each other.

    :return: (p,) and (p,); None where there are too many
    """
    if len(fast) * len(rows) > _MOST_PAIRS:
        return None
    mine, theirs = motions.at(fast), motions.at(rows)
    reach, others = (each.outer + np.hypot(*each.ways.T) for each in (mine, theirs))
    apart = np.hypot(*(mine.centers.T[..., None] - theirs.centers.T[:, None]))
    one, other = np.nonzero(apart * _LESS <= reach[:, None] + others)
    one, other = fast[one], rows[other]
    return one[one != other], other[one != other]


def _neighbours(fast: Ints, rows: Ints, motions: Motions) -> tuple[Ints, Ints] | None:
    """
    Return pairs of rows of which the first is fast: all that may come near each other.

    :param fast: rows, which are among the others
    :param rows: of bodies of about one size and speed
    :return: (p,) and (p,); None where they are too far apart for a grid
    """
    plain = motions.at(rows)
    way = float(np.hypot(*plain.ways.T).max(initial=0.0))
    cell = 2.0 * (float(plain.outer.max(initial=0.0)) + way)
    low = plain.centers.min(axis=0, initial=np.inf)
    spread = plain.centers.max(axis=0, initial=-np.inf) - low
    # NaN compares false.
    if not np.prod(spread / cell + 4.0) < _MOST_CELLS:
        return None
    x, y = ((plain.centers - low) / cell).astype(np.int64).T
    column = int(y.max(initial=0)) + 3
    number = np.zeros(len(motions.outer), np.int64)
    number[rows] = x * column + y
    order = rows[np.argsort(number[rows], kind='stable')]
    ranked = number[order]
    ones, others = [], []
    for side in (-column, 0, column):
        middle = number[fast] + side
        first = np.searchsorted(ranked, middle - 1, 'left')
        count = np.searchsorted(ranked, middle + 1, 'right') - first
        ones.append(np.repeat(fast, count))
        others.append(order[ranges(first, count)])
    one, other = np.concatenate(ones), np.concatenate(others)
    x, y = motions.centers.T
    apart = (x.take(one) - x.take(other)) ** 2 + (y.take(one) - y.take(other)) ** 2
    near = (apart * _LESS <= cell**2) & (one != other)
    return one[near], other[near]
