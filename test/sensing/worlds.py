# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds for sensors, and the engine's own rays in them."""

from dataclasses import replace
import math

import numpy as np
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pymunk

from ..building import SHAPES, spawn

# The engine's discs are smaller by 1e-12 m, and poses go to the centre of mass and back.
PRECISION = 1e-9


def plane(**settings):
    """Return an empty world that is seen from above."""
    return World(settings=WorldSettings(gravity=(0.0, 0.0), **settings))


def random_world(seed, count=120, side=8.0, **settings):
    """Return a world of all shapes, some of which overlap, around a clearing of 1 m."""
    world = plane(**settings)
    pick = np.random.default_rng(seed)
    for number in range(count):
        angle, away = pick.uniform(0.0, math.tau), pick.uniform(2.5, side)
        pose = (away * math.cos(angle), away * math.sin(angle), pick.uniform(-10.0, 10.0))
        shape = list(SHAPES.values())[number % len(SHAPES)]
        spawn(world, f'thing/{number}', shape, pose, anchored=bool(number % 3))
    return world


def add_robot(world, name='robot/0', pose=(0.0, 0.0, 0.0), shape=None, **properties):
    """Spawn a body for sensors; return its row."""
    spawn(world, name, shape or Disc(radius=0.1), pose, **properties)
    return world.snapshot().scene.names.index(name)


def seen(world, seed):
    """Return the snapshot of a world whose noise has another seed."""
    snapshot = world.snapshot()
    settings = replace(snapshot.scene.settings, seed=seed)
    return replace(snapshot, scene=replace(snapshot.scene, settings=settings))


def engine_rays(world, origin, angles, reach):
    """Return (k,) float64: distances along rays by Chipmunk's own query [m]."""
    space, everything = world.space.pm_space, pymunk.ShapeFilter()
    distances = []
    for angle in angles:
        x, y = reach * math.cos(angle), reach * math.sin(angle)
        hit = space.segment_query_first(origin, (origin[0] + x, origin[1] + y), 0.0, everything)
        distances.append(math.inf if hit is None else reach * hit.alpha)
    return np.array(distances)
