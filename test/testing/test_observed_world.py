# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A test reads poses, twists, contacts and forces of a world by name."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.testing import box, disc, PhysSim, UnknownName
import pytest

G = 9.81


def test_pose_and_twist_are_by_name(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.spawn(box('a/1', at=(5.0, 6.0, 0.7), text='{velocity: [1, 2], spin: 3}'))
    pose, twist = physsim.pose('a/1'), physsim.twist('a/1')
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((5.0, 6.0, 0.7))
    assert (twist.vx, twist.vy, twist.spin) == pytest.approx((1.0, 2.0, 3.0))
    for read in (physsim.pose, physsim.twist, physsim.contacts):
        with pytest.raises(UnknownName, match=r"^there is no body 'a/2'; nearest is 'a/\d'$"):
            read('a/2')
    with pytest.raises(UnknownName, match=r"^there is no body 'crate'; there are a/0, a/1$"):
        physsim.pose('crate')
    with pytest.raises(UnknownName, match=r"^there is no joint 'a/2'; there are none$"):
        physsim.force('a/2')


def test_contacts_tell_of_the_last_frame(physsim: PhysSim) -> None:
    assert physsim.contacts() == []
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(disc('a/0', at=(-2.0, 0.5), text='{mass: 3, elasticity: 0}'))
    physsim.spawn(disc('a/1', at=(2.0, 5.0)))
    physsim.run(0.5)
    (contact,) = physsim.contacts()
    assert (contact.a, contact.b) == ('floor/0', 'a/0')
    # N s: what carries 3 kg for a sixtieth of a second
    assert contact.impulse == pytest.approx((0.0, 3 * G / 60), rel=1e-3, abs=1e-9)
    # m: within the engine's contact slop
    assert contact.point == pytest.approx((-2.0, 0.0), abs=0.01)
    assert contact.normal == pytest.approx((0.0, 1.0), abs=1e-9)
    assert physsim.contacts('a/0') == physsim.contacts('floor/0') == [contact]
    assert physsim.contacts('a/1') == []


def test_contacts_with_the_walls_are_with_the_world(physsim: PhysSim, tmp_path: Path) -> None:
    (tmp_path / 'room.yaml').write_text('format: 1\nbounds: [-3, 0, 3, 9]\nelasticity: 0\n')
    physsim.load('room')
    physsim.spawn(disc('a/0', at=(0.0, 0.5)))
    physsim.run(0.2)
    (contact,) = physsim.contacts()
    assert (contact.a, contact.b) == ('a/0', 'world')
    assert contact.impulse[1] < 0


def test_contacts_name_bodies_as_they_were_then(physsim: PhysSim) -> None:
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(disc('a/0', at=(0.0, 0.5)))
    physsim.run(0.2)
    physsim.node.simulation.reset()
    assert physsim.names == ()
    assert [(each.a, each.b) for each in physsim.contacts()] == [('floor/0', 'a/0')]


def test_energy_is_that_of_all_bodies(physsim: PhysSim) -> None:
    physsim.spawn(disc('a/0', diameter=2.0, at=(0.0, 3.0), text='{mass: 2, velocity: [3, 4]}'))
    physsim.spawn(disc('a/1', diameter=2.0, at=(9.0, 1.0), text='{mass: 4, spin: 2}'))
    # J: ½mv² + mgh, and ½(½mr²)ω² + mgh
    expected = (2 * 25 / 2 + 2 * G * 3.0) + (4 * 1.0 / 2 * 2**2 / 2 + 4 * G * 1.0)
    assert physsim.energy() == pytest.approx(expected)
    physsim.run(0.5)
    assert physsim.energy() == pytest.approx(expected)
