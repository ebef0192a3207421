# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of each stage: the share of its functions in the time of a pile that comes down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from test.laws.scenes import floor, join, simulation, spawn
from time import perf_counter
from typing import Any
from unittest import mock

from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation

from .stages import Stage

# A checkpoint is taken in these frames.
PILE, LINKS, FRAMES = 300, 30, 190


def _pile() -> Simulation:
    """Return discs of restitution 0.9 and boxes of 0 above a floor, and a chain beside them."""
    sim = simulation()
    floor(sim)
    for number in range(PILE):
        row, column = divmod(number, 20)
        place = (0.6 * column + 0.1 * (row % 2), 0.5 + 0.6 * row, 0.0)
        if number % 2:
            spawn(sim, f'body/{number}', Disc(radius=0.25), place, elasticity=0.9)
        else:
            spawn(sim, f'body/{number}', Box(width=0.5, height=0.5), place, elasticity=0.0)
    for number in range(LINKS):
        place = (-10.0 + 0.2 * (number + 0.5), 10.0, 0.0)
        spawn(sim, f'link/{number}', Box(width=0.2, height=0.05), place, mass=0.1)
        other = f'link/{number - 1}' if number else 'world'
        points = [(-10.0 + 0.2 * number, 10.0)]
        join(sim, f'axle/{number}', 'axle', points, a=f'link/{number}', b=other)
    return sim


def shares(stages: Sequence[Stage]) -> list[float | None]:
    """Return the share of each stage in the time of all frames; None is inside of Pymunk."""
    spent = [0.0] * len(stages)

    def timed(stage: int, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            began = perf_counter()
            try:
                return function(*arguments, **options)
            finally:
                spent[stage] += perf_counter() - began

        return call

    with ExitStack() as patches:
        for number, stage in enumerate(stages):
            for owner, name in stage.timed:
                original = owner.__dict__[name]
                function = timed(number, getattr(owner, name))
                replacement = (
                    staticmethod(function) if isinstance(original, staticmethod) else function
                )
                patches.enter_context(mock.patch.object(owner, name, replacement))
        sim = _pile()
        spent[:] = [0.0] * len(stages)
        began = perf_counter()
        for _ in range(FRAMES):
            sim.advance_frame()
        total = perf_counter() - began
    return [
        share / total if stage.timed else None for share, stage in zip(spent, stages, strict=True)
    ]
