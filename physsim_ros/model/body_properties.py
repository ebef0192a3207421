# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Properties of a body apart from its shape: material, initial motion, role.

Each is declared once; markers, world files and the page read them.
"""

from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.actors import Actor, actor_from
from physsim_ros.model.applied_forces import AppliedForce, forces_from
from physsim_ros.model.checks import (
    DENSITY,
    DENSITY_WORDS,
    ELASTICITY,
    ELASTICITY_WORDS,
    FASTEST,
    flag,
    FRICTION,
    FRICTION_WORDS,
    MASS,
    MASS_WORDS,
    must_be,
    text,
    Vector,
    VELOCITY,
    Within,
)
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.media import Medium
from physsim_ros.model.robots import Robot, Towed, TOWED_WORDS
from physsim_ros.model.texts import is_printable, Words
from physsim_ros.model.transform import Point

# Greatest charge [C], of either sign: impulses between any two are finite.
MOST_CHARGE = 1e6
# Greatest length of a label [characters]: some lines beside a body.
LONGEST_LABEL = 200


def _group(value: object, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise must_be('a whole number', value, name)
    # Chipmunk's cpGroup is an unsigned 64-bit word; negative numbers wrap to distinct words.
    if not -(2**31) <= value < 2**31:
        raise BadProperty('{field} must fit into 32 bits', field=name)
    return value


def _label(value: object, name: str) -> str:
    label = text(value, name, BadProperty)
    if len(label) > LONGEST_LABEL:
        raise BadProperty(
            '{field} has more than {most} characters', field=name, most=LONGEST_LABEL
        )
    if not is_printable(label.replace('\n', '')):
        raise BadProperty('{field} has an unprintable character', field=name)
    return label


@dataclass(frozen=True, slots=True, kw_only=True)
class Properties(Checked):
    """
    The properties that a request sets; None leaves a property as it is, or at its default.

    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    mass: Annotated[float | None, MASS, 'not together with `density`', MASS_WORDS] = None
    density: Annotated[
        float | None,
        DENSITY,
        'not together with `mass`; by default parameter `density`',
        DENSITY_WORDS,
    ] = None
    friction: Annotated[
        float | None,
        FRICTION,
        'coefficient of friction; by default parameter `friction`',
        FRICTION_WORDS,
    ] = None
    elasticity: Annotated[
        float | None,
        ELASTICITY,
        'coefficient of restitution; by default parameter `elasticity`',
        ELASTICITY_WORDS,
    ] = None
    velocity: Annotated[
        Point | None,
        VELOCITY,
        'of the centre of mass, world axes',
        Words('speed', 'v', 'vel', 'linear_velocity', 'twist'),
    ] = None
    spin: Annotated[
        float | None,
        Within(-FASTEST, FASTEST, 'rad/s'),
        'counter-clockwise',
        Words('angular_velocity', 'omega', 'rotation', 'turn'),
    ] = None
    anchored: Annotated[
        bool | None,
        flag,
        'fixed to the background, even if it is `kinematic` as well',
        Words('fixed', 'static', 'immovable', 'frozen', 'locked', 'pinned'),
    ] = None
    kinematic: Annotated[
        bool | None,
        flag,
        'moves as commanded, whatever it touches, and pushes other bodies',
        Words('scripted', 'animated', 'platform'),
    ] = None
    group: Annotated[
        int | None,
        _group,
        'bodies of the same non-zero group pass through each other',
        Words('layer', 'category', 'filter', 'mask'),
    ] = None
    sensor: Annotated[
        bool | None,
        flag,
        'reports contacts, pushes nothing',
        Words('trigger', 'ghost', 'detector', 'is_trigger'),
    ] = None
    surface_velocity: Annotated[
        Point | None,
        VELOCITY,
        'makes a sensor a conveyor: velocity of its surface in the axes of the body',
        Words('conveyor', 'conveyor_velocity'),
    ] = None
    belt: Annotated[
        float | None,
        Within(-FASTEST, FASTEST, 'm/s'),
        'velocity of its surface along its outline, counter-clockwise, like a conveyor belt seen '
        'from the side',
        Words('belt_speed', 'tread', 'surface_speed'),
    ] = None
    rolling_resistance: Annotated[
        float | None,
        Within(0.0, 10.0),
        'coefficient c: a force of c times the load resists a rolling disc at its rim; of the '
        'disc and the body below it, the greater c counts',
        Words('rolling_friction', 'crr', 'roll'),
    ] = None
    one_way: Annotated[
        Point | None,
        Vector(1000.0, '', 'longer'),
        'direction, in the axes of the body, in which others pass through it; it stops those that '
        'come the other way: `[0, 1]` is a platform',
        Words('oneway', 'one_way_collision', 'one_sided', 'platform', 'passable'),
    ] = None
    closed_sides: Annotated[
        bool | None,
        flag,
        'a one-way body also stops others at its sides',
        Words('sides', 'one_way_sides'),
    ] = None
    robot: Annotated[
        Robot | None,
        Robot.from_value,
        'makes the body a robot: the name of a shipped robot, or a mapping',
        Words('vehicle', 'drive'),
    ] = None
    towed: Annotated[
        Towed | None,
        Towed.from_value,
        'gives the body an axle without a motor, as of a trailer: a mapping',
        TOWED_WORDS,
    ] = None
    actor: Annotated[
        Actor | None,
        actor_from,
        'moves the body on its own: a mapping of a path or a pedestrian model',
        Words('path', 'trajectory', 'waypoints', 'tween', 'walk', 'pedestrian', 'behavior'),
    ] = None
    forces: Annotated[
        tuple[AppliedForce, ...] | None,
        forces_from,
        'constant forces on the body, a list of mappings; `[]` is none',
        Words('force', 'applied_force', 'thrust', 'thruster', 'push'),
    ] = None
    charge: Annotated[
        float | None,
        Within(-MOST_CHARGE, MOST_CHARGE, 'C'),
        'electric; repels charges of its sign and attracts others, by parameter `coulomb`',
        Words('q', 'coulomb', 'electric_charge'),
    ] = None
    medium: Annotated[
        Medium | None,
        Medium.from_value,
        'fills an anchored or kinematic sensor with water, air or another fluid: a mapping',
        Words('water', 'fluid', 'liquid', 'air', 'buoyancy', 'wind', 'region'),
    ] = None
    label: Annotated[
        str | None,
        _label,
        'text at its centre of mass, on the page and in Rerun; `"\\n"` breaks a line',
        Words('text', 'caption', 'note', 'title'),
    ] = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.mass is not None and self.density is not None:
            raise BadProperty('a body has a mass or a density, not both', field='mass')
