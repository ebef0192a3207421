# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings of a world: gravity, damping, solver, walls, and the default material of bodies."""

from dataclasses import dataclass
import math
from typing import Annotated

from physsim_ros.model.checks import (
    DENSITY,
    DENSITY_WORDS,
    ELASTICITY,
    ELASTICITY_WORDS,
    FRICTION,
    FRICTION_WORDS,
    HEAVIEST,
    Numbers,
    shown,
    Vector,
    VELOCITY,
    Whole,
    Within,
)
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, WorldFull
from physsim_ros.model.media import DRAG, FLUID_DENSITY, GUST_TIME, GUSTS, Medium, VISCOSITY
from physsim_ros.model.shapes import LARGEST
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

Bounds = tuple[float, float, float, float]

# Standard gravity [m/s²]: also of weights on a floor, and where there is no gravity.
STANDARD_GRAVITY = 9.81
# Greatest gravity [m/s²]: a thousand times that of the earth, 40 m/s in a step.
STRONGEST = 1e4
# Greatest number of joints on one body [1]: a new joint takes a microsecond for each joint on its
# bodies.
MOST_JOINTS_ON_BODY = 1000
# A note of a setting that protects the node, and that no world file changes.
LIMIT = 'limit'
# A note of a setting that is of a world alone: a world file without it has its default.
OF_WORLD = 'of world'
# The counts that the settings limit.
_COUNTED = {'max_bodies': 'bodies', 'max_shapes': 'convex pieces', 'max_joints': 'joints'}
# Greatest number of samples of a stroke: a minute of a pen at 160 Hz.
MOST_SAMPLES = 10_000


def rectangle(value: object, name: str) -> Bounds:
    """
    Return the bounds of a rectangle [m].

    :raises Malformed: a number is not finite, or there are more or fewer than four
    :raises BadProperty: it is no list of numbers, one is out of range, or a min not below its max
    """
    left, bottom, right, top = Numbers((Within(-LARGEST, LARGEST, 'm'),) * 4)(value, name)
    if not (left < right and bottom < top):
        raise BadProperty(
            '{field} must be [xmin, ymin, xmax, ymax], each min below its max', field=name
        )
    return left, bottom, right, top


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldSettings(Checked):
    """
    The settings of a world; each is the ROS parameter of the same name.

    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is out of range
    """

    gravity: Annotated[Point, Vector(STRONGEST, 'm/s²', 'stronger'), 'acceleration'] = (
        0.0,
        -STANDARD_GRAVITY,
    )
    damping: Annotated[
        float,
        Within(0.0, 1.0),
        'share of its velocity that each body loses per second',
        Words('damper', 'drag'),
    ] = 0.0
    iterations: Annotated[
        int,
        Whole(1, 1000),
        'solver iterations of a step, divided among its four sub-steps; more make tall stacks '
        'stiffer',
    ] = 16
    bounds: Annotated[
        Bounds | None,
        rectangle,
        'walls around the world: xmin, ymin, xmax, ymax, each '
        f'{-LARGEST:g} .. {LARGEST:g} [m]; empty is no walls',
    ] = None
    density: Annotated[
        float, DENSITY, 'density of new bodies, unless they have their own', DENSITY_WORDS
    ] = 1.0
    friction: Annotated[
        float,
        FRICTION,
        'coefficient of friction of new bodies, unless they have their own',
        FRICTION_WORDS,
    ] = 0.5
    elasticity: Annotated[
        float,
        ELASTICITY,
        'coefficient of restitution of new bodies, unless they have their own',
        ELASTICITY_WORDS,
    ] = 0.5
    floor_friction: Annotated[
        float,
        FRICTION,
        'coefficient of friction between bodies and the floor of a world seen from above; 0 for a '
        'world seen from the side',
    ] = 0.0
    seed: Annotated[int, Whole(0, 2**31 - 1), 'seed of the noise of robots, and of gusts'] = 0
    air_density: Annotated[
        float,
        FLUID_DENSITY,
        'density of the air, which fills the world outside of bodies with a `medium`: it buoys '
        'bodies up, and resists them by v²',
        OF_WORLD,
    ] = 0.0
    air_viscosity: Annotated[
        float,
        VISCOSITY,
        'viscosity of the air, which resists bodies by v (Stokes)',
        OF_WORLD,
    ] = 0.0
    air_drag: Annotated[float, DRAG, 'coefficient of the drag of the air by v²', OF_WORLD] = 1.0
    wind: Annotated[Point, VELOCITY, 'velocity of the air', OF_WORLD] = (0.0, 0.0)
    gusts: Annotated[
        float,
        GUSTS,
        'root mean square of the gusts of the wind, in x and in y; they depend on `seed`',
        OF_WORLD,
    ] = 0.0
    gust_time: Annotated[float, GUST_TIME, 'typical time from one gust to the next', OF_WORLD] = (
        2.0
    )
    gravitation: Annotated[
        float,
        Within(0.0, HEAVIEST, 'N m²/kg²'),
        'constant G of the attraction G m m / r² between all bodies except sensors; its unit '
        'depends on `attraction_power`',
        OF_WORLD,
    ] = 0.0
    coulomb: Annotated[
        float,
        Within(0.0, HEAVIEST, 'N m²/C²'),
        'constant k of the force k q q / r² between bodies with a `charge`; its unit depends on '
        '`attraction_power`',
        OF_WORLD,
    ] = 0.0
    attraction_power: Annotated[
        float,
        Within(-1.0, 4.0),
        'exponent p of the distance, 1 / r^p, in both forces: 2 as in space, 1 in a flat world',
        OF_WORLD,
    ] = 2.0
    softening: Annotated[
        float,
        Within(0.0, 1000.0, 'm'),
        'length ε that limits both forces at small distances: r² becomes r² + ε²',
        OF_WORLD,
    ] = 0.001
    datum: Annotated[
        Point | None,
        Numbers((Within(-90.0, 90.0, 'deg'), Within(-180.0, 180.0, 'deg'))),
        'latitude and longitude of the origin, -90 .. 90 and -180 .. 180 [deg], for receivers of '
        'satellite navigation; x points east, y north. Without a datum they have no fix',
    ] = None
    command_timeout: Annotated[
        float,
        Within(0.0, 1e9, 's'),
        'simulation time for which a commanded wrench acts; 0 is no limit',
    ] = 0.5
    drag_force: Annotated[
        float,
        Within(0.0, 1000.0),
        'greatest force of a hand, as a multiple of the weight of the body',
    ] = 10.0
    max_bodies: Annotated[int, Whole(0, 1_000_000), 'greatest number of bodies', LIMIT] = 20000
    max_shapes: Annotated[
        int,
        Whole(0, 1_000_000),
        'greatest number of convex pieces of all bodies',
        LIMIT,
    ] = 50000
    # 10,000,000 contacts take a minute a step.
    max_overlaps: Annotated[
        int,
        Whole(0, 10_000_000),
        'greatest number of pairs of pieces that overlap at once',
        LIMIT,
    ] = 20000
    max_joints: Annotated[
        int,
        Whole(0, 1_000_000),
        f'greatest number of joints; at most {MOST_JOINTS_ON_BODY} can be on one body',
        LIMIT,
    ] = 20000

    @property
    def reference_gravity(self) -> float:
        """Return the gravity of weights [m/s²]: the standard one where the world has none."""
        return math.hypot(*self.gravity) or STANDARD_GRAVITY

    @property
    def wall_count(self) -> int:
        """Return the number of walls around the world."""
        return 0 if self.bounds is None else 4

    @property
    def air(self) -> Medium:
        """Return the air, as a medium that fills the world."""
        return Medium(
            density=self.air_density,
            viscosity=self.air_viscosity,
            drag=self.air_drag,
            flow=self.wind,
            gusts=self.gusts,
            gust_time=self.gust_time,
        )


def check_setting(name: object) -> None:
    """
    Refuse a name that is no setting.

    :raises BadProperty: it is not
    """
    if name not in WorldSettings.FIELDS:
        raise BadProperty('the world has no setting {value}', field=str(name), value=shown(name))


def check_limit(limit: str, count: int, settings: WorldSettings) -> None:
    """
    Refuse a number of bodies, convex pieces or joints.

    :param limit: name of the greatest number in the settings
    :raises WorldFull: it is too great
    """
    most = getattr(settings, limit)
    if count > most:
        raise WorldFull(
            'the world would have {count} {things}; {limit} is {most}',
            count=count,
            things=Text(_COUNTED[limit]),
            limit=limit,
            most=most,
        )
