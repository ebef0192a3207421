# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Mouse joints: the forces by which hands draw bodies to themselves.

Problem: a body that is dragged has to follow the hand without oscillation, at any mass, and must
not crush or throw what is in its way.
Method: Box2D's mouse joint, a soft constraint at the point of the grip with a greatest force (E.
Catto, *Soft Constraints*, GDC 2011; `b2MakeSoft` and `mouse_joint.c` in Box2D v3): a spring of
5 Hz, the default of `b2MouseJointDef`, damped critically, which acts on the effective mass at the
grip, so that its response is the same for any mass and anchor. It is solved implicitly for the
pose and velocity that the engine's step will have, and applied as a force of that step, before
contacts and joints. Several hands on one body are solved by projected Gauss-Seidel, as many sweeps
as hands, and at most as many as the iterations of the engine's solver.
Cost: some 12 µs a step for each grip.
Without it: nothing can be dragged.
"""

from __future__ import annotations

from collections.abc import Mapping
import math

from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.settings import STANDARD_GRAVITY, WorldSettings
from physsim_ros.model.snapshot import Grip
from physsim_ros.model.transform import Point, rotated

# Undamped frequency of the spring [Hz], and its damping ratio: 1 is critical.
FREQUENCY, DAMPING_RATIO = 5.0, 1.0


class MouseJoints:
    """
    The grips in a space.

    :param bodies: by name; kept by the space
    """

    def __init__(self, bodies: Mapping[str, RigidBody]) -> None:
        self._bodies = bodies
        self._grips: dict[str, Grip] = {}

    def grips(self) -> tuple[Grip, ...]:
        """Return the grips, in the order in which they were made."""
        return tuple(self._grips.values())

    def grip_of(self, hand: str) -> Grip | None:
        """Return the grip of a hand; None if it has none."""
        return self._grips.get(hand)

    def set_grip(self, grip: Grip) -> None:
        """Add a grip; it replaces that of the same hand in its place."""
        self._grips[grip.hand] = grip

    def remove_grip(self, hand: str) -> None:
        """Remove the grip of a hand."""
        del self._grips[hand]

    def forget_body(self, name: str) -> None:
        """Remove all grips on a body."""
        self._grips = {hand: grip for hand, grip in self._grips.items() if grip.body != name}

    def apply_forces(self, context: StepContext) -> None:
        """Add the forces of the hands to those of the coming step of the engine."""
        if not self._grips:
            return
        held: dict[str, list[Grip]] = {}
        for grip in self._grips.values():
            held.setdefault(grip.body, []).append(grip)
        for name, grips in held.items():
            rigid = self._bodies[name]
            if rigid.body.dynamic:
                _apply_to_body(rigid, grips, context)


def greatest_force(mass: float, settings: WorldSettings) -> float:
    """
    Return the greatest force of a hand on a body [N].

    :param mass: of the body [kg]
    """
    return settings.drag_force * mass * (math.hypot(*settings.gravity) or STANDARD_GRAVITY)


def _apply_to_body(rigid: RigidBody, grips: list[Grip], context: StepContext) -> None:
    """Add the forces of all hands on one body; its weight and wrench act in the same step."""
    table, dt = context.table, context.dt
    row = table.columns.rows[rigid.body.name]
    x, y, yaw, vx, vy, spin = table.state[row].tolist()
    # The engine moves bodies first, and accelerates them then.
    x, y, yaw = x + vx * dt, y + vy * dt, yaw + spin * dt
    kept = (1.0 - context.settings.damping) ** dt
    ax, ay, turning = (2.0 * table.leads[row]).tolist()
    vx, vy, spin = vx * kept + ax, vy * kept + ay, spin * kept + turning
    mass, moment = rigid.pm_body.mass, rigid.pm_body.moment
    most = greatest_force(mass, context.settings) * dt
    bias_rate, mass_scale, impulse_scale = _softness(dt)
    arms = [_arm(rigid, grip, yaw) for grip in grips]
    impulses = [(0.0, 0.0)] * len(grips)
    for _ in range(min(len(grips), context.settings.iterations)):
        for number, (grip, (rx, ry)) in enumerate(zip(grips, arms, strict=True)):
            # Cdot + bias_rate C
            ux = vx - spin * ry + bias_rate * (x + rx - grip.target[0])
            uy = vy + spin * rx + bias_rate * (y + ry - grip.target[1])
            # K: the inverse of the effective mass at the grip.
            k11, k12 = 1.0 / mass + ry * ry / moment, -rx * ry / moment
            k22 = 1.0 / mass + rx * rx / moment
            share = mass_scale / (k11 * k22 - k12 * k12)
            old_x, old_y = impulses[number]
            jx = old_x - share * (k22 * ux - k12 * uy) - impulse_scale * old_x
            jy = old_y - share * (k11 * uy - k12 * ux) - impulse_scale * old_y
            size = math.hypot(jx, jy)
            if size > most:
                jx, jy = jx * most / size, jy * most / size
            impulses[number] = jx, jy
            dx, dy = jx - old_x, jy - old_y
            vx, vy = vx + dx / mass, vy + dy / mass
            spin += (rx * dy - ry * dx) / moment
    force = rigid.pm_body.force
    # Of commands and hands together.
    rigid.pm_body.torque += (
        sum(rx * jy - ry * jx for (rx, ry), (jx, jy) in zip(arms, impulses, strict=True)) / dt
    )
    fx, fy = (sum(each) / dt for each in zip(*impulses, strict=True))
    rigid.pm_body.force = force[0] + fx, force[1] + fy


def _arm(rigid: RigidBody, grip: Grip, yaw: float) -> Point:
    """Return the grip as seen from the centre of mass, world axes [m]."""
    offset = rigid.offset
    return rotated((grip.anchor[0] - offset[0], grip.anchor[1] - offset[1]), yaw)


def _softness(dt: float) -> tuple[float, float, float]:
    """Return bias rate [1/s], mass scale and impulse scale of the spring (`b2MakeSoft`)."""
    omega = 2.0 * math.pi * FREQUENCY
    a1 = 2.0 * DAMPING_RATIO + dt * omega
    a2 = dt * omega * a1
    a3 = 1.0 / (1.0 + a2)
    return omega / a1, a2 * a3, a3
