# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A frame that nobody reads is not made, and what is asked for later is as if all had been."""

import numpy as np
from physsim_ros.model.requests import Configure
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation
import pytest

from .driven import FLOOR, SECOND
from ..building import DISC, spawning
from ..laws.scenes import join

# Frames after which somebody reads again.
AWAY = 40


def bouncing(**options: float) -> Simulation:
    """Return discs that fall and bounce, with contacts, a checkpoint every half a second."""
    simulation = Simulation(settings=FLOOR, checkpoints=0.5, **options)
    simulation.reports_contacts = True
    for number in range(4):
        disc = spawning(f'disc/{number}', DISC, (0.3 * number, 0.5 * number + 0.6, 0.0))
        simulation.requests.submit(disc, topic='~/spawn')
    simulation.advance(0)
    return simulation


def ticked(simulation: Simulation, first: int, last: int) -> list[Frame]:
    """Return the frames of some ticks at the publish rate."""
    ticks = range(first, last + 1)
    return [frame for tick in ticks for frame in simulation.advance(tick * SECOND // 60)]


def same(one: Frame, other: Frame) -> bool:
    """Return whether two frames show the same; contacts are summed in the order of addresses."""
    mine, theirs = one.contacts, other.contacts
    return (
        one.snapshot.stamp == other.snapshot.stamp
        and np.array_equal(one.snapshot.poses, other.snapshot.poses)
        and np.array_equal(one.snapshot.twists, other.snapshot.twists)
        and mine.steps == theirs.steps
        and np.array_equal(mine.pairs, theirs.pairs)
        and np.allclose(mine.impulses, theirs.impulses, rtol=1e-12, atol=1e-15)
        and np.allclose(mine.begun_at, theirs.begun_at, rtol=1e-12)
    )


@pytest.fixture
def read() -> Simulation:
    return bouncing()


@pytest.fixture
def unread() -> Simulation:
    simulation = bouncing()
    simulation.frames.is_read = False
    return simulation


def test_steps_are_made_and_frames_are_not(unread):
    assert ticked(unread, 1, AWAY) == []
    assert unread.step == AWAY * unread.frame_steps


@pytest.mark.parametrize('rate', [30.0, 60.0, 120.0])
def test_one_frame_a_second_is_made_for_those_who_come_late(rate):
    simulation = bouncing(publish_rate=rate)
    simulation.frames.is_read = False
    frames = ticked(simulation, 1, 3 * 60)
    assert [frame.snapshot.step for frame in frames] == [240, 480, 720]


def test_an_answer_comes_with_the_next_frame_read_or_not(unread):
    ticked(unread, 1, 3)
    unread.requests.submit(spawning('late/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    (frame,) = ticked(unread, 4, 6)
    assert [answer.subject for answer in frame.answers] == ['late/0']
    assert frame.snapshot.step == 4 * unread.frame_steps


def test_a_joint_that_breaks_makes_a_frame(unread):
    join(unread, 'rod/0', 'rod', [(0.9, 2.1), (0.9, 4.0)], a='disc/3', b='world', break_force=1e-3)
    frames = ticked(unread, 1, 3)
    assert 'joint_broken' in [answer.code for frame in frames for answer in frame.answers]


def test_a_body_whose_time_is_over_makes_a_frame(unread):
    short = spawning('short/0', DISC, (5.0, 9.0, 0.0), lifetime=0.1)
    unread.requests.submit(short, topic='~/spawn')
    spawned, gone = ticked(unread, 1, AWAY)
    assert 'short/0' in spawned.snapshot.scene.names
    assert 'short/0' not in gone.snapshot.scene.names
    assert gone.snapshot.step == 24


def test_a_reader_who_comes_late_has_the_frames_of_one_who_was_always_there(read, unread):
    ticked(read, 1, AWAY)
    ticked(unread, 1, AWAY)
    unread.frames.is_read = True
    for tick in range(AWAY + 1, AWAY + 30):
        (one,), (other,) = ticked(read, tick, tick), ticked(unread, tick, tick)
        assert same(one, other)
        assert np.array_equal(read.sensed.before.twists, unread.sensed.before.twists)
        assert read.sensed.before.stamp == unread.sensed.before.stamp
    assert read.world.digest() == unread.world.digest()


def test_a_rewind_through_unread_frames_shows_what_was_there(read, unread):
    shown = {frame.snapshot.step: frame for frame in ticked(read, 1, AWAY)}
    ticked(unread, 1, AWAY)
    unread.frames.is_read = True
    unread.speed = -1.0
    frames = ticked(unread, AWAY + 1, 2 * AWAY)
    assert len(frames) > AWAY / 2
    for frame in frames:
        if frame.snapshot.step in shown:
            assert same(frame, shown[frame.snapshot.step])


def test_a_pause_shows_the_last_step(unread):
    ticked(unread, 1, 7)
    unread.speed = 0.0
    (frame,) = ticked(unread, 8, 12)
    assert frame.snapshot.step == 7 * unread.frame_steps


def test_a_setting_that_changes_makes_a_frame(unread):
    unread.requests.submit(Configure(changes={'gravity': (0.0, 1.0)}), topic='~/gravity')
    (frame,) = ticked(unread, 1, 5)
    assert frame.snapshot.scene.settings.gravity == (0.0, 1.0)


def test_frames_that_pass_unread_leave_contacts_of_the_last_one_only(read, unread):
    for _ in range(AWAY):
        last = read.advance_frame()
    assert unread.ticks.pass_frames(AWAY - 1) is None
    assert same(unread.advance_frame(), last)
