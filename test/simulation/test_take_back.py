# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Each person undoes the last gesture of their own, where it stands alone, and time stays."""

from __future__ import annotations

from physsim_ros.model.errors import InPast, NotAlone, OutOfHistory
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Axle, Delete, Join, MoveBodies, Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.past import past
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import BOX, DISC, spawning

FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))
LEFT, RIGHT = (-3.0, 5.0, 0.0), (3.0, 5.0, 0.0)


def class_of(*timed: tuple[int, str, Request], frames: int = 60) -> Simulation:
    """Return a world in which people asked for requests before the frame of a number."""
    simulation = Simulation(settings=FLOOR)
    for frame in range(frames):
        for at, author, request in timed:
            if at == frame:
                simulation.requests.submit(request, topic='t', author=author)
        simulation.advance_frame()
    return simulation


ANNA, BEN = (2, 'Anna', spawning('a/0', DISC, LEFT)), (20, 'Ben', spawning('b/0', BOX, RIGHT))


def test_what_is_taken_back_has_never_been_and_what_others_did_stays() -> None:
    simulation, without = class_of(ANNA, BEN), class_of(BEN)

    simulation.take_back('Anna')

    assert simulation.step == without.step
    assert simulation.world.digest() == without.world.digest()
    with pytest.raises(OutOfHistory, match='nothing by Anna'):
        simulation.take_back('Anna')


def test_redo_brings_it_back() -> None:
    simulation = class_of(ANNA, BEN)
    before = simulation.world.digest()

    simulation.take_back('Anna')
    simulation.redo()

    assert simulation.world.digest() == before


@pytest.mark.parametrize(
    'use',
    [
        MoveBodies(names=('a/0',), by=(0.0, 1.0)),
        Join(name='j/0', kind=JointKind.ROD, points=((-3.0, 4.0), (0.0, 9.0)), a='a/0'),
    ],
)
def test_what_others_have_used_since_is_not_taken_back(use: Request) -> None:
    simulation = class_of(ANNA, BEN, (30, 'Ben', use))
    before = simulation.world.digest()

    with pytest.raises(NotAlone, match='delete it instead'):
        simulation.take_back('Anna')

    assert simulation.world.digest() == before
    simulation.take_back('Ben')
    simulation.take_back('Anna')
    assert simulation.world.scene.names == ('b/0',)


def test_it_is_refused_in_the_past_and_where_it_would_take_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    simulation = class_of(ANNA, BEN)
    end = simulation.world.stamp
    simulation.seek(500_000_000)
    with pytest.raises(InPast):
        simulation.take_back('Anna')
    simulation.seek(end)
    monkeypatch.setattr(past, 'LONGEST_AGAIN', 0.5)
    with pytest.raises(NotAlone, match='ago'):
        simulation.take_back('Anna')
    assert simulation.world.scene.names == ('a/0', 'b/0')


def test_commands_that_joined_a_gesture_are_not_taken_back_with_it() -> None:
    simulation = class_of(ANNA)
    simulation.requests.submit(spawning('c/0', BOX, (0.0, 3.0, 0.0)), topic='t', author='Anna')
    # As commands of robots do.
    later = spawning('d/0', BOX, (6.0, 3.0, 0.0))
    simulation.requests.submit(later, topic='t', joined=True)
    simulation.advance_frame()

    simulation.take_back('Anna')

    assert simulation.world.scene.names == ('a/0', 'd/0')


def test_a_later_moment_of_a_gesture_leaves_the_gestures_between_alone() -> None:
    simulation = class_of(ANNA)
    gesture = simulation.requests.gesture
    queue = simulation.requests
    queue.submit(spawning('b/0', BOX, RIGHT), topic='t', author='Ben')
    between = queue.gesture
    late = spawning('a/1', DISC, (0.0, 9.0, 0.0))
    queue.submit(late, topic='t', gesture=gesture, author='Anna')
    simulation.advance_frame()
    assert queue.gesture == between

    simulation.take_back('Anna')

    assert simulation.world.scene.names == ('b/0',)


def test_what_a_person_has_added_and_is_still_there_is_told() -> None:
    rod = Join(name='j/0', kind=JointKind.ROD, points=((-3.0, 4.0), (0.0, 9.0)), a='a/0')
    simulation = class_of(ANNA, BEN, (30, 'Anna', rod))

    assert simulation.past.added_by('Anna') == (('a/0',), ('j/0',))
    assert simulation.past.added_by('Ben') == (('b/0',), ())
    assert simulation.past.added_by('Cleo') == ((), ())


def test_what_a_person_added_is_what_was_added_last_by_them() -> None:
    again = (30, 'Ben', spawning('a/0', DISC, LEFT))
    simulation = class_of(ANNA, BEN, (25, 'Anna', Delete(name='a/0')), again)
    simulation.requests.submit(Axle(point=LEFT[:2]), topic='t', author='Anna')
    simulation.advance_frame()

    assert simulation.past.added_by('Ben') == (('b/0', 'a/0'), ())
    bodies, joints = simulation.past.added_by('Anna')
    assert not bodies
    assert joints == tuple(joint.name for joint in simulation.world.scene.joints)


def test_what_broke_is_not_told_again_where_a_gesture_is_not_taken_back() -> None:
    weak = JointProperties(break_force=1.0)
    hung = Join(
        name='j/0', kind=JointKind.PIN, points=(RIGHT[:2],), a='b/0', b='world', properties=weak
    )
    move = (5, 'Ben', MoveBodies(names=('a/0',), by=(0.0, 1.0)))
    simulation = class_of(ANNA, move, BEN, (20, 'Ben', hung))
    assert not simulation.world.scene.joints

    with pytest.raises(NotAlone):
        simulation.take_back('Anna')

    assert [each.topic for each in simulation.advance_frame().answers] == []
