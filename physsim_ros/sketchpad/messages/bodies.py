# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages that add, change, move, copy and delete bodies, or change gravity."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.files import spawn_from, with_shipped_robot
from physsim_ros.model.body_properties import properties_from
from physsim_ros.model.checks import pair
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import ChangeBody, Configure, DeleteBodies, MoveBodies, Request
from physsim_ros.model.transform import Point
from physsim_ros.sketchpad.messages.fields import (
    color_of,
    Fields,
    names_of,
    point_of,
    pose_of,
    Readers,
    text_of,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Submit:
    """
    Submit requests that are undone together.

    :param requests: in order
    :param topic: on which a node would publish them; answers and events name it
    """

    requests: tuple[Request, ...]
    topic: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Copy:
    """
    Add a body like another one, at rest.

    :param name: of the body
    :param to: position of the copy [m]
    """

    name: str
    to: Point


def _spawn(fields: Fields) -> Submit:
    body = fields.get('body')
    if not isinstance(body, dict):
        raise BadProperty('body must be a mapping', field='body')
    return Submit(requests=(spawn_from(body),), topic='~/spawn')


def _change(fields: Fields) -> Submit:
    name = text_of(fields.get('name'), 'name')
    given = fields.get('properties')
    if not isinstance(given, dict):
        raise BadProperty('properties must be a mapping', field='properties')
    properties = {key: value for key, value in given.items() if key not in ('color', 'at')}
    request = ChangeBody(
        name=name,
        properties=properties_from(with_shipped_robot(properties, ['robot'])),
        color=color_of(given['color']) if 'color' in given else None,
        pose=pose_of(given['at']) if 'at' in given else None,
    )
    return Submit(requests=(request,), topic='~/spawn')


def _move_bodies(fields: Fields) -> Submit:
    names = names_of(fields.get('names'), 'names')
    request = MoveBodies(names=names, by=point_of(fields.get('by'), 'by'))
    return Submit(requests=(request,), topic='~/command')


def _copy(fields: Fields) -> Copy:
    return Copy(name=text_of(fields.get('name'), 'name'), to=point_of(fields.get('to'), 'to'))


def _delete(fields: Fields) -> Submit:
    names = names_of(fields.get('names'), 'names')
    return Submit(requests=(DeleteBodies(names=names),), topic='~/spawn')


def _gravity(fields: Fields) -> Submit:
    gravity = pair(fields.get('gravity'), 'gravity')
    return Submit(requests=(Configure(changes={'gravity': gravity}),), topic='gravity')


READERS: Readers = {
    'spawn': (['body'], _spawn),
    'change': (['name', 'properties'], _change),
    'move_bodies': (['names', 'by'], _move_bodies),
    'copy': (['name', 'to'], _copy),
    'delete': (['names'], _delete),
    'gravity': (['gravity'], _gravity),
}
