# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Capacity: the most bodies whose frames take no longer than a sixtieth of a second."""

from __future__ import annotations

from collections.abc import Callable
import statistics

from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World

from .bodies import Bare, falling, laid, timed
from .frames import naive_message

# The tried counts of bodies are a quarter of an octave apart.
COUNTS = [round(250 * 2 ** (quarter / 4)) for quarter in range(21)]
BUDGET = 1e3 / 60  # ms
FRAMES = 40
# Frames before the measured ones: bodies lie on one another by then, or sleep.
BEFORE = 40


def _ours(world: World) -> Callable[[], object]:
    simulation = Simulation()
    simulation.load(world.save())
    return simulation.advance_frame


def _naive(world: World) -> Callable[[], object]:
    bare = Bare(world)

    def frame() -> object:
        bare.frame()
        return naive_message(bare)

    return frame


def _fits(scene: Callable[[int], World], loop: Callable[[World], Callable[[], object]]) -> int:
    """Return the greatest count that a loop keeps up with; 0 is none."""
    low, high = -1, len(COUNTS)
    while high - low > 1:
        middle = (low + high) // 2
        frame = loop(scene(COUNTS[middle]))
        for _ in range(BEFORE):
            frame()
        if statistics.mean(timed(frame) for _ in range(FRAMES)) <= BUDGET:
            low = middle
        else:
            high = middle
    return COUNTS[low] if low >= 0 else 0


def table() -> None:
    """Print a row for bodies that fall and one for bodies at rest."""
    print(
        f'\nMost bodies at 60 Hz in real time, of {COUNTS[0]} .. {COUNTS[-1]}, nothing published;'
        ' naive: attribute reads and messages of Python; + is the most that is tried'
    )
    print('scene      ours  naive  ours/naive')
    for scene in (falling, laid):
        ours, naive = _fits(scene, _ours), _fits(scene, _naive)
        name = 'falling' if scene is falling else 'at rest'
        more = '+' if ours == COUNTS[-1] else ' '
        print(f'{name:8} {ours:6}{more} {naive:5} {ours / max(naive, 1):11.2f}', flush=True)
