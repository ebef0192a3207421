# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 65 and 66: ropes past rings and around wheels, and winches."""

import math

from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import G, join, NOWHERE, run, simulation, spawn, steps

BOX = Box(width=0.2, height=0.2)


def two_boxes(sim, masses, places):
    for number, (mass, place) in enumerate(zip(masses, places, strict=True)):
        spawn(sim, f'box/{number}', BOX, (*place, 0.0), mass=mass)


@pytest.mark.parametrize('wheel', [None, 0.02, 2.0, 10.0])
def test_atwoods_machine(report, wheel):
    # A rope over a ring, or a wheel of some mass, which turns with it: I / r² is half its mass.
    sim = simulation()
    two_boxes(sim, (2.0, 1.0), ((-0.5, 3.0), (0.5, 3.0)))
    points = [(-0.5, 3.0), (0.0, 5.0), (0.5, 3.0)]
    if wheel is None:
        points = [(-0.5, 3.0), (-0.5, 5.0), (0.5, 5.0), (0.5, 3.0)]
    else:
        spawn(sim, 'wheel/0', Disc(radius=0.5), (0.0, 5.0, 0.0), mass=wheel)
        join(sim, 'axle/0', 'axle', [(0.0, 5.0)], a='wheel/0', b='world')
    join(sim, 'rope/0', 'rope', points, a='box/0', b='box/1')

    last = run(sim, 0.5)

    heavy, light = last.scene.names.index('box/0'), last.scene.names.index('box/1')
    acceleration = G * (2.0 - 1.0) / (2.0 + 1.0 + (wheel or 0.0) / 2.0)
    way = acceleration / 8.0
    report.check(65, 'Atwood, way of either body', last.poses[light, 1] - 3.0, way, 3e-4, 'm')
    report.check(65, 'Atwood, way of either body', 3.0 - last.poses[heavy, 1], way, 3e-4, 'm')
    if wheel is not None:
        spin = last.twists[last.scene.names.index('wheel/0'), 2]
        report.check(65, 'Atwood, spin of its wheel', spin, acceleration, 5e-3, 'rad/s')


@pytest.mark.parametrize('side', [1.0, -1.0])
@pytest.mark.parametrize('first', [True, False], ids=['from the bob', 'to the bob'])
def test_a_rope_whose_end_swings_winds_and_unwinds_as_much_as_it_is_longer(report, first, side):
    sim, radius = simulation(), 0.5
    spawn(sim, 'wheel/0', Disc(radius=radius), anchored=True)
    bob = spawn(sim, 'bob/0', Disc(radius=0.1), (2.0 * side, -2.0, 0.0))
    spawn(sim, 'post/0', BOX, (-radius * side, -3.0, 0.0), anchored=True)
    points = [(2.0 * side, -2.0), (0.0, 0.0), (-radius * side, -3.0)]
    names, order = ('bob/0', 'post/0'), 1 if first else -1
    a, b = names[::order]
    join(sim, 'rope/0', 'rope', points[::order], a=a, b=b, over=('wheel/0',))

    lengths, angles = [], []
    for snapshot in steps(sim, 480):
        x, y = side * snapshot.poses[bob, 0], snapshot.poses[bob, 1]
        far = math.hypot(x, y)
        # Of the point at which the rope leaves the wheel, from the x axis on.
        angles.append(math.atan2(y, x) + math.acos(radius / far))
        lengths.append(math.sqrt(far**2 - radius**2) - radius * angles[-1])

    assert max(angles) - min(angles) > 1.0
    off = max(lengths) - min(lengths)
    report.check(65, 'rope whose end swings, length', off, 0.0, 1e-5, 'm')


@pytest.mark.parametrize('strands', [2, 3, 4])
@pytest.mark.parametrize('pull', [1.0, 1.2])
def test_a_block_and_tackle_lifts_by_the_number_of_its_strands(report, strands, pull):
    # The rope runs from a weight over the ceiling, to and fro between load and ceiling.
    sim = simulation()
    load = float(strands)
    spawn(sim, 'load/0', Box(width=1.0, height=0.2), (0.0, 0.0, 0.0), mass=load)
    spawn(sim, 'pull/0', BOX, (2.0, 2.0, 0.0), mass=pull)
    ends = [('load/0', (0.0, 0.1)), ('world', (0.0, 4.0))] * 2
    bodies, stops = zip(*ends[:strands], strict=True)
    points = [(2.0, 2.0), (2.0, 4.0), (0.0, 4.0), *stops]
    over = ('world', 'world', *bodies[:-1])
    join(sim, 'rope/0', 'rope', points, a='pull/0', b=bodies[-1], over=over)

    last = run(sim, 0.5)

    n = strands
    rise = G * (n * pull - load) / (load + n * n * pull)
    where = last.poses[0, 1], 2.0 - last.poses[1, 1]
    what = 'block and tackle'
    report.check(65, f'{what}, rise of the load', where[0], rise * 0.125, 3e-4, 'm')
    report.check(65, f'{what}, way of the rope', where[1], n * rise * 0.125, 6e-4, 'm')


def test_a_differential_pulley(report):
    # The rope leaves a wheel of R and comes back to one of r on the same axle: one turn lifts the
    # load by π (R - r).
    big, small, mass = 0.5, 0.4, 5.0
    sim = simulation()
    spawn(sim, 'wheel/0', Disc(radius=big), (0.0, 3.0, 0.0), mass=1.0)
    spawn(sim, 'wheel/1', Disc(radius=small), (0.0, 3.0, 0.0), mass=1.0)
    join(sim, 'motor/0', 'motor', [(0.0, 3.0)], a='wheel/0', b='world', rate=1.0)
    join(sim, 'pin/0', 'pin', [(0.0, 3.0)], a='wheel/0', b='wheel/1')
    middle = (small - big) / 2.0
    spawn(sim, 'load/0', Box(width=1.2, height=0.3), (middle, 0.0, 0.0), mass=mass)
    points = [(big, 3.0), (0.0, 3.0), (-big, 0.0), (small, 0.0), (0.0, 3.0), (-small, 3.0)]
    over = ['wheel/0', 'load/0', 'load/0', 'wheel/1']
    join(sim, 'rope/0', 'rope', points, a='wheel/0', b='wheel/1', over=over)

    films = [run(sim, 1.0), run(sim, 1.0)]

    speed = films[1].poses[2, 1] - films[0].poses[2, 1]
    report.check(65, 'differential pulley, speed of its load', abs(speed), 0.05, 5e-4, 'm/s')


def test_a_winch_winds_at_its_rate_and_its_work_is_that_of_the_load(report):
    sim = simulation()
    spawn(sim, 'box/0', BOX, (0.0, 0.0, 0.0), mass=2.0)
    join(
        sim, 'rope/0', 'rope', [(0.0, 0.0), (0.0, 5.0)], a='box/0', b='world', rate=-0.5, lower=3.5
    )

    for number, now in enumerate(steps(sim, 960), 1):
        if number in (240, 480):
            report.check(66, 'winch, speed', now.twists[0, 1], 0.5, 1e-6, 'm/s')
            # The length is a sub-step ahead of the box.
            report.check(66, 'winch, way', now.poses[0, 1], 0.5 * number / 240, 6e-4, 'm')
    report.check(66, 'winch, end of its way', now.poses[0, 1], 1.5, 3e-4, 'm')


@pytest.mark.parametrize(('force', 'speed'), [(15.0, 0.0), (25.0, 0.5)])
def test_a_weak_winch_stalls(report, force, speed):
    sim = simulation()
    spawn(sim, 'ground/0', Box(width=4.0, height=1.0), (0.0, -0.6, 0.0), anchored=True)
    spawn(sim, 'box/0', BOX, (0.0, 0.0, 0.0), mass=2.0)
    points = [(0.0, 0.0), (0.0, 5.0)]
    join(sim, 'rope/0', 'rope', points, a='box/0', b='world', rate=-0.5, max_force=force)

    last = run(sim, 2.0)

    report.check(
        66, 'winch of 15 and 25 N with 2 kg, speed', last.twists[1, 1], speed, 1e-3, 'm/s'
    )


def test_a_ball_that_a_winch_draws_in_keeps_its_angular_momentum(report):
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'ball/0', Disc(radius=0.1), (2.0, 0.0, 0.0), velocity=(0.0, 1.0))
    points = [(2.0, 0.0), (0.0, 0.0)]
    join(sim, 'rope/0', 'rope', points, a='ball/0', b='world', rate=-0.25, lower=1.0)

    last = run(sim, 5.0)

    (x, y, _), (vx, vy, _) = last.poses[0], last.twists[0]
    report.check(66, 'ball drawn in, radius', math.hypot(x, y), 1.0, 1e-3, 'm')
    report.check(66, 'ball drawn in, v r', x * vy - y * vx, 2.0, 2e-3, 'm²/s')
