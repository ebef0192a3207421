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

"""What the scenes of the laws have in common."""

import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Configure, Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation

G = 9.81
DT = 1 / 240
NOWHERE = (0.0, 0.0)


def simulation(**settings):
    """Make an empty world at the default settings, save those that are named."""
    return Simulation(settings=WorldSettings(**settings))


def spawn(sim, name, shape, pose=(0.0, 0.0, 0.0), **properties):
    """Add a body; return its row."""
    sim.perform(Spawn(name=name, shape=shape, pose=pose, properties=Properties(**properties)))
    return len(sim.world) - 1


def floor(sim, *, angle=0.0, **properties):
    """Add an anchored slab, its top going through the origin at an angle [rad]; return its row."""
    pose = (math.sin(angle), -math.cos(angle), angle)
    return spawn(sim, 'floor/0', Box(width=200.0, height=2.0), pose, anchored=True, **properties)


def walls(sim, left, bottom, right, top):
    """Close the world in."""
    sim.perform(Configure(changes={'bounds': (left, bottom, right, top)}))


def steps(sim, count):
    """Yield what is so after each of so many steps."""
    for _ in range(count):
        sim.world.step(1)
        yield sim.world.snapshot()


def run(sim, seconds):
    """Go on by that time, frame by frame; return what is so then."""
    for _ in range(round(seconds * 60)):
        frame = sim.advance_frame()
    return frame.snapshot


def turned(vector, angle):
    """Return a vector turned counter-clockwise [rad]."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def cross(a, b):
    """Return the z component of the cross product of plane vectors."""
    return a[0] * b[1] - a[1] * b[0]


def corners(box, pose):
    """Return the corners of a box in the world, (4, 2)."""
    return np.array([np.array(pose[:2]) + turned(corner, pose[2]) for corner in box.corners()])


def depth_in_box(center, radius, box, pose):
    """Return how deep a disc lies in a box [m]; negative is the distance between them."""
    x, y = np.abs(turned(np.array(center) - pose[:2], -pose[2]))
    out_x, out_y = x - box.width / 2, y - box.height / 2
    outside = math.hypot(max(out_x, 0.0), max(out_y, 0.0))
    return radius - outside - min(max(out_x, out_y), 0.0)


def until_velocity_changes(sim, row, most=2000):
    """Step until a body's velocity or spin changes; return the snapshots before and after."""
    before = sim.world.snapshot()
    for after in steps(sim, most):
        if np.abs(after.twists[row] - before.twists[row]).max() > 1e-12:
            return before, after
        before = after
    raise AssertionError('nothing happened')


def join(sim, name, kind, points, *, a='', b='', **properties):
    """Join two bodies, or one and the background."""
    said = JointProperties(**properties)
    kind = JointKind(kind)
    sim.perform(Join(name=name, kind=kind, points=tuple(points), a=a, b=b, properties=said))


def energy(snapshot):
    """Return all the energy there is [J]."""
    return snapshot.kinetic_energy + snapshot.potential_energy + snapshot.elastic_energy
