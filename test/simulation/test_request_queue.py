# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The queue is bounded, each request is answered, and of seeks in a row the last is made."""

from dataclasses import replace
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Malformed
from physsim_ros.model.requests import Command, Delete, KeepHand, MoveHand, Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation import request_queue
from physsim_ros.simulation.applier import Applier
from physsim_ros.simulation.entries import Origin, size_of, Wait
from physsim_ros.simulation.simulation import Simulation
import pytest

SECOND = 1_000_000_000
SPAWN = Spawn(name='a/0', shape=Disc(radius=0.2), pose=(0.0, 9.0, 0.0))


def spawn(sim: Simulation, number: int) -> None:
    request = Spawn(name=f'a/{number}', shape=Disc(radius=0.2), pose=(number, 9.0, 0.0))
    sim.requests.submit(request, topic='~/spawn')


def test_of_seeks_in_a_row_the_last_is_carried_out_and_each_is_answered():
    sim = Simulation(speed=0.0)
    for number in range(3):
        spawn(sim, number)
    for _ in range(120):
        sim.advance_frame()
    for number in range(1000):
        sim.requests.submit_seek(round((0.2 + number / 1000) * SECOND), Origin('~/seek'))

    frame = sim.apply_requests()

    assert [each.topic for each in frame.answers] == ['~/seek'] * 1000
    assert all('superseded' in each.message for each in frame.answers[:-1])
    assert frame.answers[-1].message == 'at 1.200 s'
    assert sim.step == 288


def test_a_request_between_two_seeks_is_made_where_the_first_one_goes():
    sim = Simulation(speed=0.0)
    for _ in range(120):
        sim.advance_frame()
    sim.requests.submit_seek(SECOND, Origin('~/seek'))
    spawn(sim, 7)
    sim.requests.submit_seek(9 * SECOND, Origin('~/seek'))
    sim.requests.submit_seek(SECOND // 2, Origin('~/seek'))

    frame = sim.apply_requests()

    topics = [each.topic for each in frame.answers if each.topic != 'branch']
    assert topics == ['~/seek', '~/spawn', '~/seek', '~/seek']
    assert not any(each.code for each in frame.answers)
    assert sim.step == 120
    sim.seek(SECOND)
    assert sim.status.newest == 1.0
    assert len(sim.world) == 1


def test_a_seek_to_where_nothing_is_kept_is_refused():
    sim = Simulation(speed=0.0)
    sim.apply_requests()
    sim.requests.submit_seek(9 * SECOND, Origin('~/seek'))

    assert sim.apply_requests() is None
    (answer,) = sim.applier.take_answers()
    assert (answer.topic, answer.code) == ('~/seek', 'out_of_history')


@pytest.mark.parametrize('bound', ['MOST_WAITING', 'MOST_BYTES'])
def test_what_is_too_much_is_refused_and_the_rest_is_carried_out(bound, monkeypatch):
    sim = Simulation(speed=0.0)
    size = size_of(SPAWN)
    monkeypatch.setattr(request_queue, bound, 5 if bound == 'MOST_WAITING' else 5 * size)
    for _ in range(2):
        for number in range(7):
            spawn(sim, number)

        frame = sim.apply_requests()

        assert [each.code for each in frame.answers] == [''] * 5 + ['busy'] * 2
        assert [each.subject for each in frame.answers][-2:] == ['a/5', 'a/6']
        assert len(sim.world) == 5


@pytest.mark.parametrize('bound', ['MOST_WAITING', 'MOST_BYTES'])
@pytest.mark.parametrize('room', [1, 2, 3])
def test_a_gesture_is_carried_out_as_a_whole_or_refused_as_a_whole(bound, room, monkeypatch):
    sim = Simulation(speed=0.0)
    size = size_of(SPAWN)
    monkeypatch.setattr(request_queue, bound, room if bound == 'MOST_WAITING' else room * size)
    sim.requests.submit_gesture([replace(SPAWN, name=f'a/{n}') for n in range(3)], Origin('t'))

    frame = sim.apply_requests()

    assert [each.code for each in frame.answers] == ([''] * 3 if room == 3 else ['busy'] * 3)
    assert len(sim.world) == (3 if room == 3 else 0)


def test_an_undo_takes_back_the_commands_since_a_gesture_also_after_a_refusal():
    sim = Simulation(speed=0.0)
    spawn(sim, 0)
    sim.requests.refuse(Malformed('no'), Origin('~/spawn'))
    command = Command(names=('a/0',), twists=((1.0, 0.0, 0.0),))
    sim.requests.submit(command, topic='cmd_vel', joined=True)
    sim.apply_requests()

    sim.undo()

    assert len(sim.world) == 0


@pytest.fixture
def applied(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Return a list of the requests and the stamps of seeks that are applied from now on."""
    applied: list[Any] = []

    def note(_: Applier, what: Any, *__: Any) -> Any:
        applied.append(what)
        return f'at {what}' if isinstance(what, int) else Answer(topic='')

    monkeypatch.setattr(Applier, 'apply_one', note)
    monkeypatch.setattr(Applier, 'seek', note)
    return applied


def test_what_lies_between_two_seeks_decides_whether_the_first_is_carried_out(applied):
    sim = Simulation()
    queue = sim.requests
    move, other = MoveHand(hand='h', point=(1.0, 1.0)), MoveHand(hand='h', point=(9.0, 9.0))
    queue.submit(move, topic='~/drag/feedback')
    queue.submit_seek(1, Origin('~/seek'))
    queue.tell(Answer(topic='~/speed', message='speed 1'))
    queue.submit_seek(2, Origin('~/seek'))
    queue.submit(move, topic='~/drag/feedback')
    queue.submit(other, topic='~/drag/feedback')
    sim.applier.make_call(lambda: applied.append('call') or [], Wait.FOR_SEEK)
    queue.submit(move, topic='~/drag/feedback')
    queue.submit_seek(3, Origin('~/seek'))

    sim.applier.apply_all()

    assert applied == [move, 2, other, 'call', move, 3]


def test_a_move_of_a_hand_overtakes_nothing_but_moves(applied):
    sim = Simulation()
    queue = sim.requests
    first, second = (MoveHand(hand='h', point=(x, 1.0)) for x in (1.0, 2.0))
    third, other = MoveHand(hand='h', point=(3.0, 1.0)), MoveHand(hand='i', point=(9.0, 9.0))
    delete, keep = Delete(name='a/0'), KeepHand(hand='h')
    for request in (first, other, keep, second, delete, third):
        queue.submit(request, topic='~/drag/feedback')

    sim.applier.apply_all()

    assert applied == [second, other, keep, delete, third]


def test_answers_that_are_too_many_are_counted(monkeypatch, applied):
    monkeypatch.setattr(request_queue, 'MOST_WAITING', 5)
    sim = Simulation()
    queue = sim.requests
    queue.submit(SPAWN, topic='~/spawn')
    for stamp in range(100):
        queue.refuse(Malformed('no'), Origin('~/spawn'))
        queue.submit_seek(stamp, Origin('~/seek'))

    sim.applier.apply_all()
    answers = sim.applier.take_answers()

    # Up to twice the bound; seeks beyond it are refused, too.
    assert len(answers) == 11
    assert applied == [SPAWN, 1]
    assert answers[-1].code == 'busy'
    assert answers[-1].message.startswith('191 more')
    # The next are told again.
    queue.refuse(Malformed('no'), Origin('~/spawn'))
    sim.applier.apply_all()
    assert [each.code for each in sim.applier.take_answers()] == ['malformed']
