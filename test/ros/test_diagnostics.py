# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Diagnostics tell each second how the world does, and blame lateness on nothing else."""

from __future__ import annotations

from collections.abc import Callable
import math

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.ros.frame_statistics import FrameStatistics
import pytest

from .messages import spoiled
from ..client import Client, stamp_of

PERIOD = 1e9 / 60.0
Tell = Callable[[], DiagnosticArray]


def run(statistics: FrameStatistics, frames: int, *, pace: float = 1.0, began: float = 0) -> None:
    """Add frames at 60 Hz whose simulation time passes at a pace."""
    for frame in range(frames):
        statistics.add(
            now_ns=round(began + frame * PERIOD),
            stamp=round(frame * PERIOD * pace),
            step_ns=2_000_000,
            frame_ns=3_000_000,
        )


@pytest.mark.parametrize('pace', [0.5, 1.0, 4.0])
def test_the_real_time_factor_comes_to_the_pace_of_time(pace: float) -> None:
    statistics = FrameStatistics()
    run(statistics, 600, pace=pace)
    # After ten of its smoothing times a twentieth of a thousandth is missing.
    assert statistics.real_time_factor == pytest.approx(pace, rel=1e-4)


def test_the_real_time_factor_of_a_paused_world_is_0() -> None:
    statistics = FrameStatistics()
    run(statistics, 600)
    statistics.reset_pace()
    assert statistics.real_time_factor == 0.0
    # The pause itself does not count as slow.
    run(statistics, 600, began=1e15)
    assert statistics.real_time_factor == pytest.approx(1.0, rel=1e-4)


@pytest.fixture
def tell(client: Client) -> Tell:
    """Give a function that has a second go by, and returns what was published of it."""
    node, seconds = client.physsim.node, 0
    received = client.listen(DiagnosticArray, '/diagnostics')
    client.physsim.step()

    def next_second() -> DiagnosticArray:
        nonlocal seconds
        seconds += 1
        node.diagnostics.publish_due(seconds * 1_000_000_000)
        client.spin_until(lambda: len(received) == seconds)
        return received[-1]

    return next_second


def values_of(array: DiagnosticArray) -> dict[str, str]:
    (status,) = array.status
    assert (status.name, status.hardware_id) == ('physsim: world', '/physsim')
    return {pair.key: pair.value for pair in status.values}


def test_a_second_is_told_with_its_frames_and_the_energy_of_the_world(
    client: Client, tell: Tell
) -> None:
    node = client.physsim.node
    values = values_of(tell())
    assert (values['bodies'], float(values['kinetic energy [J]'])) == ('0', 0.0)
    for number in range(2):
        node.simulation.perform(
            Spawn(
                name=f'a/{number}',
                shape=Disc(radius=0.5),
                pose=(0.0, 2.0 + 3 * number, 0.0),
                properties=Properties(velocity=(3.0, -4.0), spin=2.0),
            )
        )
    node.loop.apply_requests()
    run(node.outputs.statistics, 60, pace=0.9)
    array = tell()
    assert stamp_of(array) == node.frame.snapshot.stamp > 0
    values = values_of(array)
    assert (values['bodies'], values['frames'], values['speed']) == ('2', '60', '1')
    assert 'viewer' in values
    # ms
    assert float(values['step cost [ms]']) == 2.0
    assert float(values['frame cost [ms]']) == 3.0
    assert float(values['real-time factor']) == pytest.approx(0.9, abs=1e-3)
    mass = math.pi / 4
    kinetic = 2 * (mass * 25.0 / 2 + mass * 0.5**2 / 2 * 2.0**2 / 2)
    # J, kg m/s; six digits are told
    assert float(values['kinetic energy [J]']) == pytest.approx(kinetic, rel=1e-5)
    assert float(values['potential energy [J]']) == pytest.approx(mass * 9.81 * 7.0, rel=1e-5)
    momentum = [float(each) for each in values['momentum [kg m/s]'].split(', ')]
    assert momentum == pytest.approx([6.0 * mass, -8.0 * mass], rel=1e-5)
    values = values_of(tell())
    assert (values['frames'], float(values['step cost [ms]'])) == ('0', 0.0)


def test_late_frames_are_told_in_the_second_in_which_they_come(client: Client, tell: Tell) -> None:
    clock, levels = client.physsim.node.simulation.playback.clock, []
    for late in (0, 5, 5, 7, 7):
        clock.late_frames = late
        run(client.physsim.node.outputs.statistics, 60)
        array = tell()
        levels.append(array.status[0].level)
        assert values_of(array)['late frames'] == str(late)
    ok, warn = DiagnosticStatus.OK, DiagnosticStatus.WARN
    assert levels == [ok, warn, ok, warn, ok]
    # Far behind
    clock.late_frames = 47
    run(client.physsim.node.outputs.statistics, 60, pace=0.3)
    (status,) = tell().status
    assert status.level == DiagnosticStatus.ERROR
    assert status.message.startswith('40 frames late, real-time factor 0.30')


def test_a_paused_world_says_so(client: Client, tell: Tell) -> None:
    client.physsim.node.simulation.speed = 0.0
    (status,) = tell().status
    assert (status.message, status.level) == ('paused', DiagnosticStatus.OK)


@pytest.mark.parametrize(
    ('path', 'value', 'word'),
    [
        ('diagnostics.message_delay', 3.2, 'requests wait 3.2 s'),
        ('request_topics.undecodable', 7, '7 messages cannot be decoded'),
        ('boundary.failures', 2, '2 unexpected errors'),
        ('outputs.publishers.events.stopped', True, 'a subscriber of ~/events has stopped'),
    ],
)
def test_what_is_amiss_is_a_warning_that_says_what_to_do(
    client: Client, tell: Tell, path: str, value: object, word: str
) -> None:
    spoiled(client.physsim.node, path, value)
    (status,) = tell().status
    assert status.level == DiagnosticStatus.WARN
    assert status.message.startswith(word)


def test_a_message_that_takes_long_is_named(
    client: Client, tell: Tell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client.physsim.node.boundary, 'take_longest', lambda: ('~/walls', 0.31))
    array = tell()
    assert array.status[0].message.startswith('~/walls took 0.3 s')
    assert values_of(array)['longest message [ms]'] == '310.0 ~/walls'


def test_a_viewer_that_has_failed_is_told(
    client: Client, tell: Tell, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer = type(client.physsim.node.outputs.viewer)
    with monkeypatch.context() as patch:
        patch.setattr(viewer, 'failure', property(lambda _: 'record: failed (no space)'))
        (failed,) = tell().status
    (well,) = tell().status
    assert (failed.level, well.level) == (DiagnosticStatus.WARN, DiagnosticStatus.OK)
    assert 'no space' in failed.message


def test_a_late_subscriber_is_told_of_the_last_second_and_not_of_all_before(
    client: Client,
) -> None:
    node = client.physsim.node
    client.physsim.step()
    clock, statistics = node.simulation.playback.clock, node.outputs.statistics
    clock.late_frames = 900
    run(statistics, 600)
    node.diagnostics.publish_due(1_000_000_000)
    received = client.listen(DiagnosticArray, '/diagnostics')
    clock.late_frames = 903
    run(statistics, 60)
    node.diagnostics.publish_due(2_000_000_000)
    client.spin_until(lambda: bool(received))
    values = values_of(received[-1])
    told = [values[key] for key in ('frames', 'late frames', 'late frames in this second')]
    assert told == ['60', '903', '3']
