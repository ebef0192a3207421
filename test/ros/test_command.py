# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A command on `~/command` sets poses, velocities and forces of the bodies it names."""

from __future__ import annotations

import math

from physsim_ros.testing import box, command, disc, PhysSim, polygon, Refused
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


def test_a_pose_is_taken_and_motion_kept(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{velocity: [1, 2], spin: 3}'))
    physsim.command(command('a/0', poses=[(5.0, 6.0, 0.7)]))
    assert physsim.pose('a/0') == pytest.approx((5.0, 6.0, 0.7))
    assert physsim.twist('a/0') == pytest.approx((1.0, 2.0, 3.0))
    physsim.run(0.5)
    # m: free flight from there
    expected = (5.0 + 0.5, 6.0 + 2.0 * 0.5 - G * 0.5**2 / 2, 0.7 + 3.0 * 0.5)
    assert physsim.pose('a/0') == pytest.approx(expected, abs=1e-9)


def test_a_pose_is_that_of_the_origin_not_of_the_centre_of_mass(physsim: PhysSim) -> None:
    physsim.spawn(polygon('a/0', outline=ELL.outline, at=(1.0, 1.0)))
    physsim.command(command('a/0', poses=[(5.0, 6.0, 0.7)]))
    assert physsim.pose('a/0') == pytest.approx((5.0, 6.0, 0.7))


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


def test_a_wrench_acts_at_the_centre_of_mass(weightless: PhysSim) -> None:
    weightless.spawn(polygon('a/0', outline=ELL.outline, text='{mass: 4}'))
    weightless.command(command('a/0', wrenches=[(8.0, -4.0, 0.0)]))
    weightless.run(0.5)
    # m/s: F t / m, and no turning
    assert weightless.twist('a/0') == pytest.approx((1.0, -0.5, 0.0), abs=1e-9)


def test_a_torque_turns_a_body(weightless: PhysSim) -> None:
    weightless.spawn(disc('a/0', diameter=2.0, text='{mass: 4}'))
    weightless.command(command('a/0', wrenches=[(0.0, 0.0, 3.0)]))
    weightless.run(0.5)
    # rad/s: M t / (m r²/2)
    assert weightless.twist('a/0') == pytest.approx((0.0, 0.0, 3.0 * 0.5 / 2.0), abs=1e-9)


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


def test_a_wrench_lasts_where_the_timeout_is_0(weightless: PhysSim) -> None:
    set_parameter(weightless, 'command_timeout', 0.0)
    weightless.spawn(box('a/0', text='{mass: 2}'))
    weightless.command(command('a/0', wrenches=[(4.0, 0.0, 0.0)]))
    weightless.run(3.0)
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 3.0 / 2.0)


def test_a_wrench_acts_until_the_next_one_for_that_body(weightless: PhysSim) -> None:
    weightless.spawn(box('a/0', text='{mass: 2}'))
    weightless.spawn(box('a/1', at=(0.0, 9.0), text='{mass: 2}'))
    weightless.command(command('a/0', 'a/1', wrenches=[(4.0, 0.0, 0.0)] * 2))
    weightless.run(0.25)
    weightless.command(command('a/0', wrenches=[(0.0, 0.0, 0.0)]))
    weightless.run(1.0)
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 0.25 / 2.0)
    assert weightless.twist('a/1').vx == pytest.approx(4.0 * 0.5 / 2.0)


def test_wrenches_that_follow_each_other_act_as_one(weightless: PhysSim) -> None:
    weightless.spawn(box('a/0', text='{mass: 2}'))
    for _ in range(12):
        weightless.command(command('a/0', wrenches=[(4.0, 0.0, 0.0)]))
        weightless.run(0.25)
    weightless.run(2.0)
    # m/s: 12 quarters and the rest of the last half second
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 3.25 / 2.0)


def test_a_wrench_outlives_a_change_in_place(weightless: PhysSim) -> None:
    weightless.spawn(box('a/0', text='{mass: 2}'))
    weightless.command(command('a/0', wrenches=[(4.0, 0.0, 0.0)]))
    weightless.run(0.25)
    weightless.spawn(disc('a/0'))
    weightless.run(1.0)
    assert weightless.twist('a/0').vx == pytest.approx(4.0 * 0.5 / 2.0)


@pytest.mark.parametrize('when', ['at birth', 'later'])
def test_an_anchored_body_takes_a_pose_only(physsim: PhysSim, when: str) -> None:
    physsim.spawn(box('a/0', text='' if when == 'later' else '{anchored: true}'))
    physsim.spawn(box('a/1', at=(5.0, 0.0)))
    if when == 'later':
        physsim.anchor((0.0, 0.0))
    for message in (
        command('a/0', twists=[(1, 0, 0)]),
        command('a/0', wrenches=[(1, 0, 0)]),
        command('a/1', 'a/0', poses=[(9, 9, 0), (8, 8, 0)], twists=[(1, 0, 0)] * 2),
    ):
        before = physsim.digest()
        with pytest.raises(Refused) as caught:
            physsim.command(message)
        assert caught.value.code == 'anchored'
        assert physsim.digest() == before
    physsim.command(command('a/0', poses=[(1.0, 2.0, 0.5)]))
    physsim.run(0.5)
    assert physsim.pose('a/0') == pytest.approx((1.0, 2.0, 0.5))


def test_a_kinematic_body_takes_pose_and_twist_only(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{kinematic: true}'))
    before = physsim.digest()
    with pytest.raises(Refused) as caught:
        physsim.command(command('a/0', wrenches=[(1, 0, 0)]))
    assert (caught.value.code, caught.value.field) == ('bad_property', 'wrench')
    assert physsim.digest() == before
    physsim.command(command('a/0', poses=[(1.0, 2.0, 0.0)], twists=[(0.5, 0.0, 0.1)]))
    physsim.run(1.0)
    assert physsim.pose('a/0') == pytest.approx((1.5, 2.0, 0.1))


def test_a_command_is_carried_out_whole_or_not_at_all(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    before = physsim.digest()
    with pytest.raises(Refused) as caught:
        physsim.command(command('a/0', 'z/9', poses=[(5, 5, 0)] * 2, twists=[(1, 0, 0)] * 2))
    assert caught.value.code == 'unknown_body'
    assert 'z/9' in str(caught.value)
    assert physsim.digest() == before


def test_commands_are_carried_out_in_the_order_in_which_they_come(
    physsim: PhysSim, client: Client
) -> None:
    physsim.spawn(box('a/0'))
    for number in range(50):
        client.publish('~/command', command('a/0', poses=[(float(number), 0.0, 0.0)]))
    physsim.step()
    assert physsim.pose('a/0').x == 49.0
    assert [event.code for event in client.events if event.name == '~/command'] == ['ok'] * 50


def test_a_moved_body_wakes_what_it_touches(physsim: PhysSim) -> None:
    physsim.spawn(box('floor/0', size=(40.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(box('a/0', at=(0.0, 0.5), text='{elasticity: 0}'))
    physsim.spawn(box('a/1', at=(0.0, 1.5), text='{elasticity: 0}'))
    # Long enough for everything to come to rest.
    physsim.run(5.0)
    physsim.command(command('a/0', poses=[(9.0, 0.5, 0.0)]))
    physsim.run(1.0)
    # m: what stood on it has fallen to the ground
    assert physsim.pose('a/1').y == pytest.approx(0.5, abs=0.01)


def test_a_resting_body_obeys(physsim: PhysSim) -> None:
    physsim.spawn(box('floor/0', size=(40.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(box('a/0', at=(0.0, 0.5), text='{elasticity: 0, mass: 1}'))
    physsim.run(5.0)
    physsim.command(command('a/0', wrenches=[(0.0, 3 * G, 0.0)]))
    physsim.run(0.25)
    # m/s: twice its weight is left
    assert physsim.twist('a/0').vy == pytest.approx(2 * G * 0.25, rel=0.02)
    physsim.run(5.0)
    physsim.command(command('a/0', twists=[(0.0, 4.0, 0.0)]))
    physsim.run(0.1)
    assert physsim.twist('a/0').vy == pytest.approx(4.0 - G * 0.1, rel=0.02)
    physsim.run(5.0)
    physsim.anchor((physsim.pose('a/0').x, 0.5))
    physsim.release((physsim.pose('a/0').x, 0.5))
    set_parameter(physsim, 'gravity', [0.0, G])
    physsim.run(0.5)
    # m: gravity has turned, and it falls up
    assert physsim.pose('a/0').y == pytest.approx(0.5 + G * 0.5**2 / 2, abs=0.02)
