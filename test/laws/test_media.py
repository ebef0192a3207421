# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 70 and 71: media carry what lies in them, and resist what moves through them."""

import itertools
import math
import random

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody
from physsim_ros.model.shapes import Box, Chain, Compound, contains, Disc, Polygon
from physsim_ros.model.transform import rotated_each
import pytest

from .scenes import DT, floor, G, integrated, join, run, simulation, spawn, steps

WATER = 1000.0
SQUARE = Box(width=1.0, height=1.0)
TRAPEZE = Polygon(outline=((-0.5, 0.0), (0.5, 0.0), (0.3, -0.4), (-0.3, -0.4)))
ELL = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)))


def pool(sim, shape=None, pose=(0.0, -5.0, 0.0), *, density=WATER, **medium):
    """Add water whose level is the x axis, or another region; return its row."""
    shape = shape or Box(width=30.0, height=10.0)
    said = {'density': density, **medium}
    return spawn(sim, 'pool/0', shape, pose, anchored=True, sensor=True, medium=said)


def calm(sim, shape, pose=(0.0, 0.0, 0.0), *, seconds=20.0, **properties):
    """Let a body come to rest in a pool of syrup; return its pose and velocity."""
    row = spawn(sim, 'body/0', shape, pose, **properties)
    last = run(sim, seconds)
    return last.poses[row], last.twists[row]


def submerged_part(share):
    """Return how deep the lowest point of a disc of radius 1 is, if that share of it is wet."""
    low, high = 0.0, 2.0
    for _ in range(60):
        depth = (low + high) / 2
        half = math.acos(1.0 - depth)
        wet = (half - math.sin(half) * math.cos(half)) / math.pi
        low, high = (depth, high) if wet < share else (low, depth)
    return low


# Law 70: buoyancy


@pytest.mark.parametrize('share', [0.02, 0.3, 0.5, 0.77, 0.99])
def test_a_disc_floats_at_the_depth_of_archimedes(report, share):
    sim = simulation()
    pool(sim, viscosity=200.0)
    pose, _ = calm(sim, Disc(radius=0.4), density=share * WATER)
    depth = 0.4 - pose[1]
    report.check(70, 'depth of a disc', depth / (0.4 * submerged_part(share)), 1.0, 1e-6, '-')


@pytest.mark.parametrize('share', [0.05, 0.4, 0.9])
@pytest.mark.parametrize(
    ('shape', 'depth'),
    [
        (Box(width=2.0, height=0.5), lambda share: 0.5 * share - 0.25),
        (
            Compound(element=Box(width=0.5, height=0.5), centers=((-0.7, 0.0), (0.7, 0.0))),
            lambda share: 0.5 * share - 0.25,
        ),
        (
            Compound(element=Disc(radius=0.2), centers=((-0.7, 0.0), (0.7, 0.0))),
            lambda share: 0.2 * submerged_part(share) - 0.2,
        ),
    ],
    ids=['box', 'two boxes', 'two discs'],
)
def test_bodies_float_level_at_the_depth_of_archimedes(report, shape, depth, share):
    sim = simulation()
    pool(sim, viscosity=200.0)
    pose, _ = calm(sim, shape, (0.0, 0.0, 0.05), density=share * WATER)
    report.check(70, 'depth of a float', -pose[1], depth(share), 1e-6, 'm')
    report.check(70, 'a float is level', pose[2], 0.0, 1e-6, 'rad')


def test_a_trapeze_floats_at_the_depth_of_archimedes(report):
    sim = simulation()
    pool(sim, viscosity=200.0)
    pose, _ = calm(sim, TRAPEZE, density=0.5 * WATER)
    # Its keel is 0.6 m wide, and each metre above adds a metre.
    keel = 0.4 - pose[1]
    report.check(70, 'wet area', (0.6 * keel + keel**2 / 2) / (0.5 * 0.32), 1.0, 1e-6, '-')


def test_a_log_of_half_the_density_floats_with_its_axis_at_the_level(report):
    sim = simulation()
    pool(sim, viscosity=200.0)
    log = Chain(points=((-0.5, 0.0), (0.5, 0.0)), thickness=0.3)
    pose, _ = calm(sim, log, (0.0, 0.1, 0.1), density=0.5 * WATER)
    report.check(70, 'height of a log', pose[1], 0.0, 1e-7, 'm')
    report.check(70, 'a log is level', pose[2], 0.0, 1e-6, 'rad')


@pytest.mark.parametrize('share', [0.23, 0.24, 0.5])
def test_a_square_floats_at_the_angle_that_the_metacentre_says(report, share):
    sim = simulation()
    pool(sim, viscosity=200.0)
    # The arm of stability of a draught s and a slope t of the level is
    # (1 + t²/2)/12s - (1 - s)/2, as long as the level crosses two opposite sides.
    angle = math.atan(math.sqrt(12 * share * (1 - share) - 2))
    start = angle + 0.1 if share < 0.5 else 0.1
    pose, _ = calm(sim, SQUARE, (0.0, 0.0, start), seconds=60.0, density=share * WATER)
    report.check(70, 'angle of a square', math.degrees(pose[2]), math.degrees(angle), 0.01, '°')


def test_a_light_square_floats_upright(report):
    sim = simulation()
    pool(sim, viscosity=200.0)
    pose, _ = calm(sim, SQUARE, (0.0, 0.0, 0.2), seconds=30.0, density=0.15 * WATER)
    report.check(70, 'a square of a sixth of the density is upright', pose[2], 0.0, 1e-4, 'rad')


def boat(sim, yaw, *, ballast):
    """Add a hull with a keel that hangs under it, turned about the hull."""
    spawn(sim, 'hull/0', Box(width=2.0, height=0.6), (0.0, 0.0, yaw), density=300.0, group=1)
    keel = (0.6 * math.sin(yaw), -0.6 * math.cos(yaw), yaw)
    spawn(sim, 'keel/0', Box(width=0.3, height=0.4), keel, density=ballast, group=1)
    join(sim, 'pin/0', 'pin', [keel[:2]], a='hull/0', b='keel/0')


def test_a_boat_with_ballast_rights_itself_from_beyond_the_horizontal(report):
    sim = simulation()
    pool(sim, viscosity=100.0)
    boat(sim, math.radians(130.0), ballast=4000.0)
    last = run(sim, 30.0)
    report.check(70, 'heel of a boat', math.degrees(last.poses[1, 2]), 0.0, 0.1, '°')
    wet = -(last.poses[1, 1] - 0.3) * 2.0 + 0.12
    weight = 1.2 * 300.0 + 0.12 * 4000.0
    lowest = min(wet, 1.2 + 0.12)
    report.check(70, 'displacement of a boat', lowest * WATER / weight, 1.0, 1e-3, '-')


@pytest.mark.parametrize('amplitude', [0.01, 0.15])
def test_a_box_heaves_at_its_period_and_keeps_its_energy(report, amplitude):
    sim = simulation()
    pool(sim, drag=0.0)
    spawn(sim, 'body/0', Box(width=1.0, height=0.4), (0.0, amplitude, 0.0), density=0.5 * WATER)
    heights = [snapshot.poses[1, 1] for snapshot in steps(sim, 4800)]
    down = [
        number + before / (before - after)
        for number, (before, after) in enumerate(itertools.pairwise(heights))
        if before > 0.0 >= after
    ]
    period = (down[-1] - down[0]) / (len(down) - 1) * DT
    exact = math.tau * math.sqrt(0.5 * 0.4 / G)
    report.check(70, 'period of a box that heaves', period / exact, 1.0, 1e-4, '-')
    kept = max(heights[-240:]) / amplitude
    report.check(70, 'amplitude after 20 s', kept, 1.0, 1e-3, '-')


def potential(density, box, pose):
    """Return the energy of a box in water [J], by strips of its area."""
    count = 400
    x, y = (np.arange(count) + 0.5) / count - 0.5, (np.arange(count) + 0.5) / count - 0.5
    x, y = np.meshgrid(x * box.width, y * box.height)
    height = pose[1] + x * math.sin(pose[2]) + y * math.cos(pose[2])
    area = box.width * box.height / count**2
    return G * area * float((density * height - WATER * np.minimum(height, 0.0)).sum())


def test_a_box_that_rolls_and_heaves_keeps_its_energy(report):
    sim = simulation()
    pool(sim, drag=0.0)
    box, density = Box(width=1.2, height=0.5), 0.5 * WATER
    spawn(sim, 'body/0', box, (0.0, 0.1, 0.4), density=density, velocity=(0.3, 0.5), spin=0.5)
    energies = []
    for number, snapshot in enumerate(steps(sim, 2400)):
        if number % 60 == 0:
            energy = snapshot.kinetic_energy + potential(density, box, snapshot.poses[1])
            energies.append(energy)
    span = energies[0] - potential(density, box, (0.0, 0.0, 0.0))
    spread = (max(energies) - min(energies)) / span
    report.check(70, 'energy of a box that rolls, for 10 s', spread, 0.0, 0.005, '-')


def test_what_is_full_sinks_by_the_difference_of_the_densities(report):
    sim = simulation()
    pool(sim, drag=0.0)
    row = spawn(sim, 'body/0', ELL, (0.0, -3.0, 0.3), density=1.25 * WATER)
    for snapshot in steps(sim, 120):
        t = snapshot.step * DT
        speed = snapshot.twists[row, 1] / (-G * (1 - 1 / 1.25) * t)
        report.check(70, 'what sinks falls by g (1 - ρw/ρ)', speed, 1.0, 1e-9, '-')
    report.check(70, 'what is under water does not turn', snapshot.twists[row, 2], 0.0, 1e-12, '-')


@pytest.mark.parametrize(
    'shape',
    [
        Disc(radius=3.0),
        Chain(points=((-2.0, 0.0), (2.0, 0.0)), thickness=3.0),
        Polygon(
            outline=((-3.0, -2.0), (0.0, -3.0), (3.0, -2.0), (3.0, 2.0), (0.0, 1.0), (-3.0, 2.0))
        ),
    ],
    ids=['disc', 'capsule', 'concave'],
)
def test_a_region_of_any_shape_carries_by_what_lies_in_it(report, shape):
    sim = simulation()
    pool(sim, shape, (0.0, 0.0, 0.4))
    bodies = random.Random(7)
    for number in range(20):
        place = (bodies.uniform(-4, 4), bodies.uniform(-4, 4), bodies.uniform(-3, 3))
        body = bodies.choice([Disc(radius=0.6), Box(width=1.5, height=0.7), ELL])
        name = f'body/{number}'
        spawn(sim, name, body, place, density=2 * WATER, group=1)
    scene, poses = sim.world.snapshot().scene, sim.world.snapshot().poses
    sim.world.step(1)
    twists = sim.world.snapshot().twists
    grid = np.arange(-3.0, 3.0, 0.01) + 0.005
    points = np.array([(x, y) for x in grid for y in grid])
    for row in range(1, 21):
        lifted = (twists[row, 1] + G * DT) / (G * DT) * scene.inertia[row, 0] / WATER
        inside = points[covered(scene.bodies[row].shape, points)]
        at = rotated_each(inside, poses[row, 2]) + poses[row, :2] - poses[0, :2]
        wet = covered(shape, rotated_each(at, -poses[0, 2])).sum() * (grid[1] - grid[0]) ** 2
        report.check(70, 'lift in a region, in area', lifted, wet, 0.01, 'm²')


@pytest.mark.parametrize(
    'region', [Disc(radius=3.0), Chain(points=((-2.0, 0.0), (2.0, 0.0)), thickness=3.0)]
)
def test_a_round_region_carries_bodies_and_their_mirror_images_alike(report, region):
    sim = simulation()
    pool(sim, region)
    places = random.Random(3)
    for number in range(20):
        body = places.choice([Disc(radius=0.6), Box(width=1.5, height=0.7)])
        x, y, yaw = places.uniform(0.5, 4), places.uniform(-4, 4), places.uniform(-3, 3)
        spawn(sim, f'right/{number}', body, (x, y, yaw), density=WATER, group=1)
        spawn(sim, f'left/{number}', body, (-x, y, -yaw), density=WATER, group=1)
    sim.world.step(1)
    right, left = sim.world.snapshot().twists[1::2], sim.world.snapshot().twists[2::2]
    off = np.abs(right - left * (-1.0, 1.0, -1.0)).max()
    report.check(70, 'mirrored in a round region', off / (G * DT), 0.0, 1e-9, 'g dt')


def covered(shape, points):
    """Return which points of the frame of a shape lie in it."""
    return contains(shape.form.pieces, points[:, 0], points[:, 1])


def test_nothing_happens_to_what_lies_in_no_region(report):
    plain, with_pool = simulation(), simulation()
    pool(with_pool, pose=(0.0, -50.0, 0.0))
    for sim in (plain, with_pool):
        spawn(sim, 'body/0', ELL, (0.0, 0.0, 0.3), velocity=(1.0, 2.0), spin=1.0)
    for one, other in zip(steps(plain, 240), steps(with_pool, 240), strict=True):
        off = np.abs(one.poses[0] - other.poses[1]).max()
        report.check(70, 'path outside a region', off, 0.0, 0.0, 'm')


# Law 71: drag


@pytest.mark.parametrize('mass', [0.01, 1.0, 30.0])
@pytest.mark.parametrize('yaw', [0.0, 0.5])
def test_bodies_fall_at_the_terminal_speed_of_quadratic_drag(report, mass, yaw):
    for shape in (Disc(radius=0.1), Box(width=0.3, height=0.1), ELL):
        sim = simulation(air_density=1e-3, air_drag=47.0)
        # Turning would change its width.
        spawn(sim, 'body/0', shape, (0.0, 0.0, yaw), mass=mass)
        width = width_across(shape, yaw)
        weight = G * (mass - 1e-3 * shape.form.area)
        exact = math.sqrt(weight / (0.5 * 47.0 * 1e-3 * width))
        sim.perform(
            ChangeBody(name='body/0', properties=Properties(velocity=(0.0, -exact), spin=0.0))
        )
        sim.world.step(1)
        twist = sim.world.snapshot().twists[0]
        report.check(71, 'terminal speed of quadratic drag', -twist[1] / exact, 1.0, 1e-4, '-')


def width_across(shape, yaw):
    """Return how wide a shape is along x, at a yaw [m]."""
    if isinstance(shape, Disc):
        return 2 * shape.radius
    corners = shape.corners() if isinstance(shape, Box) else shape.outline
    x = [px * math.cos(yaw) - py * math.sin(yaw) for px, py in corners]
    return max(x) - min(x)


def test_a_ball_reaches_its_terminal_speeds(report):
    stokes = simulation(air_viscosity=0.8)
    spawn(stokes, 'body/0', Disc(radius=0.1), mass=1.0)
    speed = -run(stokes, 12.0).twists[0, 1]
    exact = G / (6 * math.pi * 0.8 * 0.1)
    report.check(71, 'terminal speed by Stokes', speed / exact, 1.0, 1e-4, '-')
    newton = simulation(air_density=1.2, air_drag=0.47)
    spawn(newton, 'body/0', Disc(radius=0.1), mass=1.0)
    speed = -run(newton, 12.0).twists[0, 1]
    weight = G * (1.0 - 1.2 * math.pi * 0.01)
    exact = math.sqrt(weight / (0.5 * 1.2 * 0.47 * 0.2))
    report.check(71, 'terminal speed by Newton', speed / exact, 1.0, 1e-4, '-')


@pytest.mark.parametrize('radius', [0.01, 0.1, 0.5])
@pytest.mark.parametrize('density', [1.2, 10.0, 100.0])
def test_bubbles_rise_at_their_terminal_speed(report, density, radius):
    sim = simulation()
    pool(sim, Box(width=30.0, height=100.0), (0.0, 0.0, 0.0))
    row = spawn(sim, 'bubble/0', Disc(radius=radius), (0.0, -40.0, 0.0), density=density)
    speed = run(sim, 4.0).twists[row, 1]
    exact = math.sqrt(G * math.pi * radius * (1.0 - density / WATER))
    report.check(71, 'terminal speed of a bubble', speed / exact, 1.0, 1e-4, '-')


@pytest.mark.parametrize('viscosity', [0.0, 0.3])
def test_a_throw_follows_the_integrated_path(report, viscosity):
    wind = (-3.0, 0.5)
    sim = simulation(air_density=1.2, air_drag=0.47, air_viscosity=viscosity, wind=wind)
    spawn(sim, 'body/0', Disc(radius=0.1), mass=0.5, velocity=(20.0, 15.0), spin=30.0)

    def change(state):
        u = state[2:] - wind
        drag = 0.5 * 1.2 * 0.47 * 0.2 * np.hypot(*u) + 6 * math.pi * viscosity * 0.1
        fall = G * (1.0 - 1.2 * math.pi * 0.01 / 0.5)
        return np.array([*state[2:], *(-drag * u / 0.5 - (0.0, fall))])

    state = np.array([0.0, 0.0, 20.0, 15.0])
    for snapshot in steps(sim, 720):
        state = integrated(change, state, DT, 1)
        off = math.dist(snapshot.poses[0, :2], state[:2])
        report.check(71, 'path of a throw with drag, for 3 s', off, 0.0, 1e-3, 'm')


def test_a_bar_that_spins_is_slowed_by_the_torque_of_its_faces(report):
    sim = simulation(gravity=(0.0, 0.0), air_density=2.0, air_drag=1.0)
    spawn(sim, 'body/0', Box(width=2.0, height=0.01), mass=1.0, spin=5.0)
    moment = sim.world.snapshot().scene.inertia[0, 1]
    # Each half has one face that meets the medium: ½ c ρ ω² times twice the integral of r³.
    rate = 0.5 * 2.0 * 2.0**4 / 32 / moment
    for snapshot in steps(sim, 480):
        exact = 5.0 / (1.0 + 5.0 * rate * snapshot.step * DT)
        report.check(71, 'spin of a bar', snapshot.twists[0, 2] / exact, 1.0, 1e-3, '-')


@pytest.mark.parametrize(
    ('shape', 'density', 'square'),
    [
        # Along the outline the integral of the squared distance from the centre [m³]: of a side of
        # length s at a distance d, s d² + s³ / 12.
        (Disc(radius=0.2), 5.0, math.tau * 0.2**3),
        (
            Box(width=0.6, height=0.2),
            0.0,
            2 * (0.6 * 0.1**2 + 0.2 * 0.3**2 + (0.6**3 + 0.2**3) / 12),
        ),
    ],
)
@pytest.mark.parametrize('decay', [0.01, 3.0])
def test_what_spins_is_slowed_by_viscosity_and_a_disc_by_that_alone(
    report, shape, density, square, decay
):
    viscosity = decay * shape.form.gyration / (3 * square * DT)
    sim = simulation(gravity=(0.0, 0.0), air_viscosity=viscosity, air_density=density)
    spawn(sim, 'body/0', shape, mass=1.0, spin=5.0)
    first, last = (each.twists[0, 2] for each in steps(sim, 2))
    exact = math.exp(-decay)
    report.check(71, 'spin in a viscous medium', last / first / exact, 1.0, 1e-9, '-')


def test_a_spinning_ball_is_not_turned_aside(report):
    sim = simulation(gravity=(0.0, 0.0), air_density=1.0)
    spawn(sim, 'body/0', Disc(radius=0.2), mass=1.0, velocity=(10.0, 0.0), spin=50.0)
    last = run(sim, 1.0)
    report.check(71, 'side way of a spinning ball', last.poses[0, 1], 0.0, 1e-12, 'm')


def test_an_arrow_turns_into_the_wind(report):
    sim = simulation(gravity=(0.0, 0.0), air_density=1.2, wind=(8.0, 0.0), air_viscosity=0.05)
    feathers = Box(width=0.1, height=0.4)
    spawn(sim, 'shaft/0', Box(width=1.0, height=0.02), (0.0, 0.0, 2.0), mass=0.1, group=1)
    back = (-0.5 * math.cos(2.0), -0.5 * math.sin(2.0), 2.0)
    spawn(sim, 'feathers/0', feathers, back, mass=0.02, group=1)
    join(sim, 'pin/0', 'pin', [back[:2]], a='feathers/0', b='shaft/0')
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='shaft/0', b='world')
    last = run(sim, 30.0)
    # Its feathers, at the lee side, are behind it.
    report.check(71, 'an arrow in the wind', abs(last.poses[0, 2]), math.pi, 0.01, 'rad')


def test_a_current_carries_along_and_a_region_has_it_alone(report):
    sim = simulation(gravity=(0.0, 0.0))
    river = Box(width=100.0, height=2.0)
    pool(sim, river, (0.0, 0.0, math.pi / 2), density=1.0, viscosity=0.1, flow=(2.0, 0.0))
    spawn(sim, 'in/0', Box(width=0.2, height=0.2), mass=0.2)
    spawn(sim, 'out/0', Box(width=0.2, height=0.2), (3.0, 0.0, 0.0), mass=0.2)
    last = run(sim, 60.0)
    report.check(71, 'speed in a current', last.twists[1, 1], 2.0, 1e-3, 'm/s')
    report.check(71, 'speed beside it', last.twists[2, 1], 0.0, 0.0, 'm/s')


def test_gusts_have_their_mean_square_and_come_back_by_seed(report):
    def speeds(seed, seconds):
        sim = simulation(
            gravity=(0.0, 0.0), air_viscosity=1e4, wind=(5.0, 0.0), gusts=2.0, seed=seed
        )
        spawn(sim, 'body/0', Disc(radius=0.1), mass=0.01)
        return np.array([snapshot.twists[0] for snapshot in steps(sim, 240 * seconds)])

    one = speeds(1, 100)
    for number in range(2):
        rms = float(np.std(one[240:, number]))
        report.check(71, 'root mean square of gusts', rms, 2.0, 0.2, 'm/s')
    report.check(71, 'mean of the wind', float(np.mean(one[240:, 0])), 5.0, 0.3, 'm/s')
    assert np.array_equal(one[:240], speeds(1, 1))
    assert not np.array_equal(one[:240], speeds(2, 1))


@pytest.mark.parametrize('angle', [0.0, 0.3, 0.8, math.pi / 2])
def test_wind_presses_a_plate_along_itself_by_the_width_across_it(report, angle):
    sim = simulation(gravity=(0.0, 0.0), air_density=1.2, air_drag=1.1, wind=(8.0, 0.0))
    plate = Box(width=2.0, height=0.02)
    spawn(sim, 'plate/0', plate, (0.0, 0.0, angle), mass=50.0)
    sim.world.step(1)
    push = sim.world.snapshot().twists[0] / DT * 50.0
    exact = 0.5 * 1.1 * 1.2 * 8.0**2 * width_across(plate, math.pi / 2 - angle)
    report.check(71, 'push of wind on a plate', push[0] / exact, 1.0, 1e-3, '-')
    report.check(71, 'lift of wind on a plate', push[1] / exact, 0.0, 1e-9, '-')


def test_a_gust_is_the_same_to_the_bit_when_it_is_played_again():
    sim = simulation(gravity=(0.0, 0.0), air_density=1.2, wind=(5.0, 0.0), gusts=3.0, seed=4)
    spawn(sim, 'ball/0', Disc(radius=0.2), mass=0.1)
    blown = [run(sim, 0.5).twists[0] for _ in range(10)]
    sim.seek(0)
    sim.apply_requests()
    again = [run(sim, 0.5).twists[0] for _ in range(10)]
    assert np.array_equal(blown, again)
    assert len({twist[1] for twist in blown}) == 10


@pytest.mark.parametrize('viscosity', [0.0, 1e-3, 1.0, 1e6])
@pytest.mark.parametrize('density', [0.0, 1e-3, 1.0, 1e6])
def test_a_medium_at_rest_never_gives_energy(report, viscosity, density):
    for number in range(4):
        chance = random.Random(number)
        sim = simulation(gravity=(0.0, 0.0), air_viscosity=viscosity, air_density=density)
        shape = chance.choice([Box(width=0.3, height=0.05), TRAPEZE, ELL, Disc(radius=0.1)])
        velocity = (chance.uniform(-20, 20), chance.uniform(-20, 20))
        spawn(sim, 'body/0', shape, velocity=velocity, spin=chance.uniform(-20, 20), mass=0.1)
        last = sim.world.snapshot().kinetic_energy
        begun = last
        for snapshot in steps(sim, 120):
            energy = snapshot.kinetic_energy
            report.check(
                71, 'energy gained in a step', max(energy - last, 0.0) / begun, 0.0, 1e-6, '-'
            )
            last = energy


def test_what_floats_in_wind_feels_water_below_and_wind_above(report):
    sim = simulation(air_density=1.0, wind=(10.0, 0.0))
    pool(sim, Box(width=2000.0, height=10.0), density=10.0)
    # Half its height is in the water: the drags of both are equal at v² 10 = (10 - v)².
    spawn(sim, 'raft/0', Box(width=4.0, height=0.4), mass=1.6 / 2 * (10.0 + 1.0))
    last = run(sim, 120.0)
    speed = 10.0 / (1.0 + math.sqrt(10.0))
    report.check(71, 'speed of a raft in the wind', last.twists[1, 0] / speed, 1.0, 0.02, '-')


def test_a_stack_on_a_raft_stays_on_it(report):
    sim = simulation()
    pool(sim, viscosity=50.0)
    spawn(sim, 'raft/0', Box(width=3.0, height=0.4), (0.0, 0.0, 0.0), density=300.0)
    for level in range(4):
        place = (0.0, 0.2 + 0.3 * (level + 0.5), 0.0)
        spawn(sim, f'box/{level}', Box(width=0.3, height=0.3), place, density=300.0)
    last = run(sim, 20.0)
    depth = (1.2 + 4 * 0.09) * 300.0 / 3.0 / WATER
    report.check(70, 'depth of a laden raft', 0.2 - last.poses[1, 1], depth, 1e-3 * depth, 'm')
    lean = last.poses[5, 0] - last.poses[1, 0]
    report.check(70, 'lean of a stack on a raft', lean, 0.0, 5e-3, 'm')


def test_a_floor_under_water_carries_what_sinks_by_its_weight_in_water(report):
    sim = simulation()
    floor(sim)
    pool(sim, pose=(0.0, 5.0, 0.0))
    spawn(sim, 'body/0', Box(width=0.5, height=0.5), (0.0, 0.25, 0.0), density=3 * WATER)
    sim.world.reports_contacts = True
    for _ in range(60):
        frame = sim.advance_frame()
    pressed = frame.contacts.impulses[:, 1].sum() / (frame.contacts.steps * DT)
    report.check(
        70, 'force of what lies on the ground', abs(pressed) / (500.0 * G), 1.0, 1e-3, '-'
    )
