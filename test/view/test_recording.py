# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The picture holds what was asked for: where, how large, in which colour, and for how long."""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

import numpy as np
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Triangles
from physsim_ros.model.snapshot import Answer, Contacts, Frame, Snapshot
from physsim_ros.model.transform import cross
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.preview_lines import LINGER
from physsim_ros.view.recording import FrameRecorder, REPEAT
import pytest

from ..building import PLAIN_BODY

rr = pytest.importorskip('rerun')
chunk = pytest.importorskip('rerun.chunk')

# Frames are four steps apart.
STEP_NS = 4_166_667
RED, BLUE = (0.8, 0.05, 0.1, 1.0), (0.1, 0.2, 0.8, 1.0)
# Half of one in 255 from rounding to bytes.
COLOR_TOLERANCE = 0.51 / 255
# float32 at a metre or ten.
TOLERANCE = 2e-6


def body(name='box/0', shape=None, color=RED, **changes):
    shape = shape or Box(width=2.0, height=1.0)
    return replace(PLAIN_BODY, name=name, shape=shape, color=color, **changes)


def scene(*bodies, **settings):
    return Scene(bodies=bodies, settings=WorldSettings(**settings))


def frame(of, poses, *, step=0, **changes):
    poses = np.array(poses, dtype=np.float64).reshape(-1, 3)
    snapshot = Snapshot(
        step=step, stamp=step * STEP_NS, scene=of, poses=poses, twists=np.ones_like(poses)
    )
    return Frame(snapshot=snapshot, contacts=changes.pop('contacts', None), **changes)


@dataclass
class Row:
    """A component of an entity at a frame."""

    recorded: int
    stamp: int
    value: np.ndarray

    @property
    def frame(self):
        """Return the number of the frame; those of these tests are 1/60 s apart."""
        return round(self.recorded * 60e-9)


class Recording:
    """A picture that is drawn into a file, and what the file then holds."""

    def __init__(self, path):
        self.path = path
        self._stream = rr.RecordingStream('test')
        self._stream.set_sinks(rr.FileSink(path))
        self.picture = FrameRecorder(self._stream)

    def draw(self, *frames, **context):
        self.picture.draw(frames, context=FrameContext(**context))

    def close(self):
        self._stream.disconnect()

    def rows(self, entity, component):
        """Return all rows of a component, in the order of time; no more can be drawn then."""
        self.close()
        rows = []
        for each in chunk.RrdReader(self.path).stream():
            if each.entity_path != f'/{entity}' or each.is_static:
                continue
            table = each.to_record_batch()
            if component not in table.schema.names:
                continue
            times = [table.column(name).cast('int64').to_pylist() for name in TIMELINES]
            values = table.column(component).to_pylist()
            rows += [
                Row(*row, np.array(value))
                for *row, value in zip(*times, values, strict=True)
                if value is not None
            ]
        return sorted(rows, key=lambda row: row.recorded)

    def last(self, entity, component):
        """Return what a component is in the end."""
        return self.rows(entity, component)[-1].value

    def shapes(self, entity):
        """Return the instances of an entity as they were drawn, a list for each frame."""
        corners = self.last(entity, 'Mesh3D:vertex_positions')[:, :2]
        triangles = self.last(entity, 'Mesh3D:triangle_indices')
        colors = unpack(self.last(entity, 'Mesh3D:vertex_colors'))
        columns = ('translations', 'rotation_axis_angles', 'scales')
        places, turns, scales = (
            self.rows(entity, f'InstancePoses3D:{column}') for column in columns
        )
        frames = []
        for number, (place, turn) in enumerate(zip(places, turns, strict=True)):
            instances = []
            for row, (x, y, z) in enumerate(place.value):
                scale = scales[number].value[row, :2] if scales else 1.0
                yaw = turn.value[row]['angle']
                assert turn.value[row]['axis'] == [0, 0, 1]
                cos, sin = math.cos(yaw), math.sin(yaw)
                turned = corners * scale @ np.array([[cos, sin], [-sin, cos]])
                instances.append(Drawn(turned + np.array((x, y)), triangles, colors, z))
            frames.append(instances)
        return frames

    def shape(self, entity):
        """Return the only instance of an entity in its only frame."""
        ((only,),) = self.shapes(entity)
        return only


@dataclass
class Drawn:
    """The mesh of a body where it was drawn: corners (v, 2) [m], triangles, colours, z [m]."""

    corners: np.ndarray
    triangles: np.ndarray
    colors: np.ndarray
    z: float

    @property
    def bounds(self):
        """Left, bottom, right, top [m]."""
        return [*self.corners.min(axis=0), *self.corners.max(axis=0)]

    def color_at(self, x, y):
        """Return the colour that is seen at a point: that of the last triangle there, or None."""
        a, b, c = np.moveaxis(self.corners[self.triangles], 1, 0)
        sides = [
            cross(second - first, (x, y) - first) for first, second in ((a, b), (b, c), (c, a))
        ]
        inside = np.all([side >= 0 for side in sides], axis=0)
        inside |= np.all([side <= 0 for side in sides], axis=0)
        if not inside.any():
            return None
        return tuple(self.colors[self.triangles[np.flatnonzero(inside)[-1], 0]])


TIMELINES = ('recorded', 'sim_time')


@pytest.fixture
def recording(tmp_path):
    it = Recording(tmp_path / 'picture.rrd')
    yield it
    it.close()


def unpack(colors):
    """Return packed colours as (k, 4) 0 .. 1."""
    packed = np.array(colors, dtype=np.uint32)
    return np.stack([(packed >> shift & 255) / 255 for shift in (24, 16, 8, 0)], axis=1)


def test_a_box_has_the_place_turn_size_and_colour_that_were_asked_for(recording):
    recording.draw(frame(scene(body()), [(-3.0, 4.0, math.pi / 2)]))

    box = recording.shape('world/bodies/box/0')
    assert box.bounds == pytest.approx((-3.5, 3.0, -2.5, 5.0), abs=TOLERANCE)
    assert box.color_at(-3.0, 4.0) == pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert box.color_at(-3.6, 4.0) is None


def test_bodies_that_look_alike_are_one_entity_and_each_has_its_own_size_and_name(recording):
    sizes = (0.45, 0.5, 0.54)
    discs = [body(f'ball/{n}', Disc(radius=size)) for n, size in enumerate(sizes)]

    recording.draw(frame(scene(*discs), [(4.0 * n, 1.0, 9.0) for n in range(3)]))

    (drawn,) = recording.shapes('world/bodies/ball/0')
    for number, (size, disc) in enumerate(zip(sizes, drawn, strict=True)):
        box = (4 * number - size, 1 - size, 4 * number + size, 1 + size)
        assert disc.bounds == pytest.approx(box, abs=0.002 * size)
    assert [*recording.last('world/bodies/ball/0', 'name')] == ['ball/0', 'ball/1', 'ball/2']


def test_every_body_has_its_name_at_its_centre(recording):
    both = scene(body('box/0'), body('box/1'))

    recording.draw(*(frame(both, [(0, 0, 0), (step, 2, 0)], step=4 * step) for step in range(7)))

    assert [*recording.last('world/names', 'Points3D:labels')] == ['box/0', 'box/1']
    rows = recording.rows('world/names', 'Points3D:positions')
    assert [row.frame for row in rows] == [0, 6]
    assert rows[-1].value[:, :2].tolist() == [[0, 0], [6, 2]]


def test_a_disc_is_round(recording):
    recording.draw(frame(scene(body(shape=Disc(radius=100.0))), [(0, 0, 0)]))

    disc = recording.shape('world/bodies/box/0')
    reach = np.hypot(*disc.corners.T)
    rim = disc.corners[reach > 99.9]
    angles = np.sort(np.arctan2(rim[:, 1], rim[:, 0]))
    # The middle of a chord: half a pixel within a circle of 400 pixels.
    assert 1 - math.cos(np.diff(angles).max() / 2) < 0.5 / 400


def test_every_body_has_an_outline_that_is_darker_than_it(recording):
    star = Polygon(outline=((0, 0), (4, 0), (4, 4), (2, 1), (0, 4)))
    recording.draw(frame(scene(body(shape=star)), [(0, 0, 0)]))

    drawn = recording.shape('world/bodies/box/0')
    fill, edge = drawn.color_at(2.0, 0.5), drawn.color_at(2.0, 0.005)
    assert fill == pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert all(dark <= light for dark, light in zip(edge, fill, strict=True))
    assert edge[0] < 0.7 * fill[0]


def test_a_mark_on_a_disc_shows_that_it_rolls(recording):
    disc = scene(body(shape=Disc(radius=1.0)))

    recording.draw(frame(disc, [(0, 0, 0)]), frame(disc, [(0, 0, math.pi / 2)], step=4))

    (first,), (second,) = recording.shapes('world/bodies/box/0')
    assert first.color_at(0.5, 0.003) != first.color_at(0.003, 0.5)
    assert second.color_at(0.003, 0.5) == first.color_at(0.5, 0.003)
    assert second.color_at(0.5, 0.003) == pytest.approx(RED, abs=COLOR_TOLERANCE)


@pytest.mark.parametrize(
    'shape',
    [
        Polygon(outline=((0, 0), (4, 0), (0, 2))),
        Polygon(outline=((0, 0), (0, 2), (4, 0))),
        Polygon(outline=((0, 0), (2, 0), (2, 2), (1, 0.5))),
        Triangles(vertices=((0, 0), (1, 0), (0, 1), (2, 0), (3, 0), (2, -1))),
        Chain(points=((0, 0), (4, 0), (4, 3)), thickness=0.2),
        Compound(element=Box(width=0.2, height=0.2), centers=((-1, 0), (1, 0))),
    ],
    ids=['ramp', 'clockwise', 'concave', 'triangles', 'chain', 'compound'],
)
def test_a_shape_is_filled_where_it_is_and_nowhere_else(recording, shape):
    recording.draw(frame(scene(body(shape=shape)), [(5.0, 1.0, 0.4)]))

    drawn = recording.shape('world/bodies/box/0')
    grid = np.random.default_rng(7).uniform(-1.3, 4.3, (2000, 2))
    there = grid @ np.array([[math.cos(0.4), math.sin(0.4)], [-math.sin(0.4), math.cos(0.4)]])
    filled = [drawn.color_at(x, y) is not None for x, y in there + np.array((5.0, 1.0))]
    expected = np.array([is_within(shape, *point) for point in grid])
    # Points within a hundredth of an edge may lie on either side of a chord.
    assert np.mean(filled != expected) < 0.005


def is_within(shape, x, y):
    """Tell whether a point lies in a shape, by its pieces."""
    for piece in shape.form.pieces:
        if hasattr(piece, 'vertices'):
            corners = np.array(piece.vertices)
            edges = np.roll(corners, -1, axis=0) - corners
            if (cross(edges, (x, y) - corners) >= 0).all():
                return True
        else:
            start, end = np.array(piece.start), np.array(piece.end)
            along = np.clip(
                (((x, y) - start) @ (end - start)) / ((end - start) @ (end - start)), 0, 1
            )
            if math.dist((x, y), start + along * (end - start)) <= piece.radius:
                return True
    return False


def test_a_later_body_lies_above_an_earlier_one(recording):
    two = scene(body('a/0', color=RED), body('a/1', color=BLUE), body('a/2', color=RED))

    recording.draw(frame(two, [(0, 0, 0), (0.5, 0, 0), (0.7, 0, 0)]))

    ((first, last),) = recording.shapes('world/bodies/a/0')
    assert first.z < recording.shape('world/bodies/a/1').z < last.z


def test_an_anchored_body_bears_an_anchor_and_a_free_one_does_not(recording):
    both = scene(body(anchored=True), body('box/1', color=BLUE))
    recording.draw(frame(both, [(3.0, 4.0, 0.0), (9.0, 4.0, 0.0)]))

    anchored, free = recording.shape('world/bodies/box/0'), recording.shape('world/bodies/box/1')
    # The shank of the anchor is upright, in the middle of the body.
    assert anchored.color_at(3.001, 4.001) != pytest.approx(RED, abs=COLOR_TOLERANCE)
    assert free.color_at(9.001, 4.001) == pytest.approx(BLUE, abs=COLOR_TOLERANCE)


def test_the_anchor_of_a_concave_body_lies_on_the_body(recording):
    horseshoe = Polygon(outline=((0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)))

    recording.draw(frame(scene(body(shape=horseshoe, anchored=True)), [(0, 0, 0)]))

    drawn = recording.shape('world/bodies/box/0')
    inked = drawn.corners[(drawn.colors[:, :3] > 0.99).all(axis=1)]
    assert len(inked)
    assert all(is_within(horseshoe, *corner) for corner in inked)


def test_a_sensor_is_translucent(recording):
    recording.draw(frame(scene(body(sensor=True), body('box/1')), [(0, 0, 0), (5, 0, 0)]))

    factors = [
        unpack(recording.last(f'world/bodies/box/{n}', 'Mesh3D:albedo_factor'))[0, 3]
        for n in (0, 1)
    ]
    assert factors[0] < 0.5
    assert factors[1] == 1


def test_the_walls_lie_just_outside_the_bounds(recording):
    recording.draw(frame(scene(bounds=(-10.0, 0.0, 10.0, 12.0)), []))

    corners = recording.last('world/walls', 'Mesh3D:vertex_positions')[:, :2].reshape(-1, 6, 2)
    low, high = corners.min(axis=1), corners.max(axis=1)
    floor, ceiling, left, right = np.hstack((low, high))
    assert floor[3] == pytest.approx(0.0, abs=1e-6)
    assert ceiling[1] == pytest.approx(12.0)
    assert left[2] == pytest.approx(-10.0)
    assert right[0] == pytest.approx(10.0)


def test_the_grid_has_a_line_at_every_whole_metre_and_says_which(recording):
    recording.draw(frame(scene(bounds=(-10.0, 0.0, 10.0, 12.0)), []))

    lines = [
        np.array(line) for line in recording.last('world/grid', 'LineStrips3D:strips').tolist()
    ]
    upright = sorted(line[0, 0] for line in lines if line[0, 0] == line[1, 0])
    assert np.diff(upright) == pytest.approx(1.0)
    assert any(abs(x) < TOLERANCE for x in upright)
    places = recording.last('world/grid/metres', 'Points3D:positions')
    labels = recording.last('world/grid/metres', 'Points3D:labels')
    for (x, y, _), label in zip(places, labels, strict=True):
        # Labels hang below their points: those at the left are raised by half their height.
        assert label in {f'{x:g} m', f'{math.floor(y):g} m'}
        assert x < -10.0 or y < 0.0, 'a label covers the world'


def test_what_has_been_deleted_is_cleared(recording):
    with_box, without = (
        scene(body(), body('disc/0', Disc(radius=1.0))),
        scene(body('disc/0', Disc(radius=1.0))),
    )

    recording.draw(frame(with_box, [(0, 0, 0), (1, 0, 0)]), frame(without, [(1, 0, 0)], step=4))

    (cleared,) = recording.rows('world/bodies/box/0', 'Clear:is_recursive')
    assert cleared.frame == 1
    assert len(recording.last('world/bodies/disc/0', 'InstancePoses3D:translations')) == 1
    assert recording.rows('world/bodies/disc/0', 'Clear:is_recursive') == []


def test_the_recorded_time_goes_on_while_the_world_goes_back(recording):
    box = scene(body())

    for batch in ((0, 4, 8), (4, 0), (4,)):
        recording.draw(*(frame(box, [(step, 0, 0)], step=step) for step in batch))

    rows = recording.rows('world/bodies/box/0', 'InstancePoses3D:translations')
    assert [row.frame for row in rows] == [0, 1, 2, 3, 4, 5]
    assert [row.stamp for row in rows] == [step * STEP_NS for step in (0, 4, 8, 4, 0, 4)]
    assert [row.value[0, 0] for row in rows] == [0, 4, 8, 4, 0, 4]


def test_what_was_drawn_does_not_change_with_what_is_drawn_next(recording):
    box = scene(body())

    for step in range(20):
        recording.draw(frame(box, [(step, 0, 0)], step=4 * step))

    rows = recording.rows('world/bodies/box/0', 'InstancePoses3D:translations')
    assert [row.value[0, 0] for row in rows] == list(range(20))


def test_geometry_is_sent_with_the_scene_and_again_now_and_then(recording):
    box = scene(body())
    frames = [frame(box, [(step, 0, 0)], step=4 * step) for step in range(REPEAT + 10)]

    for first in range(0, len(frames), 60):
        end = first + 60
        recording.draw(*frames[first:end])

    rows = recording.rows('world/bodies/box/0', 'Mesh3D:vertex_positions')
    assert [row.frame for row in rows] == [0, REPEAT]


def test_what_rests_is_not_sent_again(recording):
    ground = body('ground/0', Polygon(outline=((0, 0), (9, 0), (0, 1))), anchored=True)
    both = scene(body(), ground)

    recording.draw(frame(both, [(0, 5, 0), (0, 0, 0)]))
    recording.draw(frame(both, [(0, 4, 0), (0, 0, 0)], step=4))

    assert len(recording.rows('world/bodies/box/0', 'InstancePoses3D:translations')) == 2
    assert len(recording.rows('world/bodies/ground/0', 'InstancePoses3D:translations')) == 1


def test_an_anchored_body_that_is_put_elsewhere_is_drawn_there(recording):
    ground = scene(body(anchored=True))

    recording.draw(frame(ground, [(0, 0, 0)]))
    recording.draw(frame(ground, [(2, 0, 0)], step=4))

    assert recording.last('world/bodies/box/0', 'InstancePoses3D:translations')[0, 0] == 2


def test_a_paused_world_adds_nothing(recording):
    paused = frame(scene(body()), [(0, 0, 0)], moved=False)

    recording.draw(*[paused] * 5)
    recording.draw(*[paused] * 5)

    assert len(recording.rows('world/bodies/box/0', 'InstancePoses3D:translations')) == 1


def test_what_happens_to_a_paused_world_is_drawn(recording):
    box = scene(body())
    paused = frame(box, [(0, 0, 0)], moved=False)
    moved_by_hand = frame(box, [(1, 0, 0)], moved=False)
    told = frame(box, [(1, 0, 0)], moved=False, answers=(Answer(topic='~/spawn', message='no'),))

    recording.draw(paused, moved_by_hand, told)

    assert [row.frame for row in recording.rows('events', 'TextLog:text')] == [2]
    assert recording.last('world/bodies/box/0', 'InstancePoses3D:translations')[0, 0] == 1


def test_every_answer_is_an_event_and_a_refusal_an_error(recording):
    answers = (
        Answer(topic='~/spawn', subject='box/0', message='spawned'),
        Answer(topic='~/pin', message='no body there', code='nothing_there'),
    )

    recording.draw(frame(scene(body()), [(0, 0, 0)], answers=answers))

    texts = [row.value.item() for row in recording.rows('events', 'TextLog:text')]
    levels = [row.value.item() for row in recording.rows('events', 'TextLog:level')]
    assert texts == ['box/0  spawned  (~/spawn)', 'nothing_there  no body there  (~/pin)']
    assert levels == ['INFO', 'ERROR']


def test_energies_and_momenta_are_plotted(recording):
    now = frame(scene(body()), [(2, 3, 0)])

    recording.draw(now)

    kinetic, potential = now.snapshot.kinetic_energy, now.snapshot.potential_energy
    energies = recording.last('plots/energy', 'Scalars:scalars')
    assert energies == pytest.approx([kinetic, potential, 0.0, kinetic + potential])
    # 2 kg at 1 m/s along x and y, at (2, 3), and a moment of 5/6 kg m² at 1 rad/s.
    assert recording.last('plots/momentum', 'Scalars:scalars') == pytest.approx([2.0, 2.0])
    about = recording.last('plots/angular_momentum', 'Scalars:scalars')
    assert about == pytest.approx(2 * (2 - 3) + 5 / 6)


@pytest.mark.parametrize(('speed', 'factor', 'shown'), [(4.0, 2.0, 0.5), (-1.0, -1.0, 1.0)])
def test_the_real_time_factor_is_by_the_speed_that_was_asked(recording, speed, factor, shown):
    recording.draw(frame(scene(body()), [(0, 3, 0)], speed=speed), real_time_factor=factor)

    assert recording.last('plots/pace', 'Scalars:scalars') == pytest.approx(shown)


def test_a_world_that_nothing_paces_has_no_real_time_factor(recording):
    recording.draw(frame(scene(body()), [(0, 3, 0)]), real_time_factor=0.0)

    assert recording.rows('plots/pace', 'Scalars:scalars') == []


def test_counts_are_sent_when_they_change_and_each_second(recording):
    few, more = scene(body()), scene(body(), body('box/1'))
    steps = range(0, 600, 4)
    recording.draw(*(frame(few, [(0.0, 0.0, 0.0)], step=step) for step in steps[:100]))
    recording.draw(*(frame(more, [(0.0, 0.0, 0.0)] * 2, step=step) for step in steps[100:]))
    rows = recording.rows('plots/counts', 'Scalars:scalars')
    assert [row.value[0] for row in rows] == [1.0, 1.0, 2.0]
    # A plot shows what lies in its last 15 s; values are sampled every tenth of a second.
    assert [row.frame for row in rows[:2]] == [0, 60]
    assert 100 <= rows[2].frame <= 106


def contacts(*impulses, pair=(0, -1)):
    """Return contacts at (1, 2) with impulses on the second body [N s]."""
    count = len(impulses)
    return Contacts(
        pairs=np.array([pair] * count, dtype=np.int64).reshape(-1, 2),
        points=np.array([[1.0, 2.0]] * count).reshape(-1, 2),
        normals=np.array([[0.0, -1.0]] * count).reshape(-1, 2),
        impulses=np.array(impulses, dtype=np.float64).reshape(-1, 2),
    )


def test_contacts_are_arrows_by_force_on_the_movable_body_as_long_as_they_last(recording):
    box = scene(body())
    weight = 2.0 * 9.81
    press, heavy = contacts((0.0, -weight / 60)), contacts((0.0, -2 * weight / 60))

    for number, each in enumerate((contacts(), press, heavy, contacts(), contacts())):
        recording.draw(frame(box, [(number, 0, 0)], step=4 * number, contacts=each))

    origins = recording.rows('world/contacts', 'Arrows3D:origins')
    vectors = recording.rows('world/contacts', 'Arrows3D:vectors')
    assert [(row.frame, len(row.value)) for row in origins] == [(1, 1), (2, 1), (3, 0)]
    assert origins[0].value[0, :2] == pytest.approx((1.0, 2.0))
    first, second = vectors[0].value[0], vectors[1].value[0]
    assert first[0] == 0
    assert first[1] > 0
    assert second == pytest.approx(2 * first, rel=1e-4)


def test_thousands_of_contacts_are_sent_less_often(recording):
    box = scene(body())
    crowd = contacts(*[(0.0, -1.0)] * 1500)

    recording.draw(*(frame(box, [(n, 0, 0)], step=4 * n, contacts=crowd) for n in range(60)))

    rows = recording.rows('world/contacts', 'Arrows3D:origins')
    assert 1 < len(rows) <= 8
    assert rows[-1].frame == 59


def test_a_body_that_is_traced_leaves_its_way_and_flies_beside_its_parabola(recording):
    ball = scene(body('ball/0', Disc(radius=0.5)))
    for number in range(10):
        time = 4 * number * STEP_NS * 1e-9
        at = (time, 5 + time - 9.81 * time**2 / 2, 0)
        recording.draw(frame(ball, [at], step=4 * number), traced=('ball/0', 'nobody/0'))

    heights = [row.value for row in recording.rows('plots/bodies/ball/0', 'Scalars:scalars')]
    assert len(heights) == 10
    for height, flight in heights:
        assert flight == pytest.approx(height, abs=1e-9)
    way = recording.last('world/traces', 'LineStrips3D:strips')
    assert len(way) == 1


def test_time_speed_and_the_past_are_written_in_the_picture(recording):
    box = scene(body())
    for number, (step, speed) in enumerate(((240, 1.0), (236, -2.0), (236, 0.0))):
        past = step < 240
        recording.draw(frame(box, [(number, 0, 0)], step=step, speed=speed, past=past))

    words = [row.value.item() for row in recording.rows('world/camera/status', 'Points2D:labels')]
    assert words == [
        '1.00 s  × 1',
        '0.98 s  × 2 back  in the past',
        '0.98 s  paused  in the past',
    ]


def eyes(recording):
    return [row.value[0] for row in recording.rows('world/camera', 'Transform3D:translation')]


def test_what_is_half_drawn_lies_over_the_world_until_it_is_dropped(recording):
    box, half = scene(body()), Preview(lines=(((0, 0), (3, 4)),), points=((3, 4),), label='wall')
    # Nothing moves: a preview alone is something new to see.
    for preview in (NO_PREVIEW, half, half, NO_PREVIEW):
        recording.draw(frame(box, [(0, 0, 0)], moved=False, preview=preview))

    (shown, cleared) = recording.rows('world/preview/lines', 'LineStrips3D:strips')
    assert (shown.frame, cleared.frame) == (1, 2)
    ((start, end),) = shown.value
    assert [*start[:2], *end[:2]] == [0, 0, 3, 4]
    assert len(cleared.value) == 0
    labels = recording.rows('world/preview/label', 'Points3D:labels')
    assert [[*row.value] for row in labels] == [['wall'], []]


def test_the_reading_of_a_stroke_is_seen_for_a_while(recording):
    box, read = scene(body()), Preview(lines=(((0, 0), (3, 4)),), label='wall 90%')
    for step in range(LINGER + 2):
        recording.draw(frame(box, [(step, 0, 0)], step=4 * step, preview=read))

    rows = recording.rows('world/preview/lines', 'LineStrips3D:strips')
    assert [(row.frame, len(row.value)) for row in rows] == [(0, 1), (LINGER, 0)]


def test_the_camera_stands_still_while_bodies_move(recording):
    one, two = scene(body()), scene(body(), body('box/1'))

    recording.draw(*(frame(one, [(step, 0, 0)], step=step) for step in range(20)))
    recording.draw(frame(two, [(0.5, 0, 0), (0, 0.5, 0)], step=20))

    first, second = eyes(recording)
    assert first == pytest.approx(second)


def test_the_camera_looks_at_the_bounds_and_follows_them(recording):
    recording.draw(frame(scene(bounds=(0.0, 0.0, 10.0, 2.0)), []))
    recording.draw(frame(scene(bounds=(100.0, 0.0, 300.0, 40.0)), [], step=4))

    first, second = eyes(recording)
    assert first[:2] == pytest.approx((5.0, 1.0))
    assert second[:2] == pytest.approx((200.0, 20.0))
    assert second[2] == pytest.approx(20 * first[2], rel=1e-5)


def test_the_camera_steps_back_for_bodies_that_are_far_outside(recording):
    near, far = scene(body()), scene(body(), body('box/1'))

    recording.draw(frame(near, [(0, 0, 0)]))
    recording.draw(frame(far, [(0, 0, 0), (100, 0, 0)], step=4))

    _, eye = eyes(recording)
    assert eye[:2] == pytest.approx((50.0, 0.0))


def test_a_recording_is_called_like_the_world_that_was_loaded_last(recording):
    for title in ('demo', 'car'):
        recording.draw(frame(scene(), []), title=title)
    recording.close()

    names = [
        name
        for each in chunk.RrdReader(recording.path).stream()
        if each.entity_path == '/__properties'
        for column, values in each.to_record_batch().to_pydict().items()
        if column.endswith('RecordingInfo:name')
        for name in values
    ]
    assert names[-2:] == [['demo'], ['car']]


def test_an_empty_world_can_be_drawn(recording):
    recording.draw(frame(scene(), []), frame(scene(), [], step=4))

    assert len(eyes(recording)) == 2
