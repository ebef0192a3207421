# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracks of time below the picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.view.events import TimeTracks
from physsim_ros.view.frame_batch import Change, RecordedClock
import pytest

rr = pytest.importorskip('rerun')
chunk = pytest.importorskip('rerun.chunk')

NONE = np.empty((0, 3))
EMPTY = Scene(bodies=(), settings=WorldSettings())


def frame(speed: float, *topics: str) -> Frame:
    snapshot = Snapshot(step=0, stamp=0, scene=EMPTY, poses=NONE, twists=NONE)
    answers = tuple(Answer(topic=topic, message=f'by {topic}') for topic in topics)
    return Frame(snapshot=snapshot, contacts=None, answers=answers, speed=speed)


def drawn(path: Path, *batches: list[Frame]) -> dict[str, list[tuple[int, str]]]:
    """Draw frames, and return what stands in the recording: number and state by entity."""
    recording = rr.RecordingStream('test', recording_id='band')
    recording.save(path)
    track = TimeTracks(recording)
    clock = RecordedClock()
    for frames in batches:
        for batch in clock.batches(frames):
            track.send(batch, Change(1.0, False, False, NONE))
    recording.flush()
    recording.disconnect()
    states: dict[str, list[tuple[int, str]]] = {}
    for each in chunk.RrdReader(path).stream():
        if each.is_static:
            continue
        batch = each.to_record_batch()
        (column,) = (name for name in batch.schema.names if name.endswith('state'))
        states.setdefault(each.entity_path, []).extend(
            (round(at * 60e-9), state[0])
            for at, state in zip(
                batch['recorded'].cast('int64').to_pylist(), batch[column].to_pylist(), strict=True
            )
        )
    return {path: sorted(rows) for path, rows in states.items()}


def test_each_change_of_the_run_state_stands_once(tmp_path: Path) -> None:
    speeds = [1.0, 1.0, 0.0, 0.0, -1.0, -4.0, -4.0, 4.0, 1.0]
    rows = drawn(tmp_path / 'band.rrd', [frame(speed) for speed in speeds])
    assert [number for number, _ in rows['/time/run']] == [0, 2, 4, 5, 7, 8]
    states = [state for _, state in rows['/time/run']]
    assert states[0] == states[-1] == 'play'
    assert states[1] == 'pause'
    assert states[2] == 'back'
    assert states[3] == 'fast back'
    assert states[4] == 'fast'


def styles(path: Path) -> dict[str, int]:
    """Draw nothing, and return the colours of states that stand in the recording."""
    recording = rr.RecordingStream('test', recording_id='band')
    recording.save(path)
    TimeTracks(recording)
    recording.flush()
    recording.disconnect()
    (batch,) = (
        each.to_record_batch()
        for each in chunk.RrdReader(path).stream()
        if each.entity_path == '/time/run'
    )
    columns = {name.rpartition(':')[2]: batch[name].to_pylist()[0] for name in batch.schema.names}
    return dict(zip(columns['values'], columns['colors'], strict=True))


def test_every_speed_is_a_state_that_has_a_colour_and_the_faster_is_darker(
    tmp_path: Path,
) -> None:
    speeds = [-64.0, -4.0, -1.001, -1.0, -0.1, 0.0, 0.1, 0.999, 1.0, 3.0, 64.0]
    rows = drawn(tmp_path / 'band.rrd', [frame(speed) for speed in speeds])
    states = [state for _, state in rows['/time/run']]
    assert states == [
        'fast back', 'back', 'slowly back', 'pause',
        'slow', 'play', 'fast',
    ]  # fmt: skip
    colors = styles(tmp_path / 'styles.rrd')
    # Of red, green and blue, a byte each, before alpha.
    light = [sum((colors[state] >> 8 * byte) & 255 for byte in (1, 2, 3)) for state in states]
    assert light[0] < light[1] < light[2]
    assert light[4] > light[5] > light[6]


def test_a_state_goes_on_from_one_batch_to_the_next(tmp_path: Path) -> None:
    batches = [[frame(1.0)] * 3, [frame(1.0)] * 3, [frame(0.0)]]
    rows = drawn(tmp_path / 'band.rrd', *batches)
    assert [number for number, _ in rows['/time/run']] == [0, 6]


def test_courses_have_the_numbers_of_the_world(tmp_path: Path) -> None:
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = [sim.advance_frame() for _ in range(10)]
    for number in (2, 3):
        sim.seek(100_000_000)
        sim.requests.submit(Spawn(name=f'ball/{number}', shape=Disc(radius=0.1)), topic='~/spawn')
        frames.append(sim.advance_frame())
    sim.return_to_course(2)
    frames.append(sim.advance_frame())
    assert sim.status.course == 2
    courses = drawn(tmp_path / 'band.rrd', frames)['/time/course']
    assert [state for _, state in courses] == ['1', '2', '3', '2']


def test_the_last_change_stays_until_the_next_and_one_that_is_alike_is_told_again(
    tmp_path: Path,
) -> None:
    topics = ('~/spawn', '~/undo', '~/speed', '~/undo', '~/seek', 'branch', 'history')
    frames = [frame(1.0, topic) for topic in topics]
    settings = replace(EMPTY.settings, damping=0.5, iterations=20)
    damped = replace(frames[0].snapshot, scene=replace(EMPTY, settings=settings))
    rows = drawn(tmp_path / 'band.rrd', [*frames, replace(frames[0], snapshot=damped)])
    changes = rows['/time/last_change']
    assert changes == [(1, 'undo'), (3, 'undo'), (5, 'branch'), (7, 'damping, iterations')]


def test_past_and_present_stand_where_they_begin(tmp_path: Path) -> None:
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = []
    for tick in range(40):
        if tick in {10, 15}:
            sim.speed = -sim.speed
        frames += sim.advance(tick * 16_666_667)
    states = drawn(tmp_path / 'band.rrd', frames)['/time/past']
    assert [state for _, state in states] == ['present', 'past', 'present']
    # A world that is loaded begins anew: there is nothing after it.
    sim.begin(sim.world.save())
    assert not sim.advance_frame().past
