# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rewinding: frames as they were shown, and steps that are simulated again in time for them."""

import numpy as np
from physsim_ros.model.requests import Command
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import CHECKPOINTS
import pytest

from .driven import Driven, dropped, FRAME, SECOND, told
from ..building import spawning


@pytest.mark.parametrize('speed', [-1.0, -4.0, -2.0, -64.0])
def test_rewinding_shows_every_frame_as_it_was(driven, speed):
    head = driven.simulation.step
    frames = driven.run(speed, 1.0)
    steps = [frame.snapshot.step for frame in frames]
    # The first tick only says that it goes back from now on.
    assert steps == [max(0, head + number * round(speed) * FRAME) for number in range(len(steps))]
    assert len(steps) > 5
    for frame in frames:
        if frame.snapshot.step:
            driven.assert_same(frame)


def test_slow_motion_goes_back_step_by_step(driven):
    frames = driven.run(-0.1, 1.0)
    steps = [frame.snapshot.step for frame in frames]
    assert len(steps) == pytest.approx(24, abs=1)
    assert set(np.diff(steps)) == {-1}
    for frame in frames:
        if frame.snapshot.step % FRAME == 0:
            driven.assert_same(frame)


def made_by(driven: Driven, steps: list[int], ticks: int) -> list[int]:
    """Return the number of steps that all worlds make in each tick."""
    made = []
    for _ in range(ticks):
        steps.clear()
        driven.tick()
        made.append(sum(steps))
    return made


@pytest.mark.parametrize('speed', [-1.0, -0.5, -0.1, -2.0])
def test_no_tick_makes_many_steps_while_time_goes_back(steps, speed):
    driven = Driven()
    driven.record(9.0)
    # Of the last seconds nothing is known at first but the frames that were shown.
    driven.run(speed, 0.2)
    # Three seconds are made again while three seconds are shown.
    assert max(made_by(driven, steps, round(240 / -speed))) <= max(2.0, -2 * speed * FRAME)
    assert driven.simulation.step == pytest.approx(5 * 240, abs=100)


@pytest.mark.parametrize('on', [0.5, 2.5])
def test_what_a_seek_left_out_is_made_again_in_time(steps, on):
    driven = Driven()
    driven.record(12.0)
    driven.simulation.past.frames.drop_from(0)
    driven.simulation.seek(round(4.5 * SECOND))
    driven.apply_requests()
    driven.run(1.0, on)
    driven.run(-1.0, 0.05)
    # Three seconds are made again in the time from the seek on.
    assert max(made_by(driven, steps, round(60 * (on + 1.0)))) <= 3 * FRAME * CHECKPOINTS / on
    assert driven.simulation.step < 4 * 240


def test_where_frames_were_far_apart_no_others_are_made(steps):
    driven = Driven()
    driven.ask(spawning('a/0'))
    driven.run(16.0, 1.0)
    driven.simulation.speed = -16.0
    assert max(made_by(driven, steps, 55)) == 0
    assert driven.simulation.step < 2 * 240


def test_what_is_half_made_again_ends_no_earlier_than_time_has_come_since(driven):
    driven.simulation.past.frames.drop_from(0)
    driven.simulation.seek(round(4.8 * SECOND))
    driven.apply_requests()
    driven.run(1.0, 0.2)
    # Frames before the seek begin to be replayed, up to now.
    driven.run(-1.0, 0.05)
    driven.run(8.0, 0.1)
    frames = driven.run(-1.0, 1.0)
    assert frames[0].snapshot.step > 1300
    for frame in frames:
        if frame.snapshot.step in driven.shown:
            driven.assert_same(frame)


def test_at_the_oldest_step_time_stops_and_says_so(driven):
    frames = driven.run(-64.0, 1.0)
    assert frames[-1].snapshot.step == 0
    assert driven.simulation.speed == 0.0
    assert len(told(frames, 'history')) == 1
    again = driven.run(-1.0, 0.1)
    assert len(told(again, 'history')) == 1
    assert not any(frame.stepped for frame in again)
    assert driven.run(0.0, 0.5) == []


# Contacts


def test_contacts_of_the_past_are_those_shown_where_a_request_woke_bodies():
    driven, shown = Driven(), {}
    driven.simulation.reports_contacts = True
    for number in range(6):
        box, pose = Box(width=0.5, height=0.5), (number * 0.5 - 3.0, 0.25, 0.0)
        driven.ask(spawning(f'box/{number}', box, pose))
    driven.ask(spawning('ball/0', Disc(radius=0.3), (3.0, 2.0, 0.0)))

    def compare(speed, seconds):
        for frame in driven.run(speed, seconds):
            columns = frame.contacts.pairs, frame.contacts.points, frame.contacts.normals
            rows = sorted(map(tuple, np.column_stack(columns).round(6).tolist()))
            if frame.stepped:
                assert shown.setdefault(frame.snapshot.step, rows) == rows

    # The row is asleep, and the request wakes it.
    compare(1.0, 2.5)
    driven.ask(Command(names=('box/2',), twists=((0.0, 0.5, 0.0),)))
    driven.apply_requests()
    compare(1.0, 1.0)
    # Nothing that was shown is kept: the past is simulated again.
    driven.simulation.past.frames.drop_from(0)
    compare(-1.0, 3.4)
    assert driven.simulation.step < 40


@pytest.mark.parametrize('names', [('speed', 'reports_contacts'), ('reports_contacts', 'speed')])
def test_a_paused_world_has_the_contacts_of_its_last_steps_once_they_are_reported(names):
    simulation = dropped(height=0.5).simulation
    for _ in range(60):
        assert simulation.advance_frame().contacts is None
    step, digest = simulation.step, simulation.world.digest()

    for name in names:
        setattr(simulation, name, {'speed': 0.0, 'reports_contacts': True}[name])
        frame = simulation.apply_requests()

    assert frame.contacts.steps == simulation.frame_steps
    assert len(frame.contacts.pairs) == 1
    assert not frame.stepped
    assert (simulation.step, simulation.world.digest()) == (step, digest)
    simulation.reports_contacts = False
    assert simulation.apply_requests() is None
