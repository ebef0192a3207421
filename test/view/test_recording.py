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

from contextlib import contextmanager
from dataclasses import dataclass, replace
import math
from pathlib import Path
import time

import numpy as np
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Triangles
from physsim_ros.model.snapshot import Answer, Contacts, Frame, Snapshot
from physsim_ros.view.recording import FrameRecorder, LINGER, REPEAT
import pytest

from ..rerun_program import free_port, is_open, rerun

rr = pytest.importorskip('rerun')
chunk = pytest.importorskip('rerun.chunk')

STEP_NS = 4_166_667
RED, BLUE = (0.8, 0.05, 0.1, 1.0), (0.1, 0.2, 0.8, 1.0)
# Rerun's own light on a surface that faces the camera, its lighting.wgsl.
LIT = 0.2 + 0.5 * 5 / math.sqrt(35)
# One in 255 from rounding to bytes, twice.
COLOR_TOLERANCE = 2 / 255
# Seconds for a viewer to start, and to show a recording, on a machine that is busy.
PATIENCE = 60.0
# float32 at a metre or ten.
TOLERANCE = 2e-6


def body(name='box/0', shape=None, color=RED, **changes):
    plain = Body(
        name=name,
        shape=shape or Box(width=2.0, height=1.0),
        color=color,
        mass=None,
        density=1.0,
        friction=0.5,
        elasticity=0.5,
        anchored=False,
        kinematic=False,
        group=0,
        sensor=False,
        expires=None,
    )
    return replace(plain, **changes)


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
    """What an entity was sent at a frame."""

    frame: int
    step: int
    stamp: int
    value: np.ndarray


class Recording:
    """A picture that is drawn into a file, and what the file then holds."""

    def __init__(self, path):
        self.path = path
        self._stream = rr.RecordingStream('test')
        self._stream.set_sinks(rr.FileSink(path))
        self.picture = FrameRecorder(self._stream)

    def draw(self, *frames, real_time_factor=1.0):
        self.picture.draw(frames, real_time_factor=real_time_factor)

    def close(self):
        self._stream.disconnect()

    def rows(self, entity, component):
        """Return all rows of a component, in the order of frames; no more can be drawn then."""
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
        return sorted(rows, key=lambda row: row.frame)

    def last(self, entity, component):
        """Return what a component is in the end."""
        return self.rows(entity, component)[-1].value


TIMELINES = ('frame', 'step', 'sim_time')


@pytest.fixture
def recording(tmp_path):
    it = Recording(tmp_path / 'picture.rrd')
    yield it
    it.close()


def seen(colors):
    """Return colours, (k, 4) 0 .. 1, as they are seen on a solid under Rerun's light."""
    level = unpack(colors)
    rgb = level[:, :3]
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4) * LIT
    level[:, :3] = np.where(
        linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055
    )
    return level


def unpack(colors):
    """Return packed colours as (k, 4) 0 .. 1."""
    packed = np.array(colors, dtype=np.uint32)
    return np.stack([(packed >> shift & 255) / 255 for shift in (24, 16, 8, 0)], axis=1)


def test_boxes_have_the_place_turn_size_and_colour_that_were_asked_for(recording):
    two = scene(body(), body('box/1', Box(width=0.5, height=3.0), BLUE))

    recording.draw(frame(two, [(1.0, 2.0, 0.0), (-3.0, 4.0, math.pi / 3)]))

    centers = recording.last('world/boxes', 'Boxes3D:centers')
    turns = recording.last('world/boxes', 'Boxes3D:quaternions')
    sizes = recording.last('world/boxes', 'Boxes3D:half_sizes')
    colors = seen(recording.last('world/boxes', 'Boxes3D:colors'))
    np.testing.assert_allclose(centers[:, :2], [(1.0, 2.0), (-3.0, 4.0)], atol=TOLERANCE)
    np.testing.assert_allclose(sizes[:, :2], [(1.0, 0.5), (0.25, 1.5)], atol=TOLERANCE)
    upright, turned = (0, 0, 0, 1), (0, 0, math.sin(math.pi / 6), math.cos(math.pi / 6))
    np.testing.assert_allclose(turns, [upright, turned], atol=TOLERANCE)
    np.testing.assert_allclose(colors, [RED, BLUE], atol=COLOR_TOLERANCE)


def test_discs_have_the_place_size_and_colour_that_were_asked_for(recording):
    recording.draw(frame(scene(body(shape=Disc(radius=0.7))), [(1.0, 2.0, 9.0)]))

    assert recording.last('world/discs', 'Cylinders3D:centers')[0, :2] == pytest.approx((1.0, 2.0))
    assert recording.last('world/discs', 'Cylinders3D:radii') == pytest.approx(0.7)
    colors = seen(recording.last('world/discs', 'Cylinders3D:colors'))
    np.testing.assert_allclose(colors, [RED], atol=COLOR_TOLERANCE)


def test_a_mark_on_a_disc_shows_that_it_rolls(recording):
    disc = scene(body(shape=Disc(radius=1.0)))

    recording.draw(frame(disc, [(0, 0, 0)]), frame(disc, [(0, 0, math.pi / 2)], step=4))

    first, second = recording.rows('world/marks', 'Boxes3D:centers')
    assert first.value[0, 1] == pytest.approx(0.0, abs=TOLERANCE)
    assert second.value[0, 0] == pytest.approx(0.0, abs=TOLERANCE)
    assert second.value[0, 1] == pytest.approx(first.value[0, 0])


@pytest.mark.parametrize(
    'shape',
    [
        Polygon(outline=((0, 0), (4, 0), (0, 2))),
        Polygon(outline=((0, 0), (2, 0), (2, 2), (1, 0.5))),
        Triangles(vertices=((0, 0), (1, 0), (0, 1), (2, 0), (3, 0), (2, -1))),
    ],
    ids=['ramp', 'concave', 'triangles'],
)
def test_polygons_are_filled_where_they_are(recording, shape):
    recording.draw(frame(scene(body(shape=shape)), [(5.0, 1.0, 0.4)]))

    corners = recording.last('world/polygons', 'Mesh3D:vertex_positions').reshape(-1, 3, 3)[
        ..., :2
    ]
    a, b, c = np.moveaxis(corners, 1, 0)
    areas = np.abs(np.linalg.det(np.stack((b - a, c - a), axis=2))) / 2
    assert areas.sum() == pytest.approx(shape.form.area, rel=1e-5)
    x, y = shape.form.centroid
    there = (5 + math.cos(0.4) * x - math.sin(0.4) * y, 1 + math.sin(0.4) * x + math.cos(0.4) * y)
    middle = (corners.mean(axis=1) * areas[:, None]).sum(axis=0) / areas.sum()
    assert middle == pytest.approx(there, rel=1e-5)


def test_polygons_have_the_colour_that_was_asked_for(recording):
    shape = Polygon(outline=((0, 0), (1, 0), (0, 1)))

    recording.draw(frame(scene(body(shape=shape)), [(0, 0, 0)]))

    # Meshes are not shaded.
    colors = unpack(recording.last('world/polygons', 'Mesh3D:vertex_colors'))
    np.testing.assert_allclose(colors, [RED] * 3, atol=COLOR_TOLERANCE)


def test_a_chain_is_bars_with_round_ends(recording):
    chain = Chain(points=((0, 0), (4, 0), (4, 3)), thickness=0.2)

    recording.draw(frame(scene(body(shape=chain)), [(1.0, 0.0, 0.0)]))

    bars = recording.last('world/boxes', 'Boxes3D:centers')[:, :2]
    ends = recording.last('world/discs', 'Cylinders3D:centers')[:, :2]
    np.testing.assert_allclose(bars, [(3, 0), (5, 1.5)], atol=TOLERANCE)
    assert {tuple(end) for end in ends.tolist()} == {(1, 0), (5, 0), (5, 3)}


def test_a_compound_turns_as_one(recording):
    compound = Compound(element=Box(width=0.2, height=0.2), centers=((-1, 0), (1, 0)))

    recording.draw(frame(scene(body(shape=compound)), [(0, 5, math.pi / 2)]))

    centers = recording.last('world/boxes', 'Boxes3D:centers')[:, :2]
    np.testing.assert_allclose(centers, [(0, 4), (0, 6)], atol=TOLERANCE)


def test_a_later_body_lies_above_an_earlier_one_and_its_mark_above_both(recording):
    discs = scene(body('a/0', Disc(radius=1.0)), body('a/1', Disc(radius=1.0)))

    recording.draw(frame(discs, [(0, 0, 0), (0.5, 0, 0)]))

    def tops(entity, centers, sizes):
        middle = recording.last(entity, centers)[:, 2]
        size = recording.last(entity, sizes)
        return middle + (size[:, 2] if size.ndim == 2 else size / 2)

    below, above = tops('world/discs', 'Cylinders3D:centers', 'Cylinders3D:lengths')
    mark_below, mark_above = tops('world/marks', 'Boxes3D:centers', 'Boxes3D:half_sizes')
    assert below < mark_below < above < mark_above


def test_an_anchored_body_bears_an_x(recording):
    recording.draw(frame(scene(body(anchored=True)), [(3.0, 4.0, 0.0)]))

    centers = recording.last('world/anchored/marks', 'Boxes3D:centers')
    turns = recording.last('world/anchored/marks', 'Boxes3D:quaternions')
    yaws = 2 * np.arctan2(turns[:, 2], turns[:, 3])
    np.testing.assert_allclose(centers[:, :2], [(3.0, 4.0)] * 2, atol=TOLERANCE)
    assert sorted(yaws) == pytest.approx([-math.pi / 4, math.pi / 4])


def test_the_x_of_a_concave_body_lies_on_the_body(recording):
    horseshoe = Polygon(outline=((0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)))

    recording.draw(frame(scene(body(shape=horseshoe, anchored=True)), [(0, 0, 0)]))

    (x, y, _), _ = recording.last('world/anchored/marks', 'Boxes3D:centers')
    assert y < 1 or not 1 < x < 3


def test_a_sensor_is_translucent_and_outlined_and_a_kinematic_body_outlined(recording):
    both = scene(body(sensor=True), body('box/1', kinematic=True))

    recording.draw(frame(both, [(0, 0, 0), (5, 0, 0)]))

    sensor, kinematic = unpack(recording.last('world/boxes', 'Boxes3D:colors'))
    assert sensor[3] < 0.5
    assert kinematic[3] == 1
    assert len(recording.last('world/outlines', 'Boxes3D:centers')) == 4 + 4


def test_the_walls_lie_just_outside_the_bounds(recording):
    recording.draw(frame(scene(bounds=(-10.0, 0.0, 10.0, 12.0)), []))

    centers = recording.last('world/walls', 'Boxes3D:centers')[:, :2]
    sizes = recording.last('world/walls', 'Boxes3D:half_sizes')[:, :2]
    floor, ceiling, left, right = np.hstack((centers - sizes, centers + sizes))
    assert floor[3] == pytest.approx(0.0, abs=1e-6)
    assert ceiling[1] == pytest.approx(12.0)
    assert left[2] == pytest.approx(-10.0)
    assert right[0] == pytest.approx(10.0)


def test_what_has_been_deleted_is_cleared(recording):
    with_box, without = (
        scene(body(), body('disc/0', Disc(radius=1.0))),
        scene(body('disc/0', Disc(radius=1.0))),
    )

    recording.draw(frame(with_box, [(0, 0, 0), (1, 0, 0)]), frame(without, [(1, 0, 0)], step=4))

    (cleared,) = recording.rows('world/boxes', 'Clear:is_recursive')
    assert cleared.frame == 1
    assert len(recording.last('world/discs', 'Cylinders3D:centers')) == 1
    assert recording.rows('world/discs', 'Clear:is_recursive') == []


def test_the_frame_timeline_goes_on_while_time_goes_back(recording):
    box = scene(body())

    for batch in ((0, 4, 8), (4, 0), (4,)):
        recording.draw(*(frame(box, [(step, 0, 0)], step=step) for step in batch))

    rows = recording.rows('world/boxes', 'Boxes3D:centers')
    assert [row.frame for row in rows] == [0, 1, 2, 3, 4, 5]
    assert [row.step for row in rows] == [0, 4, 8, 4, 0, 4]
    assert [row.stamp for row in rows] == [row.step * STEP_NS for row in rows]
    assert [row.value[0, 0] for row in rows] == [0, 4, 8, 4, 0, 4]


def test_what_was_drawn_does_not_change_with_what_is_drawn_next(recording):
    box = scene(body())

    for step in range(20):
        recording.draw(frame(box, [(step, 0, 0)], step=step))

    rows = recording.rows('world/boxes', 'Boxes3D:centers')
    assert [row.value[0, 0] for row in rows] == list(range(20))


def test_geometry_is_sent_with_the_scene_and_again_now_and_then(recording):
    box = scene(body())
    frames = [frame(box, [(step, 0, 0)], step=step) for step in range(REPEAT + 10)]

    for first in range(0, len(frames), 10):
        end = first + 10
        recording.draw(*frames[first:end])

    rows = recording.rows('world/boxes', 'Boxes3D:half_sizes')
    assert [row.frame for row in rows] == [0, REPEAT]


def test_what_rests_is_not_sent_again(recording):
    ground = body('ground/0', Polygon(outline=((0, 0), (9, 0), (0, 1))), anchored=True)
    both = scene(body(), ground)

    recording.draw(frame(both, [(0, 5, 0), (0, 0, 0)]))
    recording.draw(frame(both, [(0, 4, 0), (0, 0, 0)], step=4))

    assert len(recording.rows('world/boxes', 'Boxes3D:centers')) == 2
    assert len(recording.rows('world/anchored/polygons', 'Mesh3D:vertex_positions')) == 1


def test_an_anchored_body_that_is_put_elsewhere_is_drawn_there(recording):
    ground = scene(body(anchored=True))

    recording.draw(frame(ground, [(0, 0, 0)]))
    recording.draw(frame(ground, [(2, 0, 0)], step=4))

    assert recording.last('world/anchored/boxes', 'Boxes3D:centers')[0, 0] == 2
    assert recording.last('world/anchored/marks', 'Boxes3D:centers')[0, 0] == 2


def test_a_paused_world_adds_nothing(recording):
    paused = frame(scene(body()), [(0, 0, 0)], moved=False)

    recording.draw(*[paused] * 5)
    recording.draw(*[paused] * 5)

    assert len(recording.rows('world/boxes', 'Boxes3D:centers')) == 1


def test_what_happens_to_a_paused_world_is_drawn(recording):
    box = scene(body())
    paused = frame(box, [(0, 0, 0)], moved=False)
    moved_by_hand = frame(box, [(1, 0, 0)], moved=False)
    told = frame(box, [(1, 0, 0)], moved=False, answers=(Answer(topic='~/spawn', message='no'),))

    recording.draw(paused, moved_by_hand, told)

    assert [row.frame for row in recording.rows('events', 'TextLog:text')] == [2]
    assert recording.last('world/boxes', 'Boxes3D:centers')[0, 0] == 1


def test_every_answer_is_an_event_and_a_refusal_an_error(recording):
    answers = (
        Answer(topic='~/spawn', subject='box/0', message='spawned'),
        Answer(topic='~/pin', message='no body there', code='nothing_there'),
    )

    recording.draw(frame(scene(body()), [(0, 0, 0)], answers=answers))

    texts = [row.value.item() for row in recording.rows('events', 'TextLog:text')]
    levels = [row.value.item() for row in recording.rows('events', 'TextLog:level')]
    assert texts == ['~/spawn  box/0  spawned', '~/pin  no body there  [nothing_there]']
    assert levels == ['INFO', 'ERROR']


def test_energies_and_the_real_time_factor_are_plotted(recording):
    now = frame(scene(body()), [(0, 3, 0)])

    recording.draw(now, real_time_factor=0.5)

    kinetic, potential = now.snapshot.kinetic_energy, now.snapshot.potential_energy
    energies = recording.last('energy', 'Scalars:scalars')
    assert energies == pytest.approx([kinetic, potential, kinetic + potential])
    assert recording.last('real_time_factor', 'Scalars:scalars') == pytest.approx(0.5)


def test_contacts_are_points_as_long_as_they_last(recording):
    box = scene(body())
    point = np.array([[1.0, 2.0]])
    touching = Contacts(pairs=np.array([[0, -1]]), points=point, normals=point, impulses=point)
    none = np.empty((0, 2))
    apart = Contacts(pairs=none.astype(int), points=none, normals=none, impulses=none)

    for step, contacts in enumerate((apart, touching, apart, apart)):
        recording.draw(frame(box, [(step, 0, 0)], step=step, contacts=contacts))

    rows = recording.rows('world/contacts', 'Points3D:positions')
    assert [(row.frame, len(row.value)) for row in rows] == [(1, 1), (2, 0)]
    assert rows[0].value[0, :2] == pytest.approx((1.0, 2.0))


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
    labels = recording.rows('world/preview/points', 'Points3D:labels')
    assert [[*row.value] for row in labels] == [['', 'wall'], []]


def test_the_reading_of_a_stroke_is_seen_for_a_while(recording):
    box, read = scene(body()), Preview(lines=(((0, 0), (3, 4)),), label='wall 90%')
    for step in range(LINGER + 2):
        recording.draw(frame(box, [(step, 0, 0)], step=step, preview=read))

    rows = recording.rows('world/preview/lines', 'LineStrips3D:strips')
    assert [(row.frame, len(row.value)) for row in rows] == [(0, 1), (LINGER, 0)]


def test_the_camera_stands_still_while_bodies_move(recording):
    one, two = scene(body()), scene(body(), body('box/1'))

    recording.draw(*(frame(one, [(step, 0, 0)], step=step) for step in range(20)))
    recording.draw(frame(two, [(0.5, 0, 0), (0, 0.5, 0)], step=20))

    first, second = eyes(recording)
    assert first == pytest.approx(second)


def test_the_camera_looks_at_the_bounds_and_follows_them(recording):
    recording.draw(frame(scene(bounds=(0.0, 0.0, 10.0, 4.0)), []))
    recording.draw(frame(scene(bounds=(100.0, 0.0, 300.0, 4.0)), [], step=4))

    first, second = eyes(recording)
    assert first[:2] == pytest.approx((5.0, 2.0))
    assert second[:2] == pytest.approx((200.0, 2.0))
    assert second[2] == pytest.approx(20 * first[2], rel=1e-5)


def test_the_camera_steps_back_for_bodies_that_are_far_outside(recording):
    near, far = scene(body()), scene(body(), body('box/1'))

    recording.draw(frame(near, [(0, 0, 0)]))
    recording.draw(frame(far, [(0, 0, 0), (100, 0, 0)], step=4))

    _, eye = eyes(recording)
    assert eye[:2] == pytest.approx((50.0, 0.0))


def test_an_empty_world_can_be_drawn(recording):
    recording.draw(frame(scene(), []), frame(scene(), [], step=4))

    assert len(eyes(recording)) == 2


def has_vulkan():
    return any(Path('/usr/share/vulkan/icd.d').glob('*.json'))


@contextmanager
def shown(path):
    """Give a connection to a viewer without a screen that shows a recording."""
    port = free_port()
    process = rerun(path, '--headless', f'--port={port}', '--window-size=1200x800')
    try:
        deadline = time.monotonic() + PATIENCE
        while not is_open(port) and time.monotonic() < deadline:
            pass
        yield rr.experimental.ViewerClient.connect(f'rerun+http://127.0.0.1:{port}/proxy')
    finally:
        process.kill()
        process.wait()


@pytest.mark.skipif(
    not has_vulkan(), reason='no Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1'
)
def test_on_the_screen_a_red_box_is_red_and_up_is_up(recording, tmp_path):
    image = pytest.importorskip('PIL.Image')
    picture = tmp_path / 'screen.png'
    red, blue = body(shape=Box(width=4.0, height=2.0)), body('box/1', color=BLUE)
    world = scene(red, blue, bounds=(-10.0, 0.0, 10.0, 12.0))
    recording.draw(frame(world, [(-5.0, 10.0, 0.0), (5.0, 2.0, 0.0)]))
    recording.close()

    with shown(recording.path) as viewer:
        deadline, before = time.monotonic() + PATIENCE, None
        while True:
            viewer.save_screenshot(str(picture))
            pixels = np.asarray(image.open(picture).convert('RGB')) / 255
            red_rows, red_columns = np.nonzero(np.abs(pixels - RED[:3]).max(axis=2) < 4 / 255)
            blue_rows, blue_columns = np.nonzero(np.abs(pixels - BLUE[:3]).max(axis=2) < 4 / 255)
            # It draws what has been read so far; two alike are all of it.
            count = len(red_rows), len(blue_rows)
            if (all(count) and count == before) or time.monotonic() > deadline:
                break
            before = count

    assert red_rows.mean() < blue_rows.mean()
    assert red_columns.mean() < blue_columns.mean()
    # 4 m by 2 m, and ten metres apart: to the pixel or two at an edge.
    width, height = np.ptp(red_columns) + 1, np.ptp(red_rows) + 1
    assert width / height == pytest.approx(2.0, rel=0.05)
    assert (blue_columns.mean() - red_columns.mean()) / width == pytest.approx(10 / 4, rel=0.05)
    # The whole of it, and nothing else.
    assert len(red_rows) == pytest.approx(width * height, rel=0.02)
