# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The worlds that are measured, and the same bodies in a space of Pymunk alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
import math
import random
from test.building import spawn
import time

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Configure, Restore
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pymunk

SETTLE = 20.0  # simulated seconds in which a pile of a thousand comes to rest
# Bodies in a column of the resting ones.
HIGH = 4
# Half the width of the floor [m], beyond the farthest body.
GROUND = 2000.0


def fill(world: World, count: int, *, settle: float = SETTLE) -> None:
    """Let a pile of discs and boxes fall into a bin, for seconds; by then it is at rest."""
    if settle:
        world.apply(Restore(state=_settled(count, settle)))
        return
    rng = random.Random(count)
    half = math.sqrt(count) * 0.6
    row = int(2 * half / 0.7)
    world.apply(Configure(changes={'bounds': (-half, 0.0, half, 1000.0)}))
    for number in range(count):
        x = 0.5 - half + number % row * 0.7 + rng.uniform(-0.1, 0.1)
        pose = (x, 0.5 + number // row * 0.7, 0.0)
        spawn(world, f'body/{number}', _shape(number), pose, elasticity=0.0)


@lru_cache(maxsize=2)
def _settled(count: int, settle: float) -> WorldState:
    world = World()
    fill(world, count, settle=0.0)
    world.step(round(settle * world.physics_rate))
    return world.save()


def _shape(number: int) -> Disc | Box:
    return Disc(radius=0.25) if number % 2 else Box(width=0.5, height=0.5)


def falling(count: int) -> World:
    """Return bodies that fall onto one another in a bin."""
    world = World()
    fill(world, count, settle=0.0)
    return world


def sparse(count: int) -> World:
    """Return bodies that drift far apart without gravity."""
    world = World()
    world.apply(Configure(changes={'gravity': (0.0, 0.0)}))
    rng, side = random.Random(count), math.ceil(math.sqrt(count))
    for number in range(count):
        row, column = divmod(number, side)
        velocity = rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)
        motion = {'velocity': velocity, 'spin': rng.uniform(-1.0, 1.0)}
        spawn(world, f'body/{number}', _shape(number), (3.0 * column, 3.0 * row, 0.0), **motion)
    return world


def laid(count: int) -> World:
    """Return boxes laid down in columns on the ground; after a second they are at rest."""
    world = World()
    spawn(world, 'ground/0', Box(width=GROUND, height=2.0), (0.0, -1.0, 0.0), anchored=True)
    for number in range(count):
        column, level = divmod(number, HIGH)
        pose = (0.3 * column - 0.15 * count / HIGH, 0.1 + 0.2 * level, 0.0)
        spawn(world, f'body/{number}', Box(width=0.2, height=0.2), pose)
    return world


class Bare:
    """
    The bodies of a world in a space that nothing of ours is in: `Space.step` alone.

    :param world: whose bodies are copied, as they are now

    :ivar space: with the copies
    :ivar bodies: the copies, in spawn order
    """

    def __init__(self, world: World) -> None:
        ours = world.space.pm_space
        self.space = pymunk.Space()
        self.space.gravity, self.space.collision_slop = ours.gravity, ours.collision_slop
        self.space.iterations, self.space.damping = ours.iterations, ours.damping
        twins = {ours.static_body: self.space.static_body}
        for body in ours.bodies:
            twins[body] = twin = pymunk.Body(body.mass, body.moment, body.body_type)
            twin.position, twin.angle = body.position, body.angle
            twin.velocity, twin.angular_velocity = body.velocity, body.angular_velocity
            self.space.add(twin, *(_twin(shape, twin) for shape in body.shapes))
        rigids = world.space.bodies.by_name.values()
        self.bodies = [twins[rigid.pm_body] for rigid in rigids]
        walls = ours.static_body.shapes
        self.space.add(*(_twin(wall, self.space.static_body) for wall in walls))
        for held in world.space.joints.by_name.values():
            for constraint in held.constraints:
                self.space.add(_twin_of_constraint(constraint, twins))

    def frame(self) -> None:
        """Make four steps."""
        self.step(4)

    def step(self, count: int) -> None:
        """Make some steps."""
        for _ in range(count):
            self.space.step(1 / 240)


def _twin(shape: pymunk.Shape, body: pymunk.Body) -> pymunk.Shape:
    """Return the same shape on another body."""
    if isinstance(shape, pymunk.Circle):
        twin: pymunk.Shape = pymunk.Circle(body, shape.radius, shape.offset)
    elif isinstance(shape, pymunk.Segment):
        twin = pymunk.Segment(body, shape.a, shape.b, shape.radius)
    else:
        assert isinstance(shape, pymunk.Poly)
        twin = pymunk.Poly(body, shape.get_vertices(), radius=shape.radius)
    twin.friction, twin.elasticity = shape.friction, shape.elasticity
    twin.filter = shape.filter
    return twin


def _twin_of_constraint(
    constraint: pymunk.Constraint, twins: dict[pymunk.Body, pymunk.Body]
) -> pymunk.Constraint:
    """Return the same constraint between the twins of its bodies."""
    a, b = twins[constraint.a], twins[constraint.b]
    match constraint:
        case pymunk.PivotJoint():
            twin = pymunk.PivotJoint(a, b, constraint.anchor_a, constraint.anchor_b)
        case pymunk.PinJoint():
            twin = pymunk.PinJoint(a, b, constraint.anchor_a, constraint.anchor_b)
        case pymunk.SimpleMotor():
            twin = pymunk.SimpleMotor(a, b, constraint.rate)
        case pymunk.DampedSpring():
            anchors = constraint.anchor_a, constraint.anchor_b
            numbers = constraint.rest_length, constraint.stiffness, constraint.damping
            twin = pymunk.DampedSpring(a, b, *anchors, *numbers)
        case _:
            raise NotImplementedError(type(constraint))
    twin.max_force, twin.collide_bodies = constraint.max_force, constraint.collide_bodies
    return twin


def timed(act: Callable[[], object]) -> float:
    """Return the time of a call [ms]."""
    began = time.perf_counter()
    act()
    return (time.perf_counter() - began) * 1e3


def cpu_time(act: Callable[[], object]) -> float:
    """Return the CPU time of a call, of all threads of this process [ms]."""
    began = time.process_time()
    act()
    return (time.process_time() - began) * 1e3
