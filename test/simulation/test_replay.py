# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Replay: the same bits again, branches of the past, what is kept of it, and what is reported."""

from collections.abc import Callable
import gc
from typing import Any

import numpy as np
from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.requests import Command, Configure, Delete, DeleteAll, UnjoinAll
from physsim_ros.simulation.past import CachedFrame
from physsim_ros.simulation.past.line import Node
from physsim_ros.simulation.simulation import CHECKPOINTS, Simulation
import pytest

from .driven import Driven, dropped, FLOOR, FRAME, SECOND, told
from ..building import BOX, DISC, spawning


@pytest.mark.parametrize('stamp', [-1, 10 * SECOND, 10**18])
def test_what_is_not_in_the_history_is_refused(driven, stamp):
    before = driven.moment
    if stamp < 0:
        driven.simulation.limit_history(1.0)
        stamp = 0
    with pytest.raises(OutOfHistory):
        driven.simulation.seek(stamp)
    assert driven.moment == before


# Requests and refusals that make a frame without a step, and change nothing.
IDLE: list[Callable[[Driven], object]] = [
    lambda driven: driven.ask(Delete(name='nobody/0')),
    lambda driven: driven.ask(DeleteAll(namespace='nobody')),
    lambda driven: driven.run(0.5, 0.0),
]


@pytest.mark.parametrize('idle', IDLE)
@pytest.mark.parametrize('back', [False, True], ids=['now', 'past'])
def test_a_frame_without_a_step_tells_no_contacts_and_drops_none(idle, back):
    driven = dropped('a/0', 0.5)
    driven.simulation.reports_contacts = True
    driven.run(1.0, 2.0)
    if back:
        driven.run(-1.0, 1.0)
    step = driven.simulation.step

    idle(driven)
    frame = driven.apply_requests()
    driven.run(1.0, 0.5)
    again = [each for each in driven.run(-1.0, 1.0) if each.snapshot.step == step]

    assert frame.snapshot.step == step
    assert frame.contacts.pairs.tolist() == []
    assert [each.contacts.pairs.tolist() for each in again if each.contacts] == [[[0, -1]]]


@pytest.mark.parametrize('steps', [(238, 240), (239, 240), (240, 240), (237, 239)])
def test_a_seek_from_within_a_frame_shows_all_its_contacts(steps):
    driven = dropped('a/0', 0.5)
    driven.simulation.reports_contacts = True
    driven.run(1.0, 2.0)
    impulses = []
    for step in (steps[1], *steps):
        driven.simulation.seek(round(step * SECOND / 240))
        contacts = driven.apply_requests().contacts
        impulses.append(contacts.impulses.tolist())
    first, _, again = impulses
    assert first
    np.testing.assert_allclose(again, first, rtol=1e-9, atol=1e-12)


def test_reset_returns_to_what_was_loaded_longer_ago_than_is_kept():
    driven = Driven(history=5.0)
    other = dropped('b/0')
    driven.simulation.load(other.simulation.save())
    driven.run(4.0, 5.0)
    driven.simulation.reset()
    assert driven.names == ('b/0',)


def test_a_moment_that_is_kept_no_more_is_left_for_the_oldest():
    driven = dropped()
    driven.record(20.0)
    driven.simulation.seek(2 * SECOND)
    driven.simulation.limit_history(1.0)
    frame = driven.apply_requests()
    assert frame.snapshot.step == driven.simulation.past.line.oldest == 19 * 240 - FRAME
    driven.assert_same(frame)
    assert 'oldest' in told([frame], 'history')[0].message
    driven.ask(spawning('b/0', BOX, (0.0, 8.0, 0.0)))
    frame = driven.simulation.advance_frame()
    assert [answer.code for answer in frame.answers if answer.topic == '~/test'] == ['']
    assert driven.names == ('a/0', 'b/0')


@pytest.mark.parametrize('history', [0.0, 1.0])
def test_what_was_left_is_returned_to_as_far_as_it_is_kept(history):
    driven = dropped()
    driven.record(15.0)
    driven.simulation.seek(2 * SECOND)
    driven.simulation.reset()
    driven.simulation.limit_history(history)
    driven.simulation.undo()
    oldest = driven.simulation.past.line.oldest
    assert driven.simulation.step == oldest == 15 * 240 - FRAME - round(history * 240)
    driven.assert_same(driven.apply_requests())


def test_contacts_come_again_that_nobody_asked_for_the_first_time():
    driven = dropped('a/0', 0.5)
    driven.run(1.0, 5.0)
    driven.simulation.reports_contacts = True
    for frame in driven.run(-1.0, 4.0)[1:]:
        assert frame.contacts.pairs.tolist() == [[0, -1]]


def test_the_last_of_many_commands_to_a_paused_world_costs_no_more_than_the_first(monkeypatch):
    looks = [0]

    class Counted(Node):
        """A request of which each look at whether it was seen is counted."""

        def __getattribute__(self, name: str) -> Any:
            if name == 'shown':
                looks[-1] += 1
            return super().__getattribute__(name)

        def __setattr__(self, name: str, value: Any) -> None:
            if name == 'shown':
                looks[-1] += 1
            super().__setattr__(name, value)

    monkeypatch.setattr('physsim_ros.simulation.past.cursor.Node', Counted)
    driven = Driven(speed=0.0)
    driven.ask(spawning('a/0', BOX))
    for _ in range(200):
        driven.ask(Command(names=('a/0',), wrenches=((1.0, 0.0, 0.0),)))
        looks.append(0)
        driven.apply_requests()
    assert 0 < max(looks) < 10
    driven.simulation.seek(0)
    assert driven.simulation.past.cursor.serial == 201


def test_few_bodies_take_no_more_memory_than_their_poses_would():
    driven, bodies = Driven(history=120.0), 8
    for number in range(bodies):
        driven.ask(spawning(f'a/{number}', BOX, (1.5 * number - 6.0, 1.0, 0.0)))
    driven.record(20.0)
    a_segment = 60 * CHECKPOINTS * (1000 + bodies * 2 * 24)
    assert driven.simulation.past.frames.size <= max(120 * 60 * 24 * bodies, 3 * a_segment)
    for frame in driven.run(-4.0, 5.0):
        driven.assert_same(frame)


def test_what_is_worked_out_from_the_past_is_not_kept(driven):
    driven.ask(spawning('sensor/0', BOX, (0.0, 0.5, 0.0), anchored=True, sensor=True))
    driven.record(4.0)
    driven.simulation.reports_contacts = True
    # Among them some that are made again, with a sensor's contacts, which take the centres.
    for frame in driven.run(-1.0, 3.5):
        assert frame.snapshot.centers.size
    kept = [each for each in gc.get_objects() if isinstance(each, CachedFrame)]
    shots = [shot for shot in kept if shot.snapshot.scene.names == driven.names]
    assert len(shots) > 100
    # Else it would take memory that nobody counts; but for the one that is shown.
    assert sum('centers' in vars(shot.snapshot) for shot in shots) <= 1


def test_other_bits_than_before_are_told(driven):
    history = driven.simulation.past.line
    wrong = history.keyframes[2]._replace(digest='not that')
    history.keyframes[2] = wrong
    driven.simulation.seek(0)
    frames = driven.run(8.0, 0.7)
    (answer,) = told(frames, 'divergence')
    assert answer.code == 'divergence'
    assert f'{wrong.step / 240:.3f} s' in answer.message


def test_a_request_that_is_refused_when_it_is_made_again_is_told(driven):
    history = driven.simulation.past.line
    history.nodes[-1].request = Delete(name='nobody/0')
    driven.simulation.seek(0)
    answer, *_ = told(driven.run(8.0, 0.7), 'divergence')
    assert "is refused now: there is no body 'nobody/0'" in answer.message


@pytest.mark.parametrize('speeds', [(1.0,), (0.3,), (4.0,), (0.3, 1.0)])
def test_checkpoints_come_at_the_same_steps_however_the_steps_were_made(speeds):
    # 41 steps, which are no multiple of a frame.
    driven = Driven(checkpoints=41 / 240)
    collide(driven)
    for speed in speeds:
        driven.run(speed, 0.8 / speed)
    # At the beginning there are two, before and after the first requests.
    steps = sorted({mark.step for mark in driven.simulation.past.line.keyframes})
    assert steps == list(range(0, 41 * len(steps), 41))
    assert len(steps) > 4


def test_a_checkpoint_within_a_frame_loses_none_of_its_contacts():
    driven = Driven(checkpoints=41 / 240)
    driven.simulation.reports_contacts = True
    driven.ask(spawning('a/0', BOX, (0.0, 0.5, 0.0)))
    _, *frames = driven.run(1.0, 1.0)
    assert {frame.contacts.steps for frame in frames} == {FRAME}


def test_redo_that_the_history_is_too_short_for_says_so():
    driven = dropped()
    driven.run(1.0, 1.0)
    driven.ask(spawning('b/0', BOX, (3.0, 5.0, 0.0)))
    driven.run(1.0, 4.0)
    driven.simulation.seek(3 * SECOND // 2)
    driven.simulation.undo()
    driven.simulation.limit_history(2.0)
    message = driven.simulation.redo()
    oldest = driven.simulation.past.line.oldest
    assert driven.simulation.step == oldest > 360
    time = f'{oldest / 240:.3f} s'
    assert message.endswith(time)
    (answer,) = told([driven.apply_requests()], 'history')
    assert answer.message == f'{time} is the oldest that is kept'


# Requests at checkpoints


def collide(driven: Driven) -> None:
    for number in range(4):
        driven.ask(spawning(f'a/{number}', BOX, (0.3 * number, 1.0 + 1.2 * number, 0.2)))


def test_a_request_at_a_checkpoint_of_the_past_is_made_again_where_it_was():
    sim = Simulation(settings=FLOOR)
    # A seek comes from the frame before, for its contacts.
    sim.reports_contacts = True
    # Deep in the floor, so that it goes on otherwise in a space that is built anew.
    sim.perform(spawning('a/0', DISC, (2.4, 0.1, 3.0), velocity=(1.8, 2.7)))
    sim.advance_frame()
    sim.past.cursor.add_keyframe()
    for _ in range(14):
        sim.advance_frame()
    sim.seek(round(FRAME * SECOND / 240))
    sim.perform(spawning('a/1', DISC, (-0.2, 3.6, 0.0)))
    sim.advance_frame()
    before = sim.world.digest()

    sim.undo()
    for _ in range(4):
        sim.advance_frame()
    sim.redo()

    assert sim.world.digest() == before


def test_what_changes_nothing_drops_nothing(driven):
    same = spawning('c/0', BOX, (5.0, 0.5, 0.0), anchored=True)
    driven.ask(same)
    driven.record(1.0)
    driven.run(-1.0, 0.5)
    for request in (same, UnjoinAll(), DeleteAll(namespace='nobody'), Configure(changes={})):
        driven.ask(request)
        frame = driven.apply_requests()
        assert [answer.code for answer in frame.answers] == ['']
        assert told([frame], 'branch') == []


@pytest.mark.parametrize('names', [None, 'a/0', 'a/4'])
def test_what_is_deleted_at_a_checkpoint_is_gone_from_the_contacts(names):
    driven = Driven()
    driven.simulation.reports_contacts = True
    for number in range(5):
        driven.ask(spawning(f'a/{number}', BOX, (0.0, 0.5 + number, 0.0)))
    for _ in range(3):
        while driven.simulation.past.line.head % 480 or not driven.simulation.step:
            driven.simulation.advance_frame()
        driven.ask(DeleteAll() if names is None else Delete(name=names))
        driven.ask(spawning('a/0' if names is None else names, BOX, (3.0, 0.5, 0.0)))
        for _ in range(3):
            contacts = driven.simulation.advance_frame().contacts
            assert contacts.pairs.max(initial=-1) < len(driven.names)
