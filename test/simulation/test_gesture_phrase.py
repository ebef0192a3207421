# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Undo and redo name a gesture by a verb and its object."""

from physsim_ros.model.requests import (
    Axle,
    ChangeBody,
    Configure,
    Cut,
    Delete,
    DeleteAll,
    DeleteBodies,
    Grab,
    MoveBodies,
    Pin,
    Restore,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import BOX, DISC, joining, spawning


@pytest.fixture
def sim() -> Simulation:
    """Return a paused world of two boxes, joined by two rods."""
    sim = Simulation(speed=0.0)
    for number in range(2):
        sim.perform(spawning(f'a/{number}', BOX, (2.0 * number, 0.0, 0.0)))
    for name in ('j/0', 'j/1'):
        sim.perform(joining('rod', [(0.0, 0.0), (2.0, 0.0)], name, a='a/0', b='a/1'))
    return sim


@pytest.mark.parametrize(
    ('request_', 'phrase'),
    [
        (ChangeBody(name='a/0', color=(1.0, 0.0, 0.0, 1.0)), 'change a/0'),
        (Axle(point=(0.0, 0.0)), 'join axle axle/0'),
        (Configure(changes={'damping': 0.5}), 'change settings'),
        (Delete(name='a/0'), 'delete a/0'),
        (DeleteBodies(names=('a/0',)), 'delete a/0'),
        (DeleteBodies(names=('a/0', 'a/1')), 'delete several bodies'),
        (DeleteBodies(names=('a/0', 'a/1'), joints=('j/0',)), 'delete several bodies and joints'),
        (DeleteBodies(names=(), joints=('j/0', 'j/1')), 'delete several joints'),
        (DeleteBodies(names=(), joints=('j/1',)), 'delete j/1'),
        (DeleteAll(), 'delete all bodies'),
        (DeleteAll(namespace='a'), 'delete all bodies of a'),
        (MoveBodies(names=('a/0', 'a/1'), by=(1.0, 0.0)), 'move several bodies'),
        (Grab(hand='me', point=(0.0, 0.0)), 'place a/0'),
        (Cut(pieces=(ChangeBody(name='a/0', shape=DISC), spawning('a/2'))), 'cut a/0'),
        (Cut(pieces=(), severed=(Unjoin(name='j/0'),)), 'cut j/0'),
        (Cut(pieces=(), severed=(Unjoin(name='j/0'), Unjoin(name='j/1'))), 'cut several joints'),
    ],
)
def test_a_gesture_is_named_by_verb_and_object(sim, request_, phrase):
    before = sim.world.digest()
    sim.perform(request_)

    assert sim.status.undo == f'undo {phrase}'
    assert sim.undo().startswith(f'undid {phrase}, ')
    assert sim.world.digest() == before
    assert sim.status.redo == f'redo {phrase}'


def test_a_loaded_world_is_named_as_one(sim):
    sim.perform(Restore(state=sim.save()))
    assert sim.status.undo == 'undo load world'


def test_the_joints_of_a_namespace_are_named_by_it(sim):
    sim.perform(Pin(point=(0.0, 0.0)))
    sim.perform(UnjoinAll(namespace='pin'))
    assert sim.status.undo == 'undo delete all joints of pin'


def test_requests_of_one_gesture_are_counted():
    sim = Simulation(speed=0.0)
    for number in range(3):
        sim.requests.submit(
            spawning(f'a/{number}', BOX, (2.0 * number, 0, 0)), topic='', joined=number > 0
        )
    sim.apply_requests()
    assert sim.status.undo == 'undo spawn a/0 and 2 more'
