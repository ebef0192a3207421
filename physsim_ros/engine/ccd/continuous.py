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
Continuous collision: the coming step of fast bodies ends where they first hit something.

The engine tests for overlap only where a step ends. Pairs that approach by more than a safe depth
in a step are found by a broad phase of swept boxes, and advanced to their time of impact. For the
rest of the step the two move as one rigid body with their common momentum and angular momentum
(a perfectly plastic impact, of the positions only): a light body is carried along by a heavy one
and by a kinematic one, and stops at an anchored one. The engine then finds the contact where the
step ends, and resolves it from the velocities, which stay as they are.

Laws: a centre of mass keeps its way but at what is anchored; a pair that overlaps is stopped only
where it would come deeper; islands that do not meet do not know of each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
import itertools
from typing import cast, NamedTuple

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.broad_phase import boxes_overlap, overlapping_pairs
from physsim_ros.engine.ccd.time_of_impact import (
    first_impacts,
    Hull,
    hull,
    Motions,
    Pairs,
    SLOP,
)
from physsim_ros.engine.step_context import StepContext
from physsim_ros.engine.work_correction import is_jointed, take_back_work
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import turned
import pymunk
from pymunk import Vec2d

# Impacts one after the other in a step that a body takes part in, at most: so many may touch in a
# row before a wall. The engine's own result holds for what is left.
ROUNDS = 10
# So few fast bodies have their boxes compared first: it saves the rest, and changes no result.
FEW = 8


class _Standing(NamedTuple):
    """
    Shapes that never move.

    :ivar hulls: in the world
    :ivar boxes: (s, 4) float64: left, bottom, right, top [m]
    :ivar places: (s,) int64: of their bodies in the listing; -1 is the background
    """

    hulls: list[Hull]
    boxes: Floats
    places: Ints


class _Impact(NamedTuple):
    """Two rows that meet, and at which share of the step."""

    share: float
    one: int
    other: int


class ContinuousCollision:
    """
    Ends the coming step of fast bodies where they first hit something.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._table: BodyTable | None = None
        self._standing: _Standing | None = None
        self._hulls: dict[pymunk.Body, list[Hull]] = {}

    def invalidate(self) -> None:
        """Read shapes anew: a body that never moves by itself has been moved."""
        self._table = None

    def clamp_moves(self, context: StepContext) -> None:
        """Set back bodies by what they may not go in the coming step of the engine."""
        table, columns, dt = context.table, context.table.columns, context.dt
        moves = context.twists * dt
        lengths = np.hypot(moves[:, 0], moves[:, 1]) + np.abs(moves[:, 2]) * columns.turning_radii
        fast = columns.solid & (lengths > columns.safe_depths.min(initial=np.inf))
        if not fast.any():
            return
        if self._table is not table or self._standing is None:
            self._table, self._standing = table, _standing(self._space, table)
            self._hulls.clear()
        rows = np.flatnonzero(fast)
        if len(rows) <= FEW and not _boxes_meet(table, self._standing, moves, rows):
            return
        step = _Step(table, self._standing, moves, self._hulls_of)
        for row, shift in step.shifts(fast):
            engine = table.bodies[row].engine
            back = Vec2d(*shift[:2].tolist())
            engine.position += back
            engine.angle += float(shift[2])
            if not is_jointed(self._space, engine):
                way = Vec2d(*moves[row, :2].tolist())
                # As far as another body carries it, that is none of its own way.
                share = -way.dot(back) / max(way.dot(way), 1e-300)
                take_back_work(self._space, engine, -way * min(max(share, 0.0), 1.0), dt)
                context.twists[row] = *engine.velocity, engine.angular_velocity
            table.forget_state()

    def _hulls_of(self, engine: pymunk.Body) -> list[Hull]:
        """Return the hulls of a body, in its own frame."""
        if engine not in self._hulls:
            self._hulls[engine] = [hull(shape) for shape in engine.shapes]
        return self._hulls[engine]


def _boxes_meet(table: BodyTable, standing: _Standing, moves: Floats, rows: Ints) -> bool:
    """
    Return whether the swept box of a body overlaps that of another, or a static shape.

    :param moves: (n, 3) float64: of all bodies in the step [m, rad]
    :param rows: of the bodies in question
    """
    starts = table.state[:, :2]
    ends = starts + np.where(table.columns.solid[:, None], moves[:, :2], 0.0)
    reach = table.columns.reach[:, None]
    boxes = np.concatenate((np.minimum(starts, ends) - reach, np.maximum(starts, ends) + reach), 1)
    # Anchored bodies are among the static shapes; each other one overlaps itself.
    solid = boxes[table.columns.solid]
    return any(
        np.count_nonzero(boxes_overlap(boxes[row], solid)) > 1
        or boxes_overlap(boxes[row], standing.boxes).any()
        for row in rows.tolist()
    )


class _Step:
    """
    Motions of all bodies in one step, from impact to impact.

    A row is a row of the table, then come shapes that never move. Bodies that have
    met move on as one island: the rows of an island are `members` of its first row. An island that
    has met an anchored or kinematic body moves as that does, its `leader`.
    """

    def __init__(
        self,
        table: BodyTable,
        standing: _Standing,
        moves: Floats,
        hulls_of: Callable[[pymunk.Body], list[Hull]],
    ) -> None:
        self._engines = [rigid.engine for rigid in table.bodies]
        self._columns = columns = table.columns
        poses = table.state[:, :3]
        self._standing = standing
        self._hulls_of = hulls_of
        count, more = len(poses), len(standing.hulls)
        self._count = count
        ending, none = (0, more), (0, 0)
        self._collides = np.pad(columns.solid, ending, constant_values=True)
        self._turning = np.pad(columns.turning_radii, ending)
        self._movable = np.pad(columns.dynamic[:-1], ending)
        self._places = np.concatenate((np.arange(count), standing.places))
        # The background, in place -1, is in no group.
        self._depths = np.append(columns.safe_depths, np.inf)[self._places]
        self._groups = np.append(columns.groups, 0)[self._places]
        poses = np.pad(poses, (ending, none))
        rates = np.pad(np.where(columns.solid[:, None], moves, 0.0), (ending, none))
        # A turning disc covers the same ground.
        rates[self._turning == 0.0, 2] = 0.0
        self._motions = Motions(np.zeros(count + more), poses, poses[:, :2].copy(), rates)
        self._ends = poses + rates
        self._boxes = np.concatenate((np.empty((count, 4)), standing.boxes))
        self._fit_boxes(np.arange(count))
        self._islands = np.arange(count + more)
        self._members: dict[int, list[int]] = {}
        self._leaders: dict[int, int] = {}

    def shifts(self, fast: Flags) -> Iterable[tuple[int, Floats]]:
        """
        Return the places of bodies that end elsewhere than in the engine, and by how far.

        :param fast: (m,) bool: bodies that could meet others unseen by the engine
        :return: rows, and (3,) float64 shifts [m, rad]
        """
        impacts: list[_Impact] = []
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
        return zip(rows.tolist(), shifts, strict=True)

    def _fit_boxes(self, rows: Ints) -> None:
        """Bound the ways of bodies from where their motions begin to the end of the step."""
        starts = self._motions.poses[rows, :2]
        ends = self._motions.poses_at(rows, np.ones(len(rows)))[0][:, :2]
        # Height of the arc over its chord, at most.
        arm = np.hypot(*(starts - self._motions.pivots[rows]).T)
        margin = self._columns.reach[rows] + arm * self._motions.rates[rows, 2] ** 2 / 8
        self._boxes[rows, :2] = np.minimum(starts, ends) - margin[:, None]
        self._boxes[rows, 2:] = np.maximum(starts, ends) + margin[:, None]

    def _impacts(self, changed: Ints) -> list[_Impact]:
        """Return the impacts to come of rows whose motions have changed."""
        first = np.zeros(len(self._boxes), np.bool_)
        first[changed] = True
        one, other = overlapping_pairs(self._boxes, first)
        keep = self._collide(one, other)
        one, other = one[keep], other[keep]
        depth = np.minimum(self._depths[one], self._depths[other])
        keep = self._approach(one, other) > depth
        one, other, depth = one[keep], other[keep], depth[keep]
        pairs: list[int] = []
        hulls: tuple[list[Hull], list[Hull]] = [], []
        for pair, (a, b) in enumerate(zip(one.tolist(), other.tolist(), strict=True)):
            for piece in itertools.product(self._hulls(a), self._hulls(b)):
                pairs.append(pair)
                for side, each in zip(hulls, piece, strict=True):
                    side.append(each)
        if not pairs:
            return []
        radii = np.array([a.radius + b.radius for a, b in zip(*hulls, strict=True)])
        skin = np.minimum(SLOP, depth[pairs])
        skin = np.where(radii > 0.0, np.minimum(skin, radii / 2), skin)
        rows = one[pairs], other[pairs]
        shares = first_impacts(self._motions, Pairs(rows, hulls, skin, depth[pairs]))
        earliest = np.full(len(one), np.inf)
        np.minimum.at(earliest, pairs, shares)
        return [
            _Impact(float(earliest[pair]), int(one[pair]), int(other[pair]))
            for pair in np.flatnonzero(np.isfinite(earliest)).tolist()
        ]

    def _hulls(self, row: int) -> list[Hull]:
        if row >= self._count:
            return [self._standing.hulls[row - self._count]]
        return self._hulls_of(self._engines[row])

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
            keys = np.concatenate((apart, apart[:, ::-1])) @ (self._count, 1)
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

    def _resolve(self, impacts: list[_Impact]) -> Ints:
        """Join those that meet before anything near them does; return rows that move otherwise."""
        changed: list[int] = []
        passed: list[list[float]] = []
        for impact in impacts:
            rows = [
                member
                for row in impact[1:]
                if self._movable[row]
                for member in self._members.get(int(self._islands[row]), [row])
            ]
            # After an earlier impact nearby this one may not take place.
            if not boxes_overlap(self._boxes[rows][:, None], np.reshape(passed, (-1, 4))).any():
                passed += self._boxes[rows].tolist()
                changed += self._join(impact)
        return np.array(changed, np.int64)

    def _join(self, impact: _Impact) -> list[int]:
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
            # Anchored bodies come last, and hold what a kinematic one pushes against them.
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
        self._fit_boxes(members)
        return rows

    def _common_motion(self, rows: Ints, poses: Floats, pivots: Floats) -> tuple[Floats, Floats]:
        """
        Return how bodies go on as one, with the momentum and angular momentum that they have.

        :return: (2,) their centre of mass [m], and (3,) its way and their turn in a step [m, rad]
        """
        engines = [self._engines[row] for row in rows.tolist()]
        mass = np.array([engine.mass for engine in engines])
        moment = np.array([engine.moment for engine in engines])
        moment[self._turning[rows] == 0.0] = 0.0
        rates = self._motions.rates[rows]
        arms = poses[:, :2] - pivots
        ways = rates[:, :2] + rates[:, 2:] * np.column_stack((-arms[:, 1], arms[:, 0]))
        center, way = mass @ poses[:, :2] / mass.sum(), mass @ ways / mass.sum()
        arms = poses[:, :2] - center
        momentum = mass[:, None] * (ways - way)
        angular = moment @ rates[:, 2]
        angular += (arms[:, 0] * momentum[:, 1] - arms[:, 1] * momentum[:, 0]).sum()
        total = moment.sum() + mass @ (arms**2).sum(axis=1)
        return center, np.array([*way, angular / total if total > 0.0 else 0.0])


def _standing(space: pymunk.Space, table: BodyTable) -> _Standing:
    """Return all shapes that never move, but sensors."""
    shapes = [(shape, -1) for shape in space.static_body.shapes]
    for row, rigid in enumerate(table.bodies):
        if rigid.body.anchored and not rigid.body.sensor:
            shapes += [(shape, row) for shape in rigid.engine.shapes]
    hulls = []
    for shape, _ in shapes:
        body, local = cast('pymunk.Body', shape.body), hull(shape)
        corners = turned(local.corners, np.array(body.angle)) + np.array(body.position)
        normals = turned(local.normals, np.array(body.angle))
        hulls.append(Hull(corners, normals, local.radius, 0.0))
    return _Standing(
        hulls=hulls,
        boxes=np.array([tuple(shape.bb) for shape, _ in shapes], np.float64).reshape(-1, 4),
        places=np.array([place for _, place in shapes], np.int64),
    )
