# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 27: a world in the mirror moves as the mirror image of that world."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
import pytest

from .scenes import NOWHERE, simulation, spawn, steps, turned

MIRRORS = [math.radians(angle) for angle in (90, 0, 30)]


def _mirrored(vector, axis):
    """Return a vector in a mirror through the origin that lies along an angle [rad]."""
    x, y = turned(vector, -axis)
    return turned((x, -y), axis)


def _mirrored_shape(shape, axis):
    """Return the mirror image of a shape, at yaw 0."""

    def points(these):
        return tuple(tuple(_mirrored(point, axis)) for point in these)

    match shape:
        case Polygon(outline=outline):
            return Polygon(outline=points(outline))
        case Chain(points=these):
            return Chain(points=points(these), thickness=shape.thickness)
        case Compound(element=Disc(), centers=centers):
            return Compound(element=shape.element, centers=points(centers))
        case Box():
            return Polygon(outline=points(shape.corners()))
    return shape


def _check_mirror(report, bodies, seconds, axis, **settings):
    """
    Run a world and its mirror image, and compare them at each step.

    :param bodies: shape, pose and properties of each
    :return: in how many steps something changed its velocity
    """
    gravity = settings.pop('gravity', NOWHERE)
    here = simulation(gravity=gravity, **settings)
    there = simulation(gravity=tuple(_mirrored(gravity, axis)), **settings)
    for number, (shape, (x, y, yaw), properties) in enumerate(bodies):
        name, image = f'body/{number}', dict(properties)
        if 'velocity' in image:
            image['velocity'] = tuple(_mirrored(image['velocity'], axis))
        if 'spin' in image:
            image['spin'] = -image['spin']
        spawn(here, name, shape, (x, y, yaw), **properties)
        place = _mirrored((x, y), axis)
        spawn(there, name, _mirrored_shape(shape, axis), (*place, -yaw), **image)
    bounces, last = 0, here.world.snapshot()
    count = round(seconds * 240)
    for one, other in zip(steps(here, count), steps(there, count), strict=True):
        image = np.array([_mirrored(center, axis) for center in other.centers])
        off = float(np.abs(one.centers - image).max())
        report.check(27, 'mirror image, centres', off, 0.0, 1e-9, 'm')
        off = float(np.abs(one.poses[:, 2] + other.poses[:, 2]).max())
        report.check(27, 'mirror image, yaws', off, 0.0, 1e-9, 'rad')
        change = np.abs(one.twists - last.twists - (*gravity * np.array(1 / 240), 0.0))
        bounces += bool((change > 1e-9).any())
        last = one
    return bounces


def _plates(angles):
    """Return anchored plates, 6 m apart, each turned by its angle [°]."""
    plate = Box(width=4.0, height=0.5)
    return [
        (plate, (6.0 * number, -0.25, math.radians(angle)), {'anchored': True})
        for number, angle in enumerate(angles)
    ]


@pytest.mark.parametrize('axis', MIRRORS)
@pytest.mark.parametrize('elasticity', [0.9, 0.3])
def test_what_bounces_and_rolls_does_so_in_the_mirror(report, elasticity, axis):
    angles = (0, 20, -35, 10)
    bodies = _plates(angles)
    for number, angle in enumerate(angles):
        shape = Disc(radius=0.2 + 0.05 * number)
        properties = {'velocity': (0.3 * number - 0.2, 0.0), 'spin': 2.0 - angle / 10}
        bodies.append((shape, (6.0 * number, 1.0, 0.0), properties))

    bounces = _check_mirror(report, bodies, 1.5, axis, gravity=(0.0, -9.81), elasticity=elasticity)

    assert bounces > 4


@pytest.mark.parametrize('axis', MIRRORS)
def test_what_falls_on_a_corner_does_so_in_the_mirror(report, axis):
    bodies = _plates((0, 25, -15))
    ell = Polygon(outline=((0.0, 0.0), (0.6, 0.0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.8), (0.0, 0.8)))
    wheels = Compound(element=Disc(radius=0.15), centers=((-0.4, 0.0), (0.4, 0.1)))
    for number, shape in enumerate((Box(width=0.5, height=0.3), ell, wheels)):
        properties = {'velocity': (0.5, -1.0), 'spin': 1.0 - number}
        bodies.append((shape, (6.0 * number, 1.5, 0.4), properties))

    bounces = _check_mirror(report, bodies, 0.6, axis, gravity=(0.0, -9.81))

    assert bounces > 2


@pytest.mark.parametrize('axis', MIRRORS)
@pytest.mark.parametrize('friction', [0.0, 0.5])
def test_pairs_that_collide_do_so_in_the_mirror(report, friction, axis):
    pairs = [
        (Disc(radius=0.5), Disc(radius=0.3)),
        (Disc(radius=0.5), Box(width=0.6, height=0.8)),
        (Box(width=0.6, height=0.8), Box(width=1.0, height=0.4)),
        (Disc(radius=0.2), Chain(points=((0.0, -1.0), (0.3, 0.0), (0.0, 1.0)), thickness=0.1)),
    ]
    bodies = []
    for number, (one, other) in enumerate(pairs):
        y = 5.0 * number
        bodies.append((one, (-2.0, y + 0.2, 0.3), {'velocity': (2.0, 0.1), 'spin': 1.0}))
        bodies.append((other, (1.0, y, 0.1), {'velocity': (-1.0, 0.0)}))

    bounces = _check_mirror(report, bodies, 1.5, axis, friction=friction)

    assert bounces >= len(pairs)
