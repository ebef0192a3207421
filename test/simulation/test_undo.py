# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Undo, redo and reset: gestures and their names, settings, loaded worlds, resets one by one."""

import math

import numpy as np
from physsim_ros.model.errors import OutOfHistory
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

from .driven import Driven, dropped, FRAME, SECOND, told
from ..building import BOX, DISC, joining, spawning


def test_redo_shows_the_contacts_of_one_frame(driven):
    driven.simulation.reports_contacts = True
    before = driven.run(1.0, 1.0)[-1].contacts
    driven.ask(spawning('more/0', BOX, (8.0, 18.0, 0.0)))
    driven.apply_requests()
    driven.simulation.undo()
    driven.simulation.redo()
    again = driven.apply_requests().contacts
    assert again.pairs.tolist() == before.pairs.tolist()
    np.testing.assert_allclose(again.impulses, before.impulses, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize('turns', [0, 1, -3])
def test_a_marker_that_is_published_back_leaves_what_there_is_to_redo(turns):
    simulation = Simulation(speed=0.0)
    yaw = 0.1 + turns * math.tau
    simulation.perform(spawning('a/0', BOX, (0.3, 0.2, yaw)))
    simulation.perform(spawning('b/0', BOX, (5.0, 0.0, 0.0)))
    simulation.undo()
    digest, color = simulation.world.digest(), simulation.world.scene.bodies[0].color
    # The yaw of a quaternion, and channels of single precision.
    back = 2.0 * math.atan2(math.sin(0.05), math.cos(0.05))
    red, green, blue, alpha = np.array(color, np.float32).tolist()

    simulation.perform(spawning('a/0', BOX, (0.3, 0.2, back), color=(red, green, blue, alpha)))

    assert simulation.world.digest() == digest
    assert simulation.status.redo == 'redo spawn b/0'


def test_what_followed_a_reset_comes_back_with_it(driven):
    driven.simulation.reset()
    driven.record(4.0)
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.record(3.0)
    before = driven.moment
    undo, redo = driven.simulation.undo, driven.simulation.redo
    said = [act().partition(',')[0] for act in (undo, undo, redo, redo)]
    assert said == ['undid spawn b/0', 'undid reset', 'redid reset', 'redid spawn b/0']
    assert driven.moment == before
    driven.simulation.seek(SECOND // 2)
    frames = [driven.simulation.advance_frame() for _ in range(before[0] // FRAME - 30)]
    for frame in frames:
        driven.assert_same(frame)
    assert told(frames, 'divergence') == []
    assert driven.moment == before


@pytest.mark.parametrize('more', [True, False])
def test_undo_passes_over_nothing_that_is_kept_no_more(more):
    sim = Simulation(history=1.0)
    sim.perform(spawning('ball/0', BOX, anchored=True))
    sim.advance_frame()
    sim.reset()
    if more:
        sim.perform(spawning('ball/1', BOX, anchored=True))
    for _ in range(600):
        sim.advance_frame()

    with pytest.raises(OutOfHistory):
        sim.undo()
    assert ('ball/1' in sim.world) is more
    assert 'ball/0' not in sim.world


def test_what_was_loaded_at_the_beginning_cannot_be_undone():
    first = Driven()
    first.ask(spawning('a/0'))
    first.apply_requests()
    second = Driven()
    second.simulation.begin(first.simulation.save())
    with pytest.raises(OutOfHistory):
        second.simulation.undo()
    assert second.names == ('a/0',)


def test_older_steps_than_are_kept_are_dropped():
    driven = dropped(history=3.0)
    driven.record(10.0)
    history = driven.simulation.past.line
    assert history.head - history.oldest == 3 * 240
    assert len(history.keyframes) <= 3
    frames = driven.run(-64.0, 0.5)
    assert frames[-1].snapshot.step == history.head - 3 * 240
    driven.assert_same(frames[-1])
    with pytest.raises(OutOfHistory):
        driven.simulation.undo()


def test_redo_does_not_pass_over_an_undone_line_that_is_no_longer_kept():
    simulation = Simulation()
    simulation.perform(spawning('a/0', BOX))
    simulation.reset()
    simulation.limit_history(1.0)
    simulation.undo()
    simulation.undo()
    # The step of the spawn is dropped, and the line with it; only the reset could be redone.
    for _ in range(240):
        simulation.advance_frame()
    assert simulation.status.redo == ''
    with pytest.raises(OutOfHistory):
        simulation.redo()


# Phrases


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
        (Configure(changes={'damping': 0.5}), 'change damping'),
        (Configure(changes={'damping': 0.5, 'gusts': 1.0}), 'change settings'),
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
        box = spawning(f'a/{number}', BOX, (2.0 * number, 0, 0))
        sim.requests.submit(box, topic='', joined=number > 0)
    sim.apply_requests()
    assert sim.status.undo == 'undo spawn a/0 and 2 more'
