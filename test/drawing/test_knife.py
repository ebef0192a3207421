# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The knife: pieces together are the body, in mass and motion; joints and forces stay in place."""

from dataclasses import replace
import math

import numpy as np
from physsim_ros.drawing import knife
from physsim_ros.drawing.cut_shape import cut_shape
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadOutline, BadSize, NothingThere, UnknownJoint, WorldFull
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Anchor, Grab, Join, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Triangles
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


# Three triangles in a row, of which the second and the third share a side at x = 2.
FAN = Triangles(
    vertices=((0, 0), (2, 0), (1, 1), (2, 0), (2, 2), (1, 1), (2, 0), (3, 1), (2, 2)),
)
BOXES = Compound(element=Box(width=1.0, height=1.0), centers=((0, 0), (1, 0), (2, 0), (1, 1)))
DUMBBELL = Compound(element=Disc(radius=0.5), centers=((0.0, 0.0), (0.9, 0.0), (1.8, 0.0)))


@pytest.mark.parametrize(
    ('shape', 'stroke', 'count', 'tolerance'),
    [
        (Box(width=2.0, height=1.0), [(-0.3, -2.0), (0.6, 2.0)], 2, 1e-12),
        (Polygon(outline=((0, 0), (2, 0), (0, 1))), [(-1.0, 0.2), (3.0, 0.3)], 2, 1e-12),
        (U_SHAPE, [(-1.0, 2.0), (4.0, 2.5)], 3, 1e-12),
        (U_SHAPE, [(-1.0, 2.0), (1.5, 2.2)], 2, 1e-12),
        # Through corners, and along an edge of the gap.
        (U_SHAPE, [(-1.0, 4.0), (4.0, -1.0)], 3, 1e-12),
        (Disc(radius=0.5), [(-1.0, 0.2), (1.0, 0.1)], 2, 1e-4),
        (FAN, [(-1.0, 0.6), (4.0, 0.7)], 2, 1e-12),
        # Along a side that two triangles share.
        (FAN, [(2.0, -1.0), (2.0, 3.0)], 2, 1e-12),
        (BOXES, [(-1.0, 0.1), (4.0, 0.2)], 2, 1e-12),
        # Between two boxes, then through one of them as well.
        (BOXES, [(0.5, -1.0), (0.5, 0.8)], 2, 1e-12),
        (BOXES, [(0.5, -1.0), (0.6, 2.0)], 2, 1e-12),
        (DUMBBELL, [(0.9, -1.0), (0.9, 1.0)], 2, 1e-4),
        (DUMBBELL, [(-1.0, 0.0), (3.0, 0.0)], 2, 1e-4),
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
        assert joint.seat == before[name].seat
    kept, piece = scene.bodies
    assert [force.force for force in kept.forces] == [(0, 1), (2, 2)]
    assert [force.force for force in piece.forces] == [(1, 0)]


def test_a_hand_holds_the_piece_at_its_point():
    simulation = world_of(Box(width=2.0, height=1.0))
    left, right = in_world(simulation, (-0.9, 0.1), (0.9, 0.1))
    simulation.perform(Grab(hand='left', point=left))
    simulation.perform(Grab(hand='right', point=right))

    cut(simulation, *in_world(simulation, (0.3, -2.0), (0.3, 2.0)))

    held = {grip.hand: grip.body for grip in simulation.world.snapshot().grips}
    assert held == {'left': 'a/0', 'right': 'drawn/0'}


@pytest.mark.parametrize('kind', [JointKind.AXLE, JointKind.SLIDER])
def test_limits_of_a_joint_count_from_where_they_did_before_the_cut(kind):
    simulation = world_of(Box(width=2.0, height=1.0), velocity=(0.3, 0.0), spin=0.3)
    points = in_world(simulation, *((-0.9, 0.0), (0.0, 0.0))[: kind.points])
    limits = JointProperties(lower=-0.5, upper=0.5)
    simulation.perform(
        Join(name='j/0', kind=kind, points=points, a='a/0', b='world', properties=limits)
    )
    simulation.run(0.5)
    before = simulation.world.scene.joints[0]

    cut(simulation, *in_world(simulation, (-0.3, -2.0), (-0.3, 2.0)))

    assert simulation.world.scene.joints == (replace(before, a='drawn/0'),)


def test_joints_of_anchored_bodies_stay_for_when_they_are_released():
    simulation = world_of(Box(width=2.0, height=1.0))
    (left,) = in_world(simulation, (-0.9, 0.0))
    simulation.perform(Join(name='j/0', kind=JointKind.AXLE, points=(left,), a='a/0', b='world'))
    simulation.perform(Anchor(point=in_world(simulation, (0.0, 0.0))[0]))

    cut(simulation, *in_world(simulation, (-0.3, -2.0), (-0.3, 2.0)))

    assert simulation.world.scene.joints[0].a == 'drawn/0'


@pytest.mark.parametrize(
    ('shape', 'start', 'end'),
    [
        pytest.param(Box(width=2.0, height=1.0), (-2.0, 0.5), (2.0, 0.5), id='along an edge'),
        pytest.param(Box(width=2.0, height=1.0), (0.0, 1.5), (2.0, -0.5), id='at a corner'),
        pytest.param(Disc(radius=0.5), (-2.0, 0.502), (2.0, 0.502), id='tangent'),
        pytest.param(FAN, (2.0, -1.0), (2.0, 1.0), id='along half a shared side'),
        pytest.param(
            Chain(points=((-1, 0), (1, 0)), thickness=0.2), (0, 1), (0, -0.05), id='wall'
        ),
    ],
)
def test_a_body_that_is_touched_is_not_cut(shape, start, end):
    simulation = world_of(shape)
    with pytest.raises(NothingThere, match='right through no body'):
        cut(simulation, *in_world(simulation, start, end))


def test_one_stroke_cuts_all_bodies_on_its_way_but_robots_and_actors():
    simulation = Simulation()
    disc = Disc(radius=0.5)
    actor = {'kind': 'path', 'points': [[6, 0], [6, 5]], 'speed': 1.0}
    for number, (shape, said) in enumerate(
        [
            (Box(width=1.0, height=1.0), {}),
            (disc, {'robot': {'drive': {'kind': 'omni'}}}),
            (disc, {}),
            (disc, {'actor': actor}),
        ]
    ):
        pose, properties = (2.0 * number, 0.0, 0.0), Properties.from_mapping(said)
        simulation.perform(
            Spawn(name=f'a/{number}', shape=shape, pose=pose, properties=properties)
        )

    answer = cut(simulation, (-3.0, 0.1), (9.0, 0.1))

    names = simulation.world.snapshot().scene.names
    assert names == (*(f'a/{number}' for number in range(4)), 'drawn/0', 'drawn/1')
    assert answer == 'cut into 4 pieces'
    assert simulation.status.undo == 'undo cut several bodies'
    with pytest.raises(NothingThere, match='which no knife cuts') as refused:
        cut(simulation, (2.0, 1.0), (2.0, -1.0))
    assert refused.value.body == 'a/1'


def test_a_robot_that_is_grazed_does_not_keep_others_from_being_cut():
    simulation, box = Simulation(), Box(width=1.0, height=1.0)
    robot = Properties.from_mapping({'robot': {'drive': {'kind': 'omni'}}})
    simulation.perform(Spawn(name='a/0', shape=box, pose=(0.0, 0.5, 0.0)))
    simulation.perform(Spawn(name='r/0', shape=box, pose=(4.0, 0.0, 0.0), properties=robot))

    answer = cut(simulation, (-1.0, 0.4999), (5.0, 0.4999))

    assert answer == 'cut into 2 pieces'


def test_elements_of_a_compound_stay_round_and_parts_that_nothing_cuts_stay_on_the_largest():
    apart = Compound(element=Disc(radius=0.3), centers=((0, 0), (0.5, 0), (1, 0), (9, 0)))
    simulation = world_of(apart)

    cut(simulation, *in_world(simulation, (0.75, -1.0), (0.70, 1.0)))

    kept, piece = simulation.world.snapshot().scene.bodies
    assert isinstance(piece.shape, Triangles)
    assert kept.shape.form.area > piece.shape.form.area
    boxes = Compound(element=Box(width=1, height=1), centers=((0, 0), (1, 0), (2, 0), (9, 0)))
    whole = world_of(boxes)
    cut(whole, *in_world(whole, (0.5, -1.0), (0.5, 1.0)))
    shapes = [body.shape for body in whole.world.snapshot().scene.bodies]
    assert [shape.centers for shape in shapes] == [((1, 0), (2, 0), (9, 0)), ((0, 0),)]


def test_a_chain_is_cut_across_its_line_with_its_mass_and_momenta():
    line = Chain(points=((0, 0), (4, 0), (4, 3)), thickness=0.2)
    simulation = world_of(line, density=2.0, **MOTION)
    before = sums(simulation.world.snapshot())

    cut(simulation, *in_world(simulation, (0.5, -1.0), (5.0, 3.0)))

    snapshot = simulation.world.snapshot()
    shapes = [body.shape for body in snapshot.scene.bodies]
    assert [len(shape.points) for shape in shapes] == [3, 2, 2]
    assert sums(snapshot)[:3] == pytest.approx(before[:3], rel=1e-12)


def test_a_ring_is_opened_by_one_cut_and_parted_by_two():
    ring = Chain(points=((0, 0), (4, 0), (4, 3), (0, 3), (0, 0)), thickness=0.2)
    simulation = world_of(ring)
    cut(simulation, *in_world(simulation, (2.0, -1.0), (2.0, 1.0)))
    (opened,) = simulation.world.snapshot().scene.bodies
    np.testing.assert_allclose(opened.shape.points[0], (2.1, 0.0), atol=1e-12)
    np.testing.assert_allclose(opened.shape.points[-1], (1.9, 0.0), atol=1e-12)

    parted = world_of(ring)
    cut(parted, *in_world(parted, (2.0, -1.0), (2.0, 4.0)))
    assert len(parted.world.snapshot().scene.bodies) == 2


def test_a_rope_is_cut_where_it_is_crossed_beside_its_bodies():
    simulation = Simulation()
    for number in range(2):
        place = Spawn(name=f'a/{number}', shape=Disc(radius=0.5), pose=(4.0 * number, 0.0, 0.0))
        simulation.perform(place)
    points = (0.0, 0.0), (4.0, 0.0)
    for number, kind in enumerate((JointKind.ROPE, JointKind.SPRING, JointKind.ROD)):
        simulation.perform(Join(name=f'j/{number}', kind=kind, points=points, a='a/0', b='a/1'))
    cut(simulation, (0.2, 1.0), (0.2, -1.0))
    assert len(simulation.world.snapshot().scene.joints) == 3

    answer = cut(simulation, (2.0, 1.0), (2.0, -1.0))

    assert simulation.world.snapshot().scene.joints == ()
    assert answer == 'cut j/0, j/1, j/2'


def test_a_rope_that_is_cut_again_is_refused():
    simulation = Simulation()
    simulation.perform(Spawn(name='a/0', shape=Disc(radius=0.5)))
    rope = Join(name='j/0', kind=JointKind.ROPE, points=((0.0, 0.0), (4.0, 0.0)), a='a/0')
    simulation.perform(rope)
    twice = knife.cut((2.0, 1.0), (2.0, -1.0), SceneQuery(simulation.world.snapshot()))
    simulation.perform(twice)
    before = simulation.world.digest()
    with pytest.raises(UnknownJoint, match='j/0'):
        simulation.perform(twice)
    assert simulation.world.digest() == before


def test_pieces_are_theirs_who_cut_a_rope_with_the_same_stroke():
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    queue = simulation.requests
    queue.submit(Spawn(name='a/0', shape=Box(width=2.0, height=1.0)), topic='t', author='ann')
    queue.submit(
        Join(name='j/0', kind=JointKind.ROPE, points=((0.9, 0.0), (0.0, 4.0)), a='a/0'),
        topic='t',
        author='ann',
    )
    simulation.advance_frame()
    scene = SceneQuery(simulation.world.snapshot())
    queue.submit(knife.cut((0.3, -2.0), (0.3, 3.5), scene), topic='t', author='ben')
    simulation.advance_frame()
    assert simulation.world.scene.names == ('a/0', 'drawn/0')
    assert simulation.world.scene.joints == ()
    assert simulation.past.added_by('ben') == (('drawn/0',), ())


@pytest.mark.parametrize('seed', range(40))
def test_any_cut_of_any_outline_keeps_its_area_and_centroid(seed):
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0.0, math.tau, 12))
    radii = rng.uniform(0.3, 2.0, 12)
    corners = radii[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    outline = Polygon(outline=tuple(map(tuple, corners.tolist())))
    # Half of the strokes go through corners of the outline.
    start, end = rng.uniform(-3.0, 3.0, (2, 2))
    if seed % 2:
        start, end = (3 * corners[0] - 2 * corners[6], 3 * corners[6] - 2 * corners[0])
    try:
        pieces = cut_shape(outline, tuple(start.tolist()), tuple(end.tolist()))
    except (BadSize, BadOutline):
        # A sliver.
        return
    areas = np.array([piece.form.area for piece in pieces])
    centroids = np.array([piece.form.centroid for piece in pieces])
    assert areas.sum() == pytest.approx(outline.form.area, rel=1e-9)
    center = (areas[:, None] * centroids).sum(axis=0) / areas.sum()
    np.testing.assert_allclose(center, outline.form.centroid, atol=1e-9)


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
