# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Properties of a body apart from its shape: material, initial motion, role.

One table holds every property with its check; markers, world files and parameters read it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.actors import Actor, actor_from
from physsim_ros.model.checks import (
    Checked,
    Checks,
    FASTEST,
    flag,
    HEAVIEST,
    LIGHTEST,
    shown,
    velocity,
    Within,
)
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robots import Robot
from physsim_ros.model.texts import is_printable

# Greatest length of a label [characters]: some lines beside a body.
LONGEST_LABEL = 200


def _group(value: object, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise BadProperty(f'{name} must be a whole number, not {shown(value)}', field=name)
    # Chipmunk's cpGroup is an unsigned 64-bit word; negative numbers wrap to distinct words.
    if not -(2**31) <= value < 2**31:
        raise BadProperty(f'{name} must fit into 32 bits', field=name)
    return value


def _label(value: object, name: str) -> str:
    if not isinstance(value, str):
        raise BadProperty(f'{name} must be text, not {shown(value)}', field=name)
    if len(value) > LONGEST_LABEL:
        raise BadProperty(f'{name} has more than {LONGEST_LABEL} characters', field=name)
    if not is_printable(value.replace('\n', '')):
        raise BadProperty(f'{name} has an unprintable character', field=name)
    return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Properties(Checked):
    """
    The properties that a request sets; None leaves a property as it is, or at its default.

    :param mass: [kg], excludes density
    :param density: [kg/m²], excludes mass
    :param friction: coefficient, 0 .. 10
    :param elasticity: coefficient of restitution, 0 .. 1
    :param velocity: of the centre of mass, world axes [m/s]
    :param spin: [rad/s], counter-clockwise
    :param anchored: fixed to the background
    :param kinematic: moves at its commanded velocity, unaffected by contacts and joints
    :param group: bodies of the same non-zero group do not collide with each other
    :param sensor: its contacts are reported and have no effect
    :param surface_velocity: of the surface of a conveyor, which is a sensor, in the body's axes
        [m/s]
    :param robot: what makes it a robot, or a mapping of that
    :param actor: what moves it on its own, or a mapping of that
    :param label: text that is shown at its centre of mass, in lines; '' is none
    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    CHECKS: ClassVar[Checks] = {
        'mass': Within(LIGHTEST, HEAVIEST, 'kg'),
        'density': Within(LIGHTEST, HEAVIEST, 'kg/m²'),
        'friction': Within(0.0, 10.0),
        'elasticity': Within(0.0, 1.0),
        'velocity': velocity,
        'spin': Within(-FASTEST, FASTEST, 'rad/s'),
        'anchored': flag,
        'kinematic': flag,
        'group': _group,
        'sensor': flag,
        'surface_velocity': velocity,
        'robot': Robot.from_value,
        'actor': actor_from,
        'label': _label,
    }

    mass: float | None = None
    density: float | None = None
    friction: float | None = None
    elasticity: float | None = None
    velocity: tuple[float, float] | None = None
    spin: float | None = None
    anchored: bool | None = None
    kinematic: bool | None = None
    group: int | None = None
    sensor: bool | None = None
    surface_velocity: tuple[float, float] | None = None
    robot: Robot | None = None
    actor: Actor | None = None
    label: str | None = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.mass is not None and self.density is not None:
            raise BadProperty('a body has a mass or a density, not both', field='mass')
