# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The body that a request makes or changes, and what a request may ask of it, without a space.

Law: a property that a request does not name keeps its value. One that it unsets, and one of a new
body, has the default of the world.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from typing import Any

from physsim_ros.model.actors import Pedestrian
from physsim_ros.model.checks import HEAVIEST, LIGHTEST
from physsim_ros.model.colors import color_of
from physsim_ros.model.errors import Anchored, BadProperty, Exists, no_body
from physsim_ros.model.requests import ChangeBody, Command, Spawn
from physsim_ros.model.robots import check_namespace
from physsim_ros.model.scene import Body, BODY_DEFAULTS
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.transform import REST, Twist
from physsim_ros.model.translation import Text


def new_body(request: Spawn, settings: WorldSettings, expires: int | None) -> tuple[Body, Twist]:
    """
    Return the new body of a request, and its twist.

    :param settings: of the world, the defaults of properties
    :param expires: step at whose end it is removed; None is never
    :raises Refusal: the body cannot be simulated
    """
    changes = fields_set_by(request, expires)
    body = changed_body(_default_body(request, settings), changes, request, settings)
    return body, changed_twist(body, REST, request)


def fields_set_by(request: Spawn | ChangeBody, expires: int | None = None) -> dict[str, Any]:
    """
    Return the fields of a body that a request sets, by name, without its properties.

    :param expires: step at whose end it is removed; None leaves it unchanged
    """
    values = {'shape': request.shape, 'color': request.color, 'expires': expires}
    return {name: value for name, value in values.items() if value is not None}


def changed_body(
    old: Body, changes: dict[str, Any], request: Spawn | ChangeBody, settings: WorldSettings
) -> Body:
    """
    Return a body with the properties that a request sets, without those that it unsets.

    :param changes: other fields of the body, by name
    :param settings: of the world, the defaults of properties
    :raises BadProperty: it would be too light or too heavy, or a robot, conveyor or region that
        cannot be
    """
    values = {name: _default(name, settings) for name in request.unset}
    if old.mass is not None and ('mass' in values or 'density' in values):
        # A body with a mass has no other density; without the mass it has that of the world.
        values['density'] = settings.density if 'mass' in values else old.density
    given = request.properties.explicit()
    values |= given
    for motion in ('velocity', 'spin'):
        values.pop(motion, None)
    if 'density' in given:
        values['mass'] = None
    body = replace(old, **changes, **values)
    if body.mass is not None:
        # The default density of the world at its spawn is in no file.
        body = replace(body, density=body.mass / body.shape.form.area)
    if not LIGHTEST <= body.total_mass <= HEAVIEST:
        field = 'density' if body.mass is None else 'mass'
        raise BadProperty(
            'the body would weigh {value:g} kg; {low:g} to {high:g} kg can be simulated',
            field=field,
            value=body.total_mass,
            low=LIGHTEST,
            high=HEAVIEST,
        )
    _check_role(body)
    return body


def _check_role(body: Body) -> None:
    """
    Refuse a robot, an actor, a conveyor or a region of a medium that cannot be.

    :raises BadProperty: the body has another role, or the robot no namespace that ROS allows
    """
    if any(body.surface_velocity) and not body.sensor:
        template = (
            '{body} is not a sensor; only a sensor can be a conveyor from above; the surface of a '
            'solid body runs by the property belt'
        )
        raise BadProperty(template, field='surface_velocity', body=body.name)
    if body.medium is not None and (body.dynamic or not body.sensor):
        template = (
            '{body} is not an anchored or kinematic sensor; only such a body can be filled with a '
            'medium'
        )
        raise BadProperty(template, field='medium', body=body.name)
    if body.actor is not None and body.anchored:
        raise BadProperty(
            '{body} is {noun}; it cannot be anchored',
            field='anchored',
            body=body.name,
            noun=Text('an actor'),
        )
    if isinstance(body.actor, Pedestrian) and body.sensor:
        raise BadProperty(
            '{body} is a pedestrian; it cannot be a sensor', field='sensor', body=body.name
        )
    if body.robot is None:
        return
    if body.robot.drive is not None and body.towed is not None:
        raise BadProperty(
            '{body} has a drive; a link of it can be towed', field='towed', body=body.name
        )
    if body.robot.drive is None and body.actor is not None:
        raise BadProperty(
            '{body} is a robot without a drive; it is no actor', field='actor', body=body.name
        )
    # A robot without wheels may stand fast, as an arm does.
    roles = ('sensor',) if body.robot.drive is None else ('anchored', 'kinematic', 'sensor')
    for role in roles:
        if getattr(body, role):
            raise BadProperty(
                '{body} is a robot; it cannot be {field}', field=role, body=body.name
            )
    check_namespace(body.robot.namespace_of(body.name), 'namespace')


def _default(name: str, settings: WorldSettings) -> Any:
    """Return the value of a property of a body that nobody has set."""
    return getattr(settings, name, BODY_DEFAULTS.get(name))


def changed_twist(body: Body, twist: Twist, request: Spawn | ChangeBody) -> Twist:
    """
    Return the twist of a body with the properties that a request sets and unsets.

    :param twist: that it has now
    :raises Anchored: a velocity is named, and the body is anchored
    """
    properties = request.properties
    moves = (properties.velocity or (0.0, 0.0)) != (0.0, 0.0) or bool(properties.spin)
    if body.anchored and moves:
        raise Anchored('{body} is anchored; it has no velocity', field='velocity', body=body.name)
    if body.anchored:
        return REST
    vx, vy = REST[:2] if 'velocity' in request.unset else twist[:2]
    spin = 0.0 if 'spin' in request.unset else twist[2]
    if properties.velocity is not None:
        vx, vy = properties.velocity
    return vx, vy, spin if properties.spin is None else properties.spin


def check_start(body: Body, names: Collection[str]) -> None:
    """
    Refuse an actor that waits for a body that there is not.

    :param names: of the bodies of the world
    :raises UnknownBody: the field is the key of `start`
    """
    waits_for = {} if body.actor is None else body.actor.start.bodies
    for field, name in waits_for.items():
        if name not in names:
            raise no_body(name, names, field)


def check_command(body: Body, request: Command) -> None:
    """
    Refuse a command that a body cannot obey.

    :raises Anchored: it is anchored, and takes a pose only
    :raises BadProperty: it is kinematic, and forces do not move it
    """
    if body.anchored and (request.twists.size or request.wrenches.size):
        raise Anchored(
            '{body} is anchored; it takes a pose only', field='joint_names', body=body.name
        )
    if body.kinematic and request.wrenches.size:
        raise BadProperty(
            '{body} is kinematic; forces do not move it', field='wrench', body=body.name
        )


def check_namespaces(bodies: Iterable[Body]) -> None:
    """
    Refuse two robots of one namespace, topic or frame; of two bodies of one name the first counts.

    A sensor may have the topic of another robot, whose namespace is nested in that of its own.

    :raises Exists: there are
    """
    taken: dict[str, str] = {}
    seen: set[str] = set()
    for body in bodies:
        if body.robot is None or body.name in seen:
            continue
        seen.add(body.name)
        namespace = body.robot.namespace_of(body.name)
        for name in body.robot.names_below(namespace):
            other = taken.setdefault(name, body.name)
            if other != body.name:
                raise Exists(
                    'the robots {other} and {body} have one topic or frame, /{name}; give one of '
                    'them another namespace',
                    field='namespace',
                    other=other,
                    body=body.name,
                    name=name,
                )


def _default_body(request: Spawn, settings: WorldSettings) -> Body:
    """Return a new body with the default material of the world."""
    return Body(
        name=request.name,
        shape=request.shape,
        color=color_of(request.name),
        density=settings.density,
        friction=settings.friction,
        elasticity=settings.elasticity,
    )
