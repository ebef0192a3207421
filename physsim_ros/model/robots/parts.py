# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Parts of a robot: links and joints beside its body (as in URDF and SDF), and wheels that roll.

Links are bodies, and joints are joints of the world. Poses and points are in the frame of the
robot's body, as all is where the joints are at 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Self

from physsim_ros.model.checks import (
    AT_WORDS,
    DENSITY,
    DENSITY_WORDS,
    ELASTICITY,
    ELASTICITY_WORDS,
    FRICTION,
    FRICTION_WORDS,
    MASS,
    MASS_WORDS,
    OfClass,
    point_list,
)
from physsim_ros.model.colors import Color, color_value, COLOR_WORDS
from physsim_ros.model.declarations import check_key, Checked, entry_of
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints import JointKind, JointProperties, kind_from
from physsim_ros.model.names import WORLD
from physsim_ros.model.robots.drives import LENGTH
from physsim_ros.model.robots.part_names import BASE, check_part, part_name
from physsim_ros.model.robots.sensors.sensor import mounting
from physsim_ros.model.shapes import Shape, shape_in, SHAPE_WORDS, SHAPES
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import ORIGIN, Point, Pose

# Kinds of joints that a link hangs on, which have a place in its description.
TREE_KINDS = (JointKind.PIN, JointKind.AXLE, JointKind.MOTOR, JointKind.SLIDER)


# Everyday words for a body with towed wheels.
TOWED_WORDS = Words('trailer', 'wheels', 'caster', 'cart')


@dataclass(frozen=True, slots=True, kw_only=True)
class Towed(Checked):
    """
    Wheels without a motor, on an axle through the origin of a body, along its y axis.

    They roll where they are drawn, and hold the body sideways.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    track: Annotated[float, LENGTH, 'distance of the left and the right wheel'] = 0.2
    traction: Annotated[float, FRICTION, 'coefficient of friction between wheels and floor'] = 0.8

    @property
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""
        return self.track / 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Link(Checked):
    """
    A further body of a robot.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    name: Annotated[str, check_part, 'of the link, and of its frame']
    shape: Annotated[Shape, OfClass(Shape), 'a key of shapes, as `box`: as of a body']
    at: Annotated[
        Pose, mounting, 'x, y [m], yaw [rad] in the frame of the body of the robot', AT_WORDS
    ] = ORIGIN
    color: Annotated[
        Color | None, color_value, 'as of a body; by default that of the robot', COLOR_WORDS
    ] = None
    mass: Annotated[float | None, MASS, 'not together with `density`', MASS_WORDS] = None
    density: Annotated[float | None, DENSITY, 'as of a body', DENSITY_WORDS] = None
    friction: Annotated[float | None, FRICTION, 'as of a body', FRICTION_WORDS] = None
    elasticity: Annotated[float | None, ELASTICITY, 'as of a body', ELASTICITY_WORDS] = None
    towed: Annotated[Towed | None, Towed.from_value, 'a mapping, as of a body', TOWED_WORDS] = None

    @classmethod
    def from_mapping(cls, mapping: Mapping[Any, Any]) -> Self:
        """
        Return the link of a YAML mapping, in which the shape is one of the keys of shapes.

        :raises Refusal: as `Checked.from_mapping`, or there is not one shape
        """
        for key in mapping:
            check_key(
                key,
                SHAPE_WORDS | {each: cls.WORDS[each] for each in cls.FIELDS if each != 'shape'},
            )
        shape = shape_in(mapping, 'a link', SHAPES)
        rest = {key: mapping[key] for key in mapping if key not in SHAPES}
        return super(Link, cls).from_mapping({**rest, 'shape': shape})

    def entry(self) -> dict[str, Any]:
        """Return the mapping that `from_mapping` makes it of."""
        values = {key: entry_of(each) for key, each in self.explicit().items() if key != 'shape'}
        return {**values, self.shape.KEY: self.shape.entry()}


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkJoint(Checked):
    """
    A joint of two links of a robot; `base` is the body of the robot.

    The number of its points is checked where it is made in a world, with the robot.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    :raises UnknownProperty: the kind of joint does not have a property
    """

    name: Annotated[str, check_part, 'of the joint']
    kind: Annotated[JointKind, lambda value, _: kind_from(value), 'as of a joint']
    a: Annotated[str, check_part, 'a link']
    b: Annotated[str, check_part, 'a link that `a` hangs on'] = BASE
    points: Annotated[
        tuple[Point, ...],
        point_list,
        'one or two, as the kind requires, where the joints are at 0',
    ]
    properties: Annotated[
        JointProperties,
        OfClass(JointProperties),
        'those of the kind, as keys; names in `over` and `carrier` are those of links, `base` or '
        '`world`',
    ] = field(default_factory=JointProperties)

    @classmethod
    def from_mapping(cls, mapping: Mapping[Any, Any]) -> Self:
        """
        Return the joint of a YAML mapping, whose properties are keys.

        :raises Refusal: as `Checked.from_mapping`, for its properties too
        """
        own = [each for each in cls.FIELDS if each != 'properties']
        for key in mapping:
            check_key(key, {**dict.fromkeys(own, ()), **JointProperties.WORDS})
        rest = {key: mapping[key] for key in mapping if key in own}
        properties = {key: mapping[key] for key in mapping if key not in own}
        joint = {**rest, 'properties': JointProperties.from_mapping(properties)}
        return super(LinkJoint, cls).from_mapping(joint)

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        self.properties.check_kind(self.kind)

    def properties_of(self, body: str) -> JointProperties:
        """
        Return its properties, with the names of bodies in the world.

        :param body: name of the robot's body
        """
        properties = self.properties
        over, carrier = properties.over, properties.carrier
        if over is not None:
            properties = replace(properties, over=tuple(_in_world(body, name) for name in over))
        if carrier is not None:
            properties = replace(properties, carrier=_in_world(body, carrier))
        return properties

    def entry(self) -> dict[str, Any]:
        """Return the mapping that `from_mapping` makes it of."""
        values = {'name': self.name, 'kind': str(self.kind), 'a': self.a, 'b': self.b}
        points = [list(point) for point in self.points]
        return {**values, 'points': points, **self.properties.explicit()}


def _in_world(body: str, name: str) -> str:
    return WORLD if name == WORLD else part_name(body, name)


def check_tree(links: tuple[Link, ...], joints: tuple[LinkJoint, ...]) -> None:
    """
    Refuse parts that are no tree: each link is the body `a` of one joint of `TREE_KINDS`.

    Joints of other kinds, such as springs and gears, are between any two links.

    :raises BadProperty: they are not, or a name is taken or unknown
    """
    names = [link.name for link in links]
    for noun, given in (('links', [BASE, *names]), ('joints', [each.name for each in joints])):
        if twice := [name for name in given if given.count(name) > 1]:
            template = 'two {field} of a robot have the name {name}'
            raise BadProperty(template, field=noun, name=twice[0])
    hangs: dict[str, str] = {}
    for joint in joints:
        guides = (name for name in joint.properties.guides if name != WORLD)
        for end in (joint.a, joint.b, *guides):
            if end not in (BASE, *names):
                raise BadProperty(
                    'joint {joint} names a link {end}; there are {known}',
                    field='joints',
                    joint=joint.name,
                    end=end,
                    known=', '.join((BASE, *names)),
                )
        if joint.kind in TREE_KINDS and hangs.setdefault(joint.a, joint.b) != joint.b:
            raise BadProperty('{a} hangs on two links', field='joints', a=joint.a)
    for name in names:
        seen, above = {name}, hangs.get(name)
        while above not in (None, BASE) and above not in seen:
            seen.add(above)
            above = hangs.get(above)
        if above != BASE:
            kinds = ', '.join(TREE_KINDS)
            raise BadProperty(
                'link {name} does not hang on the body of the robot: it needs to be `a` of a '
                'joint whose kind is one of {kinds}',
                field='links',
                name=name,
                kinds=kinds,
            )
