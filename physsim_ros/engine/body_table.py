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
Rows: what is constant about all bodies until one comes, goes or changes, in arrays.

The world lists bodies in spawn order, the engine in an order of its own that changes whenever one
comes or goes; here the two meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.body import REST, RigidBody
from physsim_ros.engine.ccd import continuous
from physsim_ros.engine.islands import Rows, spread
from physsim_ros.engine.joints import is_exact
from physsim_ros.engine.stages import resting_damping
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.scene import Scene


@dataclass(slots=True, eq=False)
class Layout:
    """
    What is constant for the rows of all bodies until one comes, goes or changes.

    :param scene: the bodies, in spawn order
    :param rows: name -> row
    :param ids: (n,): the engine's ids of the bodies, ascending
    :param id_rows: (n,): the row of each of them
    :param order: for each row, its place in the engine's own listing
    :param listed: for each place in the engine's listing, its body; None for walls
    :param depths: (n,): how far each body may move in a step without a sweep [m]
    :param safe: for each place, the speed up to which no sweep is needed [m/s]
    :param arm: for each place, what turns a spin into a speed that counts for that [m]
    :param group: for each place, the group of bodies that pass through each other; 0 is none
    :param apart: (j, 2): places of bodies that a joint keeps from colliding
    :param unswept: while no velocity [m/s] and no spin [rad/s] is greater, all are that slow
    :param loose: (n,) bool: whether forces move the body
    :param joined: (j,) and (j,): places of what joints hold together, the background's last
    :param hung: (n,) bool: hangs by joints that give way, so that its velocity never leads
    :param offsets: (n, 2): the engine's origin in the body's frame [m]
    :param lead: (n, 3): how far the engine's velocity leads in free flight
    :param free: (n,) bool: in free flight; changes from frame to frame
    :param ground: what `stillness` has to know of the bodies
    :param expiries: step -> names of the bodies that go at its end
    :param state: (n, 6): poses and velocities of the engine's origins; None where they have
        changed since they were read
    """

    scene: Scene
    rows: dict[str, int]
    ids: Ids
    id_rows: Ints
    order: NDArray[np.intp]
    listed: tuple[RigidBody | None, ...]
    depths: Floats
    safe: Floats
    arm: Floats
    group: Ints
    apart: Ints
    unswept: float
    loose: NDArray[np.bool_]
    joined: tuple[Rows, Rows]
    hung: NDArray[np.bool_]
    offsets: Floats
    lead: Floats
    free: NDArray[np.bool_]
    ground: resting_damping.Ground
    expiries: dict[int, list[str]]
    state: Floats | None = None

    @property
    def engine_ids(self) -> Ids:
        """Return (n,) the engine's ids of the bodies, in spawn order."""
        ids = np.empty_like(self.ids)
        ids[self.id_rows] = self.ids
        return ids

    def depth(self, rigid: RigidBody) -> float:
        """Return how far a body may move in a step without a sweep [m]."""
        return float(self.depths[self.rows[rigid.body.name]])

    def flatten_flight(self) -> None:
        """Give every body its own note of whether it is in free flight."""
        for place, free in zip(self.order.tolist(), self.free.tolist(), strict=True):
            rigid = self.listed[place]
            if rigid is not None:
                rigid.free = free


def lay_out(
    scene: Scene, rigids: Sequence[RigidBody], listing: Sequence[int], dt: float
) -> Layout:
    """
    Lay bodies out in rows.

    :param scene: what they are
    :param rigids: in spawn order
    :param listing: the engine's ids, in the order of its own listing
    :param dt: of a step [s]
    """
    rows = _rows(scene, dt)
    places = {id_: place for place, id_ in enumerate(listing)}
    ids = np.array([rigid.engine.id for rigid in rigids], dtype=np.uintp)
    order = np.array([places[id_] for id_ in ids.tolist()], dtype=np.intp)
    ascending = np.argsort(ids)
    listed: list[RigidBody | None] = [None] * len(listing)
    for rigid, place in zip(rigids, order.tolist(), strict=True):
        listed[place] = rigid
    all_places = np.append(order, len(listing))
    safe, arm = np.full(len(listing), np.inf), np.zeros(len(listing))
    group = np.zeros(len(listing), np.int64)
    safe[order], arm[order], group[order] = rows.safe, rows.arm, rows.group
    lead = rows.lead.copy()
    for row, rigid in enumerate(rigids):
        if rigid.wrench != REST:
            lead[row] = rigid.lead(scene.settings.gravity, dt)
    return Layout(
        scene=scene,
        rows=rows.names,
        ids=ids[ascending],
        id_rows=ascending,
        order=order,
        listed=tuple(listed),
        depths=rows.depths,
        safe=safe,
        arm=arm,
        group=group,
        apart=order[rows.apart],
        # The length of a vector is at most 1.42 times its greater coordinate.
        unswept=float((safe / (1.42 + arm)).min(initial=np.inf)),
        loose=rows.loose,
        joined=(all_places[rows.joined[0]], all_places[rows.joined[1]]),
        hung=rows.hung,
        offsets=rows.offsets,
        lead=lead,
        free=np.array([rigid.free for rigid in rigids], dtype=np.bool_),
        ground=resting_damping.ground(listed, listing, scene.settings.friction),
        expiries=rows.expiries,
    )


class _Rows(NamedTuple):
    """
    What is constant about the rows of a scene, in whatever order the engine lists them.

    The fields are those of `Layout`, in spawn order.
    """

    names: dict[str, int]
    depths: Floats
    safe: Floats
    arm: Floats
    group: Ints
    apart: Ints
    loose: NDArray[np.bool_]
    joined: tuple[Rows, Rows]
    hung: NDArray[np.bool_]
    offsets: Floats
    lead: Floats
    expiries: dict[int, list[str]]


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def _rows(scene: Scene, dt: float) -> _Rows:
    bodies = scene.bodies
    anchored = np.array([body.anchored for body in bodies], dtype=np.bool_)
    swept = ~anchored & ~np.array([body.sensor for body in bodies], dtype=np.bool_)
    loose = np.array([not body.fixed for body in bodies], dtype=np.bool_)
    lead = np.where(
        loose[:, None], (*(half * dt / 2 for half in scene.settings.gravity), 0.0), 0.0
    )
    depths = continuous.safe_depths(bodies)
    expiries: dict[int, list[str]] = {}
    for body in bodies:
        if body.expires is not None:
            expiries.setdefault(body.expires, []).append(body.name)
    names = {name: row for row, name in enumerate(scene.names)}
    # With the background, which has no row, a body always collides.
    apart = [
        (names[joint.a], names[joint.b])
        for joint in scene.joints
        if joint.b in names and not joint.collide
    ]
    ends = [(names[joint.a], names.get(joint.b, len(names))) for joint in scene.joints]
    one, other = np.array(ends, np.intp).reshape(-1, 2).T
    yielding = np.array([not is_exact(joint) for joint in scene.joints], dtype=np.bool_)
    return _Rows(
        names=names,
        depths=depths,
        safe=np.where(swept, depths / dt, np.inf),
        arm=np.where(swept, [continuous.arm(body) for body in bodies], 0.0),
        group=np.array([body.group for body in bodies], np.int64),
        apart=np.array(apart, np.int64).reshape(-1, 2),
        loose=loose,
        joined=(one, other),
        hung=_hung(np.append(loose, False), one, other, yielding),
        offsets=np.where(anchored[:, None], 0.0, scene.centroids),
        lead=lead,
        expiries=expiries,
    )


def _hung(
    loose: NDArray[np.bool_], one: Rows, other: Rows, yielding: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """
    Return (n,) bool: what hangs on something that forces do not move, and not by exact joints.

    :param loose: (n + 1,) whether forces move it; the background comes last
    :param one: (j,) of each joint
    :param other: (j,) of each joint
    :param yielding: (j,) whether it gives way
    """
    inner = loose[one] & loose[other]

    def together(joints: NDArray[np.bool_]) -> NDArray[np.bool_]:
        marked = np.zeros(len(loose), np.bool_)
        marked[one[joints]] = marked[other[joints]] = True
        return spread(marked & loose, one[inner], other[inner])

    return (together(~inner) & together(yielding))[:-1]
