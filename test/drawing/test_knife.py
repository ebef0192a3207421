# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The knife: pieces together are the body, in mass and motion; joints and forces stay in place."""

import math

import numpy as np
from physsim_ros.drawing import knife
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadSize, NothingThere, WorldFull
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Compound, Disc, Polygon
from physsim_ros.model.transform import cross
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..simulation.driven import take_back

U_SHAPE = Polygon(
    outline=((0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)),
)
MOTION = {'velocity': (3.0, -1.0), 'spin': 2.0}


def world_of(shape, **properties):
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    said = Properties(**properties)
    simulation.perform(Spawn(name='a/0', shape=shape, pose=(1.0, 2.0, 0.4), properties=said))
    return simulation


def cut(simulation, start, end):
    scene = SceneQuery(simulation.world.snapshot())
    return simulation.perform(knife.cut(start, end, scene))


def in_world(simulation, *points):
    """Return points of the frame of the body in the world."""
    scene = SceneQuery(simulation.world.snapshot())
    return [scene.in_world('a/0', point) for point in points]


def sums(snapshot):
    """Return mass, momentum, angular momentum about the origin, centre of mass, energy."""
    mass, moment = snapshot.scene.inertia.T
    velocities, spins = snapshot.twists[:, :2], snapshot.twists[:, 2]
    momenta = mass[:, None] * velocities
    turning = (cross(snapshot.centers, momenta) + moment * spins).sum()
    center = (mass[:, None] * snapshot.centers).sum(axis=0) / mass.sum()
    return np.array((mass.sum(), *momenta.sum(axis=0), turning, *center, snapshot.kinetic_energy))


@pytest.mark.parametrize(
    ('shape', 'stroke', 'count', 'tolerance'),
    [
        (Box(width=2.0, height=1.0), [(-0.3, -2.0), (0.6, 2.0)], 2, 1e-12),
        (U_SHAPE, [(-1.0, 2.0), (4.0, 2.5)], 3, 1e-12),
        (U_SHAPE, [(-1.0, 2.0), (1.5, 2.2)], 2, 1e-12),
        # Through corners, and along an edge of the gap.
        (U_SHAPE, [(-1.0, 4.0), (4.0, -1.0)], 3, 1e-12),
        (Disc(radius=0.5), [(-1.0, 0.2), (1.0, 0.1)], 2, 1e-4),
    ],
)
@pytest.mark.parametrize('weight', [{'mass': 3.0}, {'density': 2.0}])
def test_pieces_have_mass_momenta_and_energy_of_the_body(shape, stroke, count, tolerance, weight):
    simulation = world_of(shape, **MOTION, **weight)
    before = sums(simulation.world.snapshot())

    cut(simulation, *in_world(simulation, *stroke))

    after = simulation.world.snapshot()
    assert len(after.scene.bodies) == count
    assert sums(after) == pytest.approx(before, rel=tolerance, abs=tolerance)


def test_a_cut_that_ends_within_a_body_does_not_cut_it():
    simulation = world_of(Box(width=2.0, height=1.0))
    with pytest.raises(NothingThere):
        cut(simulation, *in_world(simulation, (0.0, -2.0), (0.0, 0.4)))


def test_the_largest_piece_is_the_body_and_the_others_are_like_it():
    said = {'friction': 0.2, 'elasticity': 0.7, 'group': 3, 'label': 'm', 'density': 2.0}
    simulation = world_of(Box(width=2.0, height=1.0), **said)

    cut(simulation, *in_world(simulation, (0.5, -2.0), (0.5, 2.0)))

    kept, piece = simulation.world.snapshot().scene.bodies
    assert (kept.name, piece.name) == ('a/0', 'drawn/0')
    assert (kept.total_mass, piece.total_mass) == pytest.approx((3.0, 1.0))
    for name in ('friction', 'elasticity', 'group', 'color', 'density'):
        assert getattr(piece, name) == getattr(kept, name)
    assert (kept.label, piece.label) == ('m', '')


def test_joints_and_forces_stay_at_their_points():
    forces = [{'force': [1, 0], 'at': [0.9, 0.0]}, {'force': [0, 1], 'at': [-0.9, 0.0]}]
    simulation = world_of(Box(width=2.0, height=1.0), forces=[*forces, {'force': [2, 2]}])
    right, left = in_world(simulation, (0.9, 0.1), (-0.9, 0.1))
    axle = Join(name='j/0', kind=JointKind.AXLE, points=(right,), a='a/0', b='world')
    stiff = JointProperties(stiffness=7.0)
    spring = Join(
        name='j/1',
        kind=JointKind.SPRING,
        points=(right, (9.0, 9.0)),
        a='a/0',
        b='world',
        properties=stiff,
    )
    held = Join(name='j/2', kind=JointKind.ROD, points=(left, (0.0, 9.0)), a='a/0', b='world')
    for join in (axle, spring, held):
        simulation.perform(join)
    before = {joint.name: joint for joint in simulation.world.snapshot().scene.joints}

    cut(simulation, *in_world(simulation, (0.3, -2.0), (0.3, 2.0)))

    scene = simulation.world.snapshot().scene
    joints = {joint.name: joint for joint in scene.joints}
    assert {name: joint.a for name, joint in joints.items()} == {
        'j/0': 'drawn/0', 'j/1': 'drawn/0', 'j/2': 'a/0'}  # fmt: skip
    assert joints['j/1'].stiffness == 7.0
    for name, joint in joints.items():
        assert joint.rest_length == pytest.approx(before[name].rest_length)
        assert joint.seat[:4] == pytest.approx(before[name].seat[:4], abs=1e-12)
    kept, piece = scene.bodies
    assert [force.force for force in kept.forces] == [(0, 1), (2, 2)]
    assert [force.force for force in piece.forces] == [(1, 0)]


def test_one_stroke_cuts_all_bodies_on_its_way_but_those_that_are_not_outlines():
    simulation = Simulation()
    compound = Compound(element=Disc(radius=0.2), centers=((0.0, 0.0), (0.3, 0.0)))
    for number, shape in enumerate((Box(width=1.0, height=1.0), compound, Disc(radius=0.5))):
        simulation.perform(Spawn(name=f'a/{number}', shape=shape, pose=(2.0 * number, 0.0, 0.0)))

    answer = cut(simulation, (-3.0, 0.1), (9.0, 0.1))

    assert simulation.world.snapshot().scene.names == ('a/0', 'a/1', 'a/2', 'drawn/0', 'drawn/1')
    assert answer == 'cut into 4 pieces'
    assert simulation.status.undo == 'undo cut several bodies'


def test_a_piece_that_would_be_too_thin_is_refused():
    simulation = world_of(Box(width=2.0, height=1.0))
    with pytest.raises(BadSize, match='too thin') as refused:
        cut(simulation, *in_world(simulation, (-2.0, 0.4999), (2.0, 0.4999)))
    assert (refused.value.field, refused.value.body) == ('point', 'a/0')


@pytest.mark.parametrize('most', ['max_bodies', 'max_shapes', 'max_overlaps'])
def test_more_pieces_than_the_world_can_have_are_refused_and_the_bodies_stay_whole(most):
    simulation = Simulation(settings=WorldSettings(**{most: 3}))
    for name in ('a/0', 'a/1', 'a/2'):
        simulation.perform(Spawn(name=name, shape=Box(width=2.0, height=1.0)))
    before = simulation.world.digest()
    with pytest.raises(WorldFull, match=most):
        cut(simulation, (0.0, -2.0), (0.0, 2.0))
    assert simulation.world.digest() == before
    assert simulation.status.undo == 'undo spawn a/2'


def test_a_body_that_somebody_has_cut_is_neither_taken_back_nor_theirs():
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    queue = simulation.requests
    box = Spawn(name='a/0', shape=Box(width=2.0, height=1.0), properties=Properties(friction=0.1))
    queue.submit(box, topic='~/spawn', author='ann')
    axle = Join(name='j/0', kind=JointKind.AXLE, points=((0.9, 0.0),), a='a/0', b='world')
    queue.submit(axle, topic='~/join', author='ann')
    simulation.advance_frame()
    scene = SceneQuery(simulation.world.snapshot())
    queue.submit(knife.cut((0.3, -2.0), (0.3, 2.0), scene), topic='~/click', author='ben')
    simulation.advance_frame()
    assert simulation.world.scene.joints[0].a == 'drawn/0'
    assert simulation.past.added_by('ann') == (('a/0',), ('j/0',))
    assert take_back(simulation, 'ann').message == 'undid join axle j/0'
    assert simulation.world.scene.joints == ()
    before = simulation.world.digest()

    assert take_back(simulation, 'ann').code == 'not_alone'

    assert simulation.world.digest() == before
    assert simulation.past.added_by('ben') == (('drawn/0',), ())


def test_pieces_do_not_stir_where_they_were_at_rest():
    simulation = Simulation()
    floor = Properties(anchored=True)
    simulation.perform(Spawn(name='f/0', shape=Box(width=9.0, height=1.0), properties=floor))
    box = Box(width=2.0, height=1.0)
    simulation.perform(Spawn(name='a/0', shape=box, pose=(0.0, 1.0, 0.0)))
    for _ in range(60):
        simulation.advance_frame()

    cut(simulation, (-2.0, 1.1), (2.0, 1.1))
    for _ in range(60):
        frame = simulation.advance_frame()

    assert np.abs(frame.snapshot.twists[:, :2]).max() < 1e-3
    assert math.isclose(frame.snapshot.poses[1, 1], 1.0, abs_tol=6e-3)
