# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Time of impact of pairs of convex shapes in rigid motion, by conservative advancement.

The separation of two shapes, found by separating axes, divided by the greatest speed at which it
can shrink, is a time in which they cannot meet. Both advance by it, again and again, until they
overlap by the skin or the step ends (B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body
Systems, 1996, 2.3). All pairs advance at once, in arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.ccd.hulls import Hull
from physsim_ros.engine.scene_columns import SAFE_SHARE
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import cross, dots, norms, rotated_each

# Advances of a pair in a step, at most: straight motion takes two or three, a fast turning stick
# that grazes a disc about twenty. A pair that takes more ends its step as far as it has come.
_ADVANCES = 24
# Products of the corners of two shapes that are compared at once: some 30 MB.
_PART = 200_000
# Shapes have met when they overlap to within this share of the skin.
_TOLERANCE = 0.1


@dataclass(frozen=True, slots=True)
class Motions:
    """
    Rigid motions in the coming step, by row; time is a share of the step.

    :param since: (n,) float64: share of the step from which on the motion holds
    :param poses: (n, 3) float64: of the bodies then [m, rad]
    :param pivots: (n, 2) float64: centres of rotation then [m]
    :param rates: (n, 3) float64: way of the centre of rotation, and turn, in a whole step [m, rad]
    """

    since: Floats
    poses: Floats
    pivots: Floats
    rates: Floats

    def poses_at(self, rows: Ints, shares: Floats) -> tuple[Floats, Floats]:
        """Return (k, 3) the poses of bodies and (k, 2) their centres of rotation, at a share."""
        lapse = (shares - self.since[rows])[:, None]
        moved = self.rates[rows] * lapse
        pivots = self.pivots[rows] + moved[:, :2]
        arms = rotated_each(self.poses[rows, :2] - self.pivots[rows], moved[:, 2])
        return np.column_stack((pivots + arms, self.poses[rows, 2] + moved[:, 2])), pivots


class Pairs(NamedTuple):
    """
    Pairs of shapes that could meet in the coming step.

    :ivar rows: (p,) and (p,) int64: of the two bodies
    :ivar hulls: of shapes
    :ivar shapes: (p,) and (p,) int64: places of the two shapes in `hulls`
    :ivar skin: (p,) float64: overlap at which they have met, seen by the engine [m]
    :ivar depth: (p,) float64: how far they may enter each other in a step unseen [m]
    """

    rows: tuple[Ints, Ints]
    hulls: Sequence[Hull]
    shapes: tuple[Ints, Ints]
    skin: Floats
    depth: Floats

    def part(self, chosen: Ints) -> Pairs:
        """Return some of the pairs."""
        (one, other), (own, its) = self.rows, self.shapes
        return Pairs(
            (one[chosen], other[chosen]),
            self.hulls,
            (own[chosen], its[chosen]),
            self.skin[chosen],
            self.depth[chosen],
        )


class _Side(NamedTuple):
    """One side of all pairs, where it is: corners and normals (p, v, 2), in the world."""

    corners: Floats
    normals: Floats


def first_impacts(motions: Motions, pairs: Pairs) -> Floats:
    """
    Return (p,) the shares of the step at which pairs first overlap by the skin; infinite is never.

    An impact counts where the rest of the approach is more than the safe depth. A pair that
    overlaps deeper from the start meets at once if it comes deeper, and later if it leaves and
    comes back; not at all where it overlaps by more than the lesser inner radius, since either
    side may be the nearer one then.
    """
    corners = np.array([len(each.corners) for each in pairs.hulls], np.int64)
    products = corners[pairs.shapes[0]] * corners[pairs.shapes[1]]
    # The largest together, since a part has as many corners for each pair as its largest pair.
    order = np.argsort(products, kind='stable')
    parts = np.cumsum(products[order]) // _PART
    found = np.empty(len(order))
    for part in np.split(order, np.flatnonzero(np.diff(parts)) + 1):
        found[part] = _advance(motions, pairs.part(part))
    return found


def _advance(motions: Motions, pairs: Pairs) -> Floats:
    """Return (p,) shares of the step of first overlap, infinite for never."""
    (one, other), (skin, depth) = pairs.rows, (pairs.skin, pairs.depth)
    found = np.full(len(one), np.inf)
    shares = np.maximum(motions.since[one], motions.since[other])
    sides = [_stacked(pairs.hulls, shapes) for shapes in pairs.shapes]
    radii = np.array([each.radius for each in pairs.hulls])
    radii = radii[pairs.shapes[0]] + radii[pairs.shapes[1]]
    reaches = np.array([each.reach for each in pairs.hulls])[np.stack(pairs.shapes)]
    for rows, reach in zip(pairs.rows, reaches, strict=True):
        np.add(reach, norms(motions.poses[rows, :2] - motions.pivots[rows]), out=reach)
    target, live = -skin, np.arange(len(one))
    for advance in range(_ADVANCES):
        now, rows_a, rows_b = shares[live], one[live], other[live]
        (poses_a, pivots_a), (poses_b, pivots_b) = (
            motions.poses_at(rows, now) for rows in (rows_a, rows_b)
        )
        a, b = _placed(sides[0], live, poses_a), _placed(sides[1], live, poses_b)
        separation, axis, of_a = _separation(a, b)
        separation -= radii[live]
        met = separation <= target[live] + _TOLERANCE * skin[live]
        stays = np.ones(len(live), np.bool_)
        if advance == 0:
            target = np.where(met, separation - depth, target)
            stays = separation >= -skin - depth / SAFE_SHARE
        # A pair that leaves its overlap may not come back as deep.
        least = np.minimum(-skin[live], separation - depth[live])
        target[live] = np.maximum(target[live], least)
        gap = separation - target[live]
        if met.any():
            point = _contact_points(a, b, axis, of_a)
            rate = _rate(motions, rows_a, point - pivots_a, axis)
            rate -= _rate(motions, rows_b, point - pivots_b, axis)
            met &= stays & (rate > 0.0)
            counts = met & (rate * (1.0 - now) > depth[live])
            found[live[counts]] = now[counts]
        rates = motions.rates[rows_a], motions.rates[rows_b]
        # Greatest distance from the other one's centre of rotation, now and later.
        far = (_farthest(b, pivots_a), _farthest(a, pivots_b))
        speed = _speed_bound(rates, reaches[:, live], far, axis, 1.0 - now)
        with np.errstate(divide='ignore'):
            after = now + np.where(speed > 0.0, gap / speed, np.inf)
        stays &= ~met & (after < 1.0)
        shares[live] = after
        live = live[stays]
        if not len(live):
            break
    # Those that are still advancing may meet later; they go as far as is known to be clear.
    found[live] = shares[live]
    return found


def _separation(a: _Side, b: _Side) -> tuple[Floats, Floats, Flags]:
    """
    Return the separation of cores, exact for disjoint ones; else the negative least depth.

    :return: (p,) separations [m], (p, 2) axes from the first to the second, and (p,) whether that
        is a normal of the first
    """
    between = b.corners[:, None] - a.corners[:, :, None]
    between = between.reshape(len(between), -1, 2)
    square = (between**2).sum(axis=2)
    nearest = between[np.arange(len(between)), square.argmin(axis=1)]
    length = np.hypot(nearest[:, 0], nearest[:, 1])[:, None]
    nearest /= np.where(length > 0.0, length, 1.0)
    axes = np.concatenate((a.normals, -b.normals, nearest[:, None]), axis=1)
    lead = dots(axes[:, :, None], a.corners[:, None]).max(axis=2)
    separations = dots(axes[:, :, None], b.corners[:, None]).min(axis=2) - lead
    # A point has no normals, and two points in one place no axis.
    separations[~axes.any(axis=2)] = -np.inf
    best = separations.argmax(axis=1)
    pairs = np.arange(len(best))
    of_a: Flags = best < a.normals.shape[1]
    return np.maximum(separations[pairs, best], -1e300), axes[pairs, best], of_a


def _speed_bound(
    rates: tuple[Floats, Floats],
    reaches: Floats,
    far: tuple[Floats, Floats],
    axis: Floats,
    lapse: Floats,
) -> Floats:
    """
    Return (k,) the greatest speed at which separation along an axis can shrink [m a step].

    The axis may be held in the world, or turn with either body; the least bound is taken. A body
    that turns sees a point move by its distance from the pivot only.

    :param rates: (k, 3) of either body
    :param reaches: (2, k) of either body: of its corners from its pivot [m]
    :param far: (k,) of either body: of the other's corners from its pivot [m]
    :param lapse: (k,) what is left of the step
    """
    relative = rates[0][:, :2] - rates[1][:, :2]
    length = norms(relative)
    turns = np.abs(rates[0][:, 2]), np.abs(rates[1][:, 2])
    bound: Floats = (relative * axis).sum(axis=1) + turns[0] * reaches[0] + turns[1] * reaches[1]
    for side in (0, 1):
        seen = turns[side] * (far[side] + length * lapse)
        bound = np.minimum(bound, length + seen + turns[1 - side] * reaches[1 - side])
    return bound


def _farthest(side: _Side, points: Floats) -> Floats:
    """Return (k,) the greatest distance of a corner from a point [m]."""
    distance: Floats = norms(side.corners - points[:, None]).max(axis=1)
    return distance


def _contact_points(a: _Side, b: _Side, axis: Floats, of_a: Flags) -> Floats:
    """Return (k, 2) the foremost corner of the body whose side the axis is not a normal of."""
    ahead = dots(axis[:, None], a.corners).argmax(axis=1)
    behind = dots(axis[:, None], b.corners).argmin(axis=1)
    pairs = np.arange(len(axis))
    points: Floats = np.where(of_a[:, None], b.corners[pairs, behind], a.corners[pairs, ahead])
    return points


def _rate(motions: Motions, rows: Ints, arms: Floats, axis: Floats) -> Floats:
    """Return (k,) how far points of bodies would go along an axis in a whole step [m]."""
    rates = motions.rates[rows]
    return dots(rates[:, :2], axis) + rates[:, 2] * cross(arms, axis)


def _stacked(hulls: Sequence[Hull], shapes: Ints) -> _Side:
    """Return corners and normals of hulls as (p, v, 2), the last of each repeated."""
    used, places = np.unique(shapes, return_inverse=True)
    some = [hulls[shape] for shape in used.tolist()]
    most = max(len(each.corners) for each in some)
    last = np.array([len(each.corners) - 1 for each in some])
    take = np.minimum(np.arange(most), last[:, None])
    corners = np.array([each.corners[row] for each, row in zip(some, take, strict=True)])
    normals = np.array([each.normals[row] for each, row in zip(some, take, strict=True)])
    return _Side(corners[places], normals[places])


def _placed(side: _Side, rows: Ints, poses: Floats) -> _Side:
    """Return hulls where their bodies are."""
    angles = poses[:, 2, None]
    corners = rotated_each(side.corners[rows], angles) + poses[:, None, :2]
    return _Side(corners, rotated_each(side.normals[rows], angles))
