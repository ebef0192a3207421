# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Assemblies: robots with parts, whose bodies are spawned, moved and deleted as one.

Laws: what is set of a body that a request names is as the request says; parts that it does not
name follow as if all were rigid. A part whose robot is gone is a body like any other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.errors import BadProperty, Exists
from physsim_ros.model.requests import Join, Spawn
from physsim_ros.model.robots import part_name, Robot, whole_of
from physsim_ros.model.scene import Body
from physsim_ros.model.transform import local_to_world, Pose, Twist, world_to_local


def check_new_parts(space: Space, links: Iterable[Spawn], joints: Iterable[Join]) -> None:
    """
    Refuse parts whose names are taken.

    :raises Exists: there is a body or joint of such a name
    """
    bodies = (link.name for link in links if link.name in space.bodies.by_name)
    for name in (*bodies, *(each.name for each in joints if each.name in space.joints.by_name)):
        raise Exists('the name {name} of a part of the robot is taken', field='name', name=name)


def check_same_parts(old: Body, new: Body) -> None:
    """
    Refuse a change of the parts of a robot.

    :raises BadProperty: there is one
    """
    if _parts(old.robot) != _parts(new.robot):
        template = 'the parts of {name} cannot be changed; delete it and spawn it again'
        raise BadProperty(template, field='robot', name=old.name)


def _parts(robot: Robot | None) -> tuple[object, object]:
    return ((), ()) if robot is None else (robot.links, robot.joints)


def members(space: Space, name: str) -> tuple[str, ...]:
    """Return the names of a robot's body and parts that are there, of which a body is one."""
    bodies = space.bodies.by_name

    def robot_of(each: str) -> Robot | None:
        return bodies[each].body.robot if each in bodies else None

    whole = whole_of(name, robot_of)
    robot = robot_of(whole)
    parts = () if robot is None else (part_name(whole, link.name) for link in robot.links)
    return whole, *(each for each in parts if each in bodies)


def all_members(space: Space, names: Iterable[str]) -> list[str]:
    """Return the names of bodies, and those of the robots of which they are parts, each once."""
    return [*dict.fromkeys(each for name in names for each in members(space, name))]


def placed_with_parts(space: Space, poses: Mapping[str, Pose]) -> dict[str, Pose]:
    """Return the poses of bodies that are set, and those of the parts that follow them."""
    placed = dict(poses)
    for leader, follower in _followers(space, poses):
        to = poses[leader.body.name]
        x, y = local_to_world(world_to_local(follower.pose[:2], leader.pose), to)
        placed[follower.body.name] = x, y, follower.pose[2] + (to[2] - leader.pose[2])
    return placed


def moving_with_parts(space: Space, twists: Mapping[str, Twist]) -> dict[str, Twist]:
    """Return the velocities of bodies that are set, and those of the parts that follow them."""
    moving = dict(twists)
    for leader, follower in _followers(space, twists):
        vx, vy, spin = twists[leader.body.name]
        (x, y), (at_x, at_y) = follower.center, leader.center
        moving[follower.body.name] = vx - spin * (y - at_y), vy + spin * (x - at_x), spin
    return moving


def _followers(space: Space, named: Mapping[str, object]) -> Iterator[tuple[RigidBody, RigidBody]]:
    """Yield a named body, and a part of the same robot that is not named and follows it."""
    bodies = space.bodies.by_name
    done: set[str] = set()
    for name in named:
        names = members(space, name)
        if names[0] in done:
            continue
        done.add(names[0])
        leader = names[0] if names[0] in named else name
        for each in names:
            if each not in named:
                yield bodies[leader], bodies[each]
