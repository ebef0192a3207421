# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Short words for the tests of joints: two boxes, and what joins them."""

from typing import Any

from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World

from ..building import BOX, spawn

KINDS = list(JointKind)
# Values of properties, other than those that a joint has by default or as drawn.
VALUES: dict[str, float] = {
    'lower': -0.2,
    'upper': 0.4,
    'rate': -3.0,
    'max_torque': 5.0,
    'effort': 3.0,
    'max_speed': 2.0,
    'gain': 10.0,
    'stiffness': 20.0,
    'damping': 0.5,
    'rest_length': 0.7,
    'rest_angle': 0.3,
    'friction': 0.2,
    'length': 2.5,
    'ratio': -2.0,
}
PROPERTIES: dict[JointKind, dict[str, Any]] = {
    kind: {name: VALUES[name] for name in kind.schema.own if name in VALUES} for kind in KINDS
}
# A slider has either a rate or an effort.
del PROPERTIES[JointKind.SLIDER]['rate']


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
