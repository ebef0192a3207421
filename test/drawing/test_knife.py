# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The knife: pieces together are the body, in mass and motion; joints and forces stay in place."""

from dataclasses import replace
import math

import numpy as np
from physsim_ros.drawing import knife
from physsim_ros.drawing.cut_shape import cut_shape
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.errors import BadOutline, BadSize, NothingThere, UnknownJoint, WorldFull
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Anchor, Grab, Join
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Triangles
from physsim_ros.model.transform import cross
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import DISC, spawning
from ..simulation.driven import take_back

U_SHAPE = Polygon(
    outline=((0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)),
)
MOTION = {'velocity': (3.0, -1.0), 'spin': 2.0}


def world_of(shape, **properties):
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    simulation.perform(spawning('a/0', shape, (1.0, 2.0, 0.4), **properties))
    return simulation


def scene_of(simulation):
    return SceneQuery(simulation.world.snapshot())


def cut(simulation, start, end):
    return simulation.perform(knife.cut(start, end, scene_of(simulation)))


def cut_within(simulation, start, end):
    """Cut from point to point of the frame of the body."""
    return cut(simulation, *in_world(simulation, start, end))


def in_world(simulation, *points):
    """Return points of the frame of the body in the world."""
    scene = scene_of(simulation)
    return [scene.in_world('a/0', point) for point in points]


def join(simulation, kind, *points, b='world', **properties):
    """Join a/0 to another body, or to the background."""
    name, said = f'j/{len(simulation.world.scene.joints)}', JointProperties(**properties)
    kind = JointKind(kind)
    simulation.perform(Join(name=name, kind=kind, points=points, a='a/0', b=b, properties=said))


def sums(snapshot):
    """Return mass, momentum, angular momentum about the origin, centre of mass, energy."""
    mass, moment = snapshot.scene.inertia.T
    velocities, spins = snapshot.twists[:, :2], snapshot.twists[:, 2]
    momenta = mass[:, None] * velocities
    turning = (cross(snapshot.centers, momenta) + moment * spins).sum()
    center = (mass[:, None] * snapshot.centers).sum(axis=0) / mass.sum()
    return np.array((mass.sum(), *momenta.sum(axis=0), turning, *center, snapshot.kinetic_energy))


BOX = Box(width=2.0, height=1.0)
OMNI = {'drive': {'kind': 'omni'}}
# Three triangles in a row, of which the second and the third share a side at x = 2.
FAN = Triangles(
    vertices=((0, 0), (2, 0), (1, 1), (2, 0), (2, 2), (1, 1), (2, 0), (3, 1), (2, 2)),
)
BOXES = Compound(element=Box(width=1.0, height=1.0), centers=((0, 0), (1, 0), (2, 0), (1, 1)))
DUMBBELL = Compound(element=Disc(radius=0.5), centers=((0.0, 0.0), (0.9, 0.0), (1.8, 0.0)))


@pytest.mark.parametrize(
    ('shape', 'stroke', 'count', 'tolerance'),
    [
        (BOX, [(-0.3, -2.0), (0.6, 2.0)], 2, 1e-12),
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

    cut_within(simulation, *stroke)

    after = simulation.world.snapshot()
    assert len(after.scene.bodies) == count
    assert sums(after) == pytest.approx(before, rel=tolerance, abs=tolerance)


def test_the_largest_piece_is_the_body_and_the_others_are_like_it():
    said = {'friction': 0.2, 'elasticity': 0.7, 'group': 3, 'label': 'm', 'density': 2.0}
    simulation = world_of(BOX, **said)

    cut_within(simulation, (0.5, -2.0), (0.5, 2.0))

    kept, piece = simulation.world.scene.bodies
    assert (kept.name, piece.name) == ('a/0', 'drawn/0')
    assert (kept.total_mass, piece.total_mass) == pytest.approx((3.0, 1.0))
    for name in ('friction', 'elasticity', 'group', 'color', 'density'):
        assert getattr(piece, name) == getattr(kept, name)
    assert (kept.label, piece.label) == ('m', '')


def test_joints_and_forces_stay_at_their_points():
    forces = [{'force': [1, 0], 'at': [0.9, 0.0]}, {'force': [0, 1], 'at': [-0.9, 0.0]}]
    simulation = world_of(BOX, forces=[*forces, {'force': [2, 2]}])
    right, left = in_world(simulation, (0.9, 0.1), (-0.9, 0.1))
    join(simulation, 'axle', right)
    join(simulation, 'spring', right, (9.0, 9.0), stiffness=7.0)
    join(simulation, 'rod', left, (0.0, 9.0))
    before = simulation.world.scene.joints

    cut_within(simulation, (0.3, -2.0), (0.3, 2.0))

    scene = simulation.world.scene
    assert [joint.a for joint in scene.joints] == ['drawn/0', 'drawn/0', 'a/0']
    assert [joint.seat for joint in scene.joints] == [joint.seat for joint in before]
    assert scene.joints[1].stiffness == 7.0
    kept, piece = scene.bodies
    assert [force.force for force in kept.forces] == [(0, 1), (2, 2)]
    assert [force.force for force in piece.forces] == [(1, 0)]


def test_a_hand_holds_the_piece_at_its_point():
    simulation = world_of(BOX)
    left, right = in_world(simulation, (-0.9, 0.1), (0.9, 0.1))
    simulation.perform(Grab(hand='left', point=left))
    simulation.perform(Grab(hand='right', point=right))

    cut_within(simulation, (0.3, -2.0), (0.3, 2.0))

    held = {grip.hand: grip.body for grip in simulation.world.snapshot().grips}
    assert held == {'left': 'a/0', 'right': 'drawn/0'}


@pytest.mark.parametrize('kind', [JointKind.AXLE, JointKind.SLIDER])
def test_limits_of_a_joint_count_from_where_they_did_before_the_cut(kind):
    simulation = world_of(BOX, velocity=(0.3, 0.0), spin=0.3)
    points = in_world(simulation, *((-0.9, 0.0), (0.0, 0.0))[: kind.points])
    join(simulation, kind, *points, lower=-0.5, upper=0.5)
    simulation.run(0.5)
    before = simulation.world.scene.joints[0]

    cut_within(simulation, (-0.3, -2.0), (-0.3, 2.0))

    assert simulation.world.scene.joints == (replace(before, a='drawn/0'),)


def test_joints_of_anchored_bodies_stay_for_when_they_are_released():
    simulation = world_of(BOX)
    left, middle = in_world(simulation, (-0.9, 0.0), (0.0, 0.0))
    join(simulation, 'axle', left)
    simulation.perform(Anchor(point=middle))

    cut_within(simulation, (-0.3, -2.0), (-0.3, 2.0))

    assert simulation.world.scene.joints[0].a == 'drawn/0'


WALL = Chain(points=((-1, 0), (1, 0)), thickness=0.2)


@pytest.mark.parametrize(
    ('shape', 'start', 'end'),
    [
        pytest.param(BOX, (0.0, -2.0), (0.0, 0.4), id='that ends within'),
        pytest.param(BOX, (-2.0, 0.5), (2.0, 0.5), id='along an edge'),
        pytest.param(BOX, (0.0, 1.5), (2.0, -0.5), id='at a corner'),
        pytest.param(Disc(radius=0.5), (-2.0, 0.502), (2.0, 0.502), id='tangent'),
        pytest.param(FAN, (2.0, -1.0), (2.0, 1.0), id='along half a shared side'),
        pytest.param(WALL, (0, 1), (0, -0.05), id='half through a wall'),
    ],
)
def test_a_body_that_is_touched_is_not_cut(shape, start, end):
    simulation = world_of(shape)
    with pytest.raises(NothingThere, match='right through no body'):
        cut_within(simulation, start, end)


def test_one_stroke_cuts_all_bodies_on_its_way_but_robots_and_actors():
    simulation = Simulation()
    actor = {'kind': 'path', 'points': [[6, 0], [6, 5]], 'speed': 1.0}
    simulation.perform(spawning('a/0', Box(width=1.0, height=1.0)))
    simulation.perform(spawning('a/1', DISC, (2.0, 0.0, 0.0), robot=OMNI))
    simulation.perform(spawning('a/2', DISC, (4.0, 0.0, 0.0)))
    simulation.perform(spawning('a/3', DISC, (6.0, 0.0, 0.0), actor=actor))

    answer = cut(simulation, (-3.0, 0.1), (9.0, 0.1))

    assert simulation.world.scene.names == ('a/0', 'a/1', 'a/2', 'a/3', 'drawn/0', 'drawn/1')
    assert answer == 'cut into 4 pieces'
    assert simulation.status.undo == 'undo cut several bodies'
    with pytest.raises(NothingThere, match='which no knife cuts') as refused:
        cut(simulation, (2.0, 1.0), (2.0, -1.0))
    assert refused.value.concerns == 'a/1'


def test_parts_of_a_robot_and_joints_of_its_own_are_not_cut():
    link = {'name': 'hand', 'box': {'width': 0.4, 'height': 0.4}, 'at': [1, 0]}
    joints = [
        {'name': 'neck', 'kind': 'axle', 'a': 'hand', 'points': [[0.5, 0]]},
        {'name': 'stay', 'kind': 'rod', 'a': 'hand', 'points': [[0.8, 0], [0.1, 0]]},
    ]
    simulation = Simulation()
    robot = {'links': [link], 'joints': joints}
    simulation.perform(spawning('r/0', Box(width=0.2, height=0.2), robot=robot))
    before = simulation.world.scene

    with pytest.raises(NothingThere, match='a part of one') as refused:
        cut(simulation, (1.0, 1.0), (1.0, -1.0))
    with pytest.raises(NothingThere):
        cut(simulation, (0.4, 1.0), (0.4, -1.0))

    assert refused.value.concerns == 'r/0/hand/0'
    assert simulation.world.scene == before


def test_a_robot_that_is_grazed_does_not_keep_others_from_being_cut():
    simulation, box = Simulation(), Box(width=1.0, height=1.0)
    simulation.perform(spawning('a/0', box, (0.0, 0.5, 0.0)))
    simulation.perform(spawning('r/0', box, (4.0, 0.0, 0.0), robot=OMNI))

    assert cut(simulation, (-1.0, 0.4999), (5.0, 0.4999)) == 'cut into 2 pieces'


def test_elements_of_a_compound_stay_round_and_parts_that_nothing_cuts_stay_on_the_largest():
    apart = Compound(element=Disc(radius=0.3), centers=((0, 0), (0.5, 0), (1, 0), (9, 0)))
    simulation = world_of(apart)

    cut_within(simulation, (0.75, -1.0), (0.70, 1.0))

    kept, piece = simulation.world.scene.bodies
    assert isinstance(piece.shape, Triangles)
    assert kept.shape.form.area > piece.shape.form.area
    boxes = Compound(element=Box(width=1, height=1), centers=((0, 0), (1, 0), (2, 0), (9, 0)))
    whole = world_of(boxes)
    cut_within(whole, (0.5, -1.0), (0.5, 1.0))
    shapes = [body.shape for body in whole.world.scene.bodies]
    assert [shape.centers for shape in shapes] == [((1, 0), (2, 0), (9, 0)), ((0, 0),)]


def test_a_chain_is_cut_across_its_line_with_its_mass_and_momenta():
    line = Chain(points=((0, 0), (4, 0), (4, 3)), thickness=0.2)
    simulation = world_of(line, density=2.0, **MOTION)
    before = sums(simulation.world.snapshot())

    cut_within(simulation, (0.5, -1.0), (5.0, 3.0))

    snapshot = simulation.world.snapshot()
    shapes = [body.shape for body in snapshot.scene.bodies]
    assert [len(shape.points) for shape in shapes] == [3, 2, 2]
    assert sums(snapshot)[:3] == pytest.approx(before[:3], rel=1e-12)


def test_a_ring_is_opened_by_one_cut_and_parted_by_two():
    ring = Chain(points=((0, 0), (4, 0), (4, 3), (0, 3), (0, 0)), thickness=0.2)
    simulation = world_of(ring)
    cut_within(simulation, (2.0, -1.0), (2.0, 1.0))
    (opened,) = simulation.world.scene.bodies
    np.testing.assert_allclose(opened.shape.points[0], (2.1, 0.0), atol=1e-12)
    np.testing.assert_allclose(opened.shape.points[-1], (1.9, 0.0), atol=1e-12)

    parted = world_of(ring)
    cut_within(parted, (2.0, -1.0), (2.0, 4.0))
    assert len(parted.world.scene.bodies) == 2


def test_a_rope_is_cut_where_it_is_crossed_beside_its_bodies():
    simulation = Simulation()
    simulation.perform(spawning('a/0'))
    simulation.perform(spawning('a/1', DISC, (4.0, 0.0, 0.0)))
    for kind in ('rope', 'spring', 'rod'):
        join(simulation, kind, (0.0, 0.0), (4.0, 0.0), b='a/1')
    cut(simulation, (0.2, 1.0), (0.2, -1.0))
    with pytest.raises(NothingThere):
        cut(simulation, (9.0, 1.0), (9.0, -1.0))
    assert len(simulation.world.scene.joints) == 3

    answer = cut(simulation, (2.0, 1.0), (2.0, -1.0))

    assert simulation.world.scene.joints == ()
    assert answer == 'cut j/0, j/1, j/2'


def test_a_rope_over_a_wheel_is_cut_where_it_is_and_not_between_its_ends():
    simulation = Simulation()
    simulation.perform(spawning('a/0'))
    simulation.perform(spawning('wheel/0', DISC, (4.0, 6.0, 0.0)))
    simulation.perform(spawning('load/0', DISC, (8.0, 0.0, 0.0)))
    points = ((0.0, 0.0), (4.0, 6.0), (8.0, 0.0))
    join(simulation, 'rope', *points, b='load/0', over=('wheel/0',))
    with pytest.raises(NothingThere):
        cut(simulation, (4.0, 2.0), (4.0, -2.0))
    (joint,) = simulation.world.scene.joints

    # Both of its spans at once.
    answer = cut(simulation, (0.0, 3.0), (8.0, 3.0))

    assert joint.guides[0].radius
    assert simulation.world.scene.joints == ()
    assert answer == 'cut j/0'


def test_a_rope_that_is_cut_again_is_refused():
    simulation = Simulation()
    simulation.perform(spawning('a/0'))
    join(simulation, 'rope', (0.0, 0.0), (4.0, 0.0))
    twice = knife.cut((2.0, 1.0), (2.0, -1.0), scene_of(simulation))
    simulation.perform(twice)
    before = simulation.world.digest()
    with pytest.raises(UnknownJoint, match='j/0'):
        simulation.perform(twice)
    assert simulation.world.digest() == before


def drawn_and_cut(kind, points, end):
    """Return a world in which Ann has drawn a box with a joint, and Ben has cut it."""
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    joint = Join(name='j/0', kind=JointKind(kind), points=points, a='a/0', b='world')
    for request in (spawning('a/0', BOX), joint):
        simulation.requests.submit(request, Origin('t', author='ann'))
    simulation.advance_frame()
    request = knife.cut((0.3, -2.0), (0.3, end), scene_of(simulation))
    simulation.requests.submit(request, Origin('t', author='ben'))
    simulation.advance_frame()
    return simulation


def test_pieces_are_theirs_who_cut_a_rope_with_the_same_stroke():
    simulation = drawn_and_cut('rope', ((0.9, 0.0), (0.0, 4.0)), 3.5)

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
    simulation = world_of(BOX)
    with pytest.raises(BadSize, match='too thin') as refused:
        cut_within(simulation, (-2.0, 0.4999), (2.0, 0.4999))
    assert (refused.value.field, refused.value.concerns) == ('point', 'a/0')


@pytest.mark.parametrize('most', ['max_bodies', 'max_shapes', 'max_overlaps'])
def test_more_pieces_than_the_world_can_have_are_refused_and_the_bodies_stay_whole(most):
    simulation = Simulation(settings=WorldSettings(**{most: 3}))
    for name in ('a/0', 'a/1', 'a/2'):
        simulation.perform(spawning(name, BOX))
    before = simulation.world.digest()
    with pytest.raises(WorldFull, match=most):
        cut(simulation, (0.0, -2.0), (0.0, 2.0))
    assert simulation.world.digest() == before
    assert simulation.status.undo == 'undo spawn a/2'


def test_a_body_that_somebody_has_cut_is_neither_taken_back_nor_theirs():
    simulation = drawn_and_cut('axle', ((0.9, 0.0),), 2.0)
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
    simulation.perform(spawning('f/0', Box(width=9.0, height=1.0), anchored=True))
    simulation.perform(spawning('a/0', BOX, (0.0, 1.0, 0.0)))
    simulation.run(1.0)

    cut(simulation, (-2.0, 1.1), (2.0, 1.1))
    simulation.run(1.0)

    snapshot = simulation.world.snapshot()
    assert np.abs(snapshot.twists[:, :2]).max() < 1e-3
    assert math.isclose(snapshot.poses[1, 1], 1.0, abs_tol=6e-3)
