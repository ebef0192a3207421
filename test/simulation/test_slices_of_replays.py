# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Replays that build whole worlds do it in slices, or on the thread that asks for the result."""

from collections.abc import Callable
from threading import get_ident, Thread

from physsim_ros.engine import checkpoint
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, DISC, NOWHERE, spawning

COUNT, SLICE = 60, 10


@pytest.fixture
def sliced(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have slices of a few bodies."""
    monkeypatch.setattr(checkpoint, '_SLICE', SLICE)


def crowd() -> WorldState:
    simulation = Simulation(settings=NOWHERE)
    for number in range(COUNT):
        simulation.perform(spawning(f'a/{number}', BOX, (2.0 * number, 0.0, 0.0)))
    return simulation.save()


@pytest.mark.usefixtures('sliced')
def test_a_load_is_redone_in_slices() -> None:
    simulation = Simulation(settings=NOWHERE)
    simulation.run(0.1)
    simulation.load(crowd())
    simulation.perform(spawning('b/0', DISC, (0.0, 5.0, 0.0)))
    simulation.run(0.1)
    digest = simulation.world.digest()
    simulation.undo()
    simulation.undo()
    assert len(simulation.world) == 0
    simulation.redo()
    # Not to be asked for the world, which would finish the work.
    cursor, slices = simulation.past.cursor, 1
    while cursor.carry_out_slice():
        slices += 1
    # Bodies are built, put into the space, and given shapes.
    assert slices >= 3 * COUNT / SLICE
    assert len(simulation.world) == COUNT
    simulation.redo()
    simulation.seek(round(0.2e9))
    assert simulation.world.digest() == digest


def test_a_run_is_saved_on_the_thread_that_saves_while_the_world_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    simulation = Simulation()
    simulation.load(crowd())
    simulation.run(0.5)
    simulation.perform(spawning('b/0', DISC, (0.0, 5.0, 0.0)))
    begun = simulation.save()
    simulation.run(0.25)
    threads, found = [], []
    step = World.step
    monkeypatch.setattr(
        World, 'step', lambda self, count: threads.append(get_ident()) or step(self, count)
    )
    save = simulation.saver_of_run()
    assert not threads
    thread = Thread(target=lambda: found.append(save()))
    thread.start()
    simulation.run(1.0)
    thread.join()
    assert threads
    assert get_ident() not in threads
    assert digest_of(found[0]) == digest_of(begun)


@pytest.mark.parametrize('history', [0.0, 600.0])
def test_a_run_is_saved_alike_however_long_that_takes(history: float) -> None:
    simulation = Simulation(history=history)
    simulation.perform(spawning('a/0', DISC, (0.0, 5.0, 0.0)))
    simulation.run(1.0)
    simulation.perform(spawning('b/0', DISC, (3.0, 5.0, 0.0)))
    simulation.run(0.25)
    save = simulation.saver_of_run()
    soon = save()

    # Checkpoints come, and the first ones are dropped.
    simulation.run(10.0)

    assert save() == soon
    assert {each.body.name for each in soon.bodies} == {'a/0', 'b/0'}


COPIES = {
    'a run': lambda simulation: simulation.saver_of_run()(),
    'forces': lambda simulation: simulation.forces_now(simulation.frame.snapshot),
}


@pytest.mark.parametrize('copy', COPIES.values(), ids=COPIES)
def test_a_copy_that_fails_is_an_error_and_not_the_end_of_the_world(
    copy: Callable[[Simulation], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation, failures = Simulation(), []
    simulation.perform(spawning('a/0', DISC, (0.0, 5.0, 0.0)))
    simulation.run(0.25)
    simulation.perform(spawning('b/0', DISC, (3.0, 5.0, 0.0)))
    digest = simulation.world.digest()
    boundary = ErrorBoundary(log=failures.append)

    with monkeypatch.context() as patch, boundary.containing('page'):
        patch.setattr(Space, 'step', lambda *_, **__: 1 / 0)
        copy(simulation)

    assert len(failures) == 1
    assert 'by zero' in failures[0]
    assert simulation.world.digest() == digest
    simulation.run(0.25)


def digest_of(state: WorldState) -> str:
    simulation = Simulation()
    simulation.begin(state)
    simulation.run(0.25)
    return simulation.world.digest()
