# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds, bodies and materials that the scenes of the laws share."""

import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Configure, Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation

G = 9.81
DT = 1 / 240
NOWHERE = (0.0, 0.0)


def integrated(change, state, seconds, count):
    """
    Return a state after some time, by the method of Runge and Kutta of fourth order.

    :param change: gives the derivative of a state by time [1/s]
    :param count: of equal parts of the time
    """
    dt = seconds / count
    for _ in range(count):
        a = change(state)
        b = change(state + dt / 2 * a)
        c = change(state + dt / 2 * b)
        d = change(state + dt * c)
        state = state + dt / 6 * (a + 2 * b + 2 * c + d)
    return state


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
    """Yield a snapshot after each step."""
    for _ in range(count):
        sim.world.step(1)
        yield sim.world.snapshot()


def run(sim, seconds):
    """Advance frame by frame; return the last snapshot."""
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


def hanging_chain(count, link=0.2):
    """Return links of 0.1 kg that hang by axles on each other, level at first."""
    sim = simulation()
    for number in range(count):
        place = (link * (number + 0.5), 0.0, 0.0)
        spawn(sim, f'link/{number}', Box(width=link, height=0.05), place, mass=0.1)
        other = f'link/{number - 1}' if number else 'world'
        points = [(link * number, 0.0)]
        join(sim, f'joint/{number}', 'axle', points, a=f'link/{number}', b=other)
    return sim


def pyramid(sim, size, gap):
    """Pile up 14 levels of boxes, apart by a share of their size; return their heights [m]."""
    heights = []
    for level in range(14):
        for place in range(14 - level):
            x = (place - (13 - level) / 2) * size * (1 + gap)
            pose = (x, size * (level + 0.5), 0.0)
            spawn(sim, f'box/{len(heights)}', Box(width=size, height=size), pose)
            heights.append(pose[1])
    return heights


def bar_among_discs(spin):
    """Return a world with a bar of 4 m that spins among 40 discs, and their rows."""
    sim = simulation(gravity=NOWHERE, friction=0.0)
    spawn(sim, 'bar/0', Box(width=4.0, height=0.05), kinematic=True, spin=spin)
    discs = []
    for number in range(40):
        angle, far = 0.2 + 2.7 * number / 40, 0.4 + 1.5 * (number * 7 % 40) / 40
        place = (far * math.cos(angle), far * math.sin(angle), 0.0)
        discs.append(spawn(sim, f'disc/{number}', Disc(radius=0.03), place))
    return sim, discs


def energy(snapshot):
    """Return all the energy there is [J]."""
    return snapshot.kinetic_energy + snapshot.potential_energy + snapshot.elastic_energy


def angular_momentum(snapshot):
    """Return that of all bodies about the origin, spin included [kg m²/s]."""
    mass, moment = snapshot.scene.inertia.T
    path = cross(snapshot.centers.T, snapshot.twists[:, :2].T)
    return float((mass * path + moment * snapshot.twists[:, 2]).sum())
