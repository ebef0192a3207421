# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for copies of bodies, of whole robots and of machines, at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Malformed, no_body
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Command, Join, Request, Spawn
from physsim_ros.model.scene import Body
from physsim_ros.model.transform import Point, Pose


def copy_machine(names: Sequence[str], by: Point, scene: SceneQuery) -> tuple[Request, ...]:
    """
    Return the requests for copies of bodies, at rest, and of the joints among them.

    Of a robot that has parts, one of which is named, the whole is copied. A joint to the
    background is copied with its body. Limits of a copied joint count from where its bodies are
    now.

    :param names: of the bodies
    :param by: vector from each body to its copy [m]
    :raises UnknownBody: there is no such body
    :raises Malformed: one is named twice
    """
    requests, copies = _copies(_known(names, scene), by, scene)
    poses = {name: scene.pose(name) for name in copies}
    # A robot is spawned with its joints.
    own = {joint for name in copies for joint in scene.joints_of_robot(name)}
    copies[WORLD] = WORLD
    among = [
        joint
        for joint in scene.joints
        if joint.a in copies and joint.b in copies and joint.name not in own
    ]
    for copied, joint in zip(scene.new_joints(), among, strict=False):
        points, lengths = joint.drawn_points(poses), joint.drawn_values()
        join = Join(
            name=copied,
            kind=joint.kind,
            points=tuple((x + by[0], y + by[1]) for x, y in points),
            a=copies[joint.a],
            b=copies[joint.b],
            # Lengths that were measured when it was drawn are those of the copy, too.
            properties=replace(joint.properties, **dict[str, Any](lengths)),
        )
        requests.append(join)
    return tuple(requests)


def copy_of(name: str, body: Body, pose: Pose) -> Spawn:
    """
    Return the request for a copy of a body, at rest and without a lifetime.

    The namespace of a robot is that of its new name.

    :param name: of the new body
    :param pose: of the new body's origin [m, rad]
    """
    properties = Properties.from_mapping(body.entry())
    if properties.robot is not None:
        properties = replace(properties, robot=replace(properties.robot, namespace=None))
    return Spawn(name=name, shape=body.shape, pose=pose, color=body.color, properties=properties)


def _copies(
    names: Sequence[str], by: Point, scene: SceneQuery
) -> tuple[list[Request], dict[str, str]]:
    """
    Return the requests for copies of bodies and whole robots, and the copy of each name.

    The parts of a robot are spawned with it, and then set to where those of the original are.
    """
    requests: list[Request] = []
    copies: dict[str, str] = {}
    wholes = dict.fromkeys(scene.whole(name) for name in names)
    for copied, name in zip(scene.new_bodies(), wholes, strict=False):
        members = name, *scene.parts(name)
        copies |= {each: copied + each.removeprefix(name) for each in members}
        moved = [(x + by[0], y + by[1], yaw) for x, y, yaw in map(scene.pose, members)]
        requests.append(copy_of(copied, scene.body(name), moved[0]))
        if len(members) > 1:
            placed = tuple(copies[each] for each in members)
            requests.append(Command(names=placed, poses=np.array(moved)))
    return requests, copies


def _known(names: Sequence[str], scene: SceneQuery) -> Sequence[str]:
    """
    Return names of bodies.

    :raises UnknownBody: there is no such body
    :raises Malformed: one is named twice
    """
    known = set(scene.names)
    for name in names:
        if name not in known:
            raise no_body(name, scene.names, 'names')
    if len(set(names)) < len(names):
        raise Malformed('a body is named twice', field='names')
    return names
