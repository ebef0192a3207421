# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A shipped world by its name, and its frames over some seconds, for the tests of worlds."""

from functools import cache
from pathlib import Path

import numpy as np
from physsim_ros.files import find_world, load_world
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.simulation import Simulation

G = 9.81
RATE = 240.0
FRAMES = 60


def state_of(name):
    """Return the state that a world of the package begins with."""
    path = find_world(name, world_dir=Path('nowhere'), confined=True)
    return load_world(path, settings=WorldSettings(), physics_rate=RATE)


def simulation(name):
    """Begin with a world of the package."""
    sim = Simulation(physics_rate=RATE, publish_rate=FRAMES)
    sim.begin(state_of(name))
    return sim


class Film:
    """
    What became of a simulation, frame by frame, the first one before anything moved.

    :param seconds: how long it goes on
    """

    def __init__(self, sim, seconds):
        self.frames = [sim.world.snapshot()]
        self.frames += [sim.advance_frame().snapshot for _ in range(round(seconds * FRAMES))]
        self.names = self.frames[0].scene.names
        self.poses = np.array([frame.poses for frame in self.frames])
        self.twists = np.array([frame.twists for frame in self.frames])

    def pose(self, name):
        """Return the poses of a body, (f, 3)."""
        return self.poses[:, self.names.index(name)]

    def x(self, name):
        """Return where a body is from left to right, (f,)."""
        return self.pose(name)[:, 0]

    def yaw(self, name):
        """Return how far a body has turned, (f,)."""
        return self.pose(name)[:, 2]

    def twist(self, name):
        """Return the twists of a body, (f, 3)."""
        return self.twists[:, self.names.index(name)]

    def weight(self, *namespaces):
        """Return the mass of all bodies of these namespaces together [kg]."""
        bodies = self.frames[0].scene.bodies
        return sum(body.total_mass for body in bodies if body.name.partition('/')[0] in namespaces)


@cache
def film(name, seconds):
    """Return the film of a world of the package, which is made once."""
    return Film(simulation(name), seconds)


def at(seconds):
    """Return the frame at a time."""
    return round(seconds * FRAMES)


def first(condition):
    """Return the first frame in which something is so."""
    assert condition.any(), 'it never came to that'
    return int(np.argmax(condition))
