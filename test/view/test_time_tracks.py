# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracks of time below the picture."""

from __future__ import annotations

from dataclasses import replace

from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.simulation import Simulation

from . import picture_file
from .picture_file import chunk, scene

EMPTY = scene()


def frame(speed, *topics):
    answers = tuple(Answer(topic=topic, message=f'by {topic}') for topic in topics)
    return picture_file.frame(EMPTY, [], answers=answers, speed=speed)


def states(recording, track, *batches):
    """Draw frames, and return what stands on a track: number of the frame, and state."""
    for frames in batches:
        recording.draw(*frames)
    rows = recording.rows(f'time/{track}', 'StateChange:state')
    return [(row.frame, str(row.value[0])) for row in rows]


def test_each_change_of_the_run_state_stands_once(recording):
    speeds = [1.0, 1.0, 0.0, 0.0, -1.0, -4.0, -4.0, 4.0, 1.0]
    assert states(recording, 'run', [frame(speed) for speed in speeds]) == [
        (0, 'play'), (2, 'pause'), (4, 'back'), (5, 'fast back'), (7, 'fast'), (8, 'play')
    ]  # fmt: skip


def colors_of_states(recording):
    """Return the colours of the states of the run, by state."""
    (batch,) = (
        each.to_record_batch()
        for each in chunk.RrdReader(recording.path).stream()
        if each.entity_path == '/time/run' and each.is_static
    )
    columns = {name.rpartition(':')[2]: batch[name].to_pylist()[0] for name in batch.schema.names}
    return dict(zip(columns['values'], columns['colors'], strict=True))


def test_every_speed_is_a_state_that_has_a_colour_and_the_faster_is_darker(recording):
    speeds = [-64.0, -4.0, -1.001, -1.0, -0.1, 0.0, 0.1, 0.999, 1.0, 3.0, 64.0]
    rows = states(recording, 'run', [frame(speed) for speed in speeds])
    names = [state for _, state in rows]
    assert names == ['fast back', 'back', 'slowly back', 'pause', 'slow', 'play', 'fast']
    colors = colors_of_states(recording)
    # Of red, green and blue, a byte each, before alpha.
    light = [sum((colors[state] >> 8 * byte) & 255 for byte in (1, 2, 3)) for state in names]
    assert light[0] < light[1] < light[2]
    assert light[4] > light[5] > light[6]


def test_a_state_goes_on_from_one_batch_to_the_next(recording):
    rows = states(recording, 'run', [frame(1.0)] * 3, [frame(1.0)] * 3, [frame(0.0)])
    assert rows == [(0, 'play'), (6, 'pause')]


def test_courses_have_the_numbers_of_the_world(recording):
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = [sim.advance_frame() for _ in range(10)]
    for number in (2, 3):
        sim.seek(100_000_000)
        sim.requests.submit(Spawn(name=f'ball/{number}', shape=Disc(radius=0.1)), topic='~/spawn')
        frames.append(sim.advance_frame())
    sim.return_to_course(2)
    frames.append(sim.advance_frame())
    assert sim.status.course == 2
    courses = states(recording, 'course', frames)
    assert [state for _, state in courses] == ['1', '2', '3', '2']


def test_the_last_change_stays_until_the_next_and_one_that_is_alike_is_told_again(recording):
    topics = ('~/spawn', '~/undo', '~/speed', '~/undo', '~/seek', 'branch', 'history')
    frames = [frame(1.0, topic) for topic in topics]
    settings = replace(EMPTY.settings, damping=0.5, iterations=20)
    damped = replace(frames[0].snapshot, scene=replace(EMPTY, settings=settings))
    changes = states(recording, 'last_change', [*frames, replace(frames[0], snapshot=damped)])
    assert changes == [(1, 'undo'), (3, 'undo'), (5, 'branch'), (7, 'damping, iterations')]


def test_past_and_present_stand_where_they_begin(recording):
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = []
    for tick in range(40):
        if tick in {10, 15}:
            sim.speed = -sim.speed
        frames += sim.advance(tick * 16_666_667)
    rows = states(recording, 'past', frames)
    assert [state for _, state in rows] == ['present', 'past', 'present']
    # A world that is loaded begins anew: there is nothing after it.
    sim.begin(sim.world.save())
    assert not sim.advance_frame().past
