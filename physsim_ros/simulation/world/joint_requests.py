# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for joints: the two bodies of a joint, its seat on them, and refusals.

Laws: everything is checked before anything is changed. A joint that is requested where it already
is keeps its seat to the bit, so that markers which are published back change nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from itertools import starmap
import math

from physsim_ros.engine.space import Space
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Anchored, BadProperty, no_joint, nothing_at
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.motor_command import TimedCommand
from physsim_ros.model.names import names_in, shown_end, WORLD
from physsim_ros.model.requests import Axle, CommandMotors, Join, Pin, Rejoin, Unjoin, UnjoinAll
from physsim_ros.model.rope_path import arc, side, spans
from physsim_ros.model.scene import Guide, Joint, seat_of
from physsim_ros.model.shapes import Disc
from physsim_ros.model.transform import (
    ORIGIN,
    Point,
    Pose,
    world_to_local,
)
from physsim_ros.model.translation import counted, Text
from physsim_ros.simulation.world.live_space import LiveSpace
from physsim_ros.simulation.world.lookup import are_same, body_of_name, points_in_world


def join(live: LiveSpace, request: Join) -> Answer:
    """Make a joint, or change the one of that name."""
    space = live.space
    points = points_in_world(space, request.points, request.frame)
    old = space.joints.by_name.get(request.name)
    a, b, points = _members(space, request, points)
    kept = old.joint if old is not None and old.joint.kind is request.kind else None
    properties, passed = request.properties, points[1:-1] if request.kind.schema.passes else ()
    if kept is not None:
        changes = dict.fromkeys(request.unset) | properties.explicit()
        properties = replace(kept.properties, **changes)
    if passed:
        names = _passed_bodies(space, properties.over, passed)
        properties = replace(properties, over=names)
        points = (points[0], *map(partial(_center, space), names, passed), points[-1])
    _check_carrier(space, (a, b), properties.carrier)
    _check_members(space, request.kind, (a, *properties.guides, b))
    if (
        kept is not None
        and (kept.a, kept.b, kept.properties.guides) == (a, b, properties.guides)
        and _is_at(space, kept, points)
    ):
        seat, guides = kept.seat, kept.guides
        if not {'phase', 'ratio'}.isdisjoint((*request.properties.explicit(), *request.unset)):
            seat = seat._replace(phase=_phase(space, a, b, properties))
    else:
        phase = _phase(space, a, b, properties)
        seat = seat_of(request.kind, points, _pose(space, a), _pose(space, b), phase)
        guides, length = _rope(space, properties.over or (), points)
        seat = seat._replace(length=length) if guides else seat
        guides = guides or tuple(Guide(name, 0.0, 0.0) for name in properties.guides)
    joint = Joint(
        name=request.name,
        kind=request.kind,
        a=a,
        b=b,
        seat=seat,
        properties=properties,
        guides=guides,
    )
    if old is None or old.joint != joint:
        live.capacity.check_joint(joint)
        # Only if it differs: a joint that is built anew has no cached impulses to warm start from.
        space.join(joint)
    values = {'kind': Text(request.kind), 'joint': request.name, 'a': a, 'b': shown_end(b)}
    if old is not None:
        message = Text('changed {kind} {joint} of {a} and {b}', **values)
    else:
        message = Text('joined {a} to {b} by {kind} {joint}', **values)
    return Answer(subject=request.name, message=message)


def rejoin(live: LiveSpace, request: Rejoin) -> Answer:
    """
    Put a joint on pieces of its bodies, with its seat.

    :raises UnknownJoint: there is none of that name
    :raises UnknownBody: there is no body of a name
    """
    space = live.space
    check_names(space, (request.name,), 'name')
    for field, name in (('a', request.a), ('b', request.b)):
        if name != WORLD:
            body_of_name(space, name, field, others=(WORLD,))
    old = space.joints.by_name[request.name].joint
    joint = replace(old, a=request.a, b=request.b)
    live.capacity.check_joint(joint)
    space.join(joint)
    message = Text('changed {kind} {joint}', kind=Text(joint.kind), joint=joint.name)
    return Answer(subject=joint.name, message=message)


def join_at_point(live: LiveSpace, request: Pin | Axle) -> Answer:
    """Join the two topmost bodies at a point, or the only one and the background."""
    kind = JointKind.PIN if isinstance(request, Pin) else JointKind.AXLE
    number = 0
    while f'{kind}/{number}' in live.space.joints.by_name:
        number += 1
    name, points = f'{kind}/{number}', (request.point,)
    return join(live, Join(name=name, kind=kind, points=points, frame=request.frame))


def unjoin(live: LiveSpace, request: Unjoin) -> Answer:
    """
    Remove a joint.

    :raises UnknownJoint: there is none of that name
    """
    check_names(live.space, (request.name,), 'name')
    live.space.unjoin(request.name)
    message = Text('deleted joint {joint}', joint=request.name)
    return Answer(subject=request.name, message=message)


def command_motors(live: LiveSpace, request: CommandMotors) -> Answer:
    """
    Have motors of joints obey commands.

    :raises UnknownJoint: there is no joint of a name
    :raises BadProperty: a joint has no motor
    """
    names = [command.joint for command in request.commands]
    check_names(live.space, names, 'joint')
    for name in names:
        joint = live.space.joints.by_name[name].joint
        if not joint.properties.effort:
            template = '{name} has no motor: an axle or a slider with the property effort has one'
            raise BadProperty(template, field='joint', name=name)
    for command in request.commands:
        properties = live.space.joints.by_name[command.joint].joint.properties
        latency, rate = properties.latency or (0.0, 0.0), properties.command_rate or 0.0
        begun = live.begin_of_command(command.joint, latency, rate)
        live.space.commands.command_motor(TimedCommand(command, begun), live.step_count)
    subject = names[0] if len(names) == 1 else ''
    message = Text('commanded {motors}', motors=counted(len(names), 'motor'))
    return Answer(subject=subject, message=message)


def check_names(space: Space, names: Iterable[str], field: str) -> None:
    """
    Refuse a name of no joint.

    :param field: of the request, for the refusal
    :raises UnknownJoint: there is no joint of a name
    """
    for name in names:
        if name not in space.joints.by_name:
            raise no_joint(name, space.joints.by_name, field)


def unjoin_all(live: LiveSpace, request: UnjoinAll) -> Answer:
    """Remove all joints, or all of a namespace."""
    names = names_in(live.space.joints.by_name, request.namespace)
    for name in names:
        live.space.unjoin(name)
    return Answer(message=Text('deleted {joints}', joints=counted(len(names), 'joint')))


def loosen(space: Space, body: str, point: Point) -> list[str]:
    """Remove the welds and axles of a body at a point of the world [m]; return their names."""
    reach = space.bodies.by_name[body].body.click_reach
    names = [
        name
        for name in space.joints.names_on(body)
        if (joint := space.joints.by_name[name].joint).kind in (JointKind.PIN, JointKind.AXLE)
        and math.dist(_drawn(space, joint)[0], point) <= reach
    ]
    for name in names:
        space.unjoin(name)
    return names


def _members(
    space: Space, request: Join, points: tuple[Point, ...]
) -> tuple[str, str, tuple[Point, ...]]:
    """
    Return the two bodies of a request, and its points in their order.

    :raises UnknownBody: there is no body of a name
    :raises NothingThere: no name is given, and there is no body at the point
    """
    for field, name in (('a', request.a), ('b', request.b)):
        if name and name != WORLD:
            body_of_name(space, name, field, others=(WORLD,))
    a, b = request.a, request.b
    if not a:
        first = next((name for name in space.bodies.at(points[0]) if name != b), None)
        last = space.bodies.at(points[-1])
        # A line that begins in the background and ends on a body: its body is a.
        if first is None and request.kind.schema.along_line and b in ('', WORLD) and last:
            return last[0], WORLD, points[::-1]
        if first is None:
            raise nothing_at(points[0], 'points')
        a = first
    if not b:
        b = next((name for name in space.bodies.at(points[-1]) if name != a), WORLD)
    return a, b, points


def _passed_bodies(
    space: Space, names: tuple[str, ...] | None, points: tuple[Point, ...]
) -> tuple[str, ...]:
    """
    Return the bodies that a rope passes at points of the world [m].

    :param names: those that are named
    :raises UnknownBody: there is no body of a name
    """
    if names is None or len(names) != len(points):
        return tuple(next(iter(space.bodies.at(point)), WORLD) for point in points)
    for name in names:
        if name != WORLD:
            body_of_name(space, name, 'over', others=(WORLD,))
    return names


def _wheel(space: Space, name: str) -> float:
    """Return the radius of a body that is a wheel for ropes [m], else 0."""
    shape = None if name == WORLD else space.bodies.by_name[name].body.shape
    return shape.radius if isinstance(shape, Disc) else 0.0


def _center(space: Space, name: str, point: Point) -> Point:
    """Return the centre of a wheel, or a ring at a point of the world [m]."""
    return _pose(space, name)[:2] if _wheel(space, name) else point


def _rope(
    space: Space, names: tuple[str, ...], points: tuple[Point, ...]
) -> tuple[tuple[Guide, ...], float]:
    """
    Return what a rope passes, and its length as it is drawn [m].

    :param names: of the bodies at its points between the ends
    :param points: of the world [m]
    """
    sides = starmap(side, zip(points, points[1:], points[2:], strict=False))
    wheels = [turn * _wheel(space, name) for name, turn in zip(names, sides, strict=False)]
    radii = (0.0, *wheels, 0.0)
    passed = spans(points, radii) if names else []
    guides = tuple(
        Guide(
            name,
            *world_to_local(point, _pose(space, name)),
            radius,
            _pose(space, name)[2],
            before.heading,
            after.heading,
            before.length,
        )
        for name, point, radius, before, after in zip(
            names, points[1:], wheels, passed, passed[1:], strict=False
        )
    )
    return guides, sum(each.length for each in passed) + sum(
        arc(guide.radius, guide.heading_in, guide.heading_out) for guide in guides
    )


def _check_carrier(space: Space, ends: tuple[str, str], carrier: str | None) -> None:
    """
    Refuse a carrier of a gear that is no third body.

    :raises UnknownBody: there is no body of that name
    :raises BadProperty: it is one of the two
    """
    if carrier is None or carrier == WORLD:
        return
    body_of_name(space, carrier, 'carrier', others=(WORLD,))
    if carrier in ends:
        template = '{carrier} is a wheel of the gear, and not its carrier'
        raise BadProperty(template, field='carrier', carrier=carrier)


def _check_members(space: Space, kind: JointKind, names: tuple[str, ...]) -> None:
    """Refuse a joint none of whose bodies is dynamic."""
    bodies = [space.bodies.by_name[name].body for name in dict.fromkeys(names) if name != WORLD]
    if not any(body.dynamic for body in bodies):
        raise Anchored(
            '{bodies} cannot move; there is nothing for the {kind} to hold',
            field='a',
            bodies=', '.join(each.name for each in bodies),
            kind=Text(kind),
            concerns=bodies[0].name if bodies else '',
        )


def _phase(space: Space, a: str, b: str, properties: JointProperties) -> float:
    """
    Return the phase of a gear [rad].

    :param properties: of the gear; whole turns of the bodies are added to its phase, and without
        one the present phase is returned
    """
    ratio = 1.0 if properties.ratio is None else properties.ratio
    now = ratio * _pose(space, b)[2] - _pose(space, a)[2]
    if properties.carrier is not None:
        now += (1.0 - ratio) * _pose(space, properties.carrier)[2]
    if properties.phase is None:
        return now
    return properties.phase + math.tau * round((now - properties.phase) / math.tau)


def _is_at(space: Space, joint: Joint, points: tuple[Point, ...]) -> bool:
    """Return whether a joint is where points of the world would draw it [m]."""
    drawn = _drawn(space, joint)
    if joint.kind.schema.has_axis:
        # Its second point only gives the direction of its axis.
        x, y = points[0]
        length = math.dist(*points)
        points = (
            points[0],
            (x + (points[1][0] - x) / length, y + (points[1][1] - y) / length),
        )
    return are_same(drawn, points)


def _drawn(space: Space, joint: Joint) -> tuple[Point, ...]:
    return joint.drawn_points({name: _pose(space, name) for name in joint.bodies})


def _pose(space: Space, name: str) -> Pose:
    return ORIGIN if name == WORLD else space.bodies.by_name[name].pose
