# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests in this folder."""

from collections.abc import Generator

from physsim_ros.simulation.world import World
import pytest

from .driven import Driven
from ..building import BOX, NOWHERE, spawning


@pytest.fixture
def steps(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list to which each world adds the number of steps that it is to make."""
    asked: list[int] = []
    slices_of_steps = World.slices_of_steps

    def counted(world: World, count: int) -> Generator[None]:
        asked.append(count)
        return slices_of_steps(world, count)

    monkeypatch.setattr(World, 'slices_of_steps', counted)
    return asked


@pytest.fixture
def world() -> World:
    """Return an empty world without gravity, friction or loss."""
    return World(settings=NOWHERE)


@pytest.fixture
def driven() -> Driven:
    """Return a world in which boxes have fallen on each other for five seconds."""
    driven = Driven()
    for number in range(5):
        driven.ask(spawning(f'a/{number}', BOX, (0.2 * number, 1.0 + 1.5 * number, 0.1)))
    driven.record(3.0)
    driven.ask(spawning('late/0', BOX, (0.0, 9.0, 0.0)))
    driven.record(2.0)
    return driven
