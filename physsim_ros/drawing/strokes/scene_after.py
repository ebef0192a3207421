# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The scene that the requests of a reading will make, for earlier strokes that are read anew."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.model.body_description import new_body
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.scene import Joint, seat_of
from physsim_ros.model.transform import ORIGIN, REST


def scene_after(
    requests: Iterable[Request], scene: SceneQuery, *, without: Collection[str] = ()
) -> SceneQuery:
    """
    Return a scene with the new bodies of requests, at rest, and their axles.

    The names of their other joints are taken, too.

    :param without: names of bodies that have no joints, and are left out
    """
    requests = list(requests)
    spawned = [each for each in requests if isinstance(each, Spawn)]
    joins = {each.name: each for each in requests if isinstance(each, Join)}
    before = scene.snapshot
    rows = [row for row, name in enumerate(scene.names) if name not in without]
    bodies = (
        *(before.scene.bodies[row] for row in rows),
        *(new_body(each, scene.settings, None)[0] for each in spawned),
    )
    with_bodies = SceneQuery(
        replace(
            before,
            scene=replace(before.scene, bodies=bodies),
            poses=np.vstack((before.poses[rows], *(each.pose for each in spawned))),
            twists=np.vstack((before.twists[rows], *(REST for _ in spawned))),
        )
    )
    there = {WORLD, *with_bodies.names}
    axles = (each for each in joins.values() if each.kind is JointKind.AXLE)
    joints = (
        *(each for each in scene.joints if each.name not in joins),
        *(_axle(each, with_bodies) for each in axles if {each.a, each.b} <= there),
    )
    after = with_bodies.snapshot
    taken = (number for space, number in map(split_name, joins) if space == DRAWN)
    return SceneQuery(
        replace(after, scene=replace(after.scene, joints=joints)),
        first=split_name(scene.next_body())[1],
        first_joint=max(split_name(scene.next_joint())[1], 1 + max(taken, default=-1)),
    )


def _axle(request: Join, scene: SceneQuery) -> Joint:
    """Return the description of an axle."""
    pose_a, pose_b = (
        ORIGIN if name == WORLD else scene.pose(name) for name in (request.a, request.b)
    )
    return Joint(
        name=request.name,
        kind=request.kind,
        a=request.a,
        b=request.b,
        seat=seat_of(request.kind, request.points, pose_a, pose_b, 0.0),
        properties=request.properties,
    )
