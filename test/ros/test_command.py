# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A command on `~/command` sets poses, velocities and forces of the bodies it names."""

from __future__ import annotations

import math

from physsim_ros.testing import box, command, PhysSim

from ..client import Client, Event


def test_a_command_is_answered_once(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(3.0, 0.0)))
    (event,) = client.ask('~/command', command('a/0', twists=[(1, 0, 0)]))
    assert event == Event(0, '~/command', 'a/0', event.message, 'ok', '')
    assert event.message
    (event,) = client.ask('~/command', command('a/0', 'a/1', twists=[(1, 0, 0)] * 2))
    assert event == Event(0, '~/command', '', event.message, 'ok', '')
    (event,) = client.ask('~/command', command('z/0', twists=[(1, 0, 0)]))
    assert event == Event(2, '~/command', 'z/0', event.message, 'unknown_body', event.field)
    (event,) = client.ask('~/command', command('a/0', twists=[(math.nan, 0, 0)]))
    assert event == Event(2, '~/command', 'a/0', event.message, 'malformed', 'twist')


def test_a_command_without_arrays_changes_nothing(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    before = physsim.digest()
    assert physsim.command(command('a/0')) == 'a/0'
    assert physsim.digest() == before
