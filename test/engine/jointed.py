# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Short words for the tests of joints: two boxes, and what joins them."""

from __future__ import annotations

from typing import Any

from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import (
    Join,
)
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World

from ..building import BOX, spawn

KINDS = list(JointKind)
PROPERTIES: dict[JointKind, dict[str, Any]] = {
    JointKind.AXLE: {'lower': -1.0, 'upper': 2.0},
    JointKind.MOTOR: {'rate': -3.0, 'max_torque': 5.0},
    JointKind.SPRING: {'stiffness': 20.0, 'damping': 0.5, 'rest_length': 0.7},
    JointKind.ROPE: {'length': 2.5},
    JointKind.SLIDER: {'lower': -0.2, 'upper': 0.4},
    JointKind.GEAR: {'ratio': -2.0},
}


def joining(
    kind: JointKind | str, points: list[Point], name: str = 'joint/0', **said: Any
) -> Join:
    where = {key: said.pop(key) for key in ('a', 'b', 'frame') if key in said}
    return Join(
        name=name,
        kind=JointKind(kind),
        points=tuple(points),
        properties=JointProperties(**said),
        **where,
    )


def points_of(kind: JointKind) -> list[Point]:
    points: list[Point] = [(0.4, 0.0), (1.4, 0.0)]
    return points[: kind.points]


def pair() -> World:
    """Return a world of two boxes, a/0 below and a/1 above it at half a metre."""
    world = World()
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.3))
    spawn(world, 'a/1', BOX, (0.8, 0.0, -0.2))
    return world


def joints(world: World) -> tuple[Joint, ...]:
    return world.snapshot().scene.joints


def members(world: World) -> tuple[str, str]:
    (joint,) = joints(world)
    return joint.a, joint.b
