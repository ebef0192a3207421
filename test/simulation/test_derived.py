# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A value that a request may have can be stepped: what steps need is derived with the request."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
import itertools
import math
from typing import Any

from physsim_ros import Simulation
from physsim_ros.engine import scene_columns
from physsim_ros.engine.joints import joint_table
from physsim_ros.model.actors import actor_from, ACTORS
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import Failed, Refusal
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import ChangeBody, Configure, Delete, Join, Request, Spawn
from physsim_ros.model.robots import Robot
from physsim_ros.model.robots.drives import DRIVES
from physsim_ros.model.shapes import Disc
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.world import World
import pytest

DISC = Disc(radius=0.1)
# Paths and walks whose points are far, near, equal, few, or apart by roundings.
NEXT = math.nextafter(1.0, 2.0)
POINTS: list[list[list[float]]] = [
    [[0, 0]],
    [[0, 0], [0, 0]],
    [[1, 0], [NEXT, 0], [1, 5e-324]],
    [[-1e7, -1e7], [1e7, 1e7], [-1e7, 1e7]],
    [[1e7, 0], [math.nextafter(1e7, 0), 0], [0, 0], [1e-9, 0]],
    [[0, 0, 0], [0, 0, 1e-300]],
    [[0, 0, 0], [1e-9, 0, 3], [1, 0, -1e7], [1, 0, 1e7]],
]


def extremes(kind: type[Checked], base: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield mappings of a kind, each with a number at an end of its range."""
    yield base
    for name, declared in kind.FIELDS.items():
        if isinstance(declared.check, Within):
            for value in (declared.check.low, declared.check.high):
                yield {**base, name: value}


def actors() -> Iterator[dict[str, Any]]:
    for kind, points, repeat in itertools.product(ACTORS, POINTS, ('once', 'loop', 'to_and_fro')):
        base = {'kind': kind, 'points': points, 'repeat': repeat}
        yield from extremes(ACTORS[kind], base | ({'speed': 1.0} if kind == 'path' else {}))
        if kind == 'path':
            count = len(points) + (repeat == 'loop')
            for first, lapse in ((0.0, 5e-324), (0.0, 1e-9), (1e9, 1e-6), (1e9, 1e6)):
                yield base | {'times': [first + each * lapse for each in range(count)]}
    for time in (0.0, 1e10):
        yield {'kind': 'path', 'points': [[0, 0]], 'speed': 1, 'start': {'time': time}}


def requests() -> Iterator[Request]:
    """Yield requests, of those that can be made, for a body with a role."""
    for entry in actors():
        for kinematic in (True, False):
            try:
                properties = Properties(actor=actor_from(entry, 'actor'), kinematic=kinematic)
                yield Spawn(name='a/0', shape=DISC, pose=(0.0, 9.0, 0.0), properties=properties)
            except Refusal:
                continue
    for kind in DRIVES:
        for drive in extremes(DRIVES[kind], {'kind': kind}):
            robot = Robot.from_mapping({'drive': drive})
            properties = Properties(robot=robot)
            yield Spawn(name='a/0', shape=DISC, pose=(0.0, 9.0, 0.0), properties=properties)
    for x, y in itertools.product((-1e12, -5e-324, 0.0, 1e12), (0.0, 0.1)):
        force = AppliedForce(force=(x / 2, x / 2), at=(0.0, y))
        properties = Properties(forces=(force,), mass=1e-9)
        yield Spawn(name='a/0', shape=DISC, pose=(0.0, 9.0, 0.0), properties=properties)


def test_a_body_that_is_accepted_can_be_stepped():
    world, accepted = World(), 0
    world.apply(Configure(changes={'floor_friction': 0.3}))
    world.apply(Spawn(name='b/0', shape=DISC, pose=(0.0, 5.0, 0.0)))
    for request in requests():
        try:
            world.apply(request)
        except Refusal:
            continue
        world.step(2)
        # One that a force throws out of the range of numbers is gone.
        if 'a/0' in world:
            world.apply(Delete(name='a/0'))
        accepted += 1
    assert accepted > 500


def fail(*_: object) -> None:
    raise ZeroDivisionError


@pytest.mark.parametrize('change', ['actor', 'robot', 'forces'])
def test_an_error_in_what_steps_need_refuses_the_request(change, monkeypatch):
    properties = {
        'actor': Properties(actor=actor_from({'kind': 'orca', 'points': [[1, 1]]}, 'actor')),
        'robot': Properties(robot=Robot.from_mapping({'drive': {'kind': 'omni'}})),
        'forces': Properties(forces=(AppliedForce(force=(1.0, 0.0)),)),
    }[change]
    world = Simulation(boundary=ErrorBoundary(log=lambda _: None))
    world.perform(Spawn(name='b/0', shape=DISC, pose=(0.0, 5.0, 0.0)))
    before = world.past.cursor.arrive().digest()
    records = {'actor': '_actor_records', 'robot': '_robot_records', 'forces': '_force_records'}

    monkeypatch.setattr(scene_columns, records[change], fail)
    for request in (
        ChangeBody(name='b/0', properties=properties),
        Spawn(name='c/0', shape=DISC, pose=(0.0, 9.0, 0.0), properties=properties),
    ):
        with pytest.raises(Failed):
            world.perform(request)
    monkeypatch.undo()
    assert world.past.cursor.arrive().digest() == before
    world.advance_frame()


def test_an_error_in_what_steps_need_of_joints_refuses_their_requests(monkeypatch):
    world = Simulation(boundary=ErrorBoundary(log=lambda _: None))
    world.perform(Spawn(name='b/0', shape=DISC, pose=(0.0, 5.0, 0.0)))
    rod = Join(
        name='rod/0', kind=JointKind.ROD, points=((0.0, 5.0), (0.0, 9.0)), a='b/0', b='world'
    )
    world.perform(rod)
    rows_of, calls = joint_table._rows_of, iter(())  # noqa: SLF001

    def fail_once(*args: Any) -> Any:
        return fail() if next(calls, False) else rows_of(*args)

    monkeypatch.setattr(joint_table, '_rows_of', fail_once)
    for request in (replace(rod, name='rod/1'), ChangeBody(name='b/0', shape=Disc(radius=0.2))):
        before, calls = world.past.cursor.arrive().digest(), iter((True,))
        with pytest.raises(Failed):
            world.perform(request)
        assert world.past.cursor.arrive().digest() == before
        world.advance_frame()


def test_an_error_in_what_steps_need_on_a_floor_refuses_that_floor(monkeypatch):
    world = Simulation(boundary=ErrorBoundary(log=lambda _: None))
    world.perform(Spawn(name='b/0', shape=DISC, pose=(0.0, 5.0, 0.0)))
    before = world.past.cursor.arrive().digest()
    monkeypatch.setattr(scene_columns, 'lever_of', fail)
    with pytest.raises(Failed):
        world.perform(Configure(changes={'floor_friction': 0.3}))
    monkeypatch.undo()
    assert world.past.cursor.arrive().digest() == before
    world.advance_frame()
