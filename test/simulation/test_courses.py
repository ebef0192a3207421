# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A course that was left is kept, shown as a ghost, and returned to, to the same bits."""

from dataclasses import replace

import numpy as np
from physsim_ros.model.errors import Failed, OutOfHistory, Refusal
from physsim_ros.model.requests import Command, Delete, Request, Restore
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.past.tree import MOST_COURSES
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import Change, World
import pytest

from .driven import SLAB
from ..building import BOX, spawning

SECOND = 10**9


def simulation(checkpoints: float = 0.5) -> Simulation:
    """Return a pile of boxes that falls."""
    sim = Simulation(checkpoints=checkpoints)
    sim.perform(SLAB)
    for number in range(6):
        sim.perform(spawning(f'a/{number}', BOX, (number / 4, 0.5 + 1.2 * number, number)))
    return sim


def run(sim: Simulation, seconds: float) -> dict[int, np.ndarray]:
    """Advance; return the poses of each frame by its step."""
    shown = {}
    for _ in range(round(seconds * 60)):
        frame = sim.advance_frame()
        assert not [each for each in frame.answers if each.code]
        shown[frame.snapshot.step] = frame.snapshot.poses
    return shown


def act(sim: Simulation, speed: float) -> None:
    """Throw a box of the pile, in the past a branch."""
    sim.perform(Command(names=('a/0',), twists=((speed, 3.0, 0.0),)))


def branch(sim: Simulation, seconds: float, speed: float) -> dict[int, np.ndarray]:
    sim.seek(round(seconds * SECOND))
    act(sim, speed)
    return run(sim, 1.5)


def numbers(sim: Simulation) -> list[int]:
    return [course.number for course in sim.status.courses]


def test_time_stays_where_both_courses_have_it():
    sim = simulation()
    run(sim, 2.0)
    branch(sim, 1.0, 5.0)
    assert [tuple(each) for each in sim.status.courses] == [(1, 1.0, 2.0)]
    sim.seek(round(1.25 * SECOND))
    assert sim.return_to_course(1) == 'on course 1, at 1.250 s'
    assert (sim.status.course, numbers(sim)) == (1, [2])
    sim.seek(SECOND // 2)
    before = sim.world.digest()
    sim.return_to_course(2)
    assert sim.world.digest() == before


def test_a_branch_at_one_step_is_a_course_too():
    sim = simulation()
    run(sim, 0.5)
    act(sim, 1.0)
    run(sim, 0.5)
    sim.seek(SECOND // 2)
    act(sim, 2.0)
    frame = sim.apply_requests()
    assert [each.topic for each in frame.answers] == ['branch']
    assert numbers(sim) == [1]


def test_a_ghost_is_what_the_course_has_shown():
    sim = simulation()
    first = run(sim, 2.0)
    branch(sim, 1.0, 5.0)

    for step in (244, 400, 480):
        ghost = sim.past.course_snapshot(1, step / 240)
        assert np.array_equal(ghost.poses, first[step])
    assert sim.past.course_snapshot(1, 0.5) is None
    assert sim.past.course_snapshot(7, 1.5) is None
    sim.return_to_course(1)
    assert sim.past.course_snapshot(1, 1.5) is None
    assert sim.past.course_snapshot(2, 1.5) is not None


def test_the_ghost_of_a_course_takes_no_memory_for_contacts():
    sizes = set()
    for reports_contacts in (False, True):
        sim = simulation()
        sim.reports_contacts = reports_contacts
        run(sim, 0.5)
        sim.seek(SECOND // 4)
        act(sim, 1.0)
        sizes.add(sim.past.tree.left[1].size)
    assert len(sizes) == 1


def test_a_step_that_was_shown_without_the_oldest_request_is_not_kept():
    sim = Simulation(history=0.5)
    run(sim, 0.25)
    # A loaded state begins with a checkpoint, before which all is dropped in half a second.
    sim.requests.submit(Restore(state=sim.save()), topic='')
    run(sim, 0.5)
    assert sim.step == 180
    with pytest.raises(OutOfHistory):
        sim.seek(SECOND // 4)
    assert sim.status.oldest == 61 / 240


def test_as_many_courses_are_kept_as_are_said():
    sim = simulation()
    run(sim, 0.5)
    for number in range(MOST_COURSES + 3):
        sim.seek(SECOND // 4)
        act(sim, number + 1.0)
        run(sim, 0.05)
    assert len(numbers(sim)) == MOST_COURSES
    with pytest.raises(OutOfHistory):
        sim.return_to_course(1)


def test_what_parts_before_the_oldest_checkpoint_is_dropped():
    sim = simulation()
    run(sim, 1.0)
    branch(sim, 0.75, 5.0)
    assert numbers(sim) == [1]
    sim.limit_history(0.5)
    run(sim, 3.0)

    assert numbers(sim) == []
    before = sim.world.digest()
    with pytest.raises(OutOfHistory):
        sim.return_to_course(1)
    assert sim.world.digest() == before


def test_the_status_tells_time_state_and_words():
    sim = Simulation(speed=0.0)
    status = sim.status
    assert (status.state, status.now, status.newest, status.course) == ('paused', 0.0, 0.0, 1)
    assert (status.undo, status.redo) == ('', '')
    sim.perform(spawning('a/0', BOX))
    sim.speed = 1.0
    run(sim, 1.0)
    assert sim.status.state == 'playing'
    sim.perform(Delete(name='a/0'))
    assert sim.status.undo == 'undo delete a/0'
    sim.undo()
    assert (sim.status.undo, sim.status.redo) == ('undo spawn a/0', 'redo delete a/0')
    sim.seek(SECOND // 2)
    status = sim.status
    assert (status.state, status.oldest, status.now, status.newest) == ('in the past', 0, 0.5, 1)
    sim.speed = -1.0
    sim.advance(0)
    sim.advance(SECOND // 60)
    assert sim.status.state == 'rewinding'
    assert sim.status.now == pytest.approx(0.5 - 1 / 60)
    sim.speed = 0.0
    sim.reset()
    assert sim.status.undo == 'undo reset'
    assert sim.status.course == 2
    sim.undo()
    assert (sim.status.course, sim.status.redo) == (1, 'redo reset')


def test_a_request_that_fails_in_the_past_keeps_no_line(monkeypatch):
    sim = Simulation(boundary=ErrorBoundary(lambda _: None))
    sim.perform(spawning('a/0', BOX, (0.0, 1.0, 0.0)))
    run(sim, 1.0)
    sim.seek(SECOND // 2)
    users = sim.past.line.tip.users
    carry_out = World.apply

    def fail(world: World, request: Request) -> Change:
        if isinstance(request, Command):
            raise ZeroDivisionError
        return carry_out(world, request)

    monkeypatch.setattr(World, 'apply', fail)
    for _ in range(5):
        with pytest.raises(Failed):
            act(sim, 1.0)

    assert sim.past.line.tip.users == users
    assert not sim.past.tree.left


def test_another_world_is_opened_at_time_0_and_one_undo_reverts_it():
    sim = Simulation()
    sim.perform(spawning('a/0', BOX, (0.0, 1.0, 0.0)))
    run(sim, 1.0)
    before = sim.world.digest()
    other = Simulation()
    other.perform(spawning('b/0', BOX, (0.0, 1.0, 0.0)))
    other.perform(spawning('c/0', BOX, (3.0, 1.0, 0.0)))
    assert sim.open_world(other.save()) == 'loaded 2 bodies'
    assert (sim.status.now, sim.world.scene.names, sim.status.undo) == (
        0.0,
        ('b/0', 'c/0'),
        'undo open world',
    )
    run(sim, 0.5)
    sim.reset()
    assert sim.world.scene.names == ('b/0', 'c/0')
    sim.undo()
    sim.seek(0)
    sim.undo()
    assert (sim.world.digest(), sim.status.redo) == (before, 'redo open world')
    sim.redo()
    assert (sim.status.now, sim.world.scene.names, sim.status.undo) == (
        0.0,
        ('b/0', 'c/0'),
        'undo open world',
    )


def test_a_world_that_is_refused_changes_nothing():
    sim = Simulation()
    sim.perform(spawning('a/0', BOX, (0.0, 1.0, 0.0)))
    run(sim, 1.0)
    before, users = sim.world.digest(), sim.past.line.tip.users
    too_large = replace(
        sim.save(),
        settings=replace(sim.world.settings, max_bodies=1),
        bodies=2 * sim.save().bodies,
    )
    with pytest.raises(Refusal):
        sim.open_world(too_large)
    assert (sim.world.digest(), sim.past.line.tip.users) == (before, users)
    assert sim.status.undo == 'undo spawn a/0'
