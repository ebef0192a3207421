# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The recording holds what happened, once, and for as long as it lasts."""

from __future__ import annotations

from physsim_ros.model.answer import Answer
from physsim_ros.model.shapes import Disc, Polygon
from physsim_ros.view.recording import REPEAT
from physsim_ros.view.scenery import Scenery
import pytest
import rerun as rr

from .picture_file import body, chunk, frame, scene, STEP_NS


def test_what_has_been_deleted_is_cleared(recording):
    with_box, without = (
        scene(body(), body('disc/0', Disc(radius=1.0))),
        scene(body('disc/0', Disc(radius=1.0))),
    )

    recording.draw(frame(with_box, [(0, 0, 0), (1, 0, 0)]), frame(without, [(1, 0, 0)], step=4))

    (cleared,) = recording.rows('world/bodies/box/0', 'Clear:is_recursive')
    assert cleared.frame == 1
    assert len(recording.poses('disc/0')[-1].value) == 1
    assert recording.rows('world/bodies/disc/0', 'Clear:is_recursive') == []


def test_the_recorded_time_goes_on_while_the_world_goes_back(recording):
    box = scene(body())

    # A picture does not change as the next one is drawn.
    for batch in ((0, 4, 8), (4, 0), (4,)):
        recording.draw(*(frame(box, [(step, 0, 0)], step=step) for step in batch))

    rows = recording.poses('box/0')
    assert [row.frame for row in rows] == [0, 1, 2, 3, 4, 5]
    assert [row.stamp for row in rows] == [step * STEP_NS for step in (0, 4, 8, 4, 0, 4)]
    assert [row.value[0, 0] for row in rows] == [0, 4, 8, 4, 0, 4]


def test_geometry_is_sent_with_the_scene_and_again_now_and_then(recording):
    box = scene(body())
    frames = [frame(box, [(step, 0, 0)], step=4 * step) for step in range(round(60 * REPEAT) + 10)]

    for first in range(0, len(frames), 60):
        end = first + 60
        recording.draw(*frames[first:end])

    rows = recording.rows('world/bodies/box/0', 'Mesh3D:vertex_positions')
    assert [row.frame for row in rows] == [0, 60 * REPEAT]


def test_what_rests_is_not_sent_again(recording):
    ground = body('ground/0', Polygon(outline=((0, 0), (9, 0), (0, 1))), anchored=True)
    both = scene(body(), ground)

    recording.draw(frame(both, [(0, 5, 0), (0, 0, 0)]))
    recording.draw(frame(both, [(0, 4, 0), (0, 0, 0)], step=4))

    assert len(recording.poses('box/0')) == 2
    assert len(recording.poses('ground/0')) == 1


def test_an_anchored_body_that_is_put_elsewhere_is_drawn_there(recording):
    ground = scene(body(anchored=True))

    recording.draw(frame(ground, [(0, 0, 0)]))
    recording.draw(frame(ground, [(2, 0, 0)], step=4))

    assert recording.poses('box/0')[-1].value[0, 0] == 2


def test_a_paused_world_adds_nothing(recording):
    paused = frame(scene(body()), [(0, 0, 0)], stepped=False)

    recording.draw(*[paused] * 5)
    recording.draw(*[paused] * 5)

    assert len(recording.poses('box/0')) == 1


def test_what_happens_to_a_paused_world_is_drawn(recording):
    box = scene(body())
    paused = frame(box, [(0, 0, 0)], stepped=False)
    moved_by_hand = frame(box, [(1, 0, 0)], stepped=False)
    told = frame(box, [(1, 0, 0)], stepped=False, answers=(Answer(topic='~/spawn', message='no'),))

    recording.draw(paused, moved_by_hand, told)

    assert [row.frame for row in recording.rows('events', 'TextLog:text')] == [2]
    assert recording.poses('box/0')[-1].value[0, 0] == 1


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


def test_a_world_is_as_large_in_the_picture_wherever_it_lies():
    units = []
    for x, y in ((0.0, 0.0), (-70.0, 50.0), (30.0, -90.0)):
        scenery = Scenery(rr.RecordingStream('test'))
        two = scene(body(), body('disc/0', Disc(radius=1.0)))
        scenery.aim(frame(two, [(x, y, 0.0), (x + 4.0, y + 1.0, 0.0)]).snapshot)
        units.append(scenery.unit)

    assert units == pytest.approx([units[0]] * 3)


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
