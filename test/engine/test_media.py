# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Media in the engine: who sleeps in them, what wakes, and what is exact when it is restored."""

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import ChangeBody, Command, Configure, Delete
from physsim_ros.model.shapes import Box, Chain, Disc, hull_of, Triangles
import pytest

from ..laws.scenes import DT, floor, G, run, simulation, spawn

WATER = {'density': 10.0, 'viscosity': 1.0}


def pool(sim, top, **properties):
    said = {'sensor': True, 'medium': WATER, 'anchored': True, **properties}
    return spawn(sim, 'pool/0', Box(width=20.0, height=4.0), (0.0, top - 2.0, 0.0), **said)


def asleep(sim, name):
    return sim.world.space.bodies.by_name[name].pm_body.is_sleeping


def sunk():
    """Return a world in which a stone sleeps on the ground of a pool."""
    sim = simulation(elasticity=0.0)
    floor(sim)
    pool(sim, 2.0)
    spawn(sim, 'stone/0', Box(width=0.5, height=0.5), (0.0, 0.25, 0.0), density=12.0)
    run(sim, 2.0)
    assert asleep(sim, 'stone/0')
    return sim


def test_a_stone_on_the_ground_sleeps_until_the_medium_changes():
    sim = sunk()
    heavier = Properties(medium={**WATER, 'density': 20.0})
    sim.perform(ChangeBody(name='pool/0', properties=heavier))

    last = run(sim, 1.0)

    assert last.poses[2, 1] > 0.5


def test_a_stone_on_the_ground_wakes_where_the_wind_begins():
    sim = sunk()
    sim.perform(Delete(name='pool/0'))
    sim.perform(Configure(changes={'air_density': 1.0, 'wind': (50.0, 0.0)}))

    assert run(sim, 0.5).poses[1, 0] > 1.0


def test_water_that_rises_wakes_and_lifts_what_sleeps():
    sim = simulation(elasticity=0.0)
    floor(sim)
    pool(sim, -1.0, anchored=False, kinematic=True, velocity=(0.0, 0.0))
    spawn(sim, 'box/0', Box(width=0.5, height=0.5), (0.0, 0.25, 0.0), density=2.0)
    run(sim, 2.0)
    assert asleep(sim, 'box/0')

    sim.perform(ChangeBody(name='pool/0', properties=Properties(velocity=(0.0, 1.0))))
    last = run(sim, 3.0)

    # It floats with a fifth of its height in the water, and rises with it.
    assert last.poses[2, 1] == pytest.approx(2.0 + 0.15, abs=0.1)
    assert last.twists[2, 1] == pytest.approx(1.0, abs=0.02)


def test_what_lies_in_gusts_does_not_sleep():
    sim = simulation(elasticity=0.0, air_density=1.0, gusts=0.1)
    floor(sim)
    spawn(sim, 'box/0', Box(width=0.5, height=0.5), (0.0, 0.25, 0.0), density=2.0)

    run(sim, 2.0)

    assert not asleep(sim, 'box/0')


def test_a_region_reports_no_contacts():
    sim = sunk()
    sim.world.reports_contacts = True
    sim.perform(Command(names=('stone/0',), twists=np.array([[0.5, 0.0, 0.0]])))

    frame = sim.advance_frame()

    assert frame.contacts.pairs.tolist() == [[0, 2]]


@pytest.mark.parametrize('frames', [0, 1, 7])
def test_a_world_with_media_goes_on_from_a_checkpoint_to_the_bit(frames):
    def begun():
        sim = simulation(air_density=0.1, gusts=1.0, seed=3)
        pool(sim, 0.0)
        spawn(sim, 'log/0', Chain(points=((-1.0, 0.0), (1.0, 0.0)), thickness=0.3))
        run(sim, 0.1)
        spawn(sim, 'disc/0', Disc(radius=0.3), (0.0, 1.0, 0.0), velocity=(3.0, 1.0))
        sim.run(frames / 60)
        return sim

    one, other = begun(), begun()
    one.checkpoint()
    other.checkpoint()
    other.restore(one.checkpoint())

    for each in (one, other):
        each.world.step(100)
    assert np.array_equal(one.world.snapshot().poses, other.world.snapshot().poses)
    assert np.array_equal(one.world.snapshot().twists, other.world.snapshot().twists)


def test_true_velocities_do_not_jump_where_a_medium_begins_or_ends():
    sim = simulation()
    spawn(sim, 'disc/0', Disc(radius=0.3), velocity=(3.0, 1.0))
    run(sim, 0.1)
    for density in (5.0, 0.0):
        before = sim.world.snapshot().twists[0]
        sim.perform(Configure(changes={'air_density': density}))
        assert sim.world.snapshot().twists[0] == pytest.approx(before, abs=1e-12)
        sim.world.step(1)
        # A hundredth of the speed is more than any medium here changes in a step.
        assert np.abs(sim.world.snapshot().twists[0] - before).max() < 0.3
        run(sim, 0.1)


@pytest.mark.parametrize(
    'said',
    [
        {},
        {'anchored': True},
        {'sensor': True},
        {'kinematic': True},
    ],
)
def test_only_an_anchored_or_kinematic_sensor_is_filled(said):
    sim = simulation()
    with pytest.raises(BadProperty) as refused:
        spawn(sim, 'pool/0', Box(width=1.0, height=1.0), medium=WATER, **said)
    assert refused.value.field == 'medium'
    assert len(sim.world) == 0


def test_a_region_stays_a_sensor():
    sim = sunk()
    with pytest.raises(BadProperty):
        sim.perform(ChangeBody(name='pool/0', properties=Properties(sensor=False)))
    sim.perform(ChangeBody(name='pool/0', properties=Properties(sensor=False), unset=('medium',)))
    assert not sim.world.scene.bodies[1].sensor


def test_the_hull_of_pieces_goes_around_them():
    shape = Triangles(
        vertices=((0, 0), (1, 0), (0, 1), (3, 0), (4, 0), (4, 2), (1, 0), (2, 0), (2, 0.1))
    )
    hull = hull_of(shape.form) + shape.form.centroid

    expected = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 1.0)]
    assert hull == pytest.approx(np.array(expected), abs=1e-12)


def test_the_hull_of_discs_is_as_wide_as_they_are():
    form = Chain(points=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), thickness=0.4).form
    hull = hull_of(form) + form.centroid

    assert np.ptp(hull, axis=0) == pytest.approx((1.4, 1.4), rel=0.003)


def test_a_snapshot_has_the_buoyancy_of_what_floats():
    sim = simulation()
    pool(sim, 0.0)
    spawn(sim, 'raft/0', Box(width=1.0, height=0.4), (0.0, 0.1, 0.0), density=2.5)
    assert sim.world.snapshot().fields.shape == (0, 2)
    sim.world.reports_contacts = True
    run(sim, 10.0)

    assert sim.world.snapshot().fields == pytest.approx(np.array([[0.0, 0.0], [0.0, G]]), abs=1e-6)


def blown(names, seeds):
    """Return the speeds of two discs, each in a region of a name that has gusts of a seed."""
    sim = simulation(gravity=(0.0, 0.0), seed=3)
    for x, name, seed in zip((-5.0, 5.0), names, seeds, strict=True):
        wind = {'density': 1.0, 'gusts': 2.0, 'gust_seed': seed}
        said = {'anchored': True, 'sensor': True, 'medium': wind}
        spawn(sim, name, Box(width=8.0, height=8.0), (x, 0.0, 0.0), **said)
        spawn(sim, f'disc/{x:g}', Disc(radius=0.3), (x, 0.0, 0.0))
    return run(sim, 1.0).twists[1::2, :2]


def test_gusts_are_those_of_their_seed_whatever_the_region_is_called():
    one = blown(('left/0', 'right/0'), (0, 7))
    assert np.array_equal(one, blown(('wind/9', 'a/1'), (0, 7)))
    assert not np.allclose(one[0], one[1])
    same = blown(('left/0', 'right/0'), (7, 7))
    assert np.allclose(same[0], same[1])
    assert np.array_equal(same[1], one[1])


def struck_raft(height, *, rebuilt):
    """
    Return the velocity of a raft that slept on water, after the step in which a ball strikes it.

    :param height: from which the ball falls on it [m]
    :param rebuilt: a request between the step before and this one changes what is far away
    """
    sim = simulation(elasticity=0.0)
    pool(sim, 0.0)
    raft = spawn(sim, 'raft/0', Box(width=2.0, height=0.4), (0.0, 0.0, 0.0), density=5.0)
    spawn(sim, 'ball/0', Disc(radius=0.1), (0.0, height, 0.0), mass=0.1)
    while sim.world.snapshot().poses[-1, 1] - 0.3 > abs(sim.world.snapshot().twists[-1, 1]) * DT:
        sim.world.step(1)
    assert asleep(sim, 'raft/0')
    if rebuilt:
        spawn(sim, 'far/0', Disc(radius=0.1), (90.0, 0.0, 0.0), anchored=True)
    sim.world.step(1)
    return sim.world.snapshot().twists[raft]


@pytest.mark.parametrize('height', [60.0, 60.1, 60.2, 60.3])
def test_a_sleeping_raft_that_is_struck_floats_whatever_is_requested_far_away(height):
    velocity = struck_raft(height, rebuilt=False)

    # g for a sub-step is 10 mm/s.
    assert struck_raft(height, rebuilt=True) == pytest.approx(velocity, abs=1e-6)
    assert np.abs(velocity).max() > 0.1
