# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machines that strokes alone build, each with the law by which it runs as a person expects."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import math

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, submit_reading
from physsim_ros.files import load_drawing
from physsim_ros.model.arrays import Floats
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Scene
from physsim_ros.simulation.simulation import Simulation

G = 9.81


class Machine:
    """A world into which somebody draws while it stands."""

    def __init__(self, strokes: Iterable[tuple[Floats, float]]) -> None:
        """Draw strokes, each with the time at which it begins [s]."""
        self.simulation = Simulation(speed=0.0)
        self.read: list[str] = []
        session = DrawingSession(DrawingSettings())
        frame = self.simulation.advance_frame()
        for stroke, began in strokes:
            reading = session.stroke(stroke, '', frame.snapshot, began=began)
            self.read.append(reading.meaning)
            submit_reading(self.simulation, session, reading, topic='~/stroke')
            frame = self.simulation.apply_requests() or frame
            assert all(answer.code == '' for answer in frame.answers), frame.answers
        self.start = frame.snapshot.poses
        self.velocities = np.empty((0, len(self.start), 3))

    @property
    def scene(self) -> Scene:
        """Return the description of the world."""
        return self.simulation.world.snapshot().scene

    @property
    def masses(self) -> Floats:
        """Return the mass of every body [kg]."""
        return np.array([body.total_mass for body in self.scene.bodies])

    @property
    def joints(self) -> list[tuple[str, int, int]]:
        """
        Return kind and bodies of all joints, these by their numbers.

        The background is -1, and so is an anchored body: an end beside a beam is as good.
        """
        bodies = enumerate(self.scene.bodies)
        rows = {body.name: -1 if body.anchored else row for row, body in bodies}
        return [(str(it.kind), rows[it.a], rows.get(it.b, -1)) for it in self.scene.joints]

    def run(self, seconds: float) -> Floats:
        """Go on, and return poses, (frames, bodies, 3) float64 [m, rad]."""
        poses, velocities = [], []
        self.simulation.speed = 1.0
        for _ in range(round(60 * seconds)):
            frame = self.simulation.advance_frame()
            assert frame.answers == ()
            poses.append(frame.snapshot.poses)
            velocities.append(frame.snapshot.twists)
        self.velocities = np.array(velocities)
        return np.array(poses)

    def lengths(self, poses: Floats, number: int) -> Floats:
        """Return the distance between the two ends of a joint in every frame [m]."""
        joint, names = self.scene.joints[number], (*self.scene.names, WORLD)
        a, b = (names.index(name) for name in (joint.a, joint.b))
        # The background is the last of the bodies.
        poses = np.append(poses, np.zeros((len(poses), 1, 3)), axis=1)
        first = _in_world(poses, a, joint.seat.ax, joint.seat.ay)
        last = _in_world(poses, b, joint.seat.bx, joint.seat.by)
        return np.hypot(*(first - last).T)

    def gaps(self) -> Floats:
        """Return the distance between the two bodies of every joint of one point [m]."""
        poses = self.simulation.world.snapshot().poses
        return np.array([self.lengths(poses[None], row)[0] for row in range(len(self.joints))])


def _in_world(poses: Floats, row: int, x: float, y: float) -> Floats:
    """Return a point of a body in every frame, (frames, 2) float64 [m]."""
    px, py, yaw = poses[:, row].T
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.column_stack((px + x * cos - y * sin, py + x * sin + y * cos))


def distances(poses: Floats, first: int, second: int) -> Floats:
    """Return the distance of two bodies in every frame [m]."""
    return np.hypot(*(poses[:, first, :2] - poses[:, second, :2]).T)


def period(values: Floats) -> float:
    """Return the mean time between passages upwards through the mean, at 60 Hz [s]."""
    above = values - values.mean()
    passed = np.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
    exact = passed + above[passed] / (above[passed] - above[passed + 1])
    return float(np.diff(exact).mean() / 60)


def swings_as_a_pendulum(machine: Machine, poses: Floats, bob: int) -> None:
    """Assert the period of a bob on a rod, by the arithmetic-geometric mean."""
    rod = [kind for kind, *_ in machine.joints].index('rod')
    arm = machine.lengths(poses, rod)
    assert np.ptp(arm) < 0.005, 'm: its rod is rigid'
    places, length = poses[:, bob, :2], float(arm.mean())
    a, b = 1.0, math.cos(math.asin(float(np.ptp(places[:, 0])) / 2 / length) / 2)
    for _ in range(5):
        a, b = (a + b) / 2, math.sqrt(a * b)
    exact = 2 * math.pi * math.sqrt(length / G) / a
    assert math.isclose(period(places[:, 0]), exact, rel_tol=0.02)


def turns_by_its_motor(machine: Machine, poses: Floats, row: int) -> None:
    """Assert that a body turns clockwise about a point of itself by the rate of the motor."""
    (rate,) = (it.properties.rate for it in machine.scene.joints if str(it.kind) == 'motor')
    assert rate is not None
    assert rate < -1.0
    turned = poses[-1, row, 2] - poses[0, row, 2]
    assert math.isclose(turned, rate * (len(poses) - 1) / 60, rel_tol=0.05)


def bridge(machine: Machine) -> None:
    """Assert that a bridge bears its load and that no axle opens."""
    assert len(machine.start) == 8
    assert [kind for kind, *_ in machine.joints] == ['axle'] * 6
    poses = machine.run(4.0)
    *_, load = range(8)
    x, y, _ = poses[-1, load]
    assert 5.0 < x < 11.0, 'm: between the banks'
    assert y > poses[-1, 2:7, 1].min(), 'm: it lies on the planks'
    assert y > machine.start[load, 1] - 2.5, 'm'
    assert np.ptp(poses[-60:, load, :2], axis=0).max() < 0.5, 'm: as far as the bridge sways'
    assert machine.gaps().max() < 0.02, 'm'


def car(machine: Machine) -> None:
    """Assert that a car drives down its road on its wheels."""
    assert machine.joints == [('axle', 2, 1), ('axle', 3, 1)]
    poses = machine.run(3.0)
    _, body, rear, front = range(4)
    way = poses[-1, body, 0] - poses[0, body, 0]
    assert way > 6.0, 'm: at the bottom of the slope it has a speed of 5 m/s'
    for wheel in (rear, front):
        radius = machine.scene.bodies[wheel].shape.form.outer
        turned = poses[0, wheel, 2] - poses[-1, wheel, 2]
        assert math.isclose(radius * turned, way, rel_tol=0.12), 'slip and the longer slope'
        assert np.ptp(distances(poses, body, wheel)) < 0.01, 'm: they stay on the car'


def catapult(machine: Machine) -> None:
    """Assert that a catapult throws its stone up and away."""
    assert len(machine.start) == 5
    assert [kind for kind, *_ in machine.joints] == ['axle', 'pin']
    poses = machine.run(3.0)
    *_, stone = range(5)
    assert poses[:, stone, 1].max() > machine.start[stone, 1] + 3.0, 'm'
    assert np.abs(poses[:, stone, 0] - machine.start[stone, 0]).max() > 3.0, 'm'
    assert machine.gaps().max() < 0.02, 'm'


def clock(machine: Machine) -> None:
    """Assert that a clock's pendulum swings with its period, and that a motor turns its hand."""
    assert len(machine.start) == 3
    assert sorted(kind for kind, *_ in machine.joints) == ['axle', 'motor', 'rod']
    poses = machine.run(8.0)
    case, hand, bob = range(3)
    assert np.ptp(poses[:, case], axis=0).max() == 0.0, 'it is anchored'
    turns_by_its_motor(machine, poses, hand)
    swings_as_a_pendulum(machine, poses, bob)


def cradle(machine: Machine) -> None:
    """Assert that a cradle passes momentum on: the last ball swings out."""
    assert len(machine.start) == 5
    assert machine.joints == [('rod', ball, -1) for ball in range(1, 5)]
    machine.run(1.5)
    speed = machine.velocities[:, 1:, 0]
    struck = int(speed[:, 0].argmax())
    after = int(speed[:, 3].argmax())
    assert after >= struck
    masses = machine.masses[1:]
    before, later = (masses * speed[[struck, after]]).sum(axis=1)
    assert math.isclose(later, before, rel_tol=0.15), 'N s: momentum is kept'
    share = masses[3] * speed[after, 3] / before
    assert share > 0.25, '0.42 where four balls of elasticity 0.5 hit one another fully'
    assert speed[after, 3] > 1.5 * max(speed[after, :3]), 'm/s'


def double_pendulum(machine: Machine) -> None:
    """Assert that both bobs swing, and that energy and rods are kept."""
    assert [(kind, {a, b}) for kind, a, b in machine.joints] == [('rod', {1, -1}), ('rod', {1, 2})]
    poses = machine.run(6.0)
    for rod in (0, 1):
        assert np.ptp(machine.lengths(poses, rod)) < 0.005, 'm'
    bobs, speeds = poses[:, 1:, :2], machine.velocities[:, 1:]
    assert np.ptp(bobs[:, :, 0], axis=0).min() > 1.0, 'm: both swing'
    masses = machine.masses[1:]
    inertia = masses * [body.shape.form.gyration for body in machine.scene.bodies[1:]]
    moving = 0.5 * (masses * (speeds[:, :, :2] ** 2).sum(axis=2) + inertia * speeds[:, :, 2] ** 2)
    energy = (moving + masses * G * bobs[:, :, 1]).sum(axis=1)
    assert np.ptp(energy) < 0.03 * moving.sum(axis=1).max(), 'J'


def marble_run(machine: Machine) -> None:
    """Assert that a marble runs down three ramps into the cup."""
    assert len(machine.start) == 5
    poses = machine.run(14.0)
    x, y, _ = poses[-1, -1]
    assert 9.0 < x < 13.1, 'm: in the cup'
    assert 0.4 < y < 2.0, 'm'


def pendulum(machine: Machine) -> None:
    """Assert that a pendulum swings with its period."""
    assert machine.joints == [('rod', 1, -1)]
    poses = machine.run(10.0)
    swings_as_a_pendulum(machine, poses, 1)


def seesaw(machine: Machine) -> None:
    """Assert that a seesaw goes down where the heavier one sits."""
    assert machine.joints == [('axle', 1, -1)]
    poses = machine.run(1.0)
    _, plank, heavy, light = range(4)
    assert poses[-1, plank, 2] > 0.4, 'rad'
    assert poses[-1, heavy, 1] < machine.start[heavy, 1] - 0.5, 'm'
    assert poses[-1, light, 1] > machine.start[light, 1] + 0.3, 'm'
    assert machine.gaps().max() < 0.01, 'm: its axle holds it'


def spring_and_mass(machine: Machine) -> None:
    """Assert that a mass on a spring oscillates with its period, about where that bears it."""
    assert machine.joints == [('spring', 1, -1)]
    heights = machine.run(6.0)[:, 1, 1]
    weight, stiffness = machine.masses[1], 100.0
    exact = 2 * math.pi * math.sqrt(weight / stiffness)
    assert math.isclose(period(heights), exact, rel_tol=0.05)
    borne = machine.start[1, 1] - weight * G / stiffness
    assert math.isclose(heights.mean(), borne, abs_tol=0.03), 'm'


def windmill(machine: Machine) -> None:
    """Assert that a windmill turns by its motor, on a tower that stands."""
    assert len(machine.start) == 3
    assert machine.joints == [('axle', 2, -1), ('motor', 2, -1)]
    poses = machine.run(4.0)
    _, tower, sails = range(3)
    assert np.ptp(poses[:, tower], axis=0).max() == 0.0, 'it is anchored'
    turns_by_its_motor(machine, poses, sails)
    assert machine.gaps().max() < 0.01, 'm'


LAWS: dict[str, Callable[[Machine], None]] = {
    law.__name__: law
    for law in (
        bridge,
        car,
        catapult,
        clock,
        cradle,
        double_pendulum,
        marble_run,
        pendulum,
        seesaw,
        spring_and_mass,
        windmill,
    )
}


def strokes_of(name: str) -> list[Floats]:
    """Return the strokes of a shipped drawing as they should be."""
    return [stroke for _, stroke in load_drawing(name)]
