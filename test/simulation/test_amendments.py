# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests of the past are replaced or taken back, as if they had never been; time stays."""

from physsim_ros.model.requests import Axle, Configure, Delete, MoveBodies, Request
from physsim_ros.model.snapshot import Frame
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Amend, Origin, TakeBack
from physsim_ros.simulation.past import amendment
from physsim_ros.simulation.past.cursor import Cursor
from physsim_ros.simulation.simulation import Simulation
import pytest

from .driven import OVERDUE, take_back, world_after
from ..building import BOX, DISC, joining, spawning

LEFT, RIGHT = (-3.0, 5.0, 0.0), (3.0, 5.0, 0.0)


# Amending


def begun() -> Simulation:
    return world_after((2, '', spawning('t/0', BOX)), frames=5)


def amend(simulation: Simulation, gestures: list[int], requests: list[Request]) -> Frame:
    """Replace the requests of gestures, and return the frame that shows it."""
    simulation.requests.submit(Amend(tuple(gestures), tuple(requests)), topic='t', joined=True)
    return simulation.apply_requests()


def test_what_the_amended_past_refuses_later_is_dropped():
    simulation = begun()
    gesture = simulation.requests.gesture
    simulation.requests.submit(Delete(name='t/0'), topic='t')
    simulation.requests.submit(Configure(changes={'damping': 0.5}), topic='t')
    simulation.advance_frame()

    amend(simulation, [gesture], [spawning('t/1', DISC)])

    assert simulation.world.snapshot().scene.names == ('t/1',)
    assert simulation.settings.damping == 0.5


def test_a_refused_request_is_answered_and_the_others_hold():
    simulation = begun()

    requests = [Delete(name='no/1'), spawning('t/1', DISC)]
    frame = amend(simulation, [simulation.requests.gesture], requests)

    assert [answer.code for answer in frame.answers] == ['unknown_body', '']
    assert simulation.world.snapshot().scene.names == ('t/1',)


def test_several_gestures_become_one():
    simulation = begun()
    first = simulation.requests.gesture
    simulation.requests.submit(spawning('t/1', BOX, (3.0, 5.0, 0.0)), topic='t')
    second = simulation.requests.gesture
    simulation.advance_frame()

    amend(simulation, [first, second], [spawning('t/2', DISC)])

    assert simulation.world.snapshot().scene.names == ('t/2',)
    simulation.undo()
    assert simulation.world.snapshot().scene.names == ()


def test_gestures_that_changed_nothing_are_amended_by_what_is_made_now():
    simulation = begun()
    step = simulation.step

    amend(simulation, [simulation.requests.gesture + 7], [spawning('t/1', DISC)])

    assert simulation.step == step
    assert simulation.world.snapshot().scene.names == ('t/0', 't/1')


# Taking back

ROD = joining('rod', [(-3.0, 4.0), (0.0, 9.0)], a='a/0')
ANNA, BEN = (2, 'Anna', spawning('a/0', DISC, LEFT)), (20, 'Ben', spawning('b/0', BOX, RIGHT))


def test_what_breaks_again_while_nothing_is_taken_back_is_told_once():
    weak = joining('spring', [RIGHT[:2], (3.0, 9.0)], a='b/0', b='world', break_force=1e-3)
    use = MoveBodies(names=('a/0',), by=(0.0, 1.0))
    simulation = world_after(ANNA, BEN, (25, 'Ben', weak), (40, 'Ben', use))
    assert simulation.world.scene.joints == ()

    assert take_back(simulation, 'Anna').code == 'not_alone'
    assert not [each for each in simulation.advance_frame().answers if each.code]


@pytest.mark.parametrize('use', [MoveBodies(names=('a/0',), by=(0.0, 1.0)), ROD])
def test_what_others_have_used_since_is_not_taken_back(use):
    simulation = world_after(ANNA, BEN, (30, 'Ben', use))
    before = simulation.world.digest()

    answer = take_back(simulation, 'Anna')
    assert answer.code == 'not_alone'
    assert 'delete it instead' in answer.message

    assert simulation.world.digest() == before
    take_back(simulation, 'Ben')
    take_back(simulation, 'Anna')
    assert simulation.world.scene.names == ('b/0',)


def test_it_is_refused_in_the_past_and_where_it_would_take_long(monkeypatch):
    simulation = world_after(ANNA, BEN)
    end = simulation.world.stamp
    simulation.seek(500_000_000)
    assert take_back(simulation, 'Anna').code == 'in_past'
    simulation.seek(end)
    monkeypatch.setattr(amendment, 'LONGEST_AGAIN', 0.5)
    answer = take_back(simulation, 'Anna')
    assert answer.code == 'not_alone'
    assert 'ago' in answer.message
    assert simulation.world.scene.names == ('a/0', 'b/0')


def test_a_reading_that_would_take_long_to_replace_stays(monkeypatch):
    simulation = begun()
    gesture, before = simulation.requests.gesture, simulation.world.digest()
    monkeypatch.setattr(amendment, 'LONGEST_AGAIN', 0.01)

    frame = amend(simulation, [gesture], [spawning('t/1', DISC)])

    assert [answer.code for answer in frame.answers] == ['not_alone']
    assert simulation.world.digest() == before


def test_commands_that_joined_a_gesture_are_not_taken_back_with_it():
    simulation = world_after(ANNA)
    simulation.requests.submit(spawning('c/0', BOX, (0.0, 3.0, 0.0)), Origin('t', author='Anna'))
    # As commands of robots do.
    later = spawning('d/0', BOX, (6.0, 3.0, 0.0))
    simulation.requests.submit(later, topic='t', joined=True)
    simulation.advance_frame()

    take_back(simulation, 'Anna')

    assert simulation.world.scene.names == ('a/0', 'd/0')


def test_a_later_moment_of_a_gesture_leaves_the_gestures_between_alone():
    simulation = world_after(ANNA)
    gesture = simulation.requests.gesture
    queue = simulation.requests
    queue.submit(spawning('b/0', BOX, RIGHT), Origin('t', author='Ben'))
    between = queue.gesture
    late = spawning('a/1', DISC, (0.0, 9.0, 0.0))
    queue.submit_gesture((late,), Origin('t', author='Anna'), gesture)
    simulation.advance_frame()
    assert queue.gesture == between

    take_back(simulation, 'Anna')

    assert simulation.world.scene.names == ('b/0',)


def test_what_a_person_has_added_and_is_still_there_is_told():
    simulation = world_after(ANNA, BEN, (30, 'Anna', ROD))

    assert simulation.past.added_by('Anna') == (('a/0',), ('joint/0',))
    assert simulation.past.added_by('Ben') == (('b/0',), ())
    assert simulation.past.added_by('Cleo') == ((), ())


def test_what_a_person_added_is_what_was_added_last_by_them():
    again = (30, 'Ben', spawning('a/0', DISC, LEFT))
    simulation = world_after(ANNA, BEN, (25, 'Anna', Delete(name='a/0')), again)
    simulation.requests.submit(Axle(point=LEFT[:2]), Origin('t', author='Anna'))
    simulation.advance_frame()

    assert simulation.past.added_by('Ben') == (('b/0', 'a/0'), ())
    bodies, joints = simulation.past.added_by('Anna')
    assert not bodies
    assert joints == tuple(joint.name for joint in simulation.world.scene.joints)


def test_what_others_change_in_place_stays_theirs_who_added_it():
    line = [LEFT[:2], (0.0, 9.0)]
    spring = joining('spring', line, a='a/0', b='world')
    stiffer = joining('spring', line, a='a/0', b='world', stiffness=50.0)
    simulation = world_after(
        ANNA, (25, 'Anna', spring), (30, 'Ben', stiffer), (31, 'Ben', spawning('a/0', BOX, LEFT))
    )

    assert simulation.past.added_by('Anna') == (('a/0',), ('joint/0',))
    assert simulation.past.added_by('Ben') == ((), ())


def test_what_broke_is_not_told_again_where_a_gesture_is_not_taken_back():
    hung = joining('pin', [RIGHT[:2]], a='b/0', b='world', break_force=1.0)
    move = (50, 'Ben', MoveBodies(names=('a/0',), by=(0.0, 1.0)))
    simulation = world_after(ANNA, BEN, (20, 'Ben', hung), move)
    assert not simulation.world.scene.joints

    assert take_back(simulation, 'Anna').code == 'not_alone'

    assert [each.topic for each in simulation.advance_frame().answers] == []


def test_what_broke_is_not_told_again_where_the_way_takes_several_ticks():
    hung = joining('pin', [RIGHT[:2]], a='b/0', b='world', break_force=1.0)
    move = (50, 'Ben', MoveBodies(names=('a/0',), by=(0.0, 1.0)))
    simulation = world_after(ANNA, BEN, (20, 'Ben', hung), move)
    simulation.requests.submit(TakeBack(), Origin('t', author='Anna'))

    told, ticks = [], 0
    while not told:
        ticks += 1
        frames = simulation.advance(ticks, OVERDUE)
        told = [answer for frame in frames for answer in frame.answers]
        told += simulation.applier.take_answers()

    assert [answer.code for answer in told] == ['not_alone']
    assert ticks > 1


@pytest.mark.parametrize('change', [TakeBack(), Amend((2,), (spawning('c/0', DISC),))])
def test_an_unexpected_error_on_the_way_leaves_the_world_and_its_past_as_they_were(
    change, monkeypatch
):
    simulation = world_after(ANNA, BEN)
    simulation.past.boundary = ErrorBoundary(lambda _: None)
    before, users = simulation.world.digest(), simulation.past.line.tip.users
    simulation.undo()
    simulation.redo()

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    with monkeypatch.context() as patch:
        patch.setattr(Cursor, 'slices_of_advance', fail)
        simulation.requests.submit(change, Origin('t', author='Anna'))
        frame = simulation.apply_requests()

    assert [each.code for each in frame.answers] == ['failed']
    assert simulation.world.digest() == before
    assert simulation.past.line.tip.users == users
    assert simulation.undo().startswith('undid spawn b/0')
