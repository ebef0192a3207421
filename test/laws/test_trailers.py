# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 60: what is towed rolls where it is drawn, as the formula of a trailer says."""

import math

import numpy as np
from physsim_ros import (
    Axle,
    Box,
    Join,
    JointKind,
    Polygon,
    Properties,
    Robot,
    Simulation,
    Spawn,
    WorldSettings,
)
import pytest

SPEED = 0.2  # [m/s]
TRACTOR = {'kind': 'differential', 'max_speed': 1.0, 'traction': 0.9, 'timeout': 0.0}
# A trailer with its centre of mass on its axle, and one with it well before.
SHAPES = {
    'balanced': Box(width=0.3, height=0.2),
    'heavy in front': Polygon(outline=((-0.1, -0.1), (0.3, -0.1), (0.3, 0.1), (-0.1, 0.1))),
}


def towed(
    shape: Box | Polygon, *, length: float = 0.5, hitch: float = 0.0, angle: float = 0.0
) -> tuple[Robot, Robot]:
    """
    Return a tractor along the x axis, and its trailer.

    :param length: from the axle of the trailer to the hitch [m]
    :param hitch: how far that is behind the axle of the tractor [m]
    :param angle: of the tractor as seen from the trailer [rad]
    """
    simulation = Simulation(
        settings=WorldSettings(gravity=(0.0, 0.0), floor_friction=0.6), checkpoints=1.0
    )
    size = Box(width=0.2, height=0.2)
    tractor = Properties(mass=5.0, robot={'drive': TRACTOR})
    simulation.perform(Spawn(name='tractor/0', shape=size, properties=tractor))
    pose = -hitch - length * math.cos(angle), length * math.sin(angle), -angle
    trailer = Properties(mass=2.0, towed={'traction': 0.9}, robot={})
    simulation.perform(Spawn(name='trailer/0', shape=shape, pose=pose, properties=trailer))
    simulation.perform(
        Join(
            name='hitch/0',
            kind=JointKind.AXLE,
            points=((-hitch, 0.0),),
            a='tractor/0',
            b='trailer/0',
        )
    )
    return Robot(simulation, 'tractor/0'), Robot(simulation, 'trailer/0')


def angle_between(tractor: Robot, trailer: Robot) -> float:
    return math.remainder(tractor.truth().pose[2] - trailer.truth().pose[2], math.tau)


@pytest.mark.parametrize('hitch', [0.0, 0.1])
@pytest.mark.parametrize('shape', SHAPES)
def test_a_trailer_follows_a_circle_at_the_angle_of_the_formula(report, shape, hitch):
    tractor, trailer = towed(SHAPES[shape], hitch=hitch)
    turn = 0.2
    tractor.drive(SPEED, turn)
    tractor.simulation.run(30.0)
    # All turn about one centre: the hitch at the distance (R² + M²)^(1/2), the axle of the trailer
    # at (R² + M² - L²)^(1/2).
    radius = SPEED / turn
    exact = math.atan(hitch / radius) + math.asin(0.5 / math.hypot(radius, hitch))
    report.check(60, 'angle in a circle', angle_between(tractor, trailer), exact, 1e-4, 'rad')
    # The axle rolls.
    ahead, aside, _ = trailer.truth().twist
    report.check(60, 'slip of the axle', aside, 0.0, 1e-5, 'm/s')
    speed = turn * math.sqrt(radius**2 + hitch**2 - 0.5**2)
    report.check(60, 'speed of a trailer', ahead, speed, 1e-4, 'm/s')


@pytest.mark.parametrize('speed', [SPEED, -SPEED])
@pytest.mark.parametrize('shape', SHAPES)
def test_a_trailer_straightens_and_jackknifes_as_the_formula_says(report, shape, speed):
    tractor, trailer = towed(SHAPES[shape], angle=0.5 if speed > 0.0 else 0.02)
    tractor.drive(speed)
    angles = []
    for seconds in (1.0, 2.0):
        tractor.simulation.run(seconds)
        angles.append(math.log(math.tan(angle_between(tractor, trailer) / 2.0)))
    # dθ/dt = -v / L sin θ: ln tan(θ / 2) falls, or grows, by v / L a second.
    rate = (angles[1] - angles[0]) / 2.0
    report.check(60, 'rate of a jackknife', rate, -speed / 0.5, 1e-5, '1/s')


def test_what_is_towed_is_pushed_aside_by_no_less_than_its_traction():
    _, trailer = towed(SHAPES['balanced'])
    trailer.simulation.run(1.0)
    begin = trailer.truth().pose
    simulation = trailer.simulation
    pose = begin[0], -0.25, 0.0
    # What hits it from its side, at a twentieth of its mass, slides it a little.
    crate = Properties(mass=0.1, velocity=(0.0, 2.0))
    simulation.perform(
        Spawn(name='crate/0', shape=Box(width=0.1, height=0.1), pose=pose, properties=crate)
    )
    simulation.run(3.0)
    moved = np.subtract(trailer.truth().pose[:2], begin[:2])
    assert 0.0 < math.hypot(*moved) < 0.02


def test_a_train_is_shown_again_to_the_bit_and_continues_from_a_checkpoint():
    tractor, trailer = towed(SHAPES['heavy in front'], hitch=0.1, angle=0.4)
    simulation = tractor.simulation
    tractor.drive(SPEED, 0.3)
    simulation.run(4.5)
    digest, moment = simulation.world.digest(), simulation.checkpoint()
    simulation.seek(1_700_000_000)
    simulation.world.digest()
    simulation.seek(4_500_000_000)
    assert simulation.world.digest() == digest
    simulation.run(1.0)
    first = tractor.truth(), trailer.truth()
    simulation.restore(moment)
    simulation.run(1.0)
    assert (tractor.truth(), trailer.truth()) == first


def test_joint_states_of_a_train_are_those_of_its_axles():
    settings = WorldSettings(gravity=(0.0, 0.0))
    simulation = Simulation(settings=settings)
    states = {'sensors': [{'kind': 'joint_states'}]}
    roles = {'robot': {'drive': TRACTOR, **states}}, {'robot': states, 'towed': {}}
    for name, x, role in (('tractor/0', 0.0, roles[0]), ('trailer/0', -0.28, roles[1])):
        simulation.perform(
            Spawn(
                name=name,
                shape=Box(width=0.3, height=0.2),
                pose=(x, 0.0, 0.0),
                properties=Properties(mass=2.0, **role),
            )
        )
    simulation.perform(Axle(point=(-0.14, 0.0)))
    tractor, trailer = Robot(simulation, 'tractor/0'), Robot(simulation, 'trailer/0')
    tractor.drive(SPEED, 0.3)
    simulation.run(2.0)
    wheels, axle = tractor.read('joint_states'), trailer.read('joint_states')
    assert wheels.names == ('wheel_left_joint', 'wheel_right_joint', 'axle_0')
    angle = angle_between(tractor, trailer)
    assert wheels.positions[-1] == pytest.approx(-angle)
    assert (axle.names, axle.positions.tolist()) == (('axle_0',), pytest.approx([angle]))
    assert wheels.velocities[-1] == pytest.approx(-axle.velocities[0])
