# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Builders make the messages that people mean."""

from __future__ import annotations

from typing import Any

from physsim_ros.testing import box, chain, disc, joint, PhysSim, polygon, Refused
import pytest
from visualization_msgs.msg import MarkerArray

SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def test_properties_are_given_by_keyword(physsim: PhysSim) -> None:
    ball = disc('ball/0', at=(0, 5), velocity=(1.0, 0.0), spin=2, mass=1e-9, elasticity=0.9)
    physsim.spawn(ball)
    assert tuple(physsim.twist('ball/0')) == (1.0, 0.0, 2.0)
    (body,) = physsim.node.simulation.world.snapshot().scene.bodies
    assert (body.mass, body.elasticity, body.anchored) == (1e-9, 0.9, False)


def test_properties_are_given_once() -> None:
    with pytest.raises(TypeError, match='not both'):
        box(text='{mass: 1}', mass=2.0)


def test_a_property_that_there_is_not_is_refused_by_the_world(physsim: PhysSim) -> None:
    wrong: Any = {'bouncy': 0.9}
    with pytest.raises(Refused, match="use 'elasticity'"):
        physsim.spawn(disc(**wrong))


def test_a_polygon_is_closed_and_a_chain_is_not(physsim: PhysSim) -> None:
    shapes = [
        polygon('a/0', outline=SQUARE),
        polygon('a/1', outline=(*SQUARE, SQUARE[0]), at=(2.0, 0.0)),
        chain('a/2', points=SQUARE, at=(4.0, 0.0)),
    ]
    physsim.spawn(MarkerArray(markers=shapes))
    kinds = [body.shape.KEY for body in physsim.node.simulation.world.snapshot().scene.bodies]
    assert kinds == ['polygon', 'polygon', 'chain']


def test_an_outline_without_corners_is_refused_by_the_world(physsim: PhysSim) -> None:
    with pytest.raises(Refused):
        physsim.spawn(polygon('a/0', outline=[]))


def test_a_joint_joins_the_bodies_that_it_names(physsim: PhysSim) -> None:
    physsim.spawn(MarkerArray(markers=[box('a/0'), disc('a/1', at=(3.0, 0.0))]))
    ends = [(0.0, 0.0), (3.0, 0.0)]
    assert physsim.join(joint('rope', ends, 'rope/7', a='a/0', b='a/1', length=4.0)) == 'rope/7'
    (rope,) = physsim.node.simulation.world.snapshot().scene.joints
    assert (rope.a, rope.b, rope.properties.length) == ('a/0', 'a/1', 4.0)


@pytest.mark.parametrize('name', ['', 'crate', 'crate_0', 'crate/a'])
def test_a_name_without_a_number_says_how_names_are(name: str) -> None:
    with pytest.raises(ValueError, match='a name is a namespace, / and a number'):
        box(name)


@pytest.mark.parametrize('at', [(1.0,), (1.0, 2.0, 0.5, 0.0)])
def test_a_place_has_two_numbers_or_three(at: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match='at is x and y, or x, y and yaw'):
        box('crate/0', at=at)
