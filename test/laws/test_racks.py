# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 74: a rack and its pinion."""

import math

from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import G, join, run, simulation, spawn, steps

RADIUS, PINION, RACK = 0.2, 3.0, 2.0


def lift(sim, angle=0.0):
    """Mesh a pinion on an axle with a rack that slides by its side; return the joint's points."""
    x, y = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
    spawn(sim, 'pinion/0', Disc(radius=RADIUS), mass=PINION)
    spawn(sim, 'rack/0', Box(width=0.1, height=4.0), (x, y, angle), mass=RACK)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='pinion/0', b='world')
    along = [(x, y), (x - math.sin(angle), y + math.cos(angle))]
    join(sim, 'slider/0', 'slider', along, a='rack/0', b='world')
    join(sim, 'rack/0', 'rack', [(0.0, 0.0), (x, y)], a='pinion/0', b='rack/0')


@pytest.mark.parametrize('angle', [0.0, math.pi, 0.7])
def test_a_rack_falls_with_the_inertia_of_its_pinion_and_turns_it(report, angle):
    sim = simulation()
    lift(sim, angle)
    early, late = run(sim, 0.5), run(sim, 0.5)
    down = -math.cos(angle)
    right = RACK * G * down / (RACK + PINION / 2.0)
    along = -math.sin(angle), math.cos(angle)
    speeds = [now.twists[1, :2] @ along for now in (early, late)]
    got = (speeds[1] - speeds[0]) / 0.5
    report.check(74, 'rack on a pinion, acceleration', got, right, 1e-6, 'm/s²')
    # The rim goes where the rack goes.
    rim = late.twists[0, 2] * RADIUS
    report.check(74, 'rack on a pinion, speed of the rim', rim, speeds[1], 1e-9, 'm/s')
    way = abs(late.poses[1, :2] @ along)
    turned = abs(late.poses[0, 2]) * RADIUS
    report.check(74, 'rack on a pinion, way', turned, way, 1e-6, 'm')


@pytest.mark.parametrize('slope', [-0.3, 0.2])
def test_a_carriage_rolls_down_a_rack_on_its_pinion(report, slope):
    cos, sin = math.cos(slope), math.sin(slope)
    sim = simulation()
    x, y = -RADIUS * sin, RADIUS * cos
    spawn(sim, 'pinion/0', Disc(radius=RADIUS), (x, y, 0.0), mass=PINION)
    spawn(sim, 'carriage/0', Box(width=1.0, height=0.1), (x, y, slope), mass=RACK)
    rail = [(x, y), (x + cos, y + sin)]
    join(sim, 'slider/0', 'slider', rail, a='carriage/0', b='world')
    join(sim, 'axle/0', 'axle', [(x, y)], a='pinion/0', b='carriage/0')
    join(sim, 'rack/0', 'rack', [(x, y), (0.0, 0.0)], a='pinion/0', b='world')
    early, late = (run(sim, 0.5).twists[0, :2] @ (cos, sin) for _ in range(2))
    mass = PINION + RACK
    right = -mass * G * sin / (mass + PINION / 2.0)
    report.check(74, 'carriage on a rack, acceleration', (late - early) / 0.5, right, 1e-6, 'm/s²')


def test_a_motor_lifts_a_rack(report):
    sim = simulation()
    lift(sim)
    join(sim, 'axle/0', 'motor', [(0.0, 0.0)], a='pinion/0', b='world', rate=2.0)
    for now in list(steps(sim, 240))[10:]:
        speed = now.twists[1, 1]
        report.check(74, 'rack that a motor lifts, speed', speed, 2.0 * RADIUS, 1e-9, 'm/s')
