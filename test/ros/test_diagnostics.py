# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Diagnostics tell each second how the world does, and blame lateness on nothing else."""

from __future__ import annotations

import math
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import numpy as np
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.publishers.frame_statistics import FrameStatistics
from physsim_ros.simulation.world import World
import pytest

PERIOD = 1e9 / 60.0


def snapshot_of(bodies: int = 0, *, stamp: int = 0) -> Snapshot:
    world = World()
    for number in range(bodies):
        world.apply(
            Spawn(name=f'a/{number}', shape=Disc(radius=0.5), pose=(0.0, 2.0 + number, 0.0))
        )
    seen = world.snapshot()
    twists = np.tile([3.0, -4.0, 2.0], (bodies, 1))
    return Snapshot(step=0, stamp=stamp, scene=seen.scene, poses=seen.poses, twists=twists)


def report(
    meter: FrameStatistics, snapshot: Snapshot, *, speed: float = 1.0, late: int = 0
) -> DiagnosticArray:
    return meter.report(snapshot, speed=speed, late_frames=late, viewer='none', node='/it/physsim')


def values_of(array: DiagnosticArray) -> dict[str, str]:
    (status,) = array.status
    return {pair.key: pair.value for pair in status.values}


def run(meter: FrameStatistics, frames: int, *, pace: float = 1.0, began: float = 0.0) -> None:
    """Add frames at 60 Hz whose simulation time passes at a pace."""
    for frame in range(frames):
        meter.add(
            now_ns=round(began + frame * PERIOD),
            stamp=round(frame * PERIOD * pace),
            step_ns=2_000_000,
            frame_ns=3_000_000,
        )


@pytest.mark.parametrize('pace', [0.5, 1.0, 4.0])
def test_the_real_time_factor_comes_to_the_pace_of_time(pace: float) -> None:
    meter = FrameStatistics()
    run(meter, 600, pace=pace)
    # After ten of its smoothing times a twentieth of a thousandth is missing.
    assert meter.real_time_factor == pytest.approx(pace, rel=1e-4)


def test_the_real_time_factor_of_a_paused_world_is_0() -> None:
    meter = FrameStatistics()
    run(meter, 600)
    meter.reset_pace()
    assert meter.real_time_factor == 0.0
    # The pause itself does not count as slow.
    run(meter, 600, began=1e15)
    assert meter.real_time_factor == pytest.approx(1.0, rel=1e-4)


def test_a_report_tells_of_the_second_that_has_passed() -> None:
    meter = FrameStatistics()
    run(meter, 60)
    values = values_of(report(meter, snapshot_of(2)))
    assert values['bodies'] == '2'
    assert values['frames'] == '60'
    # ms
    assert float(values['step cost [ms]']) == 2.0
    assert float(values['frame cost [ms]']) == 3.0
    values = values_of(report(meter, snapshot_of(2)))
    assert (values['frames'], float(values['step cost [ms]'])) == ('0', 0.0)


def test_a_report_tells_energy_and_momentum() -> None:
    values = values_of(report(FrameStatistics(), snapshot_of(2)))
    mass = math.pi / 4
    kinetic = 2 * (mass * 25.0 / 2 + mass * 0.5**2 / 2 * 2.0**2 / 2)
    # J, kg m/s; six digits are told
    assert float(values['kinetic energy [J]']) == pytest.approx(kinetic, rel=1e-5)
    assert float(values['potential energy [J]']) == pytest.approx(mass * 9.81 * 5.0, rel=1e-5)
    momentum = [float(each) for each in values['momentum [kg m/s]'].split(', ')]
    assert momentum == pytest.approx([6.0 * mass, -8.0 * mass], rel=1e-5)


def test_a_report_is_stamped_with_simulation_time() -> None:
    stamp = report(FrameStatistics(), snapshot_of(stamp=12_345_678_901)).header.stamp
    assert (stamp.sec, stamp.nanosec) == (12, 345_678_901)


def test_late_frames_are_a_warning_in_the_second_in_which_they_come() -> None:
    meter = FrameStatistics()
    levels = []
    for late in (0, 5, 5, 7, 7):
        run(meter, 60)
        (status,) = report(meter, snapshot_of(), late=late).status
        levels.append(status.level)
        assert (str(late) in values_of(report(meter, snapshot_of(), late=late)).values()) is True
    ok, warn = DiagnosticStatus.OK, DiagnosticStatus.WARN
    assert levels == [ok, warn, ok, warn, ok]


def test_a_paused_world_says_so() -> None:
    (status,) = report(FrameStatistics(), snapshot_of(), speed=0.0).status
    assert status.message == 'paused'
    assert status.level == DiagnosticStatus.OK


def test_a_world_without_bodies_has_its_diagnostics_too() -> None:
    values = values_of(report(FrameStatistics(), snapshot_of()))
    assert values['bodies'] == '0'
    assert float(values['kinetic energy [J]']) == 0.0


def test_a_world_far_behind_is_an_error_and_tells_the_factor_of_that_second() -> None:
    meter = FrameStatistics()
    run(meter, 60, pace=0.3)
    array = report(meter, snapshot_of(), late=40)
    (status,) = array.status
    assert status.level == DiagnosticStatus.ERROR
    assert status.message.startswith('40 frames late, real-time factor 0.30')
    assert float(values_of(array)['real-time factor']) == pytest.approx(0.3, abs=1e-3)


@pytest.mark.parametrize(
    ('waiting', 'word'),
    [
        ({'message_delay': 3.2}, 'requests wait 3.2 s'),
        ({'undecodable': 7}, '7 messages cannot be decoded'),
        ({'failures': 2}, '2 unexpected errors'),
        ({'longest': ('~/walls', 0.31)}, '~/walls took 0.3 s'),
        ({'stopped_subscriber': True}, 'has stopped'),
    ],
)
def test_what_waits_is_a_warning_that_says_what_to_do(waiting: Any, word: str) -> None:
    meter = FrameStatistics()
    array = meter.report(
        snapshot_of(), speed=0.0, late_frames=0, viewer='none', node='/physsim', **waiting
    )
    (status,) = array.status
    assert status.level == DiagnosticStatus.WARN
    assert word in status.message


def test_a_recording_that_has_failed_is_a_warning_until_it_is_opened_again() -> None:
    meter = FrameStatistics()
    reports = [
        meter.report(
            snapshot_of(), speed=1.0, late_frames=0, viewer='', viewer_failure=why, node='/it'
        )
        for why in ('record: failed (no space)', '')
    ]

    (failed,), (well,) = (each.status for each in reports)
    assert failed.level == DiagnosticStatus.WARN
    assert 'no space' in failed.message
    assert well.level == DiagnosticStatus.OK
