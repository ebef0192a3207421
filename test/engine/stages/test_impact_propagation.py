# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Which contacts of elastic bodies are deferred, whatever the order in which they are listed."""

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
from physsim_ros.simulation.world import World
import pytest

from ...laws.scenes import NOWHERE, simulation, spawn, steps

NOTCHED = Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.2, 0.3), (0.0, 1.0)))
BENT = Chain(points=((-1.0, 0.0), (0.0, 0.2), (1.0, 0.0)), thickness=0.1)


def fallen() -> str:
    """Return the digest after a body of two pieces has hit both links of a chain in one step."""
    flying = Properties(mass=2.0, friction=0.1, elasticity=0.9, velocity=(1.75, -1.3), spin=0.81)
    anchored = Properties(friction=0.1, elasticity=0.9, anchored=True)
    world = World()
    world.apply(Spawn(name='a/0', shape=NOTCHED, pose=(1.4, 3.09, 2.01), properties=flying))
    world.apply(Spawn(name='b/0', shape=BENT, pose=(2.3, 0.78, 0.5), properties=anchored))
    world.step(140)
    return world.digest()


def test_several_contacts_of_two_bodies_are_deferred_in_any_order():
    # The engine lists contacts by their addresses, which these arrays change.
    kept, digests = [], set()
    for number in range(30):
        kept.append([bytearray(64 * (number % 7 + 1)) for _ in range(number * 13 % 50)])
        digests.add(fallen())
    assert len(digests) == 1


@pytest.mark.parametrize('mass', [10.0, 1000.0])
def test_a_heavy_disc_does_not_press_elastic_ones_into_each_other_by_their_radius(mass):
    sim, radius = simulation(gravity=NOWHERE, elasticity=0.9, friction=0.0), 0.2
    spawn(sim, 'heavy/0', Disc(radius=radius), (-1.0, 0.0, 0.0), mass=mass, velocity=(3.0, 0.0))
    for number in range(6):
        spawn(sim, f'disc/{number}', Disc(radius=radius), (2.0 * radius * number, 0.0, 0.0))
    spawn(sim, 'wall/0', Box(width=1.0, height=5.0), (2.7, 0.0, 0.0), anchored=True)

    # As a contact that is deep already is solved with the others, however fast the impact is.
    nearest = min(np.diff(now.poses[:-1, 0]).min() for now in steps(sim, 240))
    assert nearest > radius
