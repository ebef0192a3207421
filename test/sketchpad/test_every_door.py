# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A mechanism or medium is the same by Python, message, world file and page."""

from __future__ import annotations

from dataclasses import fields
import json
from typing import Any

from physsim_ros import Box, Simulation
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.media import Medium
from physsim_ros.model.requests import Join, Spawn
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.settings import WorldSettings
from physsim_ros.testing import box, joint, PhysSim
import pytest

from .browser import Browser
from ..engine.jointed import KINDS, points_of, PROPERTIES

SIDE = 0.5
SHAPE = {'box': {'width': SIDE, 'height': SIDE}}
MEDIUM = {
    'density': 900.0,
    'viscosity': 0.2,
    'drag': 0.8,
    'flow': [0.5, -0.1],
    'gusts': 0.3,
    'gust_time': 4.0,
    'gust_seed': 7,
}
BODIES: dict[str, dict[str, Any]] = {
    'belt': {'belt': 0.7, 'anchored': True},
    'one-way': {'one_way': [0.0, 1.0], 'closed_sides': True, 'anchored': True},
    'rolling': {'rolling_resistance': 0.02},
    'charge': {'charge': 1e-6},
    'medium': {'medium': MEDIUM, 'anchored': True, 'sensor': True},
}


def scene_of(browser: Browser) -> Any:
    physsim: PhysSim = browser.physsim
    physsim.step()
    return physsim.node.frame.snapshot.scene


def open_file(browser: Browser, **content: Any) -> None:
    answer = browser.open_world(json.dumps({'format': 1, **content}))
    assert not answer['code'], answer


def by_python(*requests: Any) -> Any:
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    for request in requests:
        simulation.perform(request)
    return simulation.advance_frame().snapshot.scene


def body_of(scene: Any) -> Body:
    (body,) = scene.bodies
    return body


def joint_of(scene: Any) -> Joint:
    (found,) = scene.joints
    return found


def test_the_medium_of_these_tests_has_every_key() -> None:
    assert MEDIUM.keys() == {field.name for field in fields(Medium)}


def test_a_body_is_the_same_through_every_door(browser: Browser) -> None:
    page = browser.open_page()
    for name, said in BODIES.items():
        open_file(browser, bodies=[{'name': 'a/0', 'at': [0.0, 0.0], **SHAPE, **said}])
        by_file = body_of(scene_of(browser))
        open_file(browser, bodies=[])
        browser.physsim.spawn(box('a/0', size=(SIDE, SIDE), at=(0.0, 0.0), **said))
        by_message = body_of(scene_of(browser))
        open_file(browser, bodies=[])
        assert not page.spawn('a/0', 0.0, 0.0, **SHAPE, **said)['code']
        by_page = body_of(scene_of(browser))
        shape, properties = Box(width=SIDE, height=SIDE), Properties.from_mapping(said)
        expected = body_of(by_python(Spawn(name='a/0', shape=shape, properties=properties)))
        for found in (by_file, by_message, by_page):
            told = {key: getattr(found, key) for key in said}
            assert told == {key: getattr(expected, key) for key in said}, name


@pytest.mark.parametrize('kind', KINDS)
def test_a_joint_is_the_same_through_every_door(browser: Browser, kind: JointKind) -> None:
    said, points = PROPERTIES[kind], points_of(kind)
    pair = [
        {'name': 'a/0', 'at': [0.0, 0.0, 0.0], **SHAPE},
        {'name': 'a/1', 'at': [0.8, 0.0, 0.0], **SHAPE},
    ]
    entry = {'name': 'j/0', 'kind': kind.value, 'points': points, 'a': 'a/0', 'b': 'a/1'}
    still = {'gravity': [0.0, 0.0]}

    open_file(browser, bodies=pair, joints=[{**entry, **said}], **still)
    by_file = joint_of(scene_of(browser))
    open_file(browser, bodies=pair, **still)
    browser.physsim.join(joint(kind.value, points, 'j/0', a='a/0', b='a/1', **said))
    by_message = joint_of(scene_of(browser))
    open_file(browser, bodies=pair, joints=[entry], **still)
    answer = browser.open_page().ask('change_joint', name='j/0', properties=said)
    assert not answer['code'], answer
    by_page = joint_of(scene_of(browser))

    shape = Box(width=SIDE, height=SIDE)
    spawns = [Spawn(name=each['name'], shape=shape, pose=tuple(each['at'])) for each in pair]
    properties = JointProperties.from_mapping(said)
    request = Join(
        name='j/0', kind=kind, points=tuple(points), a='a/0', b='a/1', properties=properties
    )
    expected = joint_of(by_python(*spawns, request))
    for found in (by_file, by_message, by_page):
        assert (found.kind, found.properties) == (kind, expected.properties)
