# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""No body ever ends up inside another or outside closed walls, however fast it is."""

import math

import numpy as np
from physsim_ros.engine.core import lib
from physsim_ros.engine.pymunk_bodies import build_body
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.model.requests import Configure, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
from physsim_ros.simulation.world import World
import pymunk
import pytest

from ...laws.scenes import (
    DT,
    energy,
    floor,
    G,
    NOWHERE,
    run,
    simulation,
    spawn,
    steps,
    turned,
    walls,
)
from ...slow import slow

ELL = Polygon(outline=((0.0, 0.0), (0.5, 0.0), (0.5, 0.1), (0.1, 0.1), (0.1, 0.5), (0.0, 0.5)))
SHAPES = {
    'disc': Disc(radius=0.1),
    'speck': Disc(radius=0.005),
    'box': Box(width=0.2, height=0.3),
    'rod': Box(width=1.5, height=0.04),
    'triangle': Polygon(outline=((-0.2, 0.0), (0.2, 0.0), (0.0, 0.1))),
    'ell': ELL,
    'dumbbell': Compound(element=Disc(radius=0.08), centers=((-0.3, 0.0), (0.3, 0.0))),
    'chain': Chain(points=((-0.4, 0.0), (0.0, 0.2), (0.4, 0.0)), thickness=0.03),
}
WALLS = {
    'box': Box(width=0.1, height=60.0),
    'chain of 1 mm': Chain(points=((0.0, -30.0), (0.0, 0.05), (0.0, 30.0)), thickness=0.001),
}
each_shape = pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())


class Overlaps:
    """Measures with shapes of its own how deep bodies lie in each other."""

    def __init__(self, scene):
        self._space = pymunk.Space()
        self._rigids = [build_body(body) for body in scene.bodies]
        for rigid in self._rigids:
            self._space.add(rigid.pm_body, *rigid.pm_body.shapes)

    def deepest(self, snapshot):
        """Return the depth of the deepest overlap of two bodies [m]."""
        for rigid, pose in zip(self._rigids, snapshot.poses.tolist(), strict=True):
            rigid.pose = pose
        deepest = 0.0
        for rigid in self._rigids:
            for shape in rigid.pm_body.shapes:
                for hit in self._space.shape_query(shape):
                    if hit.shape.body is not rigid.pm_body:
                        points = hit.contact_point_set.points
                        deepest = max(deepest, *(abs(point.distance) for point in points))
        return deepest


@each_shape
@pytest.mark.parametrize('wall', WALLS.values(), ids=WALLS.keys())
@pytest.mark.parametrize('speed', [10.0, 40.0, 150.0, 1000.0])
@pytest.mark.parametrize(('angle', 'spin'), [(0, 0.0), (50, 30.0)])
def test_a_fast_body_stays_on_its_side_of_a_wall(shape, wall, speed, angle, spin):
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'wall/0', wall, anchored=True)
    heading = math.radians(180 + angle)
    # The wall is not in its frame: every 0.4 of a step of its way it begins elsewhere.
    velocity = (speed * math.cos(heading), speed * math.sin(heading))
    row = spawn(sim, 'body/0', shape, (2.0, 0.4, 0.7), velocity=velocity, spin=spin)

    count = max(8, math.ceil(5.0 / (speed * math.cos(math.radians(angle))) / DT))
    nearest = min(snapshot.centers[row, 0] for snapshot in steps(sim, count))

    assert nearest > -0.02
    assert sim.world.snapshot().twists[row, 0] > 0.0, 'it did not come back'


@pytest.mark.parametrize('spin', [20.0, 100.0, 300.0])
@pytest.mark.parametrize('place', [0.2, 0.4, 0.6])
def test_a_rod_that_turns_fast_does_not_pass_through_a_disc(spin, place):
    sim = simulation(gravity=NOWHERE, friction=0.0)
    rod = spawn(sim, 'rod/0', SHAPES['rod'], spin=spin, mass=100.0)
    at = (place * math.cos(1.0), place * math.sin(1.0), 0.0)
    disc = spawn(sim, 'disc/0', Disc(radius=0.03), at)
    overlaps = Overlaps(sim.world.snapshot().scene)

    side = None
    for snapshot in steps(sim, math.ceil(2.0 / spin / DT)):
        seen = turned(snapshot.poses[disc, :2] - snapshot.poses[rod, :2], -snapshot.poses[rod, 2])
        if abs(seen[0]) < 0.75:
            side = side or math.copysign(1.0, seen[1])
            assert seen[1] * side > 0.0, 'it passed through'
        assert overlaps.deepest(snapshot) < 0.03

    assert np.hypot(*snapshot.twists[disc, :2]) > 1.0, 'it was not hit'


@each_shape
@pytest.mark.parametrize('speed', [40.0, 400.0])
@pytest.mark.parametrize('start', [1.0, 1.13, 1.31])
def test_two_fast_bodies_that_meet_head_on_do_not_pass_each_other(shape, speed, start):
    sim = simulation(gravity=NOWHERE, friction=0.0)
    for number, sign in enumerate((-1, 1)):
        spawn(sim, f'body/{number}', shape, (start * sign, 0.0, 0.0), velocity=(-speed * sign, 0))

    overlaps = Overlaps(sim.world.snapshot().scene)

    deepest = max(overlaps.deepest(snapshot) for snapshot in steps(sim, 120))

    last = sim.world.snapshot()
    assert math.dist(*last.centers) > 1.0
    # No deeper than a pair may enter each other unseen; tips of triangles turn by 0.25 rad a
    # sub-step into each other.
    assert deepest < (0.03 if shape is SHAPES['triangle'] else 0.0125)
    if shape is not SHAPES['triangle']:  # its slopes send one over the other
        assert last.centers[0, 0] < last.centers[1, 0]
        assert last.twists[0, 0] < 0.0 < last.twists[1, 0]


@pytest.mark.parametrize('start', np.linspace(2.0, 2.5, 4))
def test_a_train_of_fast_discs_piles_up_before_a_wall(start):
    sim = simulation(gravity=NOWHERE, friction=0.0, elasticity=0.0)
    spawn(sim, 'wall/0', WALLS['box'], anchored=True)
    discs = [
        spawn(sim, f'disc/{number}', Disc(radius=0.1), (start + 0.25 * number, 0.0, 0.0),
              velocity=(-200.0, 0.0))
        for number in range(8)
    ]  # fmt: skip
    overlaps = Overlaps(sim.world.snapshot().scene)

    for snapshot in steps(sim, 60):
        x = snapshot.poses[discs, 0]
        assert (np.diff(x) > 0.1).all()
        assert x[0] > 0.1
        assert overlaps.deepest(snapshot) < 0.08


def test_fast_bodies_that_fly_together_do_not_stop_each_other():
    sim = simulation(gravity=NOWHERE)
    for number in range(4):
        spawn(sim, f'body/{number}', Disc(radius=0.1), (0.25 * number, 0, 0), velocity=(300.0, 0))

    last = run(sim, 1.0)

    assert last.poses[:, 0] == pytest.approx(300.0 + 0.25 * np.arange(4), abs=1e-9)


@each_shape
@pytest.mark.parametrize(('speed', 'elasticity'), [(100.0, 0.5), slow(1000.0, 1.0)])
def test_a_fast_body_stays_in_closed_walls_for_10_s(shape, speed, elasticity):
    sim = simulation(elasticity=elasticity)
    walls(sim, -2.0, -1.0, 2.0, 3.0)
    spawn(sim, 'body/0', shape, (0.5, 1.0, 0.2), velocity=(speed * 0.6, speed * 0.8), spin=5.0)

    for snapshot in steps(sim, 2400):
        x, y = snapshot.centers[0]
        assert -2.0 < x < 2.0
        assert -1.0 < y < 3.0


def test_many_fast_bodies_stay_in_closed_walls():
    sim = simulation()
    walls(sim, -3.0, -3.0, 3.0, 3.0)
    random = np.random.default_rng(2)
    shapes = [shape for name, shape in SHAPES.items() if name != 'chain']
    specks = np.array([shapes[number % 7] is SHAPES['speck'] for number in range(21)])
    for number in range(21):
        place = np.array((number % 5, number // 5)) - 2.0
        angle = random.uniform(0, 7)
        velocity = (100 * math.cos(angle), 100 * math.sin(angle))
        spawn(sim, f'body/{number}', shapes[number % 7], (*place, 0.0), velocity=velocity)

    for _ in range(240):
        far = np.abs(sim.advance_frame().snapshot.centers).max(axis=1)
        assert far[~specks].max() < 3.0
        # A speck is as small as the overlap that is left standing; a box presses it in.
        assert far[specks].max() < 3.0 + COLLISION_SLOP


@each_shape
@pytest.mark.parametrize('speed', [40.0, 120.0])
@pytest.mark.parametrize('start', [1.0, 1.07])
def test_a_fast_paddle_takes_along_what_it_hits(shape, speed, start):
    sim = simulation(gravity=NOWHERE)
    body = spawn(sim, 'body/0', shape, (0.0, 0.0, 0.3))
    paddle = spawn(sim, 'paddle/0', Box(width=0.05, height=2.0), (-start, 0, 0), kinematic=True,
                   velocity=(speed, 0.0))  # fmt: skip

    for snapshot in steps(sim, 60):
        assert snapshot.centers[body, 0] > snapshot.poses[paddle, 0]

    assert snapshot.poses[paddle, 0] == pytest.approx(speed * 60 * DT - start)
    assert snapshot.twists[body, 0] >= speed * 0.9


def test_a_ball_that_flies_into_a_fast_paddle_comes_back():
    sim = simulation(gravity=NOWHERE)
    ball = spawn(sim, 'ball/0', Disc(radius=0.05), (1.0, 0, 0), velocity=(-40.0, 0.0))
    spawn(sim, 'paddle/0', Box(width=0.05, height=1.0), (-1.03, 0, 0), kinematic=True,
          velocity=(40.0, 0.0))  # fmt: skip

    for snapshot in steps(sim, 30):
        assert snapshot.poses[ball, 0] > snapshot.poses[1, 0]

    # 80 m/s towards the paddle, half of it back.
    assert snapshot.twists[ball, 0] == pytest.approx(80.0)


@pytest.mark.parametrize('mass', [1.0, 1000.0])
def test_a_heavy_fast_body_does_not_push_a_light_one_through_a_wall(mass):
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'wall/0', WALLS['chain of 1 mm'], anchored=True)
    small = spawn(sim, 'small/0', Disc(radius=0.05), (0.0505, 0.0, 0.0), mass=0.01)
    big = spawn(sim, 'big/0', Box(width=2, height=2), (2.0, 0, 0), velocity=(-100.0, 0), mass=mass)

    for snapshot in steps(sim, 240):
        assert snapshot.poses[big, 0] > 0.9
        assert snapshot.poses[small, 0] > -0.005 or abs(snapshot.poses[small, 1]) > 30.0


@pytest.mark.parametrize('speed', [5.0, 40.0])
def test_a_body_that_lands_on_many_feet_is_lifted_once(speed):
    sim = simulation(elasticity=0.0)
    floor(sim)
    feet = Compound(element=Disc(radius=0.2), centers=tuple((0.5 * n, 0.0) for n in range(6)))
    row = spawn(sim, 'body/0', feet, (0.0, 1.0, 0.0), velocity=(0.0, -speed))

    heights = [snapshot.poses[row, 1] - 0.2 for snapshot in steps(sim, 120)]

    down = next(number for number, height in enumerate(heights) if height < 1e-3)
    assert min(heights) > -0.01
    assert max(heights[down:]) < 1e-3


def test_what_hung_on_a_joint_once_bounces_as_if_it_never_had():
    landed = []
    for hung in (False, True):
        world = World(settings=WorldSettings(bounds=(-1.0, 0.0, 1.0, 9.0), elasticity=0.9))
        world.apply(Spawn(name='body/0', shape=Disc(radius=0.2), pose=(0.0, 2.0, 0.0)))
        bodies = world.space.bodies.by_name
        pm_body = bodies['body/0'].pm_body
        # The body lists its joint for as long as this refers to it.
        joint = hung and pymunk.PinJoint(pm_body, pymunk.Body())
        world.step(240)
        landed.append(world.snapshot().twists.tolist())
        assert bool(pm_body.constraints) is bool(joint)

    assert landed[0] == landed[1]


@pytest.mark.parametrize('shape', [Disc(radius=0.1), Box(width=0.4, height=0.2)], ids=repr)
@pytest.mark.parametrize('speed', [40.0, 100.0])
def test_a_fast_body_slides_over_tiles_as_over_one_floor(shape, speed):
    sim = simulation(friction=0.0, elasticity=0.0)
    for number in range(200):
        tile = Box(width=0.5, height=0.5)
        spawn(sim, f'tile/{number}', tile, (0.5 * number, -0.25, 0.0), anchored=True)
    row = spawn(sim, 'body/0', shape, (0.0, 0.1, 0.0))
    run(sim, 1.0)
    before = sim.world.snapshot().poses[row]
    spawn(sim, 'body/0', shape, tuple(before), velocity=(speed, 0.0))

    for last in steps(sim, 216):
        _, y, yaw = np.abs(last.poses[row] - before)
        # The body may turn a little over a seam, for a step or two.
        assert y < 1e-3
        assert yaw < 1e-3
    assert last.twists[row, 0] == pytest.approx(speed, abs=1e-3)
    assert last.poses[row, 0] - before[0] == pytest.approx(speed * 0.9, rel=1e-5)


@pytest.mark.parametrize('shape', [Disc(radius=0.2), Box(width=1.0, height=0.2), ELL], ids=repr)
@pytest.mark.parametrize('angle', [0.0, 0.3])
def test_what_falls_gains_no_energy_where_a_bounce_is_taken_back(shape, angle):
    sim = simulation(friction=0.0, elasticity=1.0)
    floor(sim)
    walls(sim, -3.0, -1.0, 3.0, 20.0)
    row = spawn(sim, 'body/0', shape, (0.5, 1.5, angle), velocity=(0.7, 0.0), spin=angle)
    before = energy(sim.world.snapshot())

    flying = []
    last = sim.world.snapshot()
    for snapshot in steps(sim, 2400):
        # In the step of a bounce a velocity is that of half a step before.
        change = snapshot.twists[row] - last.twists[row]
        if np.abs(change - (0.0, -G * DT, 0.0)).max() < 1e-9:
            flying.append(energy(snapshot))
        last = snapshot

    assert np.array(flying) == pytest.approx(before, rel=1e-3)


@pytest.mark.parametrize('speed', [40.0, slow(700.0)])
def test_a_fast_bounce_keeps_the_speed(speed):
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    walls(sim, -1.0, -1.0, 1.0, 1.0)
    row = spawn(sim, 'disc/0', Disc(radius=0.1), velocity=(speed * 0.6, speed * 0.8))

    for snapshot in steps(sim, 1000):
        assert np.abs(snapshot.twists[row, :2]) == pytest.approx((speed * 0.6, speed * 0.8))


def test_a_body_that_grazes_a_corner_flies_on():
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'wall/0', Chain(points=((0.0, -1.0), (0.0, 0.0)), thickness=0.4), anchored=True)
    # Past the round end, where a rectangle around it would be in the way.
    square = Box(width=0.1, height=0.1)
    row = spawn(sim, 'body/0', square, (-2.0, 0.2, 0.0), velocity=(60.0, 60 * 0.04))

    last = run(sim, 0.1)

    assert last.poses[row, 0] == pytest.approx(4.0)


def test_what_rests_is_not_swept():
    sim = simulation()
    walls(sim, -3.0, 0.0, 3.0, 20.0)
    for number in range(60):
        place = (number % 6 - 2.5, number // 6 + 0.5, 0.0)
        spawn(sim, f'body/{number}', Box(width=0.9, height=0.9), place)
    run(sim, 1.0)
    swept = sim.world.space.core.swept

    run(sim, 0.5)

    assert sim.world.space.core.swept == swept


@pytest.mark.parametrize('height', [-0.0128, 0.0, 0.0128])
@pytest.mark.parametrize(
    ('speed', 'radius'), [(5.0, 0.005), (10.0, 0.02), (20.0, 0.05), (29.0, 0.1)]
)
@pytest.mark.parametrize('anchored', [False, True])
def test_what_is_small_does_not_pass_between_the_pieces_of_a_body(speed, radius, height, anchored):
    sim = simulation(gravity=NOWHERE)
    large = Compound(element=Box(width=1.0, height=1.0), centers=((0.0, -0.5), (0.0, 0.5)))
    spawn(sim, 'large/0', large, (-1.0 - 0.75 * speed * DT, 0.0, 0.0), velocity=(speed, 0.0))
    spawn(sim, 'small/0', Disc(radius=radius), (0.0, height, 0.0), anchored=anchored)
    sim.world.step(math.ceil(2.2 / speed / DT))
    (large_x, _, _), (small_x, _, _) = sim.world.snapshot().poses.tolist()
    assert small_x > large_x + 0.5 - radius


def test_sticks_that_spin_through_each_other_have_a_bounded_number_of_impacts():
    sim = simulation(gravity=NOWHERE)
    for number in range(12):
        place = (0.51 * (number % 4), 0.51 * (number // 4), 0.0)
        spawn(sim, f'rod/{number}', Box(width=5.0, height=0.05), place, spin=100.0)
    for _ in range(8):
        swept = sim.world.space.core.swept
        sim.world.step(1)
        # All 66 pairs, in ten rounds a sub-step at most (`IMPACT_ROUNDS` of `impact_islands.c`).
        assert sim.world.space.core.swept - swept <= 66 * 10 * lib.SUB_STEPS
    assert np.isfinite(sim.world.snapshot().poses).all()


def test_a_fast_body_passes_where_walls_were_taken_down():
    sim = simulation(gravity=NOWHERE)
    walls(sim, -5.0, -5.0, 5.0, 5.0)
    row = spawn(sim, 'a/0', SHAPES['disc'], velocity=(80.0, 0.0))
    walls(sim, -5.0, -5.0, 12.0, 5.0)
    reached = run(sim, 0.1).poses[row, 0]
    sim.perform(Configure(changes={'bounds': None}))

    left = run(sim, 0.1)

    assert reached == pytest.approx(8.0, abs=1e-9)
    assert left.poses[row, 0] == pytest.approx(16.0, abs=1e-9)


@pytest.mark.parametrize('corners', [4, 100, 1000])
def test_a_crowd_of_any_corners_stays_on_its_side_of_a_thin_wall(corners):
    sim = simulation(gravity=NOWHERE, elasticity=0.5)
    spawn(sim, 'wall/0', Box(width=0.05, height=30.0), anchored=True)
    turns = math.tau * np.arange(corners) / corners
    outline = 0.2 * np.column_stack((np.cos(turns), 0.7 * np.sin(turns)))
    shape = Polygon(outline=tuple(map(tuple, outline.tolist())))
    rows = [
        spawn(
            sim,
            f'egg/{number}',
            shape,
            (-1.0 - 0.5 * (number % 3), 0.5 * (number // 3), 0.3 * number),
            velocity=(500.0 + number, 0.0),
            spin=100.0 * number,
        )
        for number in range(9)
    ]
    for now in steps(sim, 20):
        assert (now.poses[rows, 0] < 0.0).all()
