# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The same scene in this world, in Pymunk alone and, where pyb2d3 is installed, in Box2D 3."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.util import find_spec
import math
from typing import Any, NamedTuple, Protocol

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.simulation import Simulation
import pymunk

from .bodies import Bare
from .engine import simulation_of
from .scenes import Scene

# Frames a second of all engines, at which errors are measured.
FRAMES = 60


class Run(Protocol):
    """A scene in an engine."""

    def advance(self) -> object:
        """Advance by a frame."""

    def snapshot(self) -> Snapshot:
        """Return the state of now."""


class Rate(NamedTuple):
    """
    A rate of an engine.

    :ivar steps: a second [Hz]
    :ivar parts: iterations of the solver, or sub-steps, in each
    """

    steps: int
    parts: int

    def __str__(self) -> str:
        return f'{self.steps} x {self.parts}'


class Ours:
    """
    A scene in this world, with its frames.

    :param scene: that is built
    :param rate: steps a second
    """

    def __init__(self, scene: Scene, rate: Rate) -> None:
        self.simulation = Simulation(physics_rate=rate.steps, publish_rate=FRAMES)
        scene(self.simulation)
        self.advance = self.simulation.advance_frame

    def snapshot(self) -> Snapshot:
        """Return the state of now."""
        return self.simulation.frame.snapshot


class _Peer:
    """
    A scene in another engine.

    :param first: the state of the scene as it begins
    :param rate: of the engine
    """

    def __init__(self, first: Snapshot, rate: Rate) -> None:
        self._first = first
        self._rate = rate
        self._steps = rate.steps // FRAMES
        self._frames = 0

    def advance(self) -> None:
        """Advance by a frame."""
        self._frames += 1
        for _ in range(self._steps):
            self._step(1 / self._rate.steps)

    def _step(self, dt: float) -> None:
        raise NotImplementedError

    def _state(self) -> list[Sequence[float]]:
        """Return x, y, yaw, vx, vy, spin of each centre of mass [m, rad, m/s, rad/s]."""
        raise NotImplementedError

    def snapshot(self) -> Snapshot:
        """Return the state of now, as this world has it."""
        state = np.array(self._state())
        poses, scene = state[:, :3].copy(), self._first.scene
        cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        x, y = scene.centroids.T
        poses[:, 0] -= cos * x - sin * y
        poses[:, 1] -= sin * x + cos * y
        stamp = round(self._frames / FRAMES * 1e9)
        return replace(self._first, poses=poses, twists=state[:, 3:], stamp=stamp)


class PymunkRun(_Peer):
    """
    A scene in Pymunk alone.

    :param scene: that is built
    :param rate: steps, and iterations of the solver
    """

    def __init__(self, scene: Scene, rate: Rate) -> None:
        world = simulation_of(scene).world
        super().__init__(world.snapshot(), rate)
        bare = Bare(world)
        self._space, self._bodies = bare.space, bare.bodies
        self._space.iterations = rate.parts
        for body, twist in zip(self._bodies, self._first.twists.tolist(), strict=True):
            if body.body_type == pymunk.Body.DYNAMIC:
                body.velocity, body.angular_velocity = tuple(twist[:2]), twist[2]

    def _step(self, dt: float) -> None:
        self._space.step(dt)

    def _state(self) -> list[Sequence[float]]:
        return [
            (*each.position, each.angle, *each.velocity, each.angular_velocity)
            for each in self._bodies
        ]


class Box2DRun(_Peer):
    """
    A scene in Box2D 3, whose contacts have the friction and elasticity of this world's.

    :param scene: that is built
    :param rate: steps, and sub-steps in each
    """

    def __init__(self, scene: Scene, rate: Rate) -> None:
        # A peer, which is measured where it is installed.
        import pyb2d3  # noqa: PLC0415

        world = simulation_of(scene).world
        super().__init__(world.snapshot(), rate)
        self._b2 = pyb2d3
        settings = world.settings
        self._world = pyb2d3.World(gravity=settings.gravity)
        self._world.restitution_threshold = 0.0
        ground = self._world.create_static_body(position=(0.0, 0.0))
        for wall in world.space.pm_space.static_body.shapes:
            # The others are corners of walls.
            if isinstance(wall, pymunk.Segment):
                shape = self._shape(settings.friction, settings.elasticity, 0)
                ground.create_capsule_shape(shape, pyb2d3.capsule(wall.a, wall.b, wall.radius))
        rigids = list(world.space.bodies.by_name.values())
        self._bodies = [
            self._body(rigid.body, rigid.pm_body, twist)
            for rigid, twist in zip(rigids, self._first.twists.tolist(), strict=True)
        ]
        bodies = dict(zip(world.space.bodies.by_name, self._bodies, strict=True))
        for number, joint in enumerate(self._first.scene.joints):
            self._join(joint, bodies.get(joint.a), bodies.get(joint.b, ground), number)

    def _shape(self, friction: float, elasticity: float, group: int) -> Any:
        # Box2D takes the mean of frictions, and the greater elasticity; here both are multiplied.
        material = self._b2.surface_material(friction=friction**2, restitution=elasticity**2)
        group_filter = self._b2.make_filter(group_index=-group)
        return self._b2.shape_def(material=material, filter=group_filter, density=1.0)

    def _body(self, body: Body, pm_body: pymunk.Body, twist: Sequence[float]) -> Any:
        b2, place = self._b2, tuple(pm_body.position)
        angle = b2.make_rot(pm_body.angle)
        if not body.dynamic:
            twin = self._world.create_static_body(position=place, rotation=angle)
        else:
            twin = self._world.create_dynamic_body(
                position=place,
                rotation=angle,
                linear_velocity=tuple(twist[:2]),
                angular_velocity=twist[2],
            )
        for shape in pm_body.shapes:
            kind = self._shape(shape.friction, shape.elasticity, shape.filter.group)
            if isinstance(shape, pymunk.Circle):
                circle = b2.circle(center=tuple(shape.offset), radius=shape.radius)
                twin.create_circle_shape(kind, circle)
            elif isinstance(shape, pymunk.Segment):
                twin.create_capsule_shape(kind, b2.capsule(shape.a, shape.b, shape.radius))
            else:
                assert isinstance(shape, pymunk.Poly)
                twin.create_polygon_shape(kind, b2.polygon(points=shape.get_vertices()))
        if body.dynamic:
            mass = b2.MassData()
            mass.mass, mass.rotational_inertia, mass.center = pm_body.mass, pm_body.moment, (0, 0)
            twin.mass_data = mass
        return twin

    def _join(self, joint: Joint, a: Any, b: Any, number: int) -> None:
        seat = self._first.scene.seats[number]
        ends = {
            'body_a': a,
            'body_b': b,
            'local_anchor_a': tuple(seat[:2]),
            'local_anchor_b': tuple(seat[2:4]),
        }
        match joint.kind:
            case JointKind.AXLE:
                self._world.create_revolute_joint(**ends)
            case JointKind.ROD:
                self._world.create_distance_joint(**ends, length=self._length(number))
            case JointKind.SPRING:
                springs, mass = self._first.springs, float(a.mass)
                row = springs.numbers.tolist().index(number)
                hertz = math.sqrt(springs.stiffness[row] / mass) / math.tau
                self._world.create_distance_joint(
                    **ends,
                    length=float(springs.rest[row]),
                    enable_spring=True,
                    hertz=hertz,
                    damping_ratio=0.0,
                )
            case _:
                raise NotImplementedError(joint.kind)

    def _length(self, number: int) -> float:
        one, other = self._first.ends[number]
        return float(np.hypot(*(one - other)))

    def _step(self, dt: float) -> None:
        self._world.step(dt, self._rate.parts)

    def _state(self) -> list[Sequence[float]]:
        states: list[Sequence[float]] = []
        for body in self._bodies:
            place, velocity = body.position, body.linear_velocity
            spin = body.angular_velocity
            states.append((place.x, place.y, body.angle, velocity.x, velocity.y, spin))
        return states


# Each engine with its rates, the cheapest first.
ENGINES: dict[str, tuple[Callable[[Scene, Rate], Run], tuple[Rate, ...]]] = {
    'here': (Ours, tuple(Rate(steps, 4) for steps in (60, 120, 240, 480))),
    'Pymunk': (
        PymunkRun,
        (
            *(Rate(steps, 10) for steps in (60, 120, 240, 480)),
            *(Rate(steps, 4) for steps in (960, 1920, 3840)),
        ),
    ),
}
if find_spec('pyb2d3') is not None:
    ENGINES['Box2D 3'] = Box2DRun, tuple(Rate(steps, 4) for steps in (60, 120, 240, 480, 960))

Errors = Callable[[list[Snapshot]], float]


def depths(snapshot: Snapshot, radius: float, half: float) -> Floats:
    """
    Return how deep discs of one radius lie in each other and in a bin [m].

    :param half: half of the width of the bin, whose floor is at y = 0 [m]
    """
    places = snapshot.centers
    apart = places[:, None] - places[None]
    far = np.hypot(apart[..., 0], apart[..., 1])[np.triu_indices(len(places), 1)]
    walls = np.concatenate((places[:, 1], half - np.abs(places[:, 0])))
    return np.concatenate((2 * radius - far, radius - walls))
