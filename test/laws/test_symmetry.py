# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Law 27: a world in the mirror moves as the mirror image of that world."""

import math

import numpy as np
from physsim_ros.core.shapes import Box, Chain, Compound, Disc, Polygon

from test.laws.scenes import NOWHERE, simulation, spawn, steps, turned

MIRRORS = [math.radians(angle) for angle in (90, 0, 30)]


def _mirrored(vector, axis):
    """Return a vector in a mirror through the origin that lies along an angle [rad]."""
    x, y = turned(vector, -axis)
    return turned((x, -y), axis)


def _mirrored_shape(shape, axis):
    """Return what a shape is in the mirror, at yaw 0."""

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
    """
    gravity = settings.pop('gravity', NOWHERE)
    here = simulation(gravity=gravity, **settings)
    there = simulation(gravity=tuple(_mirrored(gravity, axis)), **settings)
    for number, (shape, (x, y, yaw), properties) in enumerate(bodies):
        spawn(here, f'body/{number}', shape, (x, y, yaw), **properties)
        image = dict(properties)
        if 'velocity' in image:
            image['velocity'] = tuple(_mirrored(image['velocity'], axis))
        if 'spin' in image:
            image['spin'] = -image['spin']
        place = _mirrored((x, y), axis)
        spawn(there, f'body/{number}', _mirrored_shape(shape, axis), (*place, -yaw), **image)
    count = round(seconds * 240)
    touched = set()
    for one, other in zip(steps(here, count), steps(there, count), strict=True):
        image = np.array([_mirrored(center, axis) for center in other.centers])
        off = float(np.abs(one.centers - image).max())
        report.check(27, 'mirror image, centre', off, 0.0, 1e-9, 'm')
        turn = one.poses[:, 2] + other.poses[:, 2]
        off = float(np.abs(turn - turn.round(9)).max())
        report.check(27, 'mirror image, yaw', float(np.abs(turn).max()), 0.0, 1e-9, 'rad')
        touched.add(tuple(one.twists[:, 2].round(6)))
    return len(touched)
