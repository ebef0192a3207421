# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A ball on a drawn track loses what the corners of the track take, and no more.

At a corner of an angle d, a ball without elasticity keeps cos d of its speed. On a track whose
corners are closer than the ball's way in a step, the steps are the corners. Law 6: what bounces on
a smooth straight track keeps its velocity along it.
"""

import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Disc
import pytest

from .scenes import DT, energy, G, NOWHERE, simulation, spawn, steps

RADIUS = 2.0
BALL = 0.1
THICKNESS = 0.02
# Of the way of the ball's centre.
WAY = RADIUS - BALL - THICKNESS / 2


def track(count, turns=1.0):
    """Return a chain around (0, 2) from its lowest point on, counter-clockwise."""
    angles = np.linspace(0.0, 2 * math.pi * turns, count + 1)
    around = np.column_stack((np.sin(angles), 1.0 - np.cos(angles))) * RADIUS
    if turns == 1.0:
        around[-1] = around[0]
    return Chain(points=tuple(map(tuple, around.tolist())), thickness=THICKNESS)


def ball_in_track(count, speed, turns=1.0, **settings):
    """Return a world with a ball at the lowest point of a track, and the ball's row."""
    sim = simulation(friction=0.0, elasticity=0.0, **settings)
    spawn(sim, 'track/0', track(count, turns), anchored=True)
    place = (0.0, RADIUS - WAY, 0.0)
    return sim, spawn(sim, 'ball/0', Disc(radius=BALL), place, velocity=(speed, 0.0))


@pytest.mark.parametrize('count', [60, 200, 900])
def test_a_ball_runs_around_in_a_closed_track(report, count):
    sim, ball = ball_in_track(count, speed := 3.0, gravity=NOWHERE)
    turns, way = 1.0, 0.0
    for snapshot in steps(sim, math.ceil(turns * 2 * math.pi * WAY / speed / DT)):
        way += math.hypot(*snapshot.twists[ball, :2]) * DT
        off = WAY - math.hypot(snapshot.poses[ball, 0], snapshot.poses[ball, 1] - RADIUS)
        assert -0.006 < off < 0.01
    around = way / (2 * math.pi * WAY)
    angle = max(2 * math.pi / count, speed * DT / WAY)
    kept = math.cos(angle) ** (2 * math.pi * around / angle)
    measured = math.hypot(*snapshot.twists[ball, :2]) / speed
    report.check(28, 'speed after a turn in a track', measured, kept, 0.02, '–',
                 relative=True)  # fmt: skip


@pytest.mark.parametrize(('share', 'passes'), [(2.3, False), (2.8, True)])
def test_a_ball_passes_a_loop_that_it_has_the_energy_for(share, passes):
    sim, ball = ball_in_track(400, math.sqrt(2 * G * share * WAY), turns=0.98)
    before = energy(sim.world.snapshot())
    highest = 0.0
    for snapshot in steps(sim, 400):
        x, y, _ = snapshot.poses[ball]
        highest = max(highest, y if abs(x) < 0.1 else 0.0)
        if x < 0.0 and y < RADIUS:
            break
    assert (highest > RADIUS + 0.99 * WAY) == passes
    if passes:
        assert energy(snapshot) > 0.95 * before


@pytest.mark.parametrize('elasticity', [0.8, 1.0])
def test_boxes_that_bounce_on_a_smooth_straight_track_keep_their_velocity(report, elasticity):
    rng = random.Random(1)
    sim = simulation(friction=0.0, elasticity=elasticity)
    points = tuple((0.37 * number - 185.0, 0.0) for number in range(1000))
    spawn(sim, 'track/0', Chain(points=points, thickness=0.3), anchored=True)
    speeds, rows = [], []
    for number in range(60):
        speeds.append(rng.uniform(-12.0, 12.0))
        pose = (5.0 * number - 150.0, rng.uniform(0.8, 1.5), rng.uniform(0.0, 6.0))
        velocity = speeds[-1], -rng.uniform(0.0, 20.0)
        box = Box(width=0.6, height=rng.choice((0.1, 0.3, 0.6)))
        rows.append(spawn(sim, f'box/{number}', box, pose, velocity=velocity, group=1))

    changed = max(
        np.abs(snapshot.twists[rows, 0] - speeds).max() for snapshot in steps(sim, round(1.0 / DT))
    )

    report.check(6, 'boxes on a smooth track, change along it', changed, 0.0, 1e-9, 'm/s')
