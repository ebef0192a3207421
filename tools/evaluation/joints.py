# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints that people draw over bodies: ropes over wheels, axles through several bodies, welds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.model.snapshot import Snapshot

from .outlines import Floats, Random
from .things import line, Thing


def _over_wheels(count: int) -> Callable[[Random, str], Thing]:
    """Return a function that draws a rope from a weight over anchored wheels to another weight."""

    def thing(rng: Random, _half: str) -> Thing:
        radius, size = rng.uniform(0.2, 0.6), rng.uniform(0.15, 0.4)
        apart = radius * rng.uniform(3.0, 6.0)
        wheels = [(apart * each, rng.normal(0.0, 0.1) * radius) for each in range(count)]
        # The rope lies beside the rim, on either side of it.
        beside = radius * rng.uniform(0.9, 1.3)
        angle = np.linspace(math.pi, 0.0, 30)
        arc = beside * np.column_stack((np.cos(angle), np.sin(angle)))
        # Of two wheels, each is passed by a quarter.
        parts = zip(np.array_split(arc, count), wheels, strict=True)
        arcs = [part + wheel for part, wheel in parts]
        first, last = arcs[0][0], arcs[-1][-1]
        ends = [end - (0.0, rng.uniform(2.0, 6.0) * radius) for end in (first, last)]
        weights = [
            Spawn(name=f'a/{n}', shape=_shape(rng, size), pose=(*end.tolist(), 0.0))
            for n, end in enumerate(ends)
        ]
        fixed = Properties(anchored=True)
        under = [
            Spawn(name=f'wheel/{n}', shape=Disc(radius=radius), pose=(*at, 0.0), properties=fixed)
            for n, at in enumerate(wheels)
        ]
        # A hand ends within the weight.
        drawn = [end + 0.2 * size * rng.normal(0.0, 1.0, 2) for end in ends]
        path = np.vstack((drawn[0], *arcs, drawn[1]))
        names = {each.name for each in under}

        def right(snapshot: Snapshot) -> bool:
            joints = snapshot.scene.joints
            return [each.kind for each in joints] == [JointKind.ROPE] and (
                {each.body for each in joints[0].guides},
                {joints[0].a, joints[0].b},
            ) == (names, {'a/0', 'a/1'})

        return Thing(paths=[path], under=(*under, *weights), right=right)

    return thing


def _shape(rng: Random, size: float) -> Shape:
    if rng.random() < 0.5:
        return Disc(radius=size)
    return Box(width=2.0 * size, height=size * rng.uniform(1.0, 2.0))


def _planks(rng: Random, count: int) -> list[Spawn]:
    """Return planks that cross at the origin, each turned against the others."""
    turn, wide = rng.uniform(0.0, math.pi), rng.uniform(0.2, 0.4)
    planks = []
    for number in range(count):
        yaw, off = turn + number * math.pi / count, rng.uniform(-0.5, 0.5)
        pose = off * math.cos(yaw), off * math.sin(yaw), yaw
        shape = Box(width=rng.uniform(1.5, 3.0), height=wide)
        planks.append(Spawn(name=f'a/{number}', shape=shape, pose=pose))
    return planks


def _circle(rng: Random, planks: Sequence[Spawn]) -> Floats:
    """Return a small circle about the origin, where planks cross."""
    wide = min(each.shape.height for each in planks if isinstance(each.shape, Box))
    angle = np.linspace(0.0, 2.0 * math.pi, 60)
    circle = np.column_stack((np.cos(angle), rng.uniform(0.8, 1.0) * np.sin(angle)))
    circle[-1] = circle[0]
    return wide * rng.uniform(0.25, 0.5) * circle


def _axle_through(count: int, rings: int) -> Callable[[Random, str], Thing]:
    """
    Return a function that draws an axle through planks.

    :param rings: number of circles that are drawn there, one after the other
    """

    def thing(rng: Random, _half: str) -> Thing:
        planks = _planks(rng, count)
        ends = {each.name for each in planks} | ({WORLD} if rings > 1 else set())

        def right(snapshot: Snapshot) -> bool:
            joints = snapshot.scene.joints
            axles = all(each.kind is JointKind.AXLE for each in joints)
            joined = {name for each in joints for name in (each.a, each.b)}
            alone = len(snapshot.scene.bodies) == count
            return axles and alone and joined == ends and len(joints) == len(ends) - 1

        paths = [_circle(rng, planks) for _ in range(rings)]
        return Thing(paths=paths, under=planks, right=right)

    return thing


def _on_two(kind: JointKind) -> Callable[[Random, str], Thing]:
    """Return a function that draws a small square or circle where two planks meet or overlap."""

    def thing(rng: Random, _half: str) -> Thing:
        high = rng.uniform(0.3, 0.8)
        # From an overlap to a gap.
        between = high * rng.uniform(-0.6, 0.15)
        planks = []
        for number, side in enumerate((-1.0, 1.0)):
            wide = rng.uniform(1.5, 3.0)
            pose = side * (wide + between) / 2, rng.normal(0.0, 0.03), rng.normal(0.0, 0.02)
            shape = Box(width=wide, height=high)
            planks.append(Spawn(name=f'a/{number}', shape=shape, pose=pose))
        if kind is JointKind.AXLE:
            path = _circle(rng, planks)
        else:
            half = rng.uniform(0.2, 0.4) * high
            corners = line((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))
            corners[1:-1] += rng.uniform(-0.1, 0.1, (3, 2))
            path = half * corners

        def right(snapshot: Snapshot) -> bool:
            joints = [(each.kind, {each.a, each.b}) for each in snapshot.scene.joints]
            return joints == [(kind, {'a/0', 'a/1'})] and len(snapshot.scene.bodies) == 2

        return Thing(paths=[path], under=planks, right=right)

    return thing


JOINTS: dict[str, Callable[[Random, str], Thing]] = {
    'rope over a wheel': _over_wheels(1),
    'rope over two wheels': _over_wheels(2),
    'axle through three planks': _axle_through(3, 1),
    'rotor: an axle, and it again': _axle_through(2, 2),
    'hinge of two planks': _on_two(JointKind.AXLE),
    'weld of two planks': _on_two(JointKind.PIN),
}
