# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A picture shows all of a world, whatever its proportions are."""

from __future__ import annotations

from itertools import product

import numpy as np
from physsim_ros import Disc, Simulation, Spawn, WorldSettings
from physsim_ros.appearance import picture_of
import pytest

RED = (1.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize('height', [0.1, 1.0, 4.0, 30.0])
def test_what_is_in_the_corners_of_a_world_is_in_its_picture(height: float) -> None:
    bounds = (-5.0, 0.0, 5.0, 10.0 * height)
    simulation = Simulation(settings=WorldSettings(bounds=bounds))
    inside = min(0.4, 0.4 * height)
    places = product((inside - 5.0, 5.0 - inside), (inside, 10.0 * height - inside))
    for number, place in enumerate(places):
        disc = Disc(radius=inside)
        simulation.perform(Spawn(name=f'disc/{number}', shape=disc, pose=(*place, 0.0), color=RED))
    picture = picture_of(simulation.frame.snapshot, 400)
    red = (picture[..., 0] > 200) & (picture[..., 1] < 100)
    top, bottom = np.array_split(red, 2)
    corners = [part for half in (top, bottom) for part in np.array_split(half, 2, axis=1)]
    assert all(part.any() for part in corners)
