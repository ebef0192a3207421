# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The status of the timeline on `~/timeline`, kept for late subscribers."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from physsim_ros.testing import command, delete, disc, PhysSim
import pytest

from ..client import Client, KEPT, set_parameter


def told(message: Any) -> dict[str, str]:
    return {'state': message.message} | {pair.key: pair.value for pair in message.values}


def test_a_late_subscriber_gets_the_last_status(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(disc('a/0'))
    messages = client.listen(DiagnosticStatus, '~/timeline', KEPT)
    client.spin_until(lambda: messages)

    assert told(messages[-1]) == {
        'state': 'playing',
        'oldest': '0.000000',
        'now': '0.000000',
        'newest': '0.000000',
        'speed': '1',
        'course': '1',
        'undo': 'undo spawn a/0',
        'redo': '',
        'courses': '',
    }
    assert messages[-1].level == DiagnosticStatus.OK


def test_it_tells_the_state_the_course_and_what_can_be_undone(
    physsim: PhysSim, client: Client
) -> None:
    messages = client.listen(DiagnosticStatus, '~/timeline', KEPT)
    physsim.spawn(disc('a/0'))
    physsim.run(1.0)
    client.call('~/pause')
    client.catch_up()
    status = told(messages[-1])
    assert (status['state'], status['now'], status['newest']) == ('paused', '1.000000', '1.000000')

    physsim.seek(0.5)
    assert told(messages[-1])['state'] == 'in the past'
    physsim.command(command('a/0', twists=[(1.0, 0.0, 0.0)]))
    status = told(messages[-1])
    assert (status['state'], status['course'], status['undo']) == (
        'paused',
        '2',
        'undo set motion of a/0',
    )
    assert status['courses'] == '1:0.500000:1.000000'
    client.call('~/undo')
    client.catch_up()
    status = told(messages[-1])
    assert (status['undo'], status['redo']) == ('undo spawn a/0', 'redo set motion of a/0')
    physsim.spawn(delete('a/0'))
    assert told(messages[-1])['redo'] == ''


def test_a_shorter_history_is_told_while_time_is_paused(physsim: PhysSim, client: Client) -> None:
    messages = client.listen(DiagnosticStatus, '~/timeline', KEPT)
    physsim.spawn(disc('a/0'))
    physsim.run(1.0)
    client.call('~/pause')
    physsim.node.loop.apply_requests()
    set_parameter(physsim, 'history', 0.2)
    client.catch_up()
    status = told(messages[-1])
    assert (status['oldest'], status['undo']) == ('0.800000', '')


def test_each_step_of_a_paused_world_is_told(physsim: PhysSim, client: Client) -> None:
    messages = client.listen(DiagnosticStatus, '~/timeline', KEPT)
    client.call('~/pause')
    for _ in range(3):
        client.call('~/step')
        client.catch_up()

        assert float(told(messages[-1])['now']) == pytest.approx(physsim.time, abs=1e-6)
    assert physsim.time == pytest.approx(3 / 60)


def test_times_of_a_running_world_come_some_times_a_second(
    physsim: PhysSim, client: Client
) -> None:
    messages = client.listen(DiagnosticStatus, '~/timeline', KEPT)
    client.spin_until(lambda: messages)
    before = len(messages)
    physsim.run(1.0)

    times = [told(message)['now'] for message in messages[before:]]
    # Four a second of 60 frames.
    assert len(times) == 4
    assert sorted(times) == times
