# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for the parts of a robot that is spawned."""

from __future__ import annotations

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests.bodies import Spawn
from physsim_ros.model.requests.joints import Join
from physsim_ros.model.robots import part_name
from physsim_ros.model.transform import composed, local_to_world


def parts_of(spawn: Spawn) -> tuple[list[Spawn], list[Join]]:
    """Return the requests for the parts of a robot that is spawned, points in the world."""
    robot = spawn.properties.robot
    if robot is None:
        return [], []
    links = [
        Spawn(
            name=part_name(spawn.name, link.name),
            shape=link.shape,
            pose=composed(spawn.pose, link.at),
            color=link.color or spawn.color,
            lifetime=spawn.lifetime,
            properties=Properties(
                mass=link.mass,
                density=link.density,
                friction=link.friction,
                elasticity=link.elasticity,
                towed=link.towed,
            ),
        )
        for link in robot.links
    ]
    joints = [
        Join(
            name=part_name(spawn.name, joint.name),
            kind=joint.kind,
            points=tuple(local_to_world(point, spawn.pose) for point in joint.points),
            a=part_name(spawn.name, joint.a),
            b=part_name(spawn.name, joint.b),
            properties=joint.properties_of(spawn.name),
        )
        for joint in robot.joints
    ]
    return links, joints
