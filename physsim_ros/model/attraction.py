# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Attraction: which bodies attract each other, by the settings of the world.

Masses attract each other by `gravitation`, charges of one sign repel each other by `coulomb`, both
by a power of the distance. `engine/core/attraction.c` has the formula.
"""

from __future__ import annotations

from collections.abc import Iterable

from physsim_ros.model.errors import WorldFull
from physsim_ros.model.scene import Body
from physsim_ros.model.settings import WorldSettings

# Greatest number of bodies that attract each other [1]: 500 take 4 ms a step.
MOST_ATTRACTING = 500


def attracts(body: Body, settings: WorldSettings) -> bool:
    """Return whether a body attracts others: by its mass, unless it is a sensor, or its charge."""
    by_mass = settings.gravitation != 0.0 and not body.sensor
    return by_mass or (settings.coulomb != 0.0 and body.charge != 0.0)


def check_attraction(bodies: Iterable[Body], settings: WorldSettings) -> None:
    """
    Refuse more bodies than can attract each other.

    :raises WorldFull: there would be too many
    """
    if not (settings.gravitation or settings.coulomb):
        return
    count = sum(attracts(body, settings) for body in bodies)
    if count > MOST_ATTRACTING:
        template = '{count} bodies would attract each other; at most {most} can'
        raise WorldFull(template, count=count, most=MOST_ATTRACTING)
