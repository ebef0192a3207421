# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Media: water, air or another fluid, which fills the region of a body or all of the world.

A medium carries what lies in it by its weight (buoyancy), resists what moves through it (linear
drag, by viscosity, and quadratic drag, by density), and flows. `engine/core/media.c` has the
formulas. The plane is a metre deep: a density is a mass by area, as that of bodies.
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import DENSITY_WORDS, HEAVIEST, VELOCITY, Whole, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.noise import normals
from physsim_ros.model.transform import Point

# Checks of the fields of a medium, which the settings of the world share for its air.
FLUID_DENSITY = Within(0.0, HEAVIEST, 'kg/m²')
VISCOSITY = Within(0.0, 1e6, 'N s/m²')
DRAG = Within(0.0, 100.0)
GUSTS = Within(0.0, 1000.0, 'm/s')
GUST_TIME = Within(0.01, 1e4, 's')
# Waves of a gust, in each of two directions.
WAVES = 8
# The greatest rate of them by the least [1].
_WIDEST = 16.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Medium(Checked):
    """
    What fills a region.

    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: a value is missing, of the wrong kind or out of range
    """

    density: Annotated[
        float,
        FLUID_DENSITY,
        'buoyancy is the weight of as much of the medium as a body displaces; quadratic drag '
        'grows with it',
        DENSITY_WORDS,
    ]
    viscosity: Annotated[
        float,
        VISCOSITY,
        'η of linear drag: 3 η v for each metre of outline, which is 6π η r v for a disc (Stokes)',
    ] = 0.0
    drag: Annotated[
        float, DRAG, 'coefficient c of quadratic drag, ½ c ρ v² times the width across the flow'
    ] = 1.0
    flow: Annotated[
        Point, VELOCITY, 'velocity of a current or wind, in the axes of the region'
    ] = (0.0, 0.0)
    gusts: Annotated[
        float,
        GUSTS,
        'root mean square of the gusts, in x and in y, which are added to the flow; by `seed`',
    ] = 0.0
    gust_time: Annotated[float, GUST_TIME, 'typical time from one gust to the next'] = 2.0
    gust_seed: Annotated[
        int,
        Whole(0, 2**31 - 1),
        'media with the same number have the same gusts at the same times',
    ] = 0

    @property
    def acts(self) -> bool:
        """Whether it has any effect: it has a density or a viscosity."""
        return self.density > 0.0 or self.viscosity > 0.0


def gust_waves(medium: Medium, seed: int) -> Floats:
    """
    Return the waves whose sum is the gusts of a medium.

    Spectral representation (M. Shinozuka, Simulation of multivariate and multidimensional random
    processes, 1971): waves at fixed rates, whose amplitudes are random numbers of the seed. They
    depend on the time alone, so that rewinding needs no state.

    :param seed: of the world
    :return: (WAVES, 5) float64: rate ω [rad/s], then x and y of the factors of cos ωt and sin ωt
        [m/s]
    """
    spread = np.arange(WAVES) / (WAVES - 1) - 0.5
    rates = 2.0 * np.pi / medium.gust_time * _WIDEST**spread
    factors = normals(seed, f'gusts {medium.gust_seed}', 0, 4 * WAVES).reshape(WAVES, 2, 2)
    # The mean square of a wave is half the sum of its squares.
    power = (factors**2).sum(axis=(0, 1)) / 2
    factors *= medium.gusts / np.sqrt(power)
    return np.column_stack((rates, factors.reshape(WAVES, 4)))
