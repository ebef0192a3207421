# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 14 to 17, 20, 22 and 23, and beams: what hangs together by joints."""

import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import (
    angular_momentum,
    DT,
    energy,
    floor,
    G,
    hanging_chain,
    join,
    NOWHERE,
    run,
    simulation,
    spawn,
    steps,
)

AXLE = (0.0, 0.0)


def crossings(times, values):
    """Return when values fall through zero, between the steps."""
    values = np.array(values)
    falls = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    share = values[falls] / (values[falls] - values[falls + 1])
    return np.array(times)[falls] + share * DT


def pendulum(angle, radius=0.1):
    """Hang a disc on an axle 1 m above it, swung by an angle; return the simulation."""
    sim = simulation()
    spawn(sim, 'bob/0', Disc(radius=radius), (math.sin(angle), -math.cos(angle), 0.0))
    join(sim, 'joint/0', 'axle', [AXLE], a='bob/0', b='world')
    return sim


@pytest.mark.parametrize('degrees', [10, 90, 150])
def test_a_pendulum_has_its_period(report, degrees):
    angle, radius = math.radians(degrees), 0.1
    sim = pendulum(angle, radius)

    seen = list(steps(sim, 2400))

    falls = crossings([each.step * DT for each in seen], [each.poses[0, 0] for each in seen])
    # https://en.wikipedia.org/wiki/Pendulum_(mechanics)#Arithmetic-geometric_mean_solution
    one, other = 1.0, math.cos(angle / 2)
    while abs(one - other) > 1e-15:
        one, other = (one + other) / 2, math.sqrt(one * other)
    exact = 2 * math.pi * math.sqrt((1.0 + radius**2 / 2) / G) / one
    measured = float(np.diff(falls).mean())
    what = f'pendulum at {degrees} degrees, period'
    report.check(14, what, measured, exact, 1e-4, 's', relative=True)


def test_a_pendulum_keeps_its_energy(report):
    sim = pendulum(math.pi / 2)
    before = sim.world.snapshot()
    deepest = float(before.scene.inertia[0, 0]) * G

    for now in steps(sim, 2400):
        lost = (energy(now) - energy(before)) / deepest
        report.check(15, 'pendulum at 90 degrees for 10 s, energy', lost, 0.0, 0.01, '–')
        gap = float(np.hypot(*(now.ends[0, 0] - now.ends[0, 1])))
        report.check(15, 'the same, play of the axle', gap, 0.0, 1e-3, 'm')


def pendulum_on_box(kind):
    """Hang a ball, level, on a box that stands on the floor; the last row is that of the ball."""
    sim = simulation()
    floor(sim, friction=1.0)
    box = Box(width=2.0, height=3.0)
    spawn(sim, 'box/0', box, (0.0, 1.5, 0.0), mass=100.0, friction=1.0, group=1)
    spawn(sim, 'bob/0', Disc(radius=0.1), (1.0, 2.9, 0.0), mass=1.0, group=1)
    points = [(0.0, 2.9)] if kind == 'axle' else [(1.0, 2.9), (0.0, 2.9)]
    join(sim, 'joint/0', kind, points, a='bob/0', b='box/0')
    return sim


@pytest.mark.parametrize('kind', ['axle', 'rod', 'rope'])
def test_a_pendulum_on_a_box_that_stands_on_the_floor_keeps_its_energy(report, kind):
    sim = pendulum_on_box(kind)
    before = energy(sim.world.snapshot())

    seen = [(abs(now.poses[-1, 0]), energy(now)) for now in steps(sim, 240 * 20)]

    _, last = max(seen[-480:])
    what = f'pendulum by a(n) {kind}, on a box, level for 20 s, energy'
    report.check(15, what, (last - before) / G, 0.0, 0.005, '–')


def bars_in_space(kind):
    """Return two bars that turn against each other, joined."""
    sim = simulation(gravity=NOWHERE)
    for number, sign in enumerate((1.0, -1.0)):
        place, velocity = (1.2 * number, 0.0, 0.0), (0.0, 3.0 * number - 1.0)
        box, name = Box(width=1.0, height=0.2), f'bar/{number}'
        spawn(sim, name, box, place, velocity=velocity, spin=2.0 * sign, group=1)
    points = [(0.6, 0.0)] if kind == 'axle' else [(0.9, 0.05), (0.3, -0.05)]
    join(sim, 'joint/0', kind, points, a='bar/1', b='bar/0')
    return sim


@pytest.mark.parametrize('kind', ['axle', 'rod', 'rope', 'slider'])
def test_two_bodies_that_are_joined_in_space_keep_energy_and_angular_momentum(report, kind):
    seen = list(steps(bars_in_space(kind), 240 * 30))

    # The joint takes what it does not allow in its first step.
    first, last = seen[0], seen[-1]
    lost = (energy(last) - energy(first)) / energy(first)
    report.check(15, f'two bars by a(n) {kind} in space for 30 s, energy', lost, 0.0, 1e-3, '–')
    turned = angular_momentum(last) / angular_momentum(first)
    what = f'two bars by a(n) {kind} in space for 30 s, angular momentum'
    report.check(15, what, turned, 1.0, 1e-4, '–')


def test_a_mass_on_a_spring_swings(report):
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'mass/0', Box(width=0.2, height=0.2), (1.5, 0.0, 0.0), mass=2.0)
    said = {'a': 'mass/0', 'b': 'world', 'stiffness': 40.0, 'rest_length': 1.0}
    join(sim, 'joint/0', 'spring', [(1.5, 0.0), (0.0, 0.0)], **said)
    before = energy(sim.world.snapshot())

    seen = list(steps(sim, 2400))

    falls = crossings([each.step * DT for each in seen], [each.poses[0, 0] - 1 for each in seen])
    exact = 2 * math.pi * math.sqrt(2.0 / 40.0)
    measured = float(np.diff(falls).mean())
    report.check(16, 'mass on a spring, period', measured, exact, 0.001, 's', relative=True)
    for each in seen:
        off = energy(each) / before
        report.check(16, 'mass on a spring for 10 s, energy kept', off, 1.0, 0.02, '–')


def speeds_after_cradle(swung, gap):
    """
    Let balls of a cradle of five come down from 30 degrees.

    :return: (5,) float64: the velocity of each after the impact, as a share of that before it
    """
    sim, radius, angle = simulation(), 0.1, math.radians(30)
    for number in range(5):
        x, turn = number * (2 * radius + gap), angle if number < swung else 0.0
        place = (x - math.sin(turn), -math.cos(turn), 0.0)
        spawn(sim, f'ball/{number}', Disc(radius=radius), place, elasticity=1.0, friction=0.0)
        join(sim, f'joint/{number}', 'axle', [(x, 0.0)], a=f'ball/{number}', b='world')
    # The last ball comes down after a quarter of a period, and all has been handed on 5 steps on.
    *_, last = steps(sim, 129)
    return last.twists[:, 0] / np.sqrt(2 * G * (1 - math.cos(angle)) / (1 + radius**2 / 2))


@pytest.mark.parametrize('swung', [1, 2, 3, 4])
@pytest.mark.parametrize('gap', [0.0, 0.002])
def test_as_many_balls_leave_the_cradle_as_came(report, swung, gap):
    for number, vx in enumerate(speeds_after_cradle(swung, gap)):
        exact = 1.0 if number >= 5 - swung else 0.0
        what = f'cradle, {swung} swung, {1000 * gap:g} mm apart, speed'
        report.check(17, what, vx, exact, 0.02, 'v')


def balls_on_rods(speed):
    """Return three balls that hang in a row between walls, of which one comes at a speed."""
    material = {'elasticity': 1.0, 'friction': 0.0}
    sim = simulation(gravity=(0.0, 0.0), bounds=(-4.0, 0.4, 4.0, 5.0), **material)
    for number in range(3):
        x, vx = 0.606 * number, speed if number == 0 else 0.0
        spawn(sim, f'ball/{number}', Disc(radius=0.3), (x, 1.4, 0.0), velocity=(vx, 0.0))
        points = [(x, 1.4), (x, 4.4)]
        join(sim, f'joint/{number}', 'rod', points, a=f'ball/{number}', b='world')
    return sim


@pytest.mark.parametrize('speed', [30.0, 400.0])
def test_balls_on_rods_between_elastic_walls_gain_no_energy(report, speed):
    sim = balls_on_rods(speed)
    before = energy(sim.world.snapshot())

    most = max(energy(each) for each in steps(sim, 480))

    gained = max(most / before - 1.0, 0.0)
    report.check(17, 'balls on rods between walls, gained in 2 s', gained, 0.0, 1e-3, '–')


def test_a_chain_does_not_stretch(report):
    for now in steps(hanging_chain(50), 1200):
        gaps = now.ends[:, 0] - now.ends[:, 1]
        stretch = float(np.hypot(gaps[:, 0], gaps[:, 1]).sum()) / 10.0
        report.check(20, 'chain of 50 axles, swung, stretch', stretch, 0.0, 0.05, '–')


def beam(load):
    """Return five boxes that are pinned to each other and a wall, with a load at the end [kg]."""
    sim = simulation()
    for number in range(5):
        spawn(sim, f'box/{number}', Box(width=1.0, height=0.2), (number + 0.5, 0.0, 0.0))
        other = f'box/{number - 1}' if number else 'world'
        join(sim, f'joint/{number}', 'pin', [(number, 0.0)], a=f'box/{number}', b=other)
    if load:
        spawn(sim, 'load/0', Box(width=0.5, height=0.5), (4.5, 0.35, 0.0), mass=load)
    return sim


@pytest.mark.parametrize('load', [0.0, 2.0])
def test_a_beam_of_pinned_boxes_does_not_sag(report, load):
    for now in steps(beam(load), 1200):
        x, y, yaw = now.poses[4]
        tip = (x + 0.5 * math.cos(yaw), y + 0.5 * math.sin(yaw))
        sag = math.dist(tip, (5.0, 0.0)) / 5.0
        report.check(20, 'beam of 5 pinned boxes, sag', sag, 0.0, 0.01, '–')


def test_a_motor_turns_at_its_rate(report):
    sim = simulation()
    spawn(sim, 'wheel/0', Disc(radius=0.5))
    join(sim, 'joint/0', 'motor', [AXLE], a='wheel/0', b='world', rate=2.0, max_torque=100.0)

    last = run(sim, 2.0)

    report.check(22, 'motor at 2 rad/s', last.twists[0, 2], 2.0, 1e-9, 'rad/s')


def test_a_motor_turns_its_load_by_its_torque_until_it_has_its_rate(report):
    sim = simulation(gravity=(0.0, 0.0))
    # Its moment of inertia is 1 kg m².
    spawn(sim, 'wheel/0', Disc(radius=0.5), mass=8.0)
    said = {'rate': 2.0, 'max_torque': 4.0}
    join(sim, 'motor/0', 'motor', [(0.0, 0.0)], a='wheel/0', b='world', **said)

    for number, now in enumerate(steps(sim, 480), 1):
        spin = min(4.0 * number * DT, 2.0)
        report.check(22, 'motor that starts, speed', now.twists[0, 2], spin, 1e-9, 'rad/s')


def test_a_motor_turns_the_other_wheel_of_a_gear(report):
    spins = []
    for order in (1, -1):
        sim = simulation(gravity=(0.0, 0.0))
        spawn(sim, 'wheel/0', Disc(radius=0.2), (-0.2, 0.0, 0.0))
        spawn(sim, 'wheel/1', Disc(radius=0.4), (0.4, 0.0, 0.0))
        joints = [
            ('joint/0', 'motor', [(-0.2, 0.0)], {'a': 'wheel/0', 'b': 'world', 'rate': 3.0}),
            ('joint/1', 'axle', [(0.4, 0.0)], {'a': 'wheel/1', 'b': 'world'}),
            ('joint/2', 'gear', [AXLE], {'a': 'wheel/0', 'b': 'wheel/1', 'ratio': -2.0}),
        ]
        for name, kind, points, said in joints[::order]:
            join(sim, name, kind, points, **said)
        spins.append(run(sim, 1.0).twists[1, 2])
    report.check(22, 'motor with a gear, speed of the other', spins[0], -1.5, 1e-9, 'rad/s')
    report.check(22, 'the same, joints in another order', spins[1], spins[0], 1e-12, 'rad/s')


def arm_on_motor(max_torque):
    """Return an arm that a motor turns: 1 kg, half a metre out, needs 4.9 N m to be level."""
    sim = simulation()
    spawn(sim, 'arm/0', Box(width=1.0, height=0.1), (0.0, -0.5, -math.pi / 2), mass=1.0)
    said = {'rate': 2.0, 'max_torque': max_torque}
    join(sim, 'joint/0', 'motor', [AXLE], a='arm/0', b='world', **said)
    return sim


def test_a_weak_motor_stalls(report):
    highest = max(now.poses[0, 1] for now in steps(arm_on_motor(1.0), 2400))

    level = max(highest, -0.3)
    report.check(22, 'motor with a fifth of the torque, height', level, -0.3, 0.1, 'm')


def test_a_driven_slider_starts_by_its_force_and_goes_at_its_rate_to_its_limit(report):
    sim = simulation()
    spawn(sim, 'lift/0', Box(width=0.4, height=0.4), (0.0, 0.0, 0.0), mass=2.0)
    said = {'rate': 0.5, 'max_force': 2.0 * (G + 1.0), 'upper': 0.8}
    join(sim, 'lift/0', 'slider', [(0.0, 0.0), (0.0, 1.0)], a='lift/0', b='world', **said)
    for number, now in enumerate(steps(sim, 360), 1):
        # As it starts, the half-step lead of its free fall is a sub-step late.
        within = G * DT / 4 if number < 125 else 1e-9
        speed = min(number * DT, 0.5)
        report.check(22, 'driven slider, speed', now.twists[0, 1], speed, within, 'm/s')
    last = run(sim, 1.0)
    report.check(22, 'driven slider, at its limit', last.poses[0, 1], 0.8, 2e-4, 'm')


def gears(ratio):
    """Return two wheels of a gear, the second of which a motor turns."""
    sim = simulation()
    spawn(sim, 'wheel/0', Disc(radius=0.2), (-0.2, 0.0, 0.0))
    spawn(sim, 'wheel/1', Disc(radius=0.4), (0.4, 0.0, 0.0))
    join(sim, 'joint/0', 'axle', [(-0.2, 0.0)], a='wheel/0', b='world')
    join(sim, 'joint/1', 'motor', [(0.4, 0.0)], a='wheel/1', b='world', rate=3.0)
    join(sim, 'joint/2', 'gear', [AXLE], a='wheel/0', b='wheel/1', ratio=ratio)
    return sim


@pytest.mark.parametrize('ratio', [2.0, -2.0, 0.5])
def test_gears_keep_their_ratio(report, ratio):
    last = run(gears(ratio), 5.0)

    turned = last.poses[0, 2] / last.poses[1, 2]
    report.check(23, 'gears, ratio', turned, ratio, 0.01, '–', relative=True)


@pytest.mark.parametrize('way', [1.0, -1.0])
def test_a_pendulum_with_a_ratchet_stays_where_it_has_risen_to(report, way):
    # One rises to the other side, as high as it was; one that would fall the other way is held.
    sim = simulation()
    for name, x, side in (('arm/0', 0.0, way), ('arm/1', 3.0, -way)):
        yaw = -math.pi / 2 - side * math.pi / 3
        pose = (x + 0.5 * math.cos(yaw), 0.5 * math.sin(yaw), yaw)
        spawn(sim, name, Box(width=1.0, height=0.1), pose)
        join(sim, f'axle:{name}', 'axle', [(x, 0.0)], a=name, b='world', ratchet=way)

    last = run(sim, 5.0)

    risen = last.poses[0, 2] + math.pi / 2
    report.check(23, 'pendulum with a ratchet, angle', risen, way * math.pi / 3, 1e-4, 'rad')
    report.check(23, 'the same, spin', last.twists[0, 2], 0.0, 1e-9, 'rad/s')
    held = last.poses[1, 2] + math.pi / 2
    # It falls in the first sub-step alone.
    report.check(23, 'pendulum that a ratchet holds', held, way * math.pi / 3, 1e-5, 'rad')


def planetary(sim, **said):
    """Add a sun and a planet of 0.2 m on an arm, which the joint `motor/0` turns."""
    spawn(sim, 'sun/0', Disc(radius=0.2), mass=2.0, group=1)
    spawn(sim, 'arm/0', Box(width=1.0, height=0.1), mass=3.0, group=1)
    spawn(sim, 'planet/0', Disc(radius=0.2), (0.4, 0.0, 0.0), mass=1.0, group=1)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='sun/0', b='world')
    join(sim, 'motor/0', 'motor', [(0.0, 0.0)], a='arm/0', b='world', **said)
    join(sim, 'axle/1', 'axle', [(0.4, 0.0)], a='planet/0', b='arm/0')
    gear = {'a': 'planet/0', 'b': 'sun/0', 'ratio': -1.0}
    join(sim, 'gear/0', 'gear', [(0.2, 0.0)], **gear, carrier='arm/0')


def test_a_planet_turns_about_its_carrier(report):
    # Willis: (w_planet - w_arm) = -(w_sun - w_arm).
    sim = simulation(gravity=(0.0, 0.0))
    planetary(sim, rate=1.0)
    sim.perform(ChangeBody(name='sun/0', properties=Properties(anchored=True)))

    last = run(sim, 2.0)

    report.check(23, 'planet around a sun that rests, spin', last.twists[2, 2], 2.0, 1e-9, 'rad/s')
    report.check(23, 'the same, angle', last.poses[2, 2], 4.0, 5e-3, 'rad')


def test_a_gear_whose_carrier_alone_is_dynamic_turns_it(report):
    sim = simulation(gravity=(0.0, 0.0))
    for name in ('sun/0', 'ring/0'):
        spawn(sim, name, Disc(radius=0.5), kinematic=True, spin=1.0)
    arm = spawn(sim, 'arm/0', Box(width=1.0, height=1.0))
    gear = {'a': 'sun/0', 'b': 'ring/0', 'ratio': -1.0, 'carrier': 'arm/0'}
    join(sim, 'gear/0', 'gear', [(0.0, 0.0)], **gear)

    # Willis: ring and sun turn alike as seen from the arm, one against the other.
    spin = run(sim, 0.05).twists[arm, 2]
    report.check(23, 'carrier of wheels that turn alike, spin', spin, 1.0, 1e-6, 'rad/s')


def test_a_planetary_gear_shares_its_torque(report):
    # Sun, arm and planet turn by w, c and 2 c - w. The motor loads c alone, so that Lagrange has
    # I_s w' = I_p (2 c' - w') and (I_a + m d²) c' + 2 I_p (2 c' - w') = T.
    sim = simulation(gravity=(0.0, 0.0))
    planetary(sim, rate=100.0, max_torque=1.0)
    sun, planet, arm = 2.0 * 0.04 / 2, 1.0 * 0.04 / 2, 3.0 * (1.0 + 0.01) / 12 + 0.4**2

    last = run(sim, 0.5)

    # w' = 2 c' I_p / (I_s + I_p)
    shared = sun * planet / (sun + planet)
    spin = 0.5 / (arm + 4.0 * shared)
    report.check(23, 'planetary gear with a torque, arm', last.twists[1, 2], spin, 1e-6, 'rad/s')
    turned = 2.0 * spin * planet / (sun + planet)
    report.check(23, 'the same, sun', last.twists[0, 2], turned, 1e-6, 'rad/s')


def slider():
    """Return a block that flies along a slider between two limits."""
    sim = simulation()
    spawn(sim, 'block/0', Box(width=0.4, height=0.4), (0.0, 3.0, 0.3), velocity=(4.0, 4.0))
    points = [(0.0, 3.0), (1.0, 4.0)]
    join(sim, 'joint/0', 'slider', points, a='block/0', b='world', lower=-0.5, upper=0.25)
    return sim


def test_a_slider_stays_between_its_limits(report):
    reached = []
    for now in steps(slider(), 480):
        along, across = np.array([[1, 1], [-1, 1]]) @ (now.poses[0, :2] - (0, 3)) / math.sqrt(2)
        beyond = max(along - 0.25, -0.5 - along, 0.0)
        report.check(23, 'slider, beyond its limits', beyond, 0.0, 0.005, 'm')
        report.check(23, 'slider, beside its line', across, 0.0, 0.005, 'm')
        report.check(23, 'slider, turned', now.poses[0, 2], 0.3, 0.005, 'rad')
        reached.append(along)
    report.check(23, 'slider, upper limit reached', max(reached), 0.25, 0.005, 'm')
    report.check(23, 'slider, lower limit reached', min(reached), -0.5, 0.005, 'm')


@pytest.mark.parametrize(('limit', 'side'), [({'lower': -0.5}, 1.0), ({'upper': 0.5}, -1.0)])
def test_a_slider_with_one_limit_is_free_the_other_way_and_held_by_it(report, limit, side):
    sim = simulation(gravity=(-2.0 * side, 0.0))
    sim.reports_contacts = True
    box = Box(width=0.4, height=0.4)
    spawn(sim, 'block/0', box, (0.0, 0.0, 0.3), velocity=(6.0 * side, 0.0), mass=3.0)
    points = [(0.0, 0.0), (1.0, 0.0)]
    join(sim, 'joint/0', 'slider', points, a='block/0', b='world', **limit)

    # 9 m away and back to the limit.
    top = run(sim, 3.0).poses[0, 0]
    last = run(sim, 5.0)

    report.check(23, 'slider with one limit, farthest', top, 9.0 * side, 1e-9, 'm')
    report.check(23, 'the same, back at its limit', last.poses[0, 0], -0.5 * side, 2e-4, 'm')
    pull, weight = last.pulls[0, 0], -6.0 * side
    report.check(23, 'the same, force of the limit', pull, weight, 0.01, 'N', relative=True)


def test_a_rope_is_slack_and_then_taut(report):
    sim = simulation()
    spawn(sim, 'ball/0', Disc(radius=0.1), (0.0, 0.0, 0.0))
    join(sim, 'joint/0', 'rope', [(0.0, 0.0), (0.0, 1.0)], a='ball/0', b='world', length=2.0)

    for now in steps(sim, 480):
        t = now.step * DT
        if G * t * t / 2 < 0.99:
            fallen = -now.poses[0, 1]
            report.check(23, 'slack rope, fall', fallen, G * t * t / 2, 1e-9, 'm')
        else:
            long = max(1.0 - now.poses[0, 1] - 2.0, 0.0)
            report.check(23, 'taut rope, longer by', long, 0.0, 0.005, 'm')
    weight = G * float(now.scene.inertia[0, 0])
    report.check(23, 'taut rope, force', now.forces[0], weight, 0.01, 'N', relative=True)
