# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Islands of bodies that have met in the coming step, and move on as one.

Each round finds the impacts to come, and joins those that meet before anything near them does. The
two go on with their common momentum and angular momentum, or as the anchored or kinematic body
that they have met.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.broad_phase import boxes_overlap
from physsim_ros.engine.ccd.hulls import Hull, Hulls, StaticShapes
from physsim_ros.engine.ccd.swept_boxes import SweptBoxes
from physsim_ros.engine.ccd.time_of_impact import first_impacts, Motions, Pairs
from physsim_ros.engine.graph_search import ranges
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import cross, dots

# Greatest count of successive impacts of a body in a step, as in a row of bodies before a wall.
# Beyond it the engine's own result holds.
ROUNDS = 10


class Impact(NamedTuple):
    """Two rows that meet, and the share of the step at which they do."""

    share: float
    one: int
    other: int


class ImpactIslands:
    """
    Motions of all bodies in one step, from impact to impact.

    A row is a row of the table, then come shapes that never move. Bodies that have
    met move on as one island: the rows of an island are `members` of its first row. An island that
    has met an anchored or kinematic body moves as that does, its `leader`.
    """

    def __init__(
        self,
        table: BodyTable,
        static: StaticShapes,
        moves: Floats,
        hulls: Hulls,
    ) -> None:
        self._pm_bodies = [rigid.pm_body for rigid in table.bodies]
        self._columns = columns = table.columns
        poses = table.state[:, :3]
        self._static = static
        self._hulls = hulls
        count, more = len(poses), len(static.hulls)
        self._count = count
        self._collides = np.append(columns.solid, np.ones(more, np.bool_))
        self._turning = np.append(columns.turning_radii, np.zeros(more))
        self._movable = np.append(columns.dynamic[:-1], np.zeros(more, np.bool_))
        self._places = np.concatenate((np.arange(count), static.places))
        # The background, in place -1, is in no group.
        self._depths = np.append(columns.safe_depths, np.inf)[self._places]
        self._groups = np.append(columns.groups, 0)[self._places]
        nowhere = np.zeros((more, 3))
        poses = np.concatenate((poses, nowhere))
        rates = np.concatenate((np.where(columns.solid[:, None], moves, 0.0), nowhere))
        # A turning disc covers the same ground.
        rates[self._turning == 0.0, 2] = 0.0
        self._motions = Motions(np.zeros(count + more), poses, poses[:, :2].copy(), rates)
        self._ends = poses + rates
        corners = np.concatenate((columns.corners, static.corners))
        self._swept = SweptBoxes(self._motions, columns.reach, static.boxes, corners)
        self._islands = np.arange(count + more)
        self._members: dict[int, list[int]] = {}
        self._leaders: dict[int, int] = {}

    def shifts(self, fast: Flags) -> tuple[Ints, Floats]:
        """
        Return the rows of bodies that end elsewhere than in the engine, and their shifts.

        :param fast: (m,) bool: bodies that could meet others unseen by the engine
        :return: (k,) rows, and (k, 3) float64 shifts [m, rad]
        """
        impacts: list[Impact] = []
        changed = np.flatnonzero(fast)
        for _ in range(ROUNDS):
            known = set(changed.tolist())
            impacts = [it for it in impacts if known.isdisjoint((it.one, it.other))]
            impacts += self._impacts(changed)
            if not impacts:
                break
            changed = self._resolve(sorted(impacts))
        rows = np.array(sorted(itertools.chain.from_iterable(self._members.values())), np.int64)
        ends, _ = self._motions.poses_at(rows, np.ones(len(rows)))
        shifts = ends - self._ends[rows]
        shifts[self._turning[rows] == 0.0, 2] = 0.0
        return rows, shifts

    def _impacts(self, changed: Ints) -> list[Impact]:
        """Return the impacts to come of rows whose motions have changed."""
        found = [self._approaching(*part) for part in self._swept.candidates(changed)]
        one, other, depth = (np.concatenate(column) for column in zip(*found, strict=True))
        if not len(one):
            return []
        rows, places = np.unique(np.stack((one, other)), return_inverse=True)
        hulls = [self._hulls_of(row) for row in rows.tolist()]
        counts = np.array([len(each) for each in hulls])
        firsts, (a, b) = np.cumsum(counts) - counts, places.reshape(2, -1)
        # Each shape of one with each of the other.
        products = counts[a] * counts[b]
        pairs, number = np.repeat(np.arange(len(one)), products), ranges(0 * products, products)
        a, b = a[pairs], b[pairs]
        shapes = firsts[a] + number // counts[b], firsts[b] + number % counts[b]
        flat = list(itertools.chain.from_iterable(hulls))
        radii = np.array([each.radius for each in flat])
        radii = radii[shapes[0]] + radii[shapes[1]]
        skin = np.minimum(COLLISION_SLOP, depth[pairs])
        skin = np.where(radii > 0.0, np.minimum(skin, radii / 2), skin)
        shares = first_impacts(
            self._motions, Pairs((one[pairs], other[pairs]), flat, shapes, skin, depth[pairs])
        )
        earliest = np.full(len(one), np.inf)
        np.minimum.at(earliest, pairs, shares)
        return [
            Impact(float(earliest[pair]), int(one[pair]), int(other[pair]))
            for pair in np.flatnonzero(np.isfinite(earliest)).tolist()
        ]

    def _approaching(self, one: Ints, other: Ints) -> tuple[Ints, Ints, Floats]:
        """Return the pairs that come near by more than their safe depth, and that depth [m]."""
        keep = self._collide(one, other)
        one, other = one[keep], other[keep]
        depth = np.minimum(self._depths[one], self._depths[other])
        keep = self._approach(one, other) > depth
        one, other, depth = one[keep], other[keep], depth[keep]
        keep = self._swept.come_near(one, other)
        return one[keep], other[keep], depth[keep]

    def _hulls_of(self, row: int) -> list[Hull]:
        if row >= self._count:
            return [self._static.hulls[row - self._count]]
        return self._hulls.of_body(self._pm_bodies[row])

    def _collide(self, one: Ints, other: Ints) -> Flags:
        """Tell which pairs do not pass through each other, and are not one island yet."""
        groups = self._groups
        found: Flags = self._collides[one] & self._collides[other]
        found &= self._movable[one] | self._movable[other]
        found &= self._islands[one] != self._islands[other]
        found &= (groups[one] == 0) | (groups[one] != groups[other])
        left = np.flatnonzero(found)
        apart = self._columns.not_colliding
        if len(apart) and len(left):
            a, b = np.concatenate((apart, apart[:, ::-1])).T
            keys = a * self._count + b
            places = self._places[one[left]], self._places[other[left]]
            found[left] = ~np.isin(places[0] * self._count + places[1], keys)
        return found

    def _approach(self, one: Ints, other: Ints) -> Floats:
        """Return (p,) by how far two bodies approach in the rest of the step, at most [m]."""
        length = np.hypot(*(self._velocities(one) - self._velocities(other)).T)
        turns = np.abs(self._motions.rates[:, 2])
        length += turns[one] * self._turning[one] + turns[other] * self._turning[other]
        since = np.maximum(self._motions.since[one], self._motions.since[other])
        approach: Floats = length * (1.0 - since)
        return approach

    def _velocities(self, rows: Ints) -> Floats:
        """Return (k, 2) the velocities of centres of mass where motions begin [m a step]."""
        rates = self._motions.rates[rows]
        arms = self._motions.poses[rows, :2] - self._motions.pivots[rows]
        return rates[:, :2] + rates[:, 2:] * np.column_stack((-arms[:, 1], arms[:, 0]))

    def _resolve(self, impacts: list[Impact]) -> Ints:
        """Join those that meet before anything near them does; return rows that move otherwise."""
        changed: list[int] = []
        boxes = self._swept.boxes
        passed, count = np.empty_like(boxes), 0
        # Islands with an earlier impact that is put off to the next round.
        waiting: set[int] = set()
        for impact in impacts:
            islands = [int(self._islands[row]) for row in impact[1:] if self._movable[row]]
            rows = [row for island in islands for row in self._members.get(island, [island])]
            # After an earlier impact nearby this one may not take place.
            if (
                not waiting.isdisjoint(islands)
                or boxes_overlap(boxes[rows][:, None], passed[:count]).any()
            ):
                waiting.update(islands)
                continue
            end = count + len(rows)
            passed[count:end], count = boxes[rows], end
            changed += self._join(impact)
        return np.array(changed, np.int64)

    def _join(self, impact: Impact) -> list[int]:
        """Let the islands of two rows go on as one; return the rows whose motions change."""
        rows: list[int] = []
        leaders: list[int] = []
        for row in impact[1:]:
            island = int(self._islands[row])
            if self._movable[row]:
                rows += self._members.pop(island, [row])
                if island in self._leaders:
                    leaders.append(self._leaders.pop(island))
            else:
                leaders.append(row)
        members = np.array(rows, np.int64)
        shares = np.full(len(rows), impact.share)
        motions = self._motions
        poses, pivots = motions.poses_at(members, shares)
        if leaders:
            # Anchored shapes come last: they stop what a kinematic body pushes against them.
            leader = max(leaders)
            _, (pivot,) = motions.poses_at(np.array([leader]), shares[:1])
            rate = motions.rates[leader]
            self._leaders[rows[0]] = leader
        else:
            pivot, rate = self._common_motion(members, poses, pivots)
        motions.since[members] = impact.share
        motions.poses[members] = poses
        motions.pivots[members] = pivot
        motions.rates[members] = rate
        self._members[rows[0]] = rows
        self._islands[members] = rows[0]
        self._swept.fit_boxes(members)
        return rows

    def _common_motion(self, rows: Ints, poses: Floats, pivots: Floats) -> tuple[Floats, Floats]:
        """
        Return how bodies go on as one, with the momentum and angular momentum that they have.

        :return: (2,) their centre of mass [m], and (3,) its way and their turn in a step [m, rad]
        """
        pm_bodies = [self._pm_bodies[row] for row in rows.tolist()]
        mass = np.array([pm_body.mass for pm_body in pm_bodies])[:, None]
        moment = np.array([pm_body.moment for pm_body in pm_bodies])
        moment[self._turning[rows] == 0.0] = 0.0
        rates = self._motions.rates[rows]
        arms = poses[:, :2] - pivots
        ways = rates[:, :2] + rates[:, 2:] * np.column_stack((-arms[:, 1], arms[:, 0]))
        center = (mass * poses[:, :2]).sum(axis=0) / mass.sum()
        way = (mass * ways).sum(axis=0) / mass.sum()
        arms = poses[:, :2] - center
        angular = (moment * rates[:, 2] + cross(arms, mass * (ways - way))).sum()
        total = (moment + mass[:, 0] * dots(arms, arms)).sum()
        return center, np.array([*way, angular / total if total > 0.0 else 0.0])
