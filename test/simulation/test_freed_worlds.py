# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world that was replaced is freed at once, or a part in each frame, without the collector."""

from collections.abc import Callable, Iterator
import gc
from itertools import pairwise
import math
import weakref

from physsim_ros.engine import checkpoint
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import DeleteAll, Join
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import NOWHERE, spawning

SHAPES = (
    Disc(radius=0.2),
    Box(width=0.3, height=0.2),
    Polygon(outline=((0.0, 0.0), (0.3, 0.0), (0.0, 0.3))),
    Compound(element=Box(width=0.1, height=0.1), centers=((-0.1, 0.0), (0.1, 0.0))),
    Chain(points=((-0.2, 0.0), (0.0, 0.1), (0.2, 0.0)), thickness=0.05),
)
COUNT = 40
# Objects that a space has beside its bodies and joints, and that make cycles [1].
FEW = 60
FRAME = 10**9 // 60


@pytest.fixture
def uncollected() -> Iterator[None]:
    """Have no garbage collected within a test."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def crowd() -> Simulation:
    """Return a world of bodies of each shape that touch, with joints of each kind."""
    simulation = Simulation(settings=NOWHERE)
    for number in range(COUNT):
        pose = (0.25 * (number % 8), 0.25 * (number // 8), 0.0)
        shape = SHAPES[number % len(SHAPES)]
        simulation.perform(spawning(f'a/{number}', shape, pose))
    for number, kind in enumerate(JointKind, 1):
        points = [(0.25 * (number % 8), 0.25 * (number // 8)), (0.1, 0.2)]
        simulation.perform(
            Join(
                name=f'j/{number}',
                kind=kind,
                a=f'a/{number}',
                b=f'a/{number - 1}',
                points=tuple(points[: kind.schema.points]),
            )
        )
    simulation.run(0.5)
    return simulation


def objects_of(simulation: Simulation) -> list[weakref.ref[object]]:
    """Return references to Pymunk's objects of the present space."""
    space = simulation.world.space.pm_space
    return [weakref.ref(each) for each in (*space.bodies, *space.shapes, *space.constraints)]


def alive(objects: list[weakref.ref[object]]) -> int:
    """Return how many objects are not freed."""
    return sum(each() is not None for each in objects)


def alive_by_frame(simulation: Simulation, objects: list[weakref.ref[object]]) -> list[int]:
    """Return how many objects are not freed after each of the next frames."""
    counts = []
    for number in range(20):
        simulation.advance(number * FRAME)
        counts.append(alive(objects))
    return counts


REPLACE: dict[str, Callable[[Simulation], object]] = {
    'begin': lambda simulation: simulation.begin(simulation.save()),
    'reset': Simulation.reset,
    'clear': lambda simulation: simulation.perform(DeleteAll()),
    'undo': Simulation.undo,
    'seek': lambda simulation: simulation.seek(0),
}


@pytest.mark.usefixtures('uncollected')
@pytest.mark.parametrize('replace', REPLACE.values(), ids=REPLACE)
def test_what_was_replaced_is_freed_without_the_collector(replace) -> None:
    simulation = crowd()
    objects = objects_of(simulation)
    replace(simulation)
    simulation.apply_requests()
    # Except the background, with its walls.
    assert alive(objects) <= 1
    assert gc.collect() <= 2 * FEW


def chains() -> Simulation:
    """Return a world of few bodies, of many pieces each."""
    points = tuple((0.1 * number, 0.02 * (number % 2)) for number in range(101))
    simulation = Simulation(settings=NOWHERE)
    for number in range(10):
        chain = Chain(points=points, thickness=0.05)
        simulation.perform(spawning(f'a/{number}', chain, (0.0, float(number), 0.0)))
    return simulation


@pytest.mark.usefixtures('uncollected')
@pytest.mark.parametrize(('make', 'size', 'most'), [(crowd, 10, 40), (chains, 100, 202)])
@pytest.mark.parametrize('again', [False, True], ids=['replaced', 'though another one is, too'])
def test_a_world_that_was_replaced_is_freed_in_slices(
    monkeypatch, make, size, most, again
) -> None:
    monkeypatch.setattr(checkpoint, '_SLICE', size)
    simulation = make()
    objects = objects_of(simulation)
    simulation.reset()
    if again:
        simulation.undo()
    counts = alive_by_frame(simulation, objects)
    assert counts[0] > len(objects) / 2, counts
    assert counts == sorted(counts, reverse=True)
    # The world that another one replaces is freed, too, in the same frames.
    assert again or max(before - after for before, after in pairwise(counts)) <= most, counts
    assert counts[-1] <= 1


def test_bodies_in_slices_have_the_same_future(monkeypatch) -> None:
    digests = []
    for size in (3, 10, 10_000):
        monkeypatch.setattr(checkpoint, '_SLICE', size)
        simulation = crowd()
        simulation.perform(spawning('b/0', Disc(radius=0.1), (0.0, 3.0, math.pi)))
        simulation.run(1.0)
        for act in (Simulation.undo, Simulation.redo, Simulation.reset, Simulation.undo):
            act(simulation)
            simulation.advance(FRAME)
        simulation.run(0.5)
        digests.append(simulation.world.digest())
    assert len({*digests}) == 1
