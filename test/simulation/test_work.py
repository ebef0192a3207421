# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The work of a request grows with the number of bodies that it is about, not with its square."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from physsim_ros import Command, MoveBodies, Simulation
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Request, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World
import pytest

from ..building import DISC, NOWHERE
from ..work import calls_of

# Between 2, where work is proportional, and 4, where it grows by the square.
TWICE = 2.5
CHARGED = WorldSettings(gravity=(0.0, 0.0), coulomb=1.0)
AIR = {'anchored': True, 'sensor': True, 'medium': {'density': 1.0}}


def spawned(number: int, **properties: object) -> Spawn:
    """Return the request for a disc beside others."""
    pose = (2.0 * number, 0.0, 0.0)
    return Spawn(name=f'd/{number}', shape=DISC, pose=pose, properties=Properties(**properties))


def world_of(count: int, settings: WorldSettings, **properties: object) -> World:
    """Return a world of discs with properties, beside two charged ones, its table made."""
    world = World(settings=settings)
    for number in range(count):
        world.apply(spawned(number, **properties))
    for number in (-1, -2):
        world.apply(spawned(number, charge=1e-9))
    world.snapshot()
    return world


def names_of(count: int) -> tuple[str, ...]:
    """Return the names of the discs."""
    return tuple(f'd/{number}' for number in range(count))


def command(count: int) -> Command:
    """Return the request that sets the poses of all discs."""
    return Command(
        names=names_of(count), poses=np.array([(2.0 * n, 1.0, 0.0) for n in range(count)])
    )


def move(count: int) -> MoveBodies:
    """Return the request that moves all discs."""
    return MoveBodies(names=names_of(count), by=(0.0, 1.0))


def changed(
    request: Callable[[int], Request], settings: WorldSettings, count: int, **properties: object
) -> Callable[[], object]:
    """Return the change of all discs of a world."""
    world, asked = world_of(count, settings, **properties), request(count)
    return lambda: world.apply(asked)


def filled(count: int) -> Callable[[], object]:
    """Return the spawn of uncharged discs in a world where charges attract each other."""
    world, spawns = world_of(0, CHARGED), [spawned(number) for number in range(count)]
    return lambda: [world.apply(each) for each in spawns]


def published_back(count: int) -> Callable[[], object]:
    """Return the change of all discs by the markers with which they were spawned."""
    world, spawns = world_of(count, CHARGED), [spawned(number) for number in range(count)]
    return lambda: [world.apply(each) for each in spawns]


def followed(count: int) -> Callable[[], object]:
    """Return requests, each with a look at the timeline, beside a course of as many requests."""
    simulation = Simulation(settings=NOWHERE, speed=0.0)
    simulation.perform(spawned(0))
    simulation.run(1.0)
    for _ in range(count):
        simulation.perform(move(1))
    simulation.seek(500_000_000)

    def act() -> None:
        for _ in range(count):
            simulation.perform(move(1))
            assert len(simulation.status.courses) == 1

    return act


WORK: dict[str, Callable[[int], Callable[[], object]]] = {
    'a command beside charges': partial(changed, command, CHARGED),
    'a move beside charges': partial(changed, move, CHARGED),
    'a move of media': partial(changed, move, NOWHERE, **AIR),
    'spawns beside charges': filled,
    'markers that come back beside charges': published_back,
    'requests beside a course': followed,
}


@pytest.mark.parametrize('begin', WORK.values(), ids=WORK)
def test_twice_as_many_are_at_most_about_twice_the_work(
    begin: Callable[[int], Callable[[], object]],
) -> None:
    assert calls_of(begin(200)) <= TWICE * calls_of(begin(100))
