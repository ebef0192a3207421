# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for joints: which two bodies one means, where the joint sits on them, what is refused.

Laws: nothing is changed before all has been checked; a joint that is asked for where it already
is keeps its seat to the last bit, so that whoever publishes what is drawn changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
import math

from physsim_ros.engine.space import Space
from physsim_ros.model.errors import Anchored, BadProperty, NothingThere, UnknownJoint
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Axle, Join, JointRequest, Pin, Unjoin, UnjoinAll
from physsim_ros.model.scene import Joint, Seat
from physsim_ros.model.texts import nearest_name
from physsim_ros.model.transform import Point, Pose, rotated
from physsim_ros.simulation.world.capacity import Capacity
from physsim_ros.simulation.world.lookup import body_of_name, points_in_world

# Points that lie so near to where a joint is drawn are where it is [m]: what is drawn comes back
# in the digits of a double, and from a person's hand never.
_SAME = 1e-9
# A click within this share of a body's inner radius, and never less than so far [m], of a pin or
# an axle means it.
_NEAR_SHARE, _NEAR = 0.35, 0.1

# Pose of the background, which never moves.
BACKGROUND = (0.0, 0.0, 0.0)
_STRAIGHT = {JointKind.SPRING, JointKind.ROD, JointKind.ROPE}


def apply_joint_request(
    space: Space, request: JointRequest, capacity: Capacity
) -> tuple[str, str]:
    """
    Carry out a request for joints.

    :return: the joint concerned, or '', and a sentence that says what was done
    :raises Refusal: and nothing is changed
    """
    match request:
        case Join(points=points, frame=frame):
            return join(space, request, points_in_world(space, points, frame), capacity)
        case Unjoin(name=name):
            return unjoin(space, name)
        case UnjoinAll(namespace=namespace):
            return '', unjoin_all(space, namespace)
        case Pin(point=point, frame=frame) | Axle(point=point, frame=frame):
            kind = JointKind.PIN if isinstance(request, Pin) else JointKind.AXLE
            (point,) = points_in_world(space, (point,), frame)
            return pin(space, kind, point, capacity)


def join(
    space: Space, request: Join, points: tuple[Point, ...], capacity: Capacity
) -> tuple[str, str]:
    """
    Make a joint, or change the one of that name.

    :param points: in the world [m]
    :return: its name, and a sentence that says what was done
    :raises Refusal: and nothing is changed
    """
    old = space.joints.by_name.get(request.name)
    a, b, points = _members(space, request, points)
    _check_members(space, request.kind, a, b)
    kept = old.joint if old is not None and old.joint.kind is request.kind else None
    said = request.properties
    if kept is not None:
        said = replace(kept.properties, **said.explicit())
    if kept is not None and (kept.a, kept.b) == (a, b) and _is_at(space, kept, points):
        seat = kept.seat
        if request.properties.phase is not None or request.properties.ratio is not None:
            seat = seat._replace(phase=_phase(space, a, b, said))
    else:
        phase = _phase(space, a, b, said)
        seat = _seat(request.kind, points, _pose(space, a), _pose(space, b), phase)
    joint = Joint(name=request.name, kind=request.kind, a=a, b=b, seat=seat, properties=said)
    if old is None or old.joint != joint:
        capacity.check_joint(space.joints, joint)
        space.joints.check_springs({}, joint)
        # A rebuilt joint has no cached impulses; bodies on it would lose their warm start.
        space.join(joint)
    other = 'the background' if b == WORLD else b
    which = f'{request.kind} {request.name}'
    if old is not None:
        return request.name, f'changed {which} of {a} and {other}'
    return request.name, f'joined {a} to {other} by {which}'


def pin(space: Space, kind: JointKind, point: Point, capacity: Capacity) -> tuple[str, str]:
    """
    Join the two topmost bodies under a point, or the only one and the background.

    :param point: in the world [m]
    :return: the name of the joint, and a sentence that says what was done
    :raises NothingThere: there is no body
    :raises Anchored: forces move neither of them
    """
    number = 0
    while f'{kind}/{number}' in space.joints.by_name:
        number += 1
    request = Join(name=f'{kind}/{number}', kind=kind, points=(point,))
    return join(space, request, (point,), capacity)


def unjoin(space: Space, name: str) -> tuple[str, str]:
    """
    Remove a joint.

    :raises UnknownJoint: there is none of that name
    """
    if name not in space.joints.by_name:
        nearest = nearest_name(name, space.joints.by_name)
        raise UnknownJoint(f'there is no joint {name!r}{nearest}', field='name')
    space.unjoin(name)
    return name, f'deleted joint {name}'


def unjoin_all(space: Space, namespace: str | None) -> str:
    """Remove all joints, or all of a namespace, and say how many."""
    names = [
        name
        for name in space.joints.by_name
        if namespace is None or split_name(name)[0] == namespace
    ]
    for name in names:
        space.unjoin(name)
    return f'deleted {len(names)} joint{"" if len(names) == 1 else "s"}'


def loosen(space: Space, body: str, point: Point) -> list[str]:
    """Remove the pins and axles of a body that sit at a point of the world [m]; name them."""
    reach = max(_NEAR, _NEAR_SHARE * space.bodies.by_name[body].body.shape.form.inner)
    names = [
        name
        for name in space.joints.names_on(body)
        if (joint := space.joints.by_name[name].joint).kind in (JointKind.PIN, JointKind.AXLE)
        and math.dist(_drawn(space, joint)[0], point) <= reach
    ]
    for name in names:
        space.unjoin(name)
    return names


def drawn_points(joint: Joint, poses: Mapping[str, Pose]) -> tuple[Point, ...]:
    """
    Return the points of the world that a joint would be drawn with where it is now [m].

    :param poses: of the bodies, by name
    """
    seat = joint.seat
    x, y = _out(poses[joint.a], (seat.ax, seat.ay))
    if joint.kind.points == 1:
        return ((x, y),)
    pose_b = BACKGROUND if joint.b == WORLD else poses[joint.b]
    if joint.kind is JointKind.SLIDER:
        ux, uy = rotated((seat.ux, seat.uy), pose_b[2])
        return (x, y), (x + ux, y + uy)
    return (x, y), _out(pose_b, (seat.bx, seat.by))


def _members(
    space: Space, request: Join, points: tuple[Point, ...]
) -> tuple[str, str, tuple[Point, ...]]:
    """
    Return the two bodies that a request means, and the points, that of the first body first.

    :raises UnknownBody: a name is none of a body
    :raises NothingThere: no name is given, and no body is there
    """
    for field, name in (('a', request.a), ('b', request.b)):
        if name and name != WORLD:
            body_of_name(space, name, field)
    a, b = request.a, request.b
    first = [name for name in space.bodies.at(points[0]) if name != b]
    last = space.bodies.at(points[-1])
    if not a and not first:
        # A line drawn from the ceiling down to a body hangs the body.
        if request.kind in _STRAIGHT and b in ('', WORLD) and last:
            return last[0], WORLD, points[::-1]
        x, y = points[0]
        raise NothingThere(f'there is no body at ({x:g}, {y:g})', field='points')
    a = a or first[0]
    b = b or next((name for name in last if name != a), WORLD)
    return a, b, points


def _check_members(space: Space, kind: JointKind, a: str, b: str) -> None:
    """Refuse a joint of a body with itself, or of two that forces do not move."""
    if a == b:
        raise BadProperty(f'{a} cannot be joined to itself', field='b', body=a)
    bodies = [space.bodies.by_name[name].body for name in (a, b) if name != WORLD]
    if all(body.fixed for body in bodies):
        fixed = ' and '.join(
            f'{body.name} is {"anchored" if body.anchored else "kinematic"}' for body in bodies
        )
        other = '' if len(bodies) == 2 else ', and so is the background'
        message = f'{fixed}{other}; there is nothing for the {kind} to hold'
        raise Anchored(message, field='a', body=bodies[0].name if bodies else '')


def _seat(
    kind: JointKind, points: tuple[Point, ...], pose_a: Pose, pose_b: Pose, phase: float
) -> Seat:
    """Return the seat of a joint that is drawn with these points."""
    ux = uy = 0.0
    at_b = points[-1]
    if kind is JointKind.SLIDER:
        (x1, y1), (x2, y2) = points
        length = math.dist(*points)
        ux, uy = rotated(((x2 - x1) / length, (y2 - y1) / length), -pose_b[2])
        at_b = points[0]
    length = math.dist(points[0], at_b)
    return Seat(*_into(pose_a, points[0]), *_into(pose_b, at_b), ux, uy, phase, length)


def _phase(space: Space, a: str, b: str, said: JointProperties) -> float:
    """
    Return the phase of a gear [rad].

    :param said: with the phase, to which as many whole turns are added as the bodies have made;
        without it, the phase is the present one
    """
    ratio = 1.0 if said.ratio is None else said.ratio
    now = ratio * _pose(space, b)[2] - _pose(space, a)[2]
    if said.phase is None:
        return now
    return said.phase + math.tau * round((now - said.phase) / math.tau)


def _is_at(space: Space, joint: Joint, points: tuple[Point, ...]) -> bool:
    """Return whether a joint would be drawn with these points now."""
    drawn = _drawn(space, joint)
    if joint.kind is JointKind.SLIDER:
        # Its second point says no more than where its line leads.
        x, y = points[0]
        length = math.dist(*points)
        points = (
            points[0],
            (x + (points[1][0] - x) / length, y + (points[1][1] - y) / length),
        )
    size = 1.0 + max(abs(number) for point in drawn for number in point)
    return all(
        math.dist(here, there) <= _SAME * size for here, there in zip(drawn, points, strict=True)
    )


def _drawn(space: Space, joint: Joint) -> tuple[Point, ...]:
    return drawn_points(joint, {name: _pose(space, name) for name in (joint.a, joint.b)})


def _pose(space: Space, name: str) -> Pose:
    return BACKGROUND if name == WORLD else space.bodies.by_name[name].pose


def _out(pose: Pose, point: Point) -> Point:
    """Return a point of a body's frame as a point of the world."""
    x, y = rotated(point, pose[2])
    return pose[0] + x, pose[1] + y


def _into(pose: Pose, point: Point) -> Point:
    """Return a point of the world as a point of a body's frame."""
    return rotated((point[0] - pose[0], point[1] - pose[1]), -pose[2])
