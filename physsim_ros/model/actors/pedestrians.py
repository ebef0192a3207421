# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pedestrians: actors that walk from point to point, by a model of how they avoid each other."""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.actors.actor import Actor, PACE
from physsim_ros.model.checks import MOST_SPEED_WORDS, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.texts import Words

# Greatest length of a model of pedestrians [m], time [s] and strength [m²/s²].
_FAR, _LONG, _STRONG = 100.0, 100.0, 1e4
_LENGTH, _TIME = Within(1e-3, _FAR, 'm'), Within(1e-2, _LONG, 's')
_STRENGTH = Within(0.0, _STRONG, 'm²/s²')


@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrian(Actor):
    """Somebody who walks from point to point; `points` have no yaw."""

    speed: Annotated[float, PACE, 'desired speed'] = 1.34
    max_speed: Annotated[
        float | None, PACE, 'greatest speed; by default 1.3 `speed`', MOST_SPEED_WORDS
    ] = None
    goal_radius: Annotated[float, _LENGTH, 'distance at which a point counts as reached'] = 0.3

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if len(self.points[0]) != 2:
            raise Malformed('points of pedestrians are [x, y]', field='points')
        if self.max_speed is not None and self.max_speed < self.speed:
            raise BadProperty('max_speed is less than speed', field='max_speed')

    @property
    def track(self) -> list[tuple[float, float, float, float]]:
        """Return its points; their times and yaws are 0."""
        return [(0.0, x, y, 0.0) for x, y in self.points]

    @property
    def pace(self) -> tuple[float, float, float]:
        """Return the desired and the greatest speed [m/s], and the goal radius [m]."""
        most = 1.3 * self.speed if self.max_speed is None else self.max_speed
        return self.speed, most, self.goal_radius


@dataclass(frozen=True, slots=True, kw_only=True)
class SocialForce(Pedestrian):
    """
    A pedestrian of the social force model.

    D. Helbing and P. Molnár, "Social force model for pedestrian dynamics", Physical Review E 51,
    1995. Defaults are theirs, but that of `step_time`: 0.5 s are those of A. Johansson, D. Helbing
    and P. Shukla, "Specification of the social force pedestrian model by evolutionary optimization
    to video tracking data", 2007. With the 2 s of 1995, 40 pedestrians who walk against each other
    on 40 m by 5 m form no lanes in 90 s; with 1 s they do in 30 s, with 0.5 s in 20 s.
    """

    KIND: ClassVar = 'social_force'
    KIND_WORDS: ClassVar = Words('pedestrian', 'person', 'people', 'human', 'walk', 'crowd')

    relaxation_time: Annotated[float, _TIME, 'time to approach the desired velocity: τ'] = 0.5
    repulsion: Annotated[float, _STRENGTH, 'potential of other pedestrians: V⁰'] = 2.1
    repulsion_range: Annotated[float, _LENGTH, 'distance over which `repulsion` decays: σ'] = 0.3
    step_time: Annotated[float, _TIME, 'time for which others are expected to walk on: Δt'] = 0.5
    wall_repulsion: Annotated[
        float, _STRENGTH, 'potential of walls and of bodies that do not walk: U⁰'
    ] = 10.0
    wall_range: Annotated[float, _LENGTH, 'distance over which `wall_repulsion` decays: R'] = 0.2
    sight: Annotated[float, Within(0.0, math.pi, 'rad'), 'half the angle of view: φ'] = (
        math.radians(100.0)
    )
    behind: Annotated[
        float, Within(0.0, 1.0), 'share of the repulsion by what is out of sight: c'
    ] = 0.5

    @property
    def parameters(self) -> tuple[float, ...]:
        """Return the numbers of `SocialForce` in `engine/core/core.h`."""
        return (
            self.relaxation_time,
            self.repulsion,
            self.repulsion_range,
            self.step_time,
            self.wall_repulsion,
            self.wall_range,
            math.cos(self.sight),
            self.behind,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Orca(Pedestrian):
    """
    A pedestrian that avoids collisions by optimal reciprocal collision avoidance.

    Van den Berg, Guy, Lin and Manocha, "Reciprocal n-body collision avoidance", 2011.
    """

    KIND: ClassVar = 'orca'
    KIND_WORDS: ClassVar = Words('rvo', 'rvo2', 'velocity_obstacle')

    horizon: Annotated[
        float, _TIME, 'time for which its velocity is free of collisions with bodies that move: τ'
    ] = 2.0
    wall_horizon: Annotated[float, _TIME, 'the same for anchored bodies and walls'] = 0.5

    @property
    def parameters(self) -> tuple[float, ...]:
        """Return the numbers of `Orca` in `engine/core/core.h`."""
        return self.horizon, self.wall_horizon
