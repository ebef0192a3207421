# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The track of time below the picture."""

from __future__ import annotations

from physsim_ros.simulation.simulation import Simulation

from . import picture_file
from .picture_file import chunk, scene

EMPTY = scene()


def frame(speed):
    return picture_file.frame(EMPTY, [], speed=speed)


def states(recording, *batches):
    """Draw frames, and return what stands on the track: number of the frame, and state."""
    for frames in batches:
        recording.draw(*frames)
    rows = recording.rows('time/run', 'StateChange:state')
    return [(row.frame, str(row.value[0])) for row in rows]


def test_each_change_of_the_run_state_stands_once(recording):
    speeds = [1.0, 1.0, 0.0, 0.0, -1.0, -4.0, -4.0, 4.0, 1.0]
    assert states(recording, [frame(speed) for speed in speeds]) == [
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
    rows = states(recording, [frame(speed) for speed in speeds])
    names = [state for _, state in rows]
    assert names == ['fast back', 'back', 'slowly back', 'pause', 'slow', 'play', 'fast']
    colors = colors_of_states(recording)
    # Of red, green and blue, a byte each, before alpha.
    light = [sum((colors[state] >> 8 * byte) & 255 for byte in (1, 2, 3)) for state in names]
    assert light[0] < light[1] < light[2]
    assert light[4] > light[5] > light[6]


def test_a_state_goes_on_from_one_batch_to_the_next(recording):
    rows = states(recording, [frame(1.0)] * 3, [frame(1.0)] * 3, [frame(0.0)])
    assert rows == [(0, 'play'), (6, 'pause')]


def test_the_past_that_is_played_is_told(recording):
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = []
    for tick in range(40):
        if tick in {10, 15}:
            sim.speed = -sim.speed
        frames += sim.advance(tick * 16_666_667)
    rows = states(recording, frames)
    assert [state for _, state in rows] == ['play', 'back', 'past', 'play']
