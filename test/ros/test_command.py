# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A command on `~/command` sets poses, velocities and forces of the bodies it names."""

from __future__ import annotations

import math

from physsim_ros.testing import box, command, PhysSim, polygon
import pytest

from ..building import ELL
from ..client import Client, Event, set_parameter

G = 9.81


@pytest.fixture
def weightless(physsim: PhysSim) -> PhysSim:
    """Give a world without gravity."""
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    return physsim


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


def test_a_pose_may_be_relative_to_another_body(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', at=(1.0, 2.0, math.pi / 2)))
    physsim.spawn(box('a/1', at=(9.0, 0.0)))
    physsim.command(command('a/1', 'a/0', poses=[(2.0, 0.0, 0.1), (0.0, -1.0, 0.0)], frame='a/0'))
    # m, rad: both relative to where a/0 was before
    assert physsim.pose('a/1') == pytest.approx((1.0, 4.0, math.pi / 2 + 0.1), abs=1e-12)
    assert physsim.pose('a/0') == pytest.approx((2.0, 2.0, math.pi / 2), abs=1e-12)


def test_a_twist_is_taken_in_the_worlds_axes_whatever_the_frame(weightless: PhysSim) -> None:
    weightless.spawn(polygon('a/0', outline=ELL.outline, at=(1.0, 1.0, 2.0)))
    weightless.spawn(box('b/0', at=(9.0, 9.0, 1.0)))
    weightless.command(command('a/0', twists=[(3.0, -1.0, 0.5)], frame='b/0'))
    assert weightless.twist('a/0') == pytest.approx((3.0, -1.0, 0.5))
    before = weightless.node.simulation.world.snapshot().centers[0]
    weightless.run(1.0)
    after = weightless.node.simulation.world.snapshot().centers[0]
    # m
    assert after - before == pytest.approx((3.0, -1.0))


def test_pose_twist_and_wrench_may_come_together(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{mass: 2}'))
    message = command(
        'a/0', poses=[(1.0, 2.0, 0.0)], twists=[(3.0, 0.0, 0.0)], wrenches=[(0.0, 2 * G, 0.0)]
    )
    physsim.command(message)
    physsim.run(0.25)
    # m: the force carries it
    assert physsim.pose('a/0') == pytest.approx((1.75, 2.0, 0.0), abs=1e-9)
    assert physsim.twist('a/0') == pytest.approx((3.0, 0.0, 0.0), abs=1e-9)


def test_a_command_without_arrays_changes_nothing(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    before = physsim.digest()
    assert physsim.command(command('a/0')) == 'a/0'
    assert physsim.digest() == before


def test_a_wrench_ends_after_the_command_timeout(weightless: PhysSim) -> None:
    weightless.spawn(box('a/0', text='{mass: 2}'))
    weightless.command(command('a/0', wrenches=[(4.0, 0.0, 0.0)]))
    weightless.run(2.0)
    # m/s: half a second by default
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 0.5 / 2.0)
    set_parameter(weightless, 'command_timeout', 0.1)
    weightless.command(command('a/0', wrenches=[(4.0, 0.0, 0.0)]))
    weightless.run(2.0)
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 0.6 / 2.0)


def test_commands_are_carried_out_in_the_order_in_which_they_come(
    physsim: PhysSim, client: Client
) -> None:
    physsim.spawn(box('a/0'))
    for number in range(50):
        client.publish('~/command', command('a/0', poses=[(float(number), 0.0, 0.0)]))
    physsim.step()
    assert physsim.pose('a/0').x == 49.0
    assert [event.code for event in client.events if event.name == '~/command'] == ['ok'] * 50
