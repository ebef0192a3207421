# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 61: no contact of a machine pulls, and its friction is within the cone, in every step."""

from contextlib import suppress
import math
import random

import numpy as np
from physsim_ros.engine.checkpoint import take_checkpoint
from physsim_ros.model.errors import Refusal
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import join, simulation, spawn, walls
from ..slow import slow
from ..worlds import film

KINDS = ('axle', 'pin', 'rod', 'slider', 'rope', 'spring', 'motor')


def machine_on_a_floor(seed):
    """Return 3 to 12 bodies of any mass on a floor, with joints and motors of any kind."""
    pick, sim = random.Random(seed), simulation(friction=0.5)
    walls(sim, -3.0, 0.0, 3.0, 50.0)
    places = []
    for number in range(pick.randint(3, 12)):
        size = pick.uniform(0.1, 0.5)
        box = Box(width=2 * size, height=pick.uniform(0.1, 1.0))
        shape = pick.choice((Disc(radius=size), box))
        places.append((pick.uniform(-2.4, 2.4), pick.uniform(0.5, 2.0)))
        said = {
            'mass': 10.0 ** pick.uniform(-2.0, 2.0),
            'friction': pick.choice((0.0, 0.2, 0.5, 1.0, 3.0)),
            'elasticity': pick.choice((0.0, 0.0, 0.5, 0.9)),
            'velocity': (pick.uniform(-3.0, 3.0), pick.uniform(-3.0, 3.0)),
        }
        spawn(sim, f'b/{number}', shape, (*places[-1], pick.uniform(-3.0, 3.0)), **said)
    for number in range(pick.randint(1, 10)):
        one, (x, y) = (at := pick.randrange(len(places))), places[at]
        others = [f'b/{other}' for other in range(len(places)) if other != one]
        kind = pick.choice(KINDS)
        points = [(x + pick.uniform(-0.4, 0.4), y + pick.uniform(-0.4, 0.4))]
        if kind in ('rod', 'slider', 'rope', 'spring'):
            points.append((x + pick.uniform(-1.0, 1.0), y + pick.uniform(-1.0, 1.0)))
        said = {}
        if kind == 'motor':
            said['rate'] = pick.uniform(-20.0, 20.0)
        if kind == 'spring':
            said['stiffness'] = 10.0 ** pick.uniform(1.0, 4.0)
        with suppress(Refusal):
            join(sim, f'j/{number}', kind, points, a=f'b/{one}', b=pick.choice(others), **said)
    return sim


def outside_the_cone(world):
    """
    Return how far impulses of the last sub-step are outside their cones, at most.

    :return: by pulls, and by friction, shares of the greatest normal impulse [1]
    """
    memory = take_checkpoint(world.space, world.step_count).memory
    friction = dict.fromkeys(range(memory.following), world.settings.friction)
    for number, body in zip(memory.ids.tolist(), world.scene.bodies, strict=True):
        pieces = range(number, number + len(body.shape.form.pieces))
        friction |= dict.fromkeys(pieces, body.friction)
    normal, across = memory.impulses.T
    if not len(normal):
        return 0.0, 0.0
    most = np.array([math.sqrt(friction[a] * friction[b]) for a, b in memory.pairs.tolist()])
    greatest = max(np.abs(normal).max(), 1e-12)
    pulls, slips = -normal.min(), (np.abs(across) - most * normal).max()
    return pulls / greatest, slips / greatest


def check_cones(report, world, steps, what):
    worst = np.zeros(2)
    for _ in range(steps):
        world.step(1)
        worst = np.maximum(worst, outside_the_cone(world))
    # Rounding: a share of 1e-9 counts as none where rows are exchanged (`mixed_lcp.c`).
    report.check(61, f'{what}, pull of a contact', worst[0], 0.0, 2e-9, '–')
    report.check(61, f'{what}, friction beyond its cone', worst[1], 0.0, 1e-8, '–')


@pytest.mark.parametrize('seeds', [range(8), *(slow(range(n, n + 40)) for n in range(8, 300, 40))])
def test_no_contact_of_a_random_machine_pulls(report, seeds):
    for seed in seeds:
        check_cones(report, machine_on_a_floor(seed).world, 60, 'random machine')


@pytest.mark.parametrize('name', [*map(slow, ('bridge', 'car')), 'catapult'])
def test_no_contact_of_a_shipped_machine_pulls(report, name):
    check_cones(report, film.simulation(name).world, 600, 'shipped machine')
