# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies slide over seams as over one face, and are stopped by steps."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
import pytest

from ...laws.scenes import G, run, simulation, spawn, steps, turned

BOX = Box(width=0.3, height=0.3)
DISC = Disc(radius=0.15)


def tiled_floor(angle=0.0, step=0.0, **settings):
    """
    Return a world with a floor of tiles from the origin on, and gravity normal to it.

    :param angle: of the floor [rad]
    :param step: by which the tiles from 2 m on are higher [m]
    """
    gravity = tuple(turned((0.0, -G), angle))
    sim = simulation(**{'friction': 0.0, 'gravity': gravity, **settings})
    for number in range(16):
        along = 0.5 * number
        place = turned((along, -0.25 + step * (along >= 2.0)), angle)
        spawn(sim, f'tile/{number}', Box(width=0.5, height=0.5), (*place, angle), anchored=True)
    return sim


@pytest.mark.parametrize('elasticity', [0.0, 0.3])
@pytest.mark.parametrize('shape', [BOX, DISC], ids=repr)
# From 0, at 0.3 and 3 m/s, a step ends where the box's face lies exactly in the plane of a seam.
@pytest.mark.parametrize('begin', [0.0, 0.1237])
@pytest.mark.parametrize('speed', [0.3, 3.0, 8.0])
@pytest.mark.parametrize('angle', [0.0, 0.4])
def test_a_body_slides_over_a_seam(shape, elasticity, speed, begin, angle):
    sim = tiled_floor(angle, elasticity=elasticity)
    place, velocity = turned((begin, 0.15), angle), turned((speed, 0.0), angle)
    row = spawn(sim, 'body/0', shape, (*place, angle), velocity=tuple(velocity))
    for snapshot in steps(sim, int(240 * min(6.0 / speed, 2.5))):
        assert turned(snapshot.poses[row, :2], -angle)[1] == pytest.approx(0.15, abs=3e-4)
    along, up = turned(snapshot.twists[row, :2], -angle) / speed
    assert along == pytest.approx(1.0, abs=0.01)
    assert up == pytest.approx(0.0, abs=0.02)
    assert snapshot.twists[row, 2] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize('elasticity', [0.0, 0.6])
@pytest.mark.parametrize('depth', [0.0, 0.5e-3, 4.5e-3])
@pytest.mark.parametrize('speed', [0.05, 0.1, 0.5, 3.0])
def test_a_disc_rolls_over_a_seam(speed, depth, elasticity):
    sim = tiled_floor(elasticity=elasticity, friction=0.5)
    spin, height = -speed / DISC.radius, DISC.radius - depth
    row = spawn(sim, 'disc/0', DISC, (0.2, height, 0.0), velocity=(speed, 0.0), spin=spin)
    for snapshot in steps(sim, int(240 * min(0.6 / speed, 4.0))):
        assert snapshot.poses[row, 1] == pytest.approx(height, abs=2e-4)
    assert snapshot.twists[row, 0] == pytest.approx(speed, rel=0.01)


@pytest.mark.parametrize('step', [0.02, 0.1])
@pytest.mark.parametrize('speed', [0.3, 3.0])
def test_a_box_is_stopped_by_a_step(step, speed):
    sim = tiled_floor(step=step, elasticity=0.0)
    row = spawn(sim, 'box/0', BOX, (1.0, 0.15, 0.0), velocity=(speed, 0.0))
    stopped = run(sim, 0.65 / speed)
    assert stopped.twists[row, 0] < 0.5 * speed
    assert stopped.poses[row, 0] + 0.15 < 1.8


@pytest.mark.parametrize('beside', [-0.03, -0.015, -0.002, 0.0, 0.002, 0.015, 0.03])
def test_a_disc_that_falls_beside_a_seam_bounces_as_from_one_box(beside):
    def fall(width, count):
        sim = simulation(friction=0.5, elasticity=0.8)
        for number in range(count):
            at = ((number - (count - 1) / 2) * width, -0.25, 0.0)
            spawn(sim, f'tile/{number}', Box(width=width, height=0.5), at, anchored=True)
        said = {'velocity': (1.0, -5.0), 'spin': 20.0}
        row = spawn(sim, 'disc/0', DISC, (beside - 0.1, 0.65, 0.0), **said)
        return run(sim, 0.3).twists[row]

    assert fall(0.5, 2) == pytest.approx(fall(1.0, 1), abs=1e-9)


def test_a_ball_that_falls_on_a_corner_bounces_from_the_corner():
    sim = simulation(gravity=(0.0, 0.0), elasticity=1.0, friction=0.0)
    spawn(sim, 'tile/0', Box(width=0.5, height=0.5), (0.25, -0.25, 0.0), anchored=True)
    # Its centre is a little outside, so that it is behind the top by less than the slop.
    normal, velocity = np.array((-math.sin(0.08), math.cos(0.08))), np.array((3.0, -3.0))
    start = DISC.radius * normal - 0.1 * velocity
    row = spawn(sim, 'disc/0', DISC, (*start, 0.0), velocity=tuple(velocity))
    (*_, last) = steps(sim, 60)

    wanted = velocity - 2.0 * (velocity @ normal) * normal
    assert last.twists[row, :2] == pytest.approx(wanted, abs=1e-6)


def test_a_ball_rolls_in_a_bowl_of_pieces_as_in_one_of_segments():
    angles = np.linspace(-math.pi / 2, math.pi / 2, 100)
    around = np.column_stack((np.sin(angles), -np.cos(angles)))
    inner, outer = (tuple(map(tuple, (around * radius).tolist())) for radius in (2.0, 2.2))
    heights = []
    for bowl in (Polygon(outline=inner + outer[::-1]), Chain(points=inner, thickness=0.001)):
        sim = simulation(friction=0.0, elasticity=0.0)
        spawn(sim, 'bowl/0', bowl, anchored=True)
        way = 2.0 - 0.15
        ball = spawn(sim, 'ball/0', DISC, (-way * math.sin(1.0), -way * math.cos(1.0), 0.0))
        run(sim, 1.0)
        lowest = -way
        highest = max(snapshot.poses[ball, 1] for snapshot in steps(sim, 480))
        heights.append((highest - lowest) / (way - way * math.cos(1.0)))
    assert heights[0] == pytest.approx(heights[1], rel=0.05)
    assert heights[0] > 0.9
