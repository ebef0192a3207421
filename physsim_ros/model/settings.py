# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings of a world: gravity, damping, solver, walls, and the default material of bodies."""

from __future__ import annotations

from dataclasses import dataclass, field
import math
from typing import ClassVar

from physsim_ros.model.checks import (
    Checked,
    Checks,
    HEAVIEST,
    LIGHTEST,
    pair,
    shown,
    Whole,
    Within,
)
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.shapes import LARGEST
from physsim_ros.model.transform import Point

Bounds = tuple[float, float, float, float]

# Standard gravity [m/s²]: of weights on the floor of a world seen from above, and of the forces of
# hands in worlds without gravity.
STANDARD_GRAVITY = 9.81
# Greatest gravity [m/s²]: a thousand times that of the earth, 40 m/s in a step.
STRONGEST = 1e4
# Greatest number of joints on one body [1]: a new joint takes a microsecond for each joint on its
# bodies.
MOST_JOINTS_ON_BODY = 1000
# Greatest number of hands that drag at once [1], each 12 µs a step: one for each page.
MOST_HANDS = 64
# Greatest number of topics of all robots [1]: those of 500 TurtleBots. Fast DDS takes a second to
# make them, and 15 s for 2,000 TurtleBots.
MOST_ROBOT_TOPICS = 4000
# Greatest number of samples of a stroke: a minute of a pen at 160 Hz.
MOST_SAMPLES = 10_000


def _gravity(value: object, name: str) -> Point:
    gravity = pair(value, name)
    if math.hypot(*gravity) > STRONGEST:
        raise BadProperty(f'{name} is stronger than {STRONGEST:g} m/s²', field=name)
    return gravity


def _bounds(value: object, name: str) -> Bounds:
    if not isinstance(value, list | tuple):
        raise BadProperty(f'{name} must be a list of four numbers, not {shown(value)}', field=name)
    if len(value) != 4:
        raise Malformed(f'{name} needs 4 numbers, not {len(value)}', field=name)
    left, bottom, right, top = (Within(-LARGEST, LARGEST, 'm')(each, name) for each in value)
    if not (left < right and bottom < top):
        raise BadProperty(
            f'{name} must be [xmin, ymin, xmax, ymax], each min below its max', field=name
        )
    return left, bottom, right, top


def _datum(value: object, name: str) -> Point:
    latitude, longitude = pair(value, name)
    return Within(-90.0, 90.0, 'deg')(latitude, name), Within(-180.0, 180.0, 'deg')(
        longitude, name
    )


# Checks of the settings that are a single number.
RANGES: dict[str, Within | Whole] = {
    'damping': Within(0.0, 1.0),
    'iterations': Whole(1, 1000),
    'density': Within(LIGHTEST, HEAVIEST, 'kg/m²'),
    'friction': Within(0.0, 10.0),
    'elasticity': Within(0.0, 1.0),
    'floor_friction': Within(0.0, 10.0),
    'seed': Whole(0, 2**31 - 1),
    'command_timeout': Within(0.0, 1e9, 's'),
    'drag_force': Within(0.0, 1000.0),
    'max_bodies': Whole(0, 1_000_000),
    'max_shapes': Whole(0, 1_000_000),
    # 10,000,000 contacts take a minute a step.
    'max_overlaps': Whole(0, 10_000_000),
    'max_joints': Whole(0, 1_000_000),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldSettings(Checked):
    """
    The settings of a world.

    :param gravity: [m/s²]
    :param damping: share of velocity lost each second, 0 .. 1
    :param iterations: of the engine's solver in a step, shared out among its sub-steps
    :param bounds: xmin, ymin, xmax, ymax of the walls around the world [m]; None is no walls
    :param density: of bodies by default [kg/m²]
    :param friction: coefficient of bodies by default
    :param elasticity: coefficient of restitution of bodies by default
    :param floor_friction: coefficient of friction between bodies and the floor of a world that is
        seen from above; 0 is a world that is seen from the side
    :param seed: of all noise
    :param datum: latitude and longitude of the origin [deg], where x is east; None is nowhere
    :param command_timeout: simulation time for which a wrench acts [s]; 0 is no limit
    :param drag_force: greatest force of a hand, in weights of the body
    :param max_bodies: greatest number of bodies
    :param max_shapes: greatest number of their convex pieces
    :param max_overlaps: greatest number of pairs of pieces that overlap at once by a request
    :param max_joints: greatest number of joints, of which `MOST_JOINTS_ON_BODY` on one body
    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is out of range
    """

    CHECKS: ClassVar[Checks] = {'gravity': _gravity, 'bounds': _bounds, 'datum': _datum, **RANGES}

    gravity: tuple[float, float] = (0.0, -9.81)
    damping: float = 0.0
    iterations: int = 16
    bounds: Bounds | None = None
    density: float = 1.0
    friction: float = 0.5
    elasticity: float = 0.5
    # Not part of the text, so that digests of worlds without a floor are those of ever.
    floor_friction: float = field(default=0.0, repr=False)
    seed: int = field(default=0, repr=False)
    datum: Point | None = field(default=None, repr=False)
    command_timeout: float = 0.5
    drag_force: float = 10.0
    max_bodies: int = 20000
    max_shapes: int = 50000
    max_overlaps: int = 20000
    max_joints: int = 20000


def check_setting(name: str) -> None:
    """
    Refuse a name that is no setting.

    :raises BadProperty: it is not
    """
    if name not in WorldSettings.CHECKS:
        raise BadProperty(f'the world has no setting {name!r}', field=name)
