# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 3 to 7, 9, 24 and 25: collisions, and that nothing passes through anything."""

import itertools
import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody, Command
from physsim_ros.model.shapes import Box, Chain, Disc
import pytest

from .scenes import (
    angular_momentum,
    corners,
    cross,
    depth_in_box,
    DT,
    floor,
    G,
    NOWHERE,
    run,
    simulation,
    spawn,
    steps,
    turned,
    until_velocity_changes,
)

ELASTICITIES = [1.0, 0.5, 0.0]


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize('speeds', [(1.0, 0.0), (0.0, -1.0), (1.0, -1.0)])
@pytest.mark.parametrize('shape', [Disc(radius=0.5), Box(width=1.0, height=1.0)], ids=repr)
def test_bodies_that_meet_head_on_keep_momentum_and_energy(report, shape, speeds, elasticity):
    sim = simulation(gravity=NOWHERE, elasticity=elasticity)
    for name, mass, speed, place in (
        ('lighter/0', 1.0, speeds[0], -1.0),
        ('heavier/0', 3.0, speeds[1], 1.0),
    ):
        spawn(sim, name, shape, (place, 0.0, 0.0), mass=mass, velocity=(speed, 0.0))
    start = sim.world.snapshot()

    end = run(sim, 3.0)

    # https://en.wikipedia.org/wiki/Coefficient_of_restitution#Speeds_after_impact
    center = (speeds[0] + 3.0 * speeds[1]) / 4.0
    approach = speeds[0] - speeds[1]
    what = f'head-on, 1 : 3 kg, e = {elasticity:g}'
    lighter, heavier = end.twists[:, 0]
    exact = center - elasticity * approach * 3.0 / 4.0, center + elasticity * approach / 4.0
    report.check(3, f'{what}, lighter body', lighter, exact[0], 1e-6, 'm/s')
    report.check(3, f'{what}, heavier body', heavier, exact[1], 1e-6, 'm/s')
    off = math.dist(end.momentum, start.momentum)
    report.check(3, f'{what}, momentum', off, 0.0, 1e-6, 'kg m/s')
    lost = (1 - elasticity**2) * approach**2 * (3.0 / 4.0) / 2
    report.check(3, f'{what}, energy', end.kinetic_energy, start.kinetic_energy - lost, 1e-6, 'J')


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize('speed', [0.7, 3.0, 9.0])
@pytest.mark.parametrize('cut', [-60, -20, 0, 30, 45])
def test_discs_part_along_their_line_of_centres(report, cut, speed, elasticity):
    radii, masses = (0.03, 0.05), (0.2, 0.3)
    normal = turned((1.0, 0.0), math.radians(cut))
    drift = np.array((0.3, -0.2))
    # The impact comes after 0.2 s and a share of a step, wherever in it.
    for share in (0.1, 0.4, 0.9):
        sim = simulation(gravity=NOWHERE, elasticity=elasticity, friction=0.0)
        start = -normal * sum(radii) - np.array((speed, 0.0)) * (0.2 + share * DT)
        velocities = drift + np.array((speed, 0.0)), drift
        for name, radius, mass, place, velocity in zip(
            'ab', radii, masses, (start, np.zeros(2)), velocities, strict=True
        ):
            pose = (*place.tolist(), 0.0)
            spawn(sim, f'{name}/0', Disc(radius=radius), pose, mass=mass, velocity=tuple(velocity))

        end = run(sim, 0.5)

        impulse = (1 + elasticity) * speed * normal[0] / sum(1 / mass for mass in masses) * normal
        exact = velocities[0] - impulse / masses[0], velocities[1] + impulse / masses[1]
        for twist, velocity in zip(end.twists, exact, strict=True):
            off = math.dist(twist[:2], velocity) / speed
            report.check(6, 'discs, oblique, velocity', off, 0.0, 1e-6, 'speeds')


@pytest.mark.parametrize('anchored', [True, False])
@pytest.mark.parametrize('speed', [2.0, 8.0, 30.0])
@pytest.mark.parametrize('cut', [-40, -20, 0, 30])
def test_a_disc_parts_from_a_corner_along_the_normal_of_their_impact(report, cut, speed, anchored):
    radius, mass, side = 0.05, 0.3, 0.4
    outwards = turned((-1.0, 0.0), math.radians(cut))
    corner = np.array((-side * math.sqrt(0.5), 0.0))
    for share in (0.1, 0.4, 0.9):
        sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
        box = Box(width=side, height=side)
        spawn(sim, 'box/0', box, (0.0, 0.0, math.pi / 4), mass=2.0, anchored=anchored)
        start = corner + outwards * radius - np.array((speed, 0.0)) * (0.2 + share * DT)
        pose = (*start.tolist(), 0.0)
        spawn(sim, 'disc/0', Disc(radius=radius), pose, mass=mass, velocity=(speed, 0.0))

        end = run(sim, 0.3)

        arm = corner[0] * outwards[1] - corner[1] * outwards[0]
        yielding = 0.0 if anchored else 1 / 2.0 + arm**2 / (2.0 * side**2 / 6)
        impulse = 2.0 * speed * -outwards[0] / (1 / mass + yielding) * outwards
        exact = np.array((speed, 0.0)) + impulse / mass
        off = math.dist(end.twists[1, :2], exact) / speed
        report.check(6, 'disc on a corner, velocity', off, 0.0, 1e-6, 'speeds')


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize('angle', [0, 15, 30, 45, 60, 75, -45])
def test_a_disc_keeps_its_tangential_speed_at_a_wall(report, angle, elasticity):
    sim = simulation(gravity=NOWHERE, elasticity=elasticity, friction=0.0)
    spawn(sim, 'wall/0', Box(width=1.0, height=40.0), (-0.5, 0.0, 0.0), anchored=True)
    normal, tangential = 2.0 * math.cos(math.radians(angle)), 2.0 * math.sin(math.radians(angle))
    said = {'velocity': (-normal, tangential), 'spin': 1.0}
    disc = spawn(sim, 'disc/0', Disc(radius=0.3), (1.0, 0.0, 0.0), **said)

    vx, vy, spin = run(sim, 4.0).twists[disc]

    what = f'disc at a wall, 0 to 75°, e = {elasticity:g}'
    report.check(4, f'{what}, normal', vx, elasticity * normal, 1e-6, 'm/s')
    report.check(4, f'{what}, tangential', vy, tangential, 1e-6, 'm/s')
    report.check(4, f'{what}, spin', spin, 1.0, 1e-6, 'rad/s')


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize('tilt', [10, 30, 45, 60, 80])
@pytest.mark.parametrize('size', [0.2, 1.0])
def test_a_corner_on_a_wall_gets_the_impulse_of_the_formula(report, size, tilt, elasticity):
    sim = simulation(gravity=NOWHERE, elasticity=elasticity, friction=0.0)
    outwards = np.array((1.0, 0.0))
    spawn(sim, 'wall/0', Box(width=1.0, height=40.0), (-0.5, 0.0, 0.0), anchored=True)
    square, pose = Box(width=size, height=size), (1.0, 0.0, math.radians(tilt))
    row = spawn(sim, 'box/0', square, pose, velocity=(-1.0, 0.0), mass=2.0)

    before, after = until_velocity_changes(sim, row)

    # It does not turn before the impact, and turns within the step after it.
    pose = before.poses[row]
    arm = min(corners(square, pose) - pose[:2], key=lambda corner: corner @ outwards)
    lever = cross(arm, outwards)
    moment = 2.0 * size**2 / 6
    # https://en.wikipedia.org/wiki/Collision_response#Impulse-based_contact_model
    impulse = (1 + elasticity) / (1 / 2.0 + lever**2 / moment)
    exact = -outwards + impulse / 2.0 * outwards
    off = math.dist(after.twists[row, :2], exact)
    what = f"square's corner on a wall, e = {elasticity:g}"
    report.check(5, f'{what}, velocity', off, 0.0, 1e-5, 'm/s')
    spin = impulse * lever / moment
    report.check(5, f'{what}, spin', after.twists[row, 2], spin, 1e-5, 'rad/s')


def _impulse(velocity, masses, arms, normal, elasticity, friction):
    """
    Return the impulse on the second of two bodies, by Newton's restitution and Coulomb's cone.

    Where that would give energy to the bodies (Kane and Levinson 1985), it is the impulse of the
    greatest restitution that gives none.

    :param velocity: of the first at the contact, as seen from the second [m/s]
    :param masses: of each: mass [kg], moment [kg m²]
    :param arms: of each, from its centre to the contact [m]
    :param normal: from the first to the second
    :return: the impulse [N s]; 0 where they slide, else the share of its error that one sweep of
        a solver leaves which takes normal and tangent each for itself, as the engine does
    """
    tangent = turned(normal, math.pi / 2)

    def share(one, other):
        return one @ other * sum(1 / mass for mass, _ in masses) + sum(
            cross(arm, one) * cross(arm, other) / moment
            for arm, (_, moment) in zip(arms, masses, strict=True)
        )

    approach, slip = velocity @ normal, velocity @ tangent
    matrix = np.array(
        [[share(one, other) for other in (normal, tangent)] for one in (normal, tangent)]
    )

    def solved(share):
        """Return the impulse of a share of the elasticity, the coupling, the energy given [J]."""
        wanted = (1 + share * elasticity) * approach
        along, across = np.linalg.solve(matrix, [wanted, slip])
        coupling = abs(matrix[0, 1]) / math.sqrt(matrix[0, 0] * matrix[1, 1])
        if abs(across) > friction * along:
            # It slides: the impulse lies on the cone, on the side of the slip.
            slide = math.copysign(friction, across)
            along, coupling = wanted / (matrix[0, 0] + slide * matrix[0, 1]), 0.0
            across = slide * along
        impulse = np.array([along, across])
        energy = impulse @ (matrix @ impulse / 2 - (approach, slip))
        return along * normal + across * tangent, coupling, energy

    impulse, coupling, energy = solved(1.0)
    low, high = (0.0, 1.0) if energy > 1e-9 else (1.0, 1.0)
    while high - low > 1e-9:
        share = (low + high) / 2
        low, high = (low, share) if solved(share)[2] > 0.0 else (share, high)
        impulse, coupling, _ = solved(low)
    return impulse, coupling


# How far the paths are off centre [m], how the box that comes with a corner is tilted [°], and how
# it slips [m/s]: on both sides of the cone at a friction of 0.3.
OBLIQUE = list(itertools.product((-0.35, 0.1, 0.3), (20, 45, 70), (-1.0, -0.1, 0.0, 0.3, 1.0)))
# Share of the error of a sticking impulse that a sweep may leave [1]: with more, ten do not reach
# 1e-4 (0.38 to the tenth is 6e-5) and the bound is wider. At twenty the law holds for those too.
COUPLED = 0.38


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize(('friction', 'iterations'), [(0.0, 10), (0.3, 10), (0.3, 20)])
def test_boxes_that_meet_obliquely_get_the_impulse_of_the_formula(
    report, friction, iterations, elasticity
):
    couplings, along = [], np.array((1.0, 0.0))
    for offset, tilt, slip in OBLIQUE:
        material = {'elasticity': elasticity, 'friction': friction}
        sim = simulation(gravity=NOWHERE, iterations=iterations, **material)
        comer, stander = Box(width=0.6, height=0.6), Box(width=0.8, height=1.4)
        tilted = [turned(point, math.radians(tilt)) for point in comer.corners()]
        # It arrives at the end of the 12th step, and so to the nanometre where it touches.
        gap = np.array([-0.4 - 12 * DT + 1e-9, offset - slip * 12 * DT])
        pose = (*(gap - max(tilted, key=lambda point: point[0])), math.radians(tilt))
        a = spawn(sim, 'comer/0', comer, pose, velocity=(1.0, slip), mass=0.5)
        b = spawn(sim, 'stander/0', stander, mass=2.0)
        start = sim.world.snapshot()

        before, after = until_velocity_changes(sim, b)

        point = max(corners(comer, after.poses[a]), key=lambda each: each @ along)
        arms = [point - after.poses[row, :2] for row in (a, b)]
        masses = after.scene.inertia
        impulse, coupling = _impulse(before.twists[a, :2], masses, arms, along, **material)
        couplings.append(coupling)
        what, tolerance = f'oblique boxes, μ = {friction:g}, e = {elasticity:g}', 1e-4
        if iterations == 20:
            what = f'the same at 20 iterations, μ = {friction:g}'
        elif coupling > COUPLED:
            what, tolerance = 'the same, strongly coupled', 1e-3
        for row, sign in ((a, -1.0), (b, 1.0)):
            mass, moment = masses[row]
            exact = before.twists[row, :2] + sign * impulse / mass
            off = math.dist(after.twists[row, :2], exact)
            report.check(6, f'{what}, velocity', off, 0.0, tolerance, 'm/s')
            spin = sign * cross(arms[row], impulse) / moment
            off = (after.twists[row, 2] - spin) * math.dist((0, 0), arms[row])
            report.check(6, f'{what}, speed of spin', off, 0.0, tolerance, 'm/s')
        off = math.dist(after.momentum, start.momentum)
        report.check(6, 'oblique boxes, momentum', off, 0.0, 1e-12, 'kg m/s')
        off = angular_momentum(after) - angular_momentum(start)
        report.check(6, 'oblique boxes, angular momentum', off, 0.0, 1e-5, 'kg m²/s')
    sticking = sum(coupling > 0 for coupling in couplings)
    assert (0 < sticking < len(OBLIQUE)) == (friction > 0)


@pytest.mark.parametrize('elasticity', ELASTICITIES)
@pytest.mark.parametrize('height', [1.0, 5.0, 20.0])
@pytest.mark.parametrize('side', [0, 45, 315])
@pytest.mark.parametrize('yaw', [0, 20])
def test_a_disc_dropped_on_a_box_bounces_off_the_side_it_came_from(
    report, yaw, side, height, elasticity
):
    box = Box(width=1.0, height=1.0)
    outwards = turned((1.0, 0.0), math.radians(side + yaw))
    sim = simulation(gravity=tuple(-G * outwards), elasticity=elasticity)
    spawn(sim, 'box/0', box, (0.0, 0.0, math.radians(yaw)), anchored=True)
    # Onto the middle of a side, or onto a corner.
    top = (0.5 if side % 90 == 0 else math.sqrt(0.5)) + 0.1
    disc = spawn(sim, 'disc/0', Disc(radius=0.1), (*((top + height) * outwards), 0.0))
    fall = math.sqrt(2 * height / G)

    deepest = 0.0
    for snapshot in steps(sim, math.ceil((fall + 0.5) / DT)):
        pose = snapshot.poses[0]
        center = snapshot.poses[disc, :2]
        deepest = max(deepest, depth_in_box(center, 0.1, box, pose))
        assert center @ outwards > 0
        if side % 90 == 0:
            assert center @ outwards > 0.5

    report.check(7, 'disc dropped on sides and corners, penetration', deepest, 0.0, 0.01, 'm')


@pytest.mark.parametrize('speed', [1.0, 10.0, 25.0, 100.0])
@pytest.mark.parametrize('side', [0, 45, 315])
@pytest.mark.parametrize('elasticity', [1.0, 0.5])
def test_a_disc_thrown_at_a_loose_box_never_enters_it(report, elasticity, side, speed):
    box = Box(width=1.0, height=1.0)
    outwards = turned((1.0, 0.0), math.radians(side))
    sim = simulation(gravity=NOWHERE, elasticity=elasticity)
    spawn(sim, 'box/0', box, mass=1.0)
    pose, velocity = (*(2.0 * outwards), 0.0), tuple(-speed * outwards)
    disc = spawn(sim, 'disc/0', Disc(radius=0.1), pose, velocity=velocity, mass=1.0)

    deepest = 0.0
    for snapshot in steps(sim, math.ceil(1.0 / DT)):
        center = snapshot.poses[disc, :2]
        deepest = max(deepest, depth_in_box(center, 0.1, box, snapshot.poses[0]))
        assert (center - snapshot.poses[0, :2]) @ outwards > 0.4

    report.check(7, 'disc thrown at a loose box, penetration', deepest, 0.0, 0.01, 'm')


@pytest.mark.parametrize('speed', [1.0, 5.0, 15.0])
@pytest.mark.parametrize('angle', [0, 30, 60])
@pytest.mark.parametrize(
    'wall',
    [Box(width=0.1, height=20.0), Chain(points=((0.0, -10.0), (0.0, 10.0)), thickness=0.02)],
    ids=['box', 'chain'],
)
def test_a_disc_bounces_off_the_side_of_a_wall_that_it_came_from(report, wall, angle, speed):
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'wall/0', wall, anchored=True)
    half = 0.05 if isinstance(wall, Box) else 0.01
    normal = speed * math.cos(math.radians(angle))
    velocity = (-normal, speed * math.sin(math.radians(angle)))
    disc = spawn(sim, 'disc/0', Disc(radius=0.1), (0.5, 0.0, 0.0), velocity=velocity)

    deepest = 0.0
    for snapshot in steps(sim, math.ceil(1.2 / normal / DT)):
        deepest = max(deepest, half + 0.1 - snapshot.poses[disc, 0])

    assert snapshot.twists[disc, 0] == pytest.approx(normal / 2)
    report.check(7, 'disc at each side of a wall, penetration', deepest, 0.0, 0.01, 'm')


@pytest.mark.parametrize('elasticities', [(0.5, 0.5), (0.25, 1.0)])
def test_a_pair_has_the_geometric_mean_of_the_elasticities(report, elasticities):
    sim = simulation(gravity=NOWHERE)
    for number, (elasticity, sign) in enumerate(zip(elasticities, (-1, 1), strict=True)):
        said = {'velocity': (-sign, 0.0), 'elasticity': elasticity}
        spawn(sim, f'disc/{number}', Disc(radius=0.5), (sign, 0.0, 0.0), **said)

    (parting,) = np.diff(run(sim, 2.0).twists[:, 0])

    report.check(9, 'elasticity of a pair with 0.5', parting / 2.0, 0.5, 1e-6, '–')


@pytest.mark.parametrize('frictions', [(0.4, 0.4), (0.2, 0.8), (1.6, 0.1)])
def test_a_pair_has_the_geometric_mean_of_the_frictions(report, frictions):
    sim = simulation()
    floor(sim, friction=frictions[0])
    box = spawn(sim, 'box/0', Box(width=1.0, height=0.2), (0.0, 0.1, 0.0), friction=frictions[1])
    run(sim, 2.0)
    sim.perform(Command(names=('box/0',), twists=((5.0, 0.0, 0.0),)))

    first = run(sim, 0.2)
    last = run(sim, 0.5)

    slowing = (first.twists[box, 0] - last.twists[box, 0]) / 0.5
    report.check(9, 'friction of a pair with 0.4', slowing / G, 0.4, 1e-6, '–')


@pytest.mark.parametrize(
    'hitter', [Disc(radius=0.3), Box(width=0.5, height=0.5)], ids=['disc', 'box']
)
@pytest.mark.parametrize('elasticity', ELASTICITIES)
def test_an_anchored_body_does_not_move_at_all(report, elasticity, hitter):
    sim = simulation(elasticity=elasticity)
    anchored = spawn(sim, 'anchored/0', Box(width=0.4, height=0.4), (0.1, 0.2, 0.3), anchored=True)
    start = sim.world.snapshot().poses[anchored].copy()
    spawn(sim, 'hitter/0', hitter, (-1.9, 0.2, 0.5), velocity=(20.0, 0.0), mass=100.0)

    end = run(sim, 0.5)

    assert end.twists[1, 0] < 19.0, 'it was not hit'
    moved = np.abs(end.poses[anchored] - start).max()
    report.check(24, 'anchored body hit at 20 m/s by 100 kg', moved, 0.0, 0.0, 'm, rad')
    assert not end.twists[anchored].any()


def test_faces_that_meet_as_a_sub_step_ends_meet_as_a_whole(report):
    sim = simulation(elasticity=1.0, friction=0.0)
    floor(sim, elasticity=0.0)
    shape = Box(width=1.0, height=1.0)
    spawn(sim, 'box/0', shape, (1.0, 0.5, 0.0), mass=1.0)
    # After half a second the faces overlap by rounding, at one of their corners.
    spawn(sim, 'box/1', shape, (2.5, 0.5, 0.0), mass=100.0, velocity=(-1.0, 0.0))
    for now in steps(sim, 240):
        spin = np.abs(now.twists[:, 2]).max()
        report.check(3, 'boxes on a floor that meet, spin', spin, 0.0, 0.02, 'rad/s')


@pytest.mark.parametrize('gap', [0.003, 0.05, 0.13])
@pytest.mark.parametrize('speed', [0.2, 1.0, 10.0, 60.0])
@pytest.mark.parametrize('shape', [Disc(radius=0.5), Box(width=1.0, height=1.0)], ids=repr)
def test_a_body_whose_velocity_is_set_in_each_frame_slides_along_a_wall(report, shape, speed, gap):
    sim = simulation(gravity=NOWHERE, elasticity=0.0)
    wall = Box(width=0.05, height=200.0)
    spawn(sim, 'wall/0', wall, (0.525 + gap, 0.0, 0.0), anchored=True, friction=0.0)
    row = spawn(sim, 'body/0', shape)

    velocity, deepest = (speed, 0.3 * speed), 0.0
    for _ in range(60):
        sim.perform(ChangeBody(name='body/0', properties=Properties(velocity=velocity)))
        x, y, _ = sim.advance_frame().snapshot.poses[row]
        deepest = max(deepest, x - gap)

    report.check(25, 'velocity that is set towards a wall, penetration', deepest, 0.0, 1e-4, 'm')
    report.check(25, 'the same, way along the wall', y, 0.3 * speed, 1e-9, 'm')


def test_a_body_whose_velocity_is_set_in_each_frame_pushes_another_ahead(report):
    sim = simulation(gravity=NOWHERE, elasticity=0.0)
    shape = Box(width=1.0, height=1.0)
    spawn(sim, 'box/0', shape)
    spawn(sim, 'box/1', shape, (1.3123, 0.0, 0.0))
    for _ in range(60):
        sim.perform(ChangeBody(name='box/0', properties=Properties(velocity=(2.0, 0.0))))
        end = sim.advance_frame().snapshot
    overlap = 1.0 - (end.poses[1, 0] - end.poses[0, 0])
    report.check(25, 'velocity that is set towards a loose box, overlap', overlap, 0.0, 5e-4, 'm')
    report.check(25, 'speed of the loose box', end.twists[1, 0], 2.0, 1e-9, 'm/s')
