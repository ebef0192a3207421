# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 62: motors of joints: an arm obeys its equations of motion, and goes where it is told."""

import math

import numpy as np
from physsim_ros import Box, Properties, Robot, robot_spawn, Simulation, Spawn, WorldSettings
from physsim_ros.model.requests import ChangeBody, CommandMotors
import pytest

from .scenes import integrated, NOWHERE

DOWN = (0.0, -9.81)
# Of the shipped arm: lengths [m], masses [kg], and moments of inertia about the middles [kg m²].
LENGTHS, MASSES = (0.4, 0.3), (1.2, 0.6)
MOMENTS = tuple(
    mass * (length**2 + height**2) / 12.0
    for mass, length, height in zip(MASSES, LENGTHS, (0.05, 0.04), strict=True)
)


def arm(gravity: tuple[float, float] = NOWHERE, yaw: float = 0.0) -> Robot:
    simulation = Simulation(settings=WorldSettings(gravity=gravity), checkpoints=1.0)
    simulation.perform(robot_spawn('arm', name='arm/0', at=(0.0, 0.0, yaw)))
    return Robot(simulation, 'arm/0')


def command(robot: Robot, mode: str, **points: list[tuple[float, ...]]) -> None:
    robot.simulation.perform(
        CommandMotors(
            commands=tuple(
                {'joint': f'{robot.name}/{joint}/0', 'mode': mode, 'points': path}
                for joint, path in points.items()
            )
        )
    )


def positions(robot: Robot) -> np.ndarray:
    return robot.read('joint_states').positions


def accelerations(angles, rates, torques, gravity):
    """
    Return the accelerations of a planar arm of two uniform links.

    J. J. Craig, "Introduction to Robotics", section 6.7, with moments of inertia of the links;
    angles are that of the first link in the world, and that of the second against the first.
    """
    (l1, l2), (m1, m2), (i1, i2) = LENGTHS, MASSES, MOMENTS
    (q1, q2), (w1, w2) = angles, rates
    c, s = l1 * l2 / 2.0 * m2 * math.cos(q2), l1 * l2 / 2.0 * m2 * math.sin(q2)
    second = i2 + m2 * l2**2 / 4.0
    first = i1 + m1 * l1**2 / 4.0 + m2 * l1**2
    mass = np.array([[first + second + 2.0 * c, second + c], [second + c, second]])
    bent = np.array([-s * (2.0 * w1 * w2 + w2**2), s * w1**2])
    weight = np.array(
        [
            (m1 / 2.0 + m2) * l1 * math.cos(q1) + m2 * l2 / 2.0 * math.cos(q1 + q2),
            m2 * l2 / 2.0 * math.cos(q1 + q2),
        ]
    )
    return np.linalg.solve(mass, torques - bent - gravity * weight)


def exact(torques, gravity, seconds, yaw):
    """Return the angles of the joints after some time from rest."""

    def change(now):
        return np.concatenate((now[2:], accelerations(now[:2], now[2:], torques, gravity)))

    return integrated(change, np.array([yaw, 0.0, 0.0, 0.0]), seconds, 200)[:2] - (yaw, 0.0)


@pytest.mark.parametrize(
    ('torques', 'gravity', 'yaw', 'seconds'),
    [
        ((0.05, -0.02), NOWHERE, 0.0, 0.8),
        ((-0.1, 0.01), NOWHERE, 2.0, 0.8),
        ((5.3, 0.87), DOWN, 0.2, 0.3),
    ],
)
def test_an_arm_with_torques_obeys_its_equations_of_motion(report, torques, gravity, yaw, seconds):
    robot = arm(gravity, yaw)
    # Its motors hold it first.
    robot.simulation.run(0.1)
    shoulder, elbow = torques
    command(robot, 'effort', shoulder=[(0.0, shoulder)], elbow=[(0.0, elbow)])
    robot.simulation.run(seconds)
    off = positions(robot) - exact(np.array(torques), -gravity[1], seconds, yaw)
    report.check(62, 'joints of an arm by torques', float(np.abs(off).max()), 0.0, 3e-3, 'rad')


@pytest.mark.parametrize('mode', ['position', 'velocity', 'effort'])
@pytest.mark.parametrize('gravity', [NOWHERE, DOWN])
def test_a_command_before_the_first_step_acts_as_one_given_later(mode, gravity):
    early, late = arm(gravity), arm(gravity)
    late.simulation.world.step(24)
    ways = []
    for robot in (early, late):
        command(robot, mode, shoulder=[(0.0, 5.3)], elbow=[(0.0, -0.87)])
        robot.simulation.world.step(24)
        ways.append(robot.simulation.world.snapshot())
    # The motors have held it up to their gain.
    assert ways[0].poses == pytest.approx(ways[1].poses, abs=1e-9)
    assert ways[0].twists == pytest.approx(ways[1].twists, abs=1e-8)


def test_a_way_to_a_position_falls_by_the_gain(report):
    robot = arm()
    command(robot, 'position', shoulder=[(0.0, 0.02)], elbow=[(0.0, -0.03)])
    left = []
    for _ in range(2):
        robot.simulation.run(0.1)
        left.append(positions(robot) - (0.02, -0.03))
    # A gain of 20 / s.
    for rate in np.log(left[0] / left[1]) / 0.1:
        report.check(62, 'decay of the way to a position', rate, 20.0, 0.02, '1/s')


def test_an_arm_follows_a_trajectory_and_stays_at_its_end(report):
    robot = arm(DOWN)
    # Rates at its ends: cubic polynomials.
    path = [(1.0, 0.8, 0.5), (2.0, 1.0, 0.0)]
    command(robot, 'position', shoulder=path, elbow=[(2.0, -1.2, 0.0)])
    robot.simulation.run(1.5)
    # Between (1 s, 0.8, 0.5 / s) and (2 s, 1, 0): Hermite's polynomial in the middle.
    middle = (0.8 + 1.0) / 2.0 + 0.5 / 8.0
    report.check(62, 'trajectory', positions(robot)[0], middle, 1e-4, 'rad')
    robot.simulation.run(1.5)
    for position, end in zip(positions(robot), (1.0, -1.2), strict=True):
        report.check(62, 'end of a trajectory', position, end, 1e-6, 'rad')


def test_a_joint_bears_what_its_motor_can_without_sagging_and_no_more(report):
    robot = arm(DOWN)
    robot.simulation.run(1.0)
    begin = positions(robot)
    robot.simulation.run(5.0)
    sag = float(np.abs(positions(robot) - begin).max())
    report.check(62, 'sag of a loaded arm in 5 s', sag, 0.0, 1e-9, 'rad')
    (l1, l2), (m1, m2) = LENGTHS, MASSES
    weight = 9.81 * (m1 * l1 / 2.0 + m2 * (l1 + l2 / 2.0))
    held, falls = arm(DOWN), arm(DOWN)
    for robot in (held, falls):
        robot.simulation.run(0.1)
    begin = positions(held)[0]
    command(held, 'effort', shoulder=[(0.0, 1.001 * weight)])
    command(falls, 'effort', shoulder=[(0.0, 0.999 * weight)])
    for robot in (held, falls):
        robot.simulation.run(0.5)
    assert positions(held)[0] > begin > positions(falls)[0]


@pytest.mark.parametrize('elasticity', [0.0, 0.3, 0.7, 1.0])
@pytest.mark.parametrize('holds', [True, False])
def test_a_gripper_lifts_what_the_friction_of_its_fingers_holds(holds, elasticity):
    simulation = Simulation()
    simulation.perform(robot_spawn('gripper', name='gripper/0', at=(0.0, 1.0)))
    for side in ('left', 'right'):
        bounces = Properties(elasticity=elasticity)
        simulation.perform(ChangeBody(name=f'gripper/0/{side}_finger/0', properties=bounces))
    robot = Robot(simulation, 'gripper/0')
    force, friction, way = 20.0, 0.8, 0.42
    # A cubic way in 2 s accelerates by 6 s / t² at its ends, which is not needed to slip.
    most, greatest = 2.0 * friction * force, 6.0 * way / 2.0**2
    mass = 0.99 * most / (9.81 + greatest) if holds else 1.01 * most / 9.81
    floor = Properties(anchored=True)
    simulation.perform(
        Spawn(name='floor/0', shape=Box(width=4, height=0.2), pose=(0, -0.1, 0), properties=floor)
    )
    crate = Properties(mass=mass, friction=friction, elasticity=1.0)
    square = Box(width=0.12, height=0.12)
    simulation.perform(Spawn(name='box/0', shape=square, pose=(0, 0.06, 0), properties=crate))
    command(robot, 'position', lift=[(2.0, 0.72, 0.0)])
    simulation.run(2.5)
    command(robot, 'effort', left=[(0.0, force)], right=[(0.0, force)])
    simulation.run(1.0)
    command(robot, 'position', lift=[(2.0, 0.72 - way, 0.0)])
    simulation.run(3.0)
    snapshot = simulation.world.snapshot()
    height = snapshot.poses[snapshot.row('box/0'), 1] - 0.06
    assert height == pytest.approx(way if holds else 0.0, abs=1e-4)
