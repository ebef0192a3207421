# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The past has one budget in bytes; what is kept of it comes again to the bit."""

from collections.abc import Callable
import gc
import math
import tracemalloc

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty, Malformed, OutOfHistory
from physsim_ros.model.joints import JointProperties
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    CommandMotors,
    Configure,
    Join,
    Request,
    Spawn,
)
from physsim_ros.model.shapes import Box, Disc, Polygon, Shape
from physsim_ros.simulation.past.tree import LEAST_MEMORY, MEGABYTE
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..slow import slow

SECOND = 1_000_000_000
# Steps a second, as many as frames [Hz].
RATE = 60.0
NAMES = tuple(f'a/{number}' for number in range(100))
TWISTS = np.random.default_rng(17).uniform(-1.0, 1.0, (64, 100, 3))


def crowd(memory: float) -> Simulation:
    """Return a hundred discs above a floor."""
    sim = Simulation(speed=0.0, history_memory=memory, physics_rate=RATE, publish_rate=RATE)
    sim.perform(Configure(changes={'bounds': (-30.0, 0.0, 30.0, 20.0)}))
    for number, name in enumerate(NAMES):
        at = (0.5 * (number % 50) - 12.0, 1.0 + number // 50, 0.0)
        sim.perform(Spawn(name=name, shape=Disc(radius=0.2), pose=at))
    return sim


def command(sim: Simulation, number: int, *, joined: bool = False) -> None:
    # New strings each time, as they come off the wire.
    names = tuple(f'{name:s}'[:2] + name[2:] for name in NAMES)
    request = Command(names=names, twists=TWISTS[number % 64])
    sim.requests.submit(request, topic='~/command', joined=joined)


def told(sim: Simulation, frames: int) -> list[str]:
    """Advance, and return the events with code `history`."""
    found = []
    for _ in range(frames):
        answers = sim.advance_frame().answers
        found += [answer.message for answer in answers if answer.code == 'history']
    return found


def used(sim: Simulation) -> float:
    return sim.past.budget.used


def traced() -> int:
    """Return the memory that is taken while `tracemalloc` runs [B]."""
    gc.collect()
    return tracemalloc.get_traced_memory()[0]


@pytest.mark.parametrize('paused', [slow(False), True])
def test_a_flood_of_commands_takes_no_more_than_the_budget(paused):
    tracemalloc.start()
    sim = crowd(LEAST_MEMORY)
    # The world and the space before it, of which the bodies are used again, are not the past.
    for _ in range(2):
        sim.advance_frame()
        sim.past.cursor.add_keyframe()
    before, first = traced(), used(sim)
    digests, events = {}, []
    # More than the budget, if only by a half where time stands.
    for number in range(60 if paused else 150):
        for part in range(4):
            command(sim, number + part)
        frame = sim.apply_requests() if paused else sim.advance_frame()
        events += [each for each in frame.answers if each.code == 'history']
        if frame.snapshot.step % RATE == 0:
            digests[frame.snapshot.step] = sim.world.digest()
        assert used(sim) <= LEAST_MEMORY * MEGABYTE
    taken = traced() - before
    tracemalloc.stop()

    assert 0.5 < (used(sim) - first) / taken < 2.0
    assert len(events) == 1
    history = sim.past.line
    assert sim.status.oldest == history.oldest / RATE
    if paused:
        return
    assert 0 < history.oldest < history.head == sim.step
    end = sim.world.digest()
    with pytest.raises(OutOfHistory):
        sim.seek(round((history.oldest - 1) / RATE * SECOND))
    assert sim.world.digest() == end
    kept = [step for step in digests if step >= history.oldest]
    assert kept
    for step in kept:
        sim.seek(round(step / RATE * SECOND))
        assert sim.world.digest() == digests[step]
    sim.seek(round(history.head / RATE * SECOND))
    assert sim.world.digest() == end


def spawn_again(sim: Simulation, shape: Shape) -> None:
    sim.requests.submit(Spawn(name=NAMES[1], shape=shape, pose=(1.0, 9.0, 0.0)), topic='')
    sim.apply_requests()


def corners(size: float) -> tuple[tuple[float, float], ...]:
    return tuple((size * math.cos(k / 5), size * math.sin(k / 5)) for k in range(30))


def throw(sim: Simulation, number: int) -> None:
    """Branch off at a fifth of a second, and run for a second."""
    told(sim, 60)
    sim.seek(SECOND // 5)
    sim.perform(Command(names=NAMES[:1], twists=TWISTS[number][:1]))


def begin_again(sim: Simulation) -> None:
    sim.advance_frame()
    sim.reset()


def trajectory(number: int) -> Request:
    """Return a command of a motor with many points; the first one makes the motor."""
    if not number:
        effort = JointProperties(effort=1.0)
        return Join(name='j/0', kind='axle', points=((0.0, 0.0),), a='a/0', properties=effort)
    points = [[0.01 * step, 0.1 * number + step] for step in range(500)]
    return CommandMotors(commands=[{'joint': 'j/0', 'mode': 'position', 'points': points}])


def with_landmarks(number: int) -> Request:
    """Return the request for a robot that knows many landmarks by their names."""
    names = [f'landmark_{number}/{place}' for place in range(300)]
    robot = {'sensors': [{'kind': 'landmarks', 'bodies': names}]}
    return ChangeBody(name='a/0', properties=Properties(robot=robot))


def along_points(number: int) -> Request:
    """Return the request for an actor with many points."""
    points = [[1e-3 * number, 0.1 * place] for place in range(300)]
    return ChangeBody(name='a/0', properties=Properties(actor={'kind': 'orca', 'points': points}))


ACTS: dict[str, tuple[int, Callable[[Simulation, int], object]]] = {
    'commands': (100, lambda sim, number: (command(sim, number), sim.apply_requests())),
    'discs': (300, lambda sim, n: spawn_again(sim, Disc(radius=0.2 + 1e-6 * n))),
    'boxes': (300, lambda sim, n: spawn_again(sim, Box(width=0.2 + 1e-6 * n, height=0.2))),
    'polygons': (300, lambda sim, n: spawn_again(sim, Polygon(outline=corners(1 + 1e-6 * n)))),
    'frames': (300, lambda sim, _: sim.advance_frame()),
    'checkpoints': (100, lambda sim, _: (sim.advance_frame(), sim.past.cursor.add_keyframe())),
    'branches': (10, throw),
    'resets': (100, lambda sim, _: begin_again(sim)),
    'motors': (30, lambda sim, number: sim.perform(trajectory(number))),
    'robots': (30, lambda sim, number: sim.perform(with_landmarks(number))),
    'actors': (30, lambda sim, number: sim.perform(along_points(number))),
}
QUICK = ('commands', 'frames', 'resets', 'motors', 'robots', 'actors')


@pytest.mark.parametrize('act', [name if name in QUICK else slow(name) for name in ACTS])
def test_the_memory_that_is_told_is_within_a_factor_of_two_of_what_is_taken(act):
    times, carry_out = ACTS[act]
    sim = crowd(100.0)
    sim.advance_frame()
    tracemalloc.start()
    # The bodies that the world uses again after a checkpoint are not the past.
    for number in range(2):
        carry_out(sim, number)
    sim.advance_frame()
    before, first = traced(), used(sim)
    for number in range(2, times + 2):
        carry_out(sim, number)
    sim.advance_frame()
    taken = traced() - before
    tracemalloc.stop()

    assert 0.5 < (used(sim) - first) / taken < 2.0


def test_a_past_that_is_given_up_keeps_no_frames():
    sim = Simulation()
    sim.perform(Spawn(name='a/0', shape=Disc(radius=0.2)))
    told(sim, 60)
    assert sim.past.frames.size

    sim.limit_history(0.0)
    sim.advance_frame()

    assert not sim.past.frames.size


def test_frames_go_first_then_ghosts_and_courses_and_the_course_in_force_last():
    sim = crowd(100.0)
    told(sim, 240)
    for number in range(3):
        sim.seek(SECOND)
        command(sim, number)
        told(sim, 300)
    courses = len(sim.status.courses)
    assert courses == 3
    assert sim.past.course_snapshot(1, 2.0) is not None
    without_frames = used(sim) - sim.past.frames.size

    # Frames are dropped for it, and nothing else.
    sim.limit_memory(without_frames / MEGABYTE + 2.5)
    assert told(sim, 1) == []
    assert len(sim.status.courses) == 3

    # Then the ghosts of the courses, of which the first left goes first.
    sim.limit_memory(3.0)
    (message,) = told(sim, 1)
    assert 'history_memory' in message
    assert sim.past.course_snapshot(1, 2.0) is None
    assert sim.status.oldest == 0.0

    sim.limit_memory(LEAST_MEMORY)
    for number in range(300):
        command(sim, number)
        command(sim, number + 1)
        sim.advance_frame()
        if sim.status.oldest > 0.0:
            break
    assert sim.status.courses == ()
    assert sim.status.oldest > 0.0


def test_what_is_shown_of_the_past_stays_though_the_budget_shrinks():
    sim = crowd(100.0)
    told(sim, 60)
    early = sim.world.digest()
    for number in range(400):
        command(sim, number)
        sim.advance_frame()
    sim.seek(SECOND)
    sim.limit_memory(LEAST_MEMORY)
    assert sim.apply_requests() is not None
    assert sim.status.now == 1.0
    assert sim.status.oldest <= 1.0
    assert sim.world.digest() == early

    sim.seek(round(sim.status.newest * SECOND))
    assert sim.apply_requests() is not None
    assert sim.status.oldest > 1.0


def test_a_gesture_is_undone_as_a_whole_or_not_at_all():
    sim = crowd(LEAST_MEMORY)
    # One gesture, of which the log has the last part only.
    for number in range(600):
        command(sim, number, joined=number > 0)
    sim.apply_requests()
    assert sim.past.line.keyframes[0].serial > 0
    before = sim.world.digest()

    with pytest.raises(OutOfHistory):
        sim.undo()

    assert sim.world.digest() == before
    assert sim.status.undo == ''
    # A later gesture is whole.
    command(sim, 7)
    sim.apply_requests()
    sim.undo()
    assert sim.world.digest() == before


def test_undone_requests_and_resets_are_of_the_budget():
    sim = crowd(2.0)
    for number in range(300):
        command(sim, number)
        sim.advance_frame()
    for _ in range(200):
        sim.undo()
    for _ in range(5):
        sim.redo()
    sim.advance_frame()
    assert used(sim) <= 2.0 * MEGABYTE
    for _ in range(12):
        sim.reset()
        told(sim, 4)
    assert used(sim) <= 2.0 * MEGABYTE
    assert sim.undo().startswith('undid reset')


@pytest.mark.parametrize(
    ('value', 'refusal'),
    [
        (0.0, BadProperty),
        (-1.0, BadProperty),
        (0.5 * LEAST_MEMORY, BadProperty),
        (np.nan, Malformed),
    ],
)
def test_a_budget_that_is_none_is_refused(value, refusal):
    sim = Simulation()
    with pytest.raises(refusal):
        Simulation(history_memory=value)
    with pytest.raises(refusal):
        sim.limit_memory(value)
    assert sim.past.budget.megabytes == 256.0
