# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Kinds of joints and their properties: one table of properties, one table of kinds.

Not here: constraints and Jacobian rows of a kind (`engine.joints`), and its glyph
(`appearance`).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from typing import Annotated, Any, Self

from physsim_ros.model.checks import (
    brief,
    FASTEST,
    flag,
    FRICTION_WORDS,
    HEAVIEST,
    MOST_SPEED_WORDS,
    shown,
    text,
    texts,
    Within,
)
from physsim_ros.model.declarations import check_key, Checked
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.latency import COMMAND_RATE, COMMAND_RATE_WORDS, delays, LATENCY_WORDS
from physsim_ros.model.names import WORLD
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.texts import hint_of, no_kind, Words
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

# Greatest ratio of a gear, and the inverse of the least: between the fastest and the slowest wheel
# of a clock it is 1e6.
MOST_RATIO = 1e6
# Greatest phase of a gear [rad]: exact to a nanometre at an arm of a metre.
_MOST_PHASE = 1e6


# Points of a rope, at most: each is looked at in every step.
MOST_STOPS = 64

# The properties of every kind.
_COMMON = ('max_force', 'break_force', 'collide')


# The note of a property is its value where nobody sets it: a number, or this, as the poses of the
# bodies have it when the joint is made.
AS_DRAWN = 'as drawn'


# The checks of the name of a body, and of several.
_name, _names = partial(text, error=BadProperty), partial(texts, error=BadProperty)


def _direction(value: object, name: str) -> float:
    direction = Within(-1.0, 1.0)(value, name)
    if abs(direction) < 1.0:
        raise BadProperty(
            '{field} is {direction:g}; it must be 1 or -1', field=name, direction=direction
        )
    return direction


def _ratio(value: object, name: str) -> float:
    ratio = Within(-MOST_RATIO, MOST_RATIO)(value, name)
    if abs(ratio) < 1.0 / MOST_RATIO:
        raise BadProperty('{field} is {value:g}; it must not be 0', field=name, value=ratio)
    return ratio


@dataclass(frozen=True, slots=True)
class Schema:
    """
    The points and properties of a kind of joint.

    :param points: number of points that a joint is drawn with, 1 or 2
    :param passes: whether there may be further points between its two, of bodies that it passes
    :param sentence: what it does, in Markdown
    :param own: names of the properties that not every kind has
    :param words: everyday words for it; those of Box2D, Pymunk and URDF among them
    :param least_distance: between its two points [m]; 0 is no such rule
    :param has_axis: whether the direction from its first to its second point is an axis of body b
    :param rolls: whether the line through its second point, across that from its first, is an
        axis of body b, along which a rolls
    :param along_line: whether its force is along the line between its two points, where a knife
        can cut it
    """

    points: int
    sentence: str
    own: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    least_distance: float = 0.0
    has_axis: bool = False
    rolls: bool = False
    along_line: bool = False
    passes: bool = False

    @property
    def properties(self) -> tuple[str, ...]:
        """Return the names of the properties of the kind, its own first."""
        return *self.own, *_COMMON


class JointKind(StrEnum):
    """Kinds of joints; the value is the word in markers and world files."""

    schema: Schema

    def __new__(cls, word: str, schema: Schema) -> Self:
        """Make a kind of its word and its schema."""
        kind = str.__new__(cls, word)
        kind._value_, kind.schema = word, schema
        return kind

    PIN = 'pin', Schema(1, 'holds them together', words=('weld', 'fixed', 'glue', 'nail'))
    AXLE = (
        'axle',
        Schema(
            1,
            'lets them turn about the point, with a `ratchet` one way only; `stiffness` adds a '
            'torsion spring; limits are angles',
            own=(
                'lower',
                'upper',
                'ratchet',
                'friction',
                'stiffness',
                'damping',
                'rest_angle',
                'effort',
                'max_speed',
                'gain',
                'latency',
                'command_rate',
            ),
            words=(
                *('hinge', 'revolute', 'continuous', 'pivot', 'bolt', 'ratchet', 'freewheel'),
                *('bearing', 'torsion_spring', 'rotary_spring', 'damped_rotary_spring'),
            ),
        ),
    )
    MOTOR = (
        'motor',
        Schema(
            1,
            'an axle that drives `a` against `b`',
            own=('rate', 'max_torque'),
            words=('engine', 'actuator'),
        ),
    )
    SPRING = (
        'spring',
        Schema(
            2,
            'pulls and pushes in proportion to its strain',
            own=('stiffness', 'damping', 'rest_length'),
            words=('elastic', 'damped_spring', 'shock'),
            along_line=True,
        ),
    )
    ROD = (
        'rod',
        Schema(
            2,
            'keeps the drawn distance',
            words=('distance', 'bar', 'link', 'stick'),
            least_distance=SMALLEST,
            along_line=True,
        ),
    )
    ROPE = (
        'rope',
        Schema(
            2,
            'is at most `length` long, from its first point past rings and around wheels to its '
            'last; with `rate` a winch',
            own=('length', 'over', 'rate', 'lower', 'upper'),
            words=('string', 'cord', 'cable', 'chain', 'slide', 'pulley', 'winch', 'tackle'),
            along_line=True,
            passes=True,
        ),
    )
    SLIDER = (
        'slider',
        Schema(
            2,
            'lets `a` slide along a line fixed to `b`, without rotating; with `rate` it is driven',
            own=(
                *('lower', 'upper', 'friction', 'rate', 'effort', 'max_speed', 'gain'),
                *('latency', 'command_rate'),
            ),
            words=('prismatic', 'groove', 'rail', 'piston'),
            least_distance=SMALLEST,
            has_axis=True,
        ),
    )
    GEAR = (
        'gear',
        Schema(
            1,
            'couples the rotations of `a` and `b`',
            own=('ratio', 'phase', 'carrier'),
            words=('cog', 'gears', 'planetary', 'epicyclic'),
        ),
    )
    RACK = (
        'rack',
        Schema(
            2,
            'lets `a`, a pinion about the first point, roll without slipping on a straight rack '
            'of `b`, which goes through the second point, across the line between the two',
            words=('rack_and_pinion', 'pinion', 'rolling', 'toothed_rack'),
            least_distance=SMALLEST,
            rolls=True,
        ),
    )

    @property
    def points(self) -> int:
        """Return the number of points that a joint of this kind is drawn with."""
        return self.schema.points

    @property
    def phrase(self) -> str:
        """Return the kind with its article, as `an axle`."""
        return f'an {self}' if self[0] in 'aeiou' else f'a {self}'


def kind_from(value: object) -> JointKind:
    """
    Return the kind of joint that a word names.

    :raises BadProperty: there is no such kind
    """
    for kind in JointKind:
        if kind == value:
            return kind
    kinds = ', '.join(JointKind)
    if value is None:
        raise BadProperty('a joint needs a kind: {kinds}', field='kind', kinds=kinds)
    # `shown` bounds the text: aliases of YAML may unfold to millions of words.
    word = shown(value).strip("'")
    hint = hint_of(word, {kind: kind.schema.words for kind in JointKind})
    raise BadProperty(no_kind('joint', shown(value), hint, kinds), field='kind')


@dataclass(frozen=True, slots=True, kw_only=True)
class JointProperties(Checked):
    """
    The properties that a request sets; None leaves a property as it is, or at its default.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    lower: Annotated[
        float | None,
        Within(-LARGEST, LARGEST, 'rad or m'),
        'least angle of `a` relative to `b`, or least displacement of `a` along the axis, from '
        'where they were joined; of a winch, the least length',
        Words('min', 'minimum', 'from'),
    ] = None
    upper: Annotated[
        float | None,
        Within(-LARGEST, LARGEST, 'rad or m'),
        'greatest angle, displacement or length',
        Words('max', 'maximum', 'to'),
    ] = None
    ratchet: Annotated[
        float | None,
        _direction,
        '1: `a` turns against `b` only counter-clockwise; -1: only clockwise',
        Words('freewheel', 'pawl', 'clutch'),
    ] = None
    rate: Annotated[
        float | None,
        Within(-FASTEST, FASTEST, 'rad/s or m/s'),
        'motor: angular velocity of `a` relative to `b`, counter-clockwise; slider: velocity of '
        '`a` along its line, by default not driven; winch: rate of its length, which begins as '
        '`length`, by default none',
        1.0,
        Words('speed', 'angular_velocity', 'omega', 'rpm', 'motor_speed', 'target'),
    ] = None
    max_torque: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N m'),
        'greatest torque of a motor',
        1000.0,
        Words('torque', 'strength', 'power'),
    ] = None
    effort: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N m or N'),
        'gives the joint a motor of this greatest torque or force, which holds until it is '
        'commanded; not together with `rate`',
        Words('motor_torque', 'motor_force', 'max_effort'),
    ] = None
    max_speed: Annotated[
        float | None,
        Within(0.0, FASTEST, 'rad/s or m/s'),
        'greatest rate of that motor',
        1.0,
        MOST_SPEED_WORDS,
    ] = None
    gain: Annotated[
        float | None,
        Within(0.0, 200.0, '1/s'),
        'speed of that motor towards a commanded position, divided by the distance to it',
        20.0,
        Words('kp', 'p_gain', 'proportional_gain'),
    ] = None
    latency: Annotated[
        Point | None,
        delays,
        'least and greatest time from a command to that motor, drawn by `seed`; one number is '
        'both [s]',
        0.0,
        LATENCY_WORDS,
    ] = None
    command_rate: Annotated[
        float | None,
        COMMAND_RATE,
        'times a second at which that motor looks for a new command; 0 is each step',
        0.0,
        COMMAND_RATE_WORDS,
    ] = None
    friction: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N m or N'),
        'torque or force with which a bearing or a slide resists motion, whatever its load',
        0.0,
        FRICTION_WORDS,
    ] = None
    stiffness: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N/m or N m/rad'),
        'spring: force per strain; axle: torque per angle, by default none',
        100.0,
        Words('k', 'spring_constant', 'hardness', 'stiff'),
    ] = None
    damping: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N s/m or N m s/rad'),
        'spring: force against the rate of strain; axle: torque against its angular velocity',
        0.0,
        Words('damper', 'viscosity', 'c'),
    ] = None
    rest_angle: Annotated[
        float | None,
        Within(-LARGEST, LARGEST, 'rad'),
        'angle of `a` relative to `b`, from where they were joined, at which a torsion spring '
        'has no torque',
        0.0,
        Words('neutral_angle', 'zero_angle', 'equilibrium'),
    ] = None
    rest_length: Annotated[
        float | None,
        Within(0.0, LARGEST, 'm'),
        'length of a spring without force',
        AS_DRAWN,
        Words('natural_length', 'free_length', 'rest'),
    ] = None
    length: Annotated[
        float | None,
        Within(0.0, LARGEST, 'm'),
        "greatest distance of a rope's points",
        AS_DRAWN,
        Words('distance', 'long'),
    ] = None
    over: Annotated[
        tuple[str, ...] | None,
        _names,
        'names of the bodies at the points between the ends, `world` for the background; on a '
        'disc the rope runs as on a wheel, without slipping; other points are rings',
        AS_DRAWN,
        Words('via', 'through', 'wheels', 'pulleys', 'rings', 'sheaves'),
    ] = None
    ratio: Annotated[
        float | None,
        _ratio,
        'turns of `a` for one of `b`; negative for opposite directions; '
        f'{brief(1 / MOST_RATIO)} .. {brief(MOST_RATIO)}, either sign',
        1.0,
        Words('transmission', 'teeth'),
    ] = None
    phase: Annotated[
        float | None,
        Within(-_MOST_PHASE, _MOST_PHASE, 'rad'),
        'angle of `b` times `ratio` minus angle of `a`',
        AS_DRAWN,
        Words('angle', 'offset'),
    ] = None
    carrier: Annotated[
        str | None,
        _name,
        'name of a third body relative to which the angles of a gear are measured, such as the '
        'arm of a planet; by default, and with `world`, they are absolute',
        Words('arm', 'planet_carrier', 'reference'),
    ] = None
    max_force: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N'),
        'greatest force of the joint; for torques, N m. For a driven slider, the force of its '
        'drive, by default 1000 N',
        Words('force'),
    ] = None
    break_force: Annotated[
        float | None,
        Within(0.0, HEAVIEST, 'N'),
        'force above which the joint is removed; for torques, N m',
        Words('breaks', 'breakable', 'breaking_force', 'fragile'),
    ] = None
    collide: Annotated[
        bool | None,
        flag,
        'whether the joined bodies collide with each other',
        False,
        Words('collision', 'collisions', 'collide_connected'),
    ] = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            template = 'lower is {lower:g} and upper {upper:g}; lower must not be greater'
            raise BadProperty(template, field='lower', lower=self.lower, upper=self.upper)
        if self.rate is not None and self.effort:
            raise BadProperty(
                'a slider has either a rate, with which it is driven, or an effort, with which '
                'its motor obeys commands',
                field='effort',
            )

    @property
    def guides(self) -> tuple[str, ...]:
        """Return the names of the bodies that a joint has beside its two, as its guides."""
        if self.carrier is None or self.carrier == WORLD:
            return self.over or ()
        return (self.carrier,)

    def check_kind(self, kind: JointKind, unset: tuple[str, ...] = ()) -> None:
        """
        Refuse a property that a kind of joint does not have.

        :param unset: names of further properties
        :raises UnknownProperty: there is one
        """
        known = kind.schema.properties
        for name in (*self.explicit(), *unset):
            if name not in known:
                raise UnknownProperty(
                    '{kind} has no {field}; it has {known}',
                    field=name,
                    kind=Text(kind.phrase),
                    known=', '.join(known),
                )


# Keys of a joint in the text of a marker, with everyday words for them.
JOINT_KEYS = {'kind': (), 'a': (), 'b': (), **JointProperties.WORDS}
# Values of the properties that nobody sets, by name; those that are not here are absent, or
# as drawn.
DEFAULTS: dict[str, float] = {
    name: note
    for name, each in JointProperties.FIELDS.items()
    for note in each.notes
    if isinstance(note, float | bool)
}


def joined_from(mapping: Mapping[Any, Any]) -> tuple[JointKind, str, str, JointProperties]:
    """
    Return kind, names of the bodies a and b, and properties of a YAML mapping.

    :raises Refusal: a key is unknown, or a value is out of range
    """
    for key in mapping:
        check_key(key, JOINT_KEYS)
    properties = {key: mapping[key] for key in mapping if key not in {'kind', 'a', 'b'}}
    a, b = (_name(mapping.get(key, ''), key) for key in ('a', 'b'))
    kind = kind_from(mapping.get('kind'))
    return kind, a, WORLD if a and not b else b, JointProperties.from_mapping(properties)
