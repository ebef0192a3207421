# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Amending: a gesture of the past is replaced, as if it had never been anything else."""

from __future__ import annotations

from physsim_ros.model.requests import Configure, Delete, Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.request_queue import Amend
from physsim_ros.simulation.simulation import Simulation

from ..building import BOX, DISC, spawning

FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))


def world_after(*timed: tuple[int, Request], frames: int) -> Simulation:
    """Return a world that was asked for each request before the frame of that number."""
    simulation = Simulation(settings=FLOOR)
    for frame in range(frames):
        for at, request in timed:
            if at == frame:
                simulation.requests.submit(request, topic='t')
        simulation.advance_frame()
    return simulation


def amend(simulation: Simulation, gestures: list[int], requests: list[Request]) -> Frame:
    """Replace the requests of gestures, and return the frame that shows it."""
    simulation.requests.submit(Amend(tuple(gestures), tuple(requests)), topic='t', joined=True)
    frame = simulation.apply_requests()
    assert frame is not None
    return frame


def test_an_amended_world_is_where_it_would_have_come_with_those_requests() -> None:
    wall, ball = spawning('t/0', BOX, (0.0, 1.0, 0.0), anchored=True), spawning('t/1', DISC)
    later = spawning('t/2', DISC, (0.1, 3.0, 0.0))
    straight = world_after((2, ball), (30, later), frames=90)
    other = world_after((2, wall), frames=10)
    gesture = other.requests.gesture
    for frame in range(10, 90):
        if frame == 30:
            other.requests.submit(later, topic='t')
        other.advance_frame()

    amend(other, [gesture], [ball])

    assert other.step == straight.step
    assert other.world.digest() == straight.world.digest()


def test_the_amended_gesture_is_undone_as_one() -> None:
    simulation = world_after((2, spawning('t/0', BOX)), frames=5)
    gesture = simulation.requests.gesture
    simulation.advance_frame()

    amend(simulation, [gesture], [spawning('t/1', DISC), spawning('t/2', DISC)])
    simulation.undo()

    assert simulation.world.snapshot().scene.names == ()


def test_what_the_amended_past_refuses_later_is_dropped() -> None:
    simulation = world_after((2, spawning('t/0', BOX)), frames=5)
    gesture = simulation.requests.gesture
    simulation.requests.submit(Delete(name='t/0'), topic='t')
    simulation.requests.submit(Configure(changes={'damping': 0.5}), topic='t')
    simulation.advance_frame()

    amend(simulation, [gesture], [spawning('t/1', DISC)])

    assert simulation.world.snapshot().scene.names == ('t/1',)
    assert simulation.settings.damping == 0.5


def test_a_refused_request_is_answered_and_the_others_hold() -> None:
    simulation = world_after((2, spawning('t/0', BOX)), frames=5)

    requests = [Delete(name='no/1'), spawning('t/1', DISC)]
    frame = amend(simulation, [simulation.requests.gesture], requests)

    assert [answer.code for answer in frame.answers] == ['unknown_body', '']
    assert simulation.world.snapshot().scene.names == ('t/1',)


def test_several_gestures_become_one() -> None:
    simulation = world_after((2, spawning('t/0', BOX)), frames=5)
    first = simulation.requests.gesture
    simulation.requests.submit(spawning('t/1', BOX, (3.0, 5.0, 0.0)), topic='t')
    second = simulation.requests.gesture
    simulation.advance_frame()

    amend(simulation, [first, second], [spawning('t/2', DISC)])

    assert simulation.world.snapshot().scene.names == ('t/2',)
    simulation.undo()
    assert simulation.world.snapshot().scene.names == ()


def test_gestures_that_changed_nothing_are_amended_by_what_is_made_now() -> None:
    simulation = world_after((2, spawning('t/0', BOX)), frames=5)
    step = simulation.step

    amend(simulation, [simulation.requests.gesture + 7], [spawning('t/1', DISC)])

    assert simulation.step == step
    assert simulation.world.snapshot().scene.names == ('t/0', 't/1')
