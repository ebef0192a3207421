# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 54: applied forces accelerate by F/m, turn by their arm, and give energy by their work."""

import math

import numpy as np
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody, Command
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.model.transform import local_to_world
import pytest

from .scenes import DT, floor, G, join, simulation, spawn, steps

L_SHAPE = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)))


def place(snapshot, point):
    """Return where a point of the first body is in the world [m]."""
    return np.array(local_to_world(point, tuple(snapshot.poses[0])))


@pytest.mark.parametrize('shape', [Disc(radius=0.5), L_SHAPE], ids=['disc', 'polygon'])
def test_a_constant_force_gives_acceleration_force_by_mass(report, shape):
    sim = simulation()
    spawn(sim, 'body/0', shape, (1.0, 2.0, 0.3), mass=3.0, forces=[{'force': [6.0, -1.5]}])
    start = sim.world.snapshot().centers[0]

    for snapshot in steps(sim, 480):
        t = snapshot.step * DT
        a = np.array((6.0 / 3.0, -1.5 / 3.0 - G))
        off = math.dist(snapshot.twists[0, :2], a * t)
        report.check(54, 'v = F t/m, for 2 s', off / np.hypot(*a * t), 0.0, 1e-12, '-')
        off = math.dist(snapshot.centers[0], start + a * t * t / 2)
        report.check(54, 'x = F t²/2m, for 2 s', off / np.hypot(*a * t * t / 2), 0.0, 1e-11, '-')
        what = 'no spin by a force at the centre of mass'
        report.check(54, what, snapshot.twists[0, 2], 0.0, 1e-15, 'rad/s')


def test_a_thruster_at_an_arm_turns_by_torque_over_moment(report):
    sim = simulation(gravity=(0.0, 0.0))
    thruster = {'force': [0.0, 2.0], 'at': [0.5, 0.0], 'axes': 'body'}
    spawn(sim, 'body/0', Box(width=1.0, height=0.2), mass=4.0, forces=[thruster])
    moment = sim.world.snapshot().scene.inertia[0, 1]

    for snapshot in steps(sim, 480):
        t = snapshot.step * DT
        turned = snapshot.twists[0, 2] / (0.5 * 2.0 / moment * t)
        report.check(54, 'ω = F r t/J', turned, 1.0, 1e-12, '-')
        yaw = 0.5 * 2.0 / moment * t * t / 2
        report.check(54, 'yaw of a thruster for 2 s', snapshot.poses[0, 2], yaw, 1e-9, 'rad')


def test_the_energy_that_a_thruster_gives_is_its_work(report):
    sim = simulation(gravity=(0.0, 0.0))
    thruster = AppliedForce(force=(3.0, 2.0), at=(0.3, 0.1), axes='body')
    spawn(sim, 'body/0', L_SHAPE, mass=4.0, forces=(thruster,))
    work, last = 0.0, sim.world.snapshot()

    for snapshot in steps(sim, 960):
        mean = (last.poses[0, 2] + snapshot.poses[0, 2]) / 2
        force = np.array(thruster.in_world(mean))
        work += force @ (place(snapshot, thruster.at) - place(last, thruster.at))
        last = snapshot

    report.check(54, 'work of a thruster for 4 s', last.kinetic_energy / work, 1.0, 1e-4, '-')


def test_a_pull_at_a_point_keeps_the_sum_of_energy_and_its_potential(report):
    # It swings about the direction of the pull, as in a field.
    sim = simulation(gravity=(0.0, 0.0))
    pull = AppliedForce(force=(5.0, 0.0), at=(0.0, 0.4))
    spawn(sim, 'body/0', Box(width=0.2, height=0.8), mass=2.0, forces=(pull,))
    start = place(sim.world.snapshot(), pull.at)

    for snapshot in steps(sim, 4800):
        work = np.array(pull.force) @ (place(snapshot, pull.at) - start)
        off = snapshot.kinetic_energy - work
        report.check(54, 'E - F·x of a pull at an arm, for 20 s', off, 0.0, 1e-3, 'J')


def pulled_block(pull):
    """Return a block of 2 kg on a floor that a force pulls [N]."""
    sim = simulation()
    floor(sim, friction=0.25)
    said = {'mass': 2.0, 'friction': 0.25, 'forces': [{'force': [pull, 0.0]}]}
    spawn(sim, 'block/0', Box(width=1.0, height=0.5), (0.0, 0.25, 0.0), **said)
    return sim


@pytest.mark.parametrize(('pull', 'acceleration'), [(3.0, 0.0), (8.0, 8.0 / 2.0 - 0.25 * G)])
def test_friction_holds_a_block_up_to_its_limit(report, pull, acceleration):
    *_, last = steps(pulled_block(pull), 480)

    speed = last.twists[1, 0]
    report.check(54, 'block pulled on a floor for 2 s', speed, acceleration * 2.0, 2e-3, 'm/s')


def test_a_pendulum_hangs_along_the_sum_of_weight_and_pull(report):
    sim = simulation(damping=0.9)
    spawn(sim, 'bob/0', Disc(radius=0.1), (0.0, -1.0, 0.0), mass=1.0, forces=[{'force': [G, 0.0]}])
    join(sim, 'rod/0', 'rod', [(0.0, -1.0), (0.0, 0.0)], b='world')

    *_, last = steps(sim, 6000)

    x, y = last.poses[0, :2]
    report.check(54, 'pendulum pulled by its weight', math.atan2(x, -y), math.pi / 4, 1e-3, 'rad')


def test_switching_a_force_off_and_on_leaves_the_velocity_of_that_moment(report):
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'body/0', Disc(radius=0.5), mass=1.0, forces=[{'force': [2.0, 0.0]}])
    *_, before = steps(sim, 240)

    sim.perform(ChangeBody(name='body/0', properties=Properties(forces=[])))
    after = sim.world.snapshot()
    *_, last = steps(sim, 240)

    assert after.scene.bodies[0].forces == ()
    for vx in (before.twists[0, 0], after.twists[0, 0], last.twists[0, 0]):
        report.check(54, 'velocity as a force ends, and 1 s later', vx, 2.0, 1e-12, 'm/s')


def test_wrenches_add_to_applied_forces(report):
    sim = simulation(gravity=(0.0, 0.0), command_timeout=0.0)
    forces = [{'force': [2.0, 0.0]}, {'force': [0.0, 1.0]}]
    spawn(sim, 'body/0', Disc(radius=0.5), mass=1.0, forces=forces)
    sim.perform(Command(names=('body/0',), wrenches=[(1.0, 0.0, 0.0)]))

    *_, last = steps(sim, 240)

    off = math.dist(last.twists[0, :2], (3.0, 1.0))
    report.check(54, 'velocity by two forces and a wrench, 1 s', off, 0.0, 1e-12, 'm/s')


def test_an_anchored_body_keeps_its_forces_for_its_release():
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'body/0', Disc(radius=0.5), mass=1.0, anchored=True, forces=[{'force': [2.0, 0.0]}])
    *_, held = steps(sim, 60)

    sim.perform(ChangeBody(name='body/0', properties=Properties(anchored=False)))
    *_, last = steps(sim, 60)

    assert held.poses[0, 0] == 0.0
    assert last.twists[0, 0] == pytest.approx(2.0 * 60 * DT, abs=1e-12)
