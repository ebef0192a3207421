# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Thousands of requests are applied in slices: time goes on between them, but in no gesture."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from threading import Thread

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import CommandMotors, DriveRobot
from physsim_ros.runtime.slices import end_slice, wrap_future
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.ticks import FrameEnd, TickLimits
import pytest

from .driven import OVERDUE
from ..building import BOX, NOWHERE, spawning

FRAME = 10**9 // 60
COUNT, SLICE = 100, 10


def submit(simulation: Simulation, *, joined: bool) -> None:
    for number in range(COUNT):
        body = spawning(f'a/{number}', BOX, (2.0 * number, 0.0, 0.0))
        simulation.requests.submit(body, topic='~/spawn_array', joined=joined and number > 0)


def spending(count: int) -> TickLimits:
    """Return the limits of a call that has time for a number of requests."""
    return TickLimits(is_spent=spent_after(count))


def spent_after(count: int) -> Callable[[], bool]:
    """Return whether there is no time left, which lasts for a number of requests."""
    asked = 0

    def is_spent() -> bool:
        nonlocal asked
        asked += 1
        return asked >= count

    return is_spent


def tick(simulation: Simulation, number: int) -> int:
    """Tick with time for a slice; return the number of frames."""
    return len(simulation.advance(number * FRAME, spending(SLICE)))


def test_time_goes_on_between_requests():
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    submit(simulation, joined=False)
    for number in range(1, COUNT // SLICE + 1):
        assert tick(simulation, number) == 1
        assert len(simulation.world) == SLICE * number
    assert simulation.step == 4 * COUNT // SLICE


def test_time_stands_within_a_gesture():
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    step = simulation.step
    submit(simulation, joined=True)
    for number in range(1, COUNT // SLICE):
        assert tick(simulation, number) == 0
        assert simulation.step == step
    # The time that it stood for is not made up for.
    assert tick(simulation, COUNT // SLICE) == 1
    assert len(simulation.world) == COUNT
    assert simulation.step <= step + 4
    assert simulation.undo().startswith('undid')
    assert len(simulation.world) == 0


def test_each_request_of_a_slice_is_answered_once_and_in_order():
    simulation = Simulation(settings=NOWHERE)
    submit(simulation, joined=True)
    answers: list[Answer] = []
    for number in range(COUNT // SLICE + 1):
        for frame in simulation.advance(number * FRAME, spending(SLICE)):
            answers += frame.answers
        answers += simulation.applier.take_answers()
    assert [answer.subject for answer in answers] == [f'a/{each}' for each in range(COUNT)]


@pytest.mark.parametrize(
    'command',
    [
        DriveRobot(name='r/0', velocity=(1.0, 0.0, 0.0)),
        CommandMotors(
            commands=({'joint': 'j/0', 'mode': 'velocity', 'points': [(0.0, 1.0, 0.0)]},)
        ),
    ],
)
def test_commands_of_robots_do_not_stop_time(command):
    """They join the gesture before them, so that an undo takes them back with it."""
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    for _ in range(COUNT):
        simulation.requests.submit(command, topic='cmd_vel', joined=True)
    assert tick(simulation, 1) == 1


def test_a_call_behind_requests_waits_for_them():
    simulation = Simulation(settings=NOWHERE)
    submit(simulation, joined=True)
    seen: list[int] = []

    def call() -> list[Answer]:
        seen.append(len(simulation.world))
        return [Answer(topic='~/undo')]

    simulation.applier.make_call(call, Wait.BEHIND_REQUESTS)
    simulation.applier.apply_ready(spent_after(SLICE))
    assert seen == []
    simulation.applier.make_call(call, Wait.NONE)
    assert seen == [SLICE]
    for number in range(COUNT // SLICE + 1):
        tick(simulation, number)
    assert seen == [SLICE, COUNT]


def begin_reading(simulation: Simulation, wait: Wait = Wait.FOR_SEEK) -> Future[str]:
    """Submit a call that waits for a file, and a request behind it; return what is waited for."""
    future: Future[str] = Future()

    async def call() -> list[Answer]:
        return [Answer(topic='~/load_world', message=await wrap_future(future))]

    simulation.applier.make_call(call, wait)
    late = spawning('late/0', BOX, (0.0, 0.0, 0.0))
    simulation.requests.submit(late, topic='~/spawn')
    return future


def test_time_goes_on_while_a_call_waits_for_a_file_and_requests_wait_for_the_call():
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    future = begin_reading(simulation)
    for number in range(1, 5):
        assert tick(simulation, number) == 1
        assert not simulation.applier.apply_ready()
        assert len(simulation.world) == 0
    future.set_result('loaded')
    (frame,) = simulation.advance(5 * FRAME)
    assert simulation.step == 20
    assert [each.message for each in frame.answers] == ['loaded', 'spawned late/0']
    assert simulation.applier.apply_ready()


@pytest.mark.parametrize('wait', [Wait.TO_READ, Wait.NONE])
def test_requests_go_on_while_a_file_is_written_and_only_calls_that_read_it_wait(wait):
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    future, seen = begin_reading(simulation, wait), list[Wait]()
    assert tick(simulation, 1) == 1
    assert len(simulation.world) == 1
    # Who wants the world at once does not wait for the file.
    assert simulation.advance_frame().stepped

    def call(each: Wait) -> list[Answer]:
        seen.append(each)
        return []

    for each in (Wait.FOR_SEEK, Wait.NONE):
        simulation.applier.make_call(partial(call, each), each)
    tick(simulation, 2)
    assert seen == [Wait.NONE, Wait.FOR_SEEK][: 1 if wait is Wait.TO_READ else 2]
    future.set_result('written')
    (frame,) = simulation.advance(3 * FRAME)
    assert [each.message for each in frame.answers] == ['written']
    assert seen == [Wait.NONE, Wait.FOR_SEEK]


def test_a_single_frame_of_a_paused_world_waits_for_a_call_that_waits_for_a_file():
    simulation = Simulation(settings=NOWHERE, speed=0.0)
    tick(simulation, 0)
    future = begin_reading(simulation)
    simulation.playback.queue_frame()
    assert tick(simulation, 1) == 0
    future.set_result('loaded')
    (frame,) = simulation.advance(2 * FRAME)
    assert frame.stepped
    assert frame.snapshot.scene.names == ('late/0',)


def test_who_wants_the_world_at_once_waits_for_the_file():
    simulation = Simulation(settings=NOWHERE)
    future = begin_reading(simulation)
    assert not simulation.applier.apply_ready()
    Thread(target=future.set_result, args=('loaded',)).start()
    simulation.advance_frame()
    assert len(simulation.world) == 1


def test_a_single_frame_of_a_paused_world_waits_for_all_requests():
    simulation = Simulation(settings=NOWHERE, speed=0.0)
    tick(simulation, 0)
    submit(simulation, joined=False)
    simulation.playback.queue_frame()
    for number in range(1, COUNT // SLICE):
        assert tick(simulation, number) == 0
    (frame,) = simulation.advance(10**9, spending(SLICE + 1))
    assert frame.stepped
    assert len(frame.snapshot.scene.bodies) == COUNT


def test_a_refused_request_is_no_hold():
    simulation = Simulation(settings=NOWHERE)
    tick(simulation, 0)
    for _ in range(COUNT):
        simulation.requests.refuse(Refusal('no'), Origin('~/spawn'))
    # Refusals are answers: none of them waits for the world.
    assert tick(simulation, 1) == 1


def test_a_frame_of_slow_steps_ends_after_any_step_and_later_calls_make_the_others():
    slow, fast = Simulation(), Simulation()
    for simulation in (slow, fast):
        simulation.perform(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    for call in range(1, 9):
        frames = slow.advance(call * FRAME, replace(OVERDUE, frame_end=FrameEnd.STEP))
        # The first call only shows the box.
        assert [frame.snapshot.step for frame in frames] == [call - 1]
    while fast.step < 4:
        fast.advance_frame()
    slow.applier.seek(fast.world.stamp)
    assert (slow.step, slow.world.digest()) == (4, fast.world.digest())
    # Where there is time, a frame is whole.
    slow.applier.seek(round(7e9 / 240))
    (frame,) = slow.advance(20 * FRAME, TickLimits(frame_end=FrameEnd.STEP))
    (frame,) = slow.advance(21 * FRAME, TickLimits(frame_end=FrameEnd.STEP))
    assert frame.snapshot.step == 8


def test_slices_of_a_call_that_wait_for_nothing_go_on_while_there_is_time():
    simulation = Simulation(settings=NOWHERE)
    made = []

    async def call() -> list[Answer]:
        for number in range(1, COUNT + 1):
            made.append(number)
            await end_slice()
        return [Answer(topic='~/call', message='done')]

    tick(simulation, 0)
    simulation.applier.make_call(call, Wait.FOR_SEEK)
    submit(simulation, joined=False)
    # The first slice begins it.
    tick(simulation, 1)
    assert len(made) == 1
    for number in range(2, COUNT // SLICE + 2):
        tick(simulation, number)
        assert len(made) == min(COUNT, 1 + SLICE * (number - 1))
        assert len(simulation.world) == 0
    tick(simulation, COUNT)
    assert len(simulation.world) > 0
