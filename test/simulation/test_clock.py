# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Steps follow a steady time that is handed in; none is skipped, and what is late is counted."""

import random

from physsim_ros.simulation.clock import Clock, LATEST
import pytest

SECOND = 1_000_000_000
# Steps a frame at 240 Hz of physics and 60 Hz of frames.
FRAME = 4
# Frames by which simulation time may be late.
MOST_BEHIND = round(60 * LATEST)


class Run:
    """A clock that was asked once, and a world that makes the steps that are due from then on."""

    def __init__(self, speed: float, *, step: int = 0, frame: int = FRAME) -> None:
        self.clock = Clock(physics_rate=240.0, frame_steps=frame, speed=speed)
        self.step = step
        self.now = 7 * SECOND
        self.frames: list[int] = []
        # Nothing is due at first.
        assert self.at(0.0) == 0

    def at(self, now: float) -> int:
        """Ask once at a time [s] and make the steps; return how many they were."""
        self.now = 7 * SECOND + round(now * SECOND)
        due = self.clock.due(self.now, self.step)
        self.step += due
        if due:
            self.frames.append(self.step)
        return due

    def periods(self, count: int, *, since: float = 0.0, jitter: float = 0.0) -> None:
        """Ask once a publish period, now and then early or late by a share of it."""
        rng = random.Random(1)
        for number in range(1, count + 1):
            self.at(since + (number + rng.uniform(-jitter, jitter)) / 60.0)


@pytest.mark.parametrize('speed', [1.0, 2, 16.0, 64.0])
@pytest.mark.parametrize('jitter', [0.0, 0.1, 0.49])
def test_whole_speeds_end_each_frame_on_the_same_multiples_whatever_the_jitter(speed, jitter):
    run = Run(speed)

    run.periods(600, jitter=jitter)

    quota = round(FRAME * speed)
    assert run.frames == list(range(quota, 600 * quota + 1, quota))
    assert run.clock.late_frames == 0


def test_asking_more_often_gives_no_more_steps():
    run = Run(1.0)
    for number in range(601):
        run.at(number / 600.0)

    assert run.step == pytest.approx(240, abs=FRAME)
    assert all(step % FRAME == 0 for step in run.frames)


@pytest.mark.parametrize('speed', [0.001, 0.01, 0.04, 0.1, 0.25, 0.5, 0.9, 1.5, 2.5, 63.7])
def test_fractional_speeds_keep_time_to_a_step(speed):
    run = Run(speed)

    for number in range(1, 3001):
        run.at(number / 60.0)
        # Never ahead, and behind by less than a step but for the last bit of a product.
        exact = number * FRAME * speed
        assert exact - 1.001 <= run.step <= exact + 1e-6

    assert run.clock.late_frames == 0


def test_a_paused_world_takes_no_steps_and_goes_on_without_a_jump():
    run = Run(1.0)
    run.periods(10)

    run.clock.speed = 0.0
    assert [run.at(10 / 60 + second) for second in range(1, 100)] == [0] * 99
    run.clock.speed = 1.0
    # The first call nails the time line down; nothing of the pause is made up for.
    assert run.at(200.0) == 0
    run.periods(10, since=200.0)

    assert run.step == 20 * FRAME
    assert run.clock.late_frames == 0


@pytest.mark.parametrize(('before', 'after'), [(1.0, 4.0), (4.0, 1.0), (0.5, 2.0), (1.0, 0.5)])
def test_a_change_of_speed_counts_from_then_on(before, after):
    run = Run(before)
    run.periods(60)
    at_change = run.step

    run.clock.speed = after
    run.at(1.0)
    run.periods(60, since=1.0)

    assert at_change == pytest.approx(240 * before, abs=1)
    # Within a frame: whole speeds first go on to a multiple.
    assert run.step - at_change == pytest.approx(240 * after, abs=FRAME)
    assert run.clock.late_frames == 0


@pytest.mark.parametrize('step', [1, 2, 3])
def test_a_whole_speed_goes_on_to_a_multiple_and_stays_there(step):
    run = Run(1.0, step=step)

    run.periods(100, jitter=0.4)

    assert run.frames == list(range(FRAME, 100 * FRAME + 1, FRAME))


def test_a_restart_forgets_what_was_due():
    run = Run(1.0)

    run.clock.restart()

    assert run.at(0.05) == 0
    assert run.at(0.05 + 1 / 60) == FRAME
    assert run.clock.late_frames == 0


@pytest.mark.parametrize('speed', [0.5, 1.0, 2.5])
@pytest.mark.parametrize('behind', [2, MOST_BEHIND, MOST_BEHIND + 1, 1000])
def test_a_call_makes_a_frame_at_most_however_late_it_is(speed, behind):
    assert Run(speed).at(behind / 60.0) == FRAME * speed


@pytest.mark.parametrize('speed', [1.0, 4.0, 0.5, 2.5])
@pytest.mark.parametrize('gap', [7, 10, 60, 1000])
def test_what_is_too_late_is_counted_and_time_slows_down(speed, gap):
    run = Run(speed)
    run.periods(4)

    # A bit more than that many periods pass, and then all is well again.
    late = 4.01 + gap
    run.at(late / 60.0)
    run.at(late / 60.0)
    for number in range(1, 61):
        run.at((late + number) / 60.0)

    # Each period that has passed has a frame, or is counted as late; none is both, none neither.
    assert run.clock.late_frames == gap - 1
    made = (4 + 1 + 60) * FRAME * speed
    # At fractional speeds what is due is rounded down to steps, before the gap and after it.
    assert run.step == pytest.approx(made, abs=0 if speed.is_integer() else 2)


@pytest.mark.parametrize('frame', [1, 2, FRAME, 8])
def test_up_to_the_limit_nothing_is_late_at_any_publish_rate(frame):
    run = Run(1.0, frame=frame)

    for _ in range(240):
        run.at(LATEST)

    assert run.clock.late_frames == 0
    assert run.step == 240 * LATEST


def test_a_machine_that_is_too_slow_for_good_gives_all_steps_later():
    run = Run(1.0)
    # Each frame takes two periods.
    for number in range(1, 501):
        run.at(2.0 * number / 60.0)

    # Steps are all there, one frame after the other; half of the frames could not be made.
    assert run.frames == list(range(FRAME, 500 * FRAME + 1, FRAME))
    assert run.clock.late_frames == pytest.approx(500, abs=MOST_BEHIND + 1)


# Going back


@pytest.mark.parametrize('speed', [1.0, 4.0, 0.5, 64.0, 2.5])
@pytest.mark.parametrize('step', [0, 1, 1003])
def test_going_back_is_going_on_in_a_mirror(speed, step):
    onward, backward = (
        Clock(physics_rate=240.0, frame_steps=4, speed=each) for each in (speed, -speed)
    )
    ahead, behind = step, -step
    for tick in range(200):
        ahead += onward.due(tick * 16_666_667, ahead)
        behind += backward.due(tick * 16_666_667, behind)
        assert behind == -ahead
    assert ahead - step == pytest.approx(199 / 60 * 240 * speed, abs=8 * speed)
