# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lasers and range finders: exact against the engine's rays, by REP 117, alike in any company."""

import math

import numpy as np
from physsim_ros.model.robots.sensors import Laser, RangeFinder
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
from physsim_ros.sensing import read_laser, scan_points, Surroundings
from physsim_ros.sensing.distance import read_range, within_range
import pytest

from .worlds import add_robot, engine_rays, plane, PRECISION, random_world, seen
from ..building import SHAPES, spawn

FAR = 12.0
SEED = 3


def scan(world, row, laser, seed=SEED):
    return read_laser(Surroundings(seen(world, seed)), row, laser)


def assert_same(scanned, expected):
    assert np.array_equal(np.isinf(scanned), np.isinf(expected))
    seen = np.isfinite(expected)
    assert seen.any()
    assert np.abs(scanned[seen] - expected[seen]).max() < PRECISION


@pytest.mark.parametrize('seed', range(12))
def test_ranges_are_those_of_the_engine_in_random_worlds_of_all_shapes(seed):
    pick = np.random.default_rng(seed)
    bounds = (-7.0, -6.0, 6.5, 7.5) if seed % 2 else None
    world = random_world(seed, bounds=bounds)
    x, y, yaw = pick.uniform(-0.5, 0.5, 3).tolist()
    first, span = pick.uniform(-3.0, 3.0), pick.uniform(0.5, 6.2)
    laser = Laser(at=(0.3, -0.2, 0.7), beams=501, angle=(first, first + span), range=(0.0, FAR))
    # By the engine before the robot is there: it would see itself.
    ahead = x + 0.3 * math.cos(yaw) + 0.2 * math.sin(yaw)
    aside = y + 0.3 * math.sin(yaw) - 0.2 * math.cos(yaw)
    angles = yaw + 0.7 + np.linspace(first, first + span, 501)
    expected = engine_rays(world, (ahead, aside), angles, FAR)
    row = add_robot(world, pose=(x, y, yaw), shape=Box(width=1.4, height=0.9))

    assert_same(scan(world, row, laser), expected)


@pytest.mark.parametrize('shape', SHAPES)
def test_each_shape_alone_is_seen_as_the_engine_has_it(shape):
    world = plane()
    spawn(world, 'thing/0', SHAPES[shape], (3.0, 0.4, 0.3))
    laser = Laser(beams=2000, range=(0.0, FAR))
    expected = engine_rays(world, (0.0, 0.0), np.arange(2000) * math.tau / 2000, FAR)

    assert_same(scan(world, add_robot(world), laser), expected)


def test_the_round_end_of_a_chain_is_seen_from_its_own_line():
    # Chipmunk's query has its far side there: from within the slab of a thick segment it takes
    # the side at which a ray leaves for the one at which it enters.
    world = plane()
    chain = Chain(points=((0.0, 0.0), (2.0, 0.0)), thickness=0.2)
    spawn(world, 'chain/0', chain, (1.0, 0.0, 0.0), anchored=True)
    row = add_robot(world)

    ranges = scan(world, row, Laser(beams=3, angle=(-0.05, 0.05), range=(0.0, 5.0)))

    aside = math.cos(0.05) - math.sqrt(0.1**2 - math.sin(0.05) ** 2)
    assert ranges.tolist() == pytest.approx([aside, 0.9, aside], abs=1e-12)


@pytest.mark.parametrize('far', [2.0, 1e-6])
def test_a_wall_ahead_is_as_far_as_it_is(far):
    world = plane()
    spawn(world, 'wall/0', Box(width=0.2, height=10.0), (far + 0.1, 0.0, 0.0), anchored=True)
    row = add_robot(world, pose=(0.0, 0.0, 0.0))

    ranges = scan(world, row, Laser(beams=3, angle=(-0.5, 0.5), range=(0.0, 5.0)))

    aslant = far / math.cos(0.5)
    assert ranges.tolist() == pytest.approx([aslant, far, aslant], rel=1e-9, abs=1e-12)


def test_the_first_beam_and_the_way_round_are_those_of_the_robot():
    world = plane()
    spawn(world, 'left/0', Disc(radius=0.5), (0.0, 2.0, 0.0))
    row = add_robot(world, pose=(0.0, 0.0, math.pi / 2))

    # The robot looks up, so that the disc is ahead; beams of a quarter turn.
    ranges = scan(world, row, Laser(beams=4, range=(0.1, 5.0)))
    turned = scan(world, row, Laser(beams=4, at=(0.0, 0.0, -math.pi / 2), range=(0.1, 5.0)))

    assert ranges.tolist() == pytest.approx([1.5, math.inf, math.inf, math.inf])
    assert turned.tolist() == pytest.approx([math.inf, 1.5, math.inf, math.inf])


def test_nothing_is_infinity_and_too_close_is_minus_infinity():
    world = plane()
    spawn(world, 'near/0', Disc(radius=0.5), (0.6, 0.0, 0.0), anchored=True)
    spawn(world, 'far/0', Disc(radius=0.5), (-5.0, 0.0, 0.0), anchored=True)
    row = add_robot(world)

    ranges = scan(world, row, Laser(beams=4, range=(0.2, 4.0)))

    assert ranges.tolist() == [-math.inf, math.inf, math.inf, math.inf]


@pytest.mark.parametrize(
    'shape',
    [
        Disc(radius=0.5),
        Box(width=1.0, height=1.0),
        Chain(points=((-1.0, 0.0), (1.0, 0.0)), thickness=0.3),
        Polygon(
            outline=((-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0), (-1.0, 1.0))
        ),
        Compound(element=Box(width=0.5, height=0.5), centers=((5.0, 5.0), (0.1, 0.1))),
    ],
)
def test_inside_a_shape_every_beam_is_too_close(shape):
    world = plane()
    spawn(world, 'around/0', shape, (0.0, 0.0, 0.2), anchored=True)
    row = add_robot(world)

    assert np.all(scan(world, row, Laser(beams=90, range=(0.1, 5.0))) == -np.inf)


@pytest.mark.parametrize('x', [1.0, 1.0 - 1e-12, 1.0 + 1e-12])
def test_on_an_edge_every_beam_is_too_close(x):
    world = plane()
    spawn(world, 'wall/0', Box(width=2.0, height=2.0), anchored=True)
    row = add_robot(world, pose=(x, 0.3, 0.0))

    assert np.all(scan(world, row, Laser(beams=90, range=(0.1, 5.0))) == -np.inf)


def test_the_walls_of_bounds_are_seen_and_beyond_them_all_is_wall():
    world = plane(bounds=(-2.0, -1.0, 3.0, 4.0))
    inside = add_robot(world, 'inside/0')
    outside = add_robot(world, 'outside/0', (20.0, 0.0, 0.0))
    laser = Laser(beams=4, range=(0.0, 10.0))

    assert scan(world, inside, laser).tolist() == pytest.approx([3.0, 4.0, 2.0, 1.0])
    assert np.all(scan(world, outside, Laser(beams=4, range=(0.1, 10.0))) == -np.inf)


def test_own_pieces_and_sensors_are_not_seen():
    world = plane()
    spawn(world, 'zone/0', Box(width=1.0, height=1.0), (2.0, 0.0, 0.0), sensor=True)
    body = Compound(element=Disc(radius=0.1), centers=((0.0, 0.0), (0.5, 0.0), (-0.5, 0.0)))
    row = add_robot(world, shape=body)

    assert np.all(scan(world, row, Laser(beams=60)) == np.inf)


def test_a_world_of_nothing_else_is_empty():
    world = plane()

    assert np.all(scan(world, add_robot(world), Laser(beams=7)) == np.inf)
    assert scan(world, 0, Laser(beams=1)).tolist() == [math.inf]


def test_no_beam_passes_between_pieces_that_share_an_edge():
    # A mesh of walls along the axes, seen from where beams lie exactly on their seams.
    world = plane()
    for number in range(20):
        place = (3.0, number - 9.5, 0.0)
        spawn(world, f'wall/{number}', Box(width=1.0, height=1.0), place, anchored=True)
    row = add_robot(world)

    ranges = scan(world, row, Laser(beams=201, angle=(-math.pi / 4, math.pi / 4), range=(0, 20)))

    assert np.abs(ranges * np.cos(np.linspace(-math.pi / 4, math.pi / 4, 201)) - 2.5).max() < 1e-12


def test_along_a_face_only_its_end_is_seen():
    world = plane()
    spawn(world, 'wall/0', Box(width=2.0, height=1.0), (3.0, -0.5, 0.0), anchored=True)
    spawn(world, 'diamond/0', Box(width=1.0, height=1.0), (0.0, 3.0, math.pi / 4), anchored=True)
    row = add_robot(world)

    ahead, up = scan(world, row, Laser(beams=5, range=(0.0, 9.0), angle=(0, math.pi)))[[0, 2]]

    assert ahead == math.inf or ahead == pytest.approx(2.0)
    assert up == pytest.approx(3.0 - math.sqrt(0.5), abs=1e-12)


def test_one_among_fifty_reads_the_same_bits_as_alone():
    laser = Laser(beams=720, range=(0.1, 10.0), noise=0.01)
    alone, together = random_world(1), plane()
    # The others are out of sight, and spawned before and after.
    for number in range(25):
        add_robot(together, f'before/{number}', (100.0 + number, 0.0, 0.0))
    for body, pose in zip(
        alone.snapshot().scene.bodies, alone.snapshot().poses.tolist(), strict=True
    ):
        spawn(together, body.name, body.shape, tuple(pose), anchored=body.anchored)
    pose = (0.1, 0.2, 0.3)
    row, row_among = add_robot(alone, pose=pose), add_robot(together, pose=pose)
    for number in range(25):
        add_robot(together, f'after/{number}', (0.0, 100.0 + number, 0.0))
    surroundings = Surroundings(seen(together, SEED))
    for other in range(10):
        read_laser(surroundings, other, laser)

    among = read_laser(surroundings, row_among, laser)

    assert scan(alone, row, laser).tobytes() == among.tobytes()


def test_noise_is_that_of_the_seed_and_the_step():
    world = plane()
    spawn(world, 'wall/0', Box(width=0.2, height=200.0), (3.1, 0.0, 0.0), anchored=True)
    row = add_robot(world)
    laser = Laser(beams=4000, angle=(-0.1, 0.1), range=(0.1, 5.0), noise=0.02)
    exact = scan(world, row, Laser(beams=4000, angle=(-0.1, 0.1), range=(0.1, 5.0)))

    first, again, other = (scan(world, row, laser, seed) for seed in (1, 1, 2))
    world.step(1)
    later = scan(world, row, laser, 1)

    assert first.tobytes() == again.tobytes()
    assert not np.any(first == other)
    assert not np.any(first == later)
    assert np.std(first - exact) == pytest.approx(0.02, rel=0.05)


def test_noise_out_of_range_is_infinite():
    world = plane()
    spawn(world, 'wall/0', Box(width=0.2, height=20.0), (1.1, 0.0, 0.0), anchored=True)
    row = add_robot(world)

    near = scan(world, row, Laser(beams=100, angle=(-1e-3, 1e-3), range=(1.0, 1.01), noise=0.05))

    assert set(near[np.isinf(near)].tolist()) == {math.inf, -math.inf}
    assert np.all(near[np.isfinite(near)] >= 1.0)
    assert np.all(near[np.isfinite(near)] <= 1.01)


def test_ten_thousand_beams_in_a_ring_of_a_thousand_large_discs():
    # Each covers a third of the view: pairs are met in parts.
    world = plane()
    angles = np.arange(1000) * math.tau / 1000
    centers = 10.0 * np.column_stack((np.cos(angles), np.sin(angles)))
    for number, some in enumerate(np.split(centers, 10)):
        discs = Compound(element=Disc(radius=8.0), centers=tuple(map(tuple, some.tolist())))
        spawn(world, f'discs/{number}', discs, anchored=True)
    row = add_robot(world)

    ranges = scan(world, row, Laser(beams=10_000, range=(0.0, 20.0)))

    assert ranges.min() == pytest.approx(2.0, abs=1e-12)
    assert ranges.max() < 2.001


# Range finders


def nearest(world, row, finder, seed=1):
    return read_range(Surroundings(seen(world, seed)), row, finder)


def test_the_nearest_in_the_cone_counts():
    world = plane()
    spawn(world, 'ahead/0', Box(width=0.2, height=4.0), (2.1, 0.0, 0.0))
    spawn(world, 'aside/0', Disc(radius=0.1), (1.0, 0.35, 0.0))
    row = add_robot(world)

    narrow = nearest(world, row, RangeFinder(cone=0.2, range=(0.1, 5.0)))
    wide = nearest(world, row, RangeFinder(cone=1.0, rays=101, range=(0.1, 5.0)))

    assert narrow == pytest.approx(2.0, abs=1e-12)
    assert wide == pytest.approx(math.hypot(1.0, 0.35) - 0.1, abs=1e-3)


@pytest.mark.parametrize('finder', [RangeFinder(rays=1), RangeFinder(cone=0.0)])
def test_a_cone_without_width_is_a_ray_ahead(finder):
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))

    assert nearest(world, add_robot(world), finder) == pytest.approx(0.5)


def test_out_of_range_is_infinite():
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))
    row = add_robot(world)

    assert nearest(world, row, RangeFinder(range=(0.1, 0.4))) == math.inf
    assert nearest(world, row, RangeFinder(range=(0.6, 2.0))) == -math.inf


def test_noise_of_a_range_finder_is_that_of_the_seed():
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))
    row = add_robot(world)
    finder = RangeFinder(noise=0.01)

    assert nearest(world, row, finder, 1) == nearest(world, row, finder, 1)
    assert nearest(world, row, finder, 1) != nearest(world, row, finder, 2)
    assert nearest(world, row, finder, 1) == pytest.approx(0.5, abs=0.06)


def test_noise_does_not_bring_back_what_is_out_of_range():
    distances, noise = np.array([9.95, 10.05, 0.15, 0.05]), np.array([2.0, -2.0, -2.0, 2.0])

    read = within_range(distances, 0.1, 10.0, 0.05 * noise)

    assert read.tolist() == [math.inf, math.inf, -math.inf, -math.inf]


def test_beams_of_blind_sectors_are_nan_and_the_others_as_without_them():
    world = random_world(2)
    row = add_robot(world)
    full = {'beams': 360, 'range': (0.1, 5.0), 'noise': 0.01}
    # One across the end of the turn, one of a single beam.
    sectors = ((math.radians(-10), math.radians(10)), (math.radians(90), math.radians(90)))
    ranges = scan(world, row, Laser(**full, blind=sectors))
    hidden = [*range(11), 90, *range(350, 360)]
    assert np.flatnonzero(np.isnan(ranges)).tolist() == hidden
    seen = ~np.isnan(ranges)
    assert np.array_equal(ranges[seen], scan(world, row, Laser(**full))[seen])


def test_points_of_a_scan_with_blind_beams_are_finite():
    world = random_world(2)
    row = add_robot(world)
    laser = Laser(beams=36, blind=((0.0, 1.0),))
    points = scan_points(world.snapshot(), row, laser, scan(world, row, laser))
    assert np.isfinite(points).all()
    assert points[1].tolist() == points[0].tolist()
