# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file costs the world's thread what its length says, whatever it is full of; so do steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import gc
from itertools import pairwise
import time
from typing import Any

from physsim_ros import Robot, Simulation
from physsim_ros.files import load_mapping, state_from
from physsim_ros.model.actors import ACTORS
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots.drives import DRIVES
from physsim_ros.model.robots.sensors import SENSORS
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import SHAPES
import pytest
from tools.bench.full_files import KindOfFile, KINDS, lasers, text_of

# Length of a file, a quarter of the greatest that a page may send, and of a part [characters].
WHOLE, PART = 2**18, 2**16
# CPU time of the whole by that of the part: 4 where work is proportional, 16 by the square.
MOST = 8.0
# Greatest CPU time for which a checkpoint or an undo stops the world's thread [s]; a busy machine
# may take twice as long.
LONGEST_PART = 0.25
# CPU time of the part below which the ratio says nothing [s].
LEAST = 0.02


def costs_of(entries: KindOfFile, length: int) -> dict[str, float]:
    """Return the CPU time of each thing that is done with a file of a length [s]."""
    costs: dict[str, float] = {}

    def note(what: str, act: Callable[[], Any]) -> Any:
        began = time.thread_time()
        found = act()
        costs[what] = time.thread_time() - began
        return found

    text, world = text_of(entries, length), Simulation()
    content = note('text', lambda: load_mapping(text, field='world'))
    state = note('bodies and joints', lambda: state_from(content, WorldSettings(), 240.0))
    note('world', lambda: world.begin(state))
    world.advance_frame()
    note('frame', world.advance_frame)
    costs |= costs_of_rebuilds(world, state)
    scanner = next((body.name for body in world.world.scene.bodies if body.robot), None)
    if entries is lasers and scanner is not None:
        # Those of one robot: a node reads them at their own rates.
        robot = Robot(world, scanner)
        note('readings', lambda: [robot.scan(f's{each}') for each in range(64)])
    return costs


def costs_of_rebuilds(world: Simulation, state: WorldState) -> dict[str, float]:
    """Return the CPU time of a checkpoint, and of the longest part of it and of an undo [s]."""
    cursor = world.past.cursor

    def parts_of(work: Iterator[object]) -> list[float]:
        times = [time.thread_time()]
        times += (time.thread_time() for _ in work)
        return [end - begin for begin, end in pairwise([*times, time.thread_time()])]

    checkpoint = parts_of(cursor.slices_of_keyframe())
    world.open_world(state)
    world.past.undo()
    # Steps have parts of their own, at most 50 ms each.
    undo = parts_of(iter(cursor.carry_out_slice, False))
    return {'checkpoint': sum(checkpoint), 'longest part': max(*checkpoint, *undo)}


def least_costs(entries: KindOfFile, length: int) -> dict[str, float]:
    """Return the lesser of two measurements [s]: other programs make one longer, never shorter."""
    first, second = costs_of(entries, length), costs_of(entries, length)
    return {what: min(took, second[what]) for what, took in first.items()}


@pytest.fixture
def collected() -> Iterator[None]:
    """Have no garbage of other tests collected while a cost is measured."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def words_of(value: Any) -> Iterator[str]:
    """Yield the keys and texts of a value of JSON."""
    match value:
        case str():
            yield value
        case dict():
            for key, each in value.items():
                yield key
                yield from words_of(each)
        case list():
            for each in value:
                yield from words_of(each)


def test_each_kind_of_thing_is_in_a_file() -> None:
    files = [kind(number) for kind in KINDS.values() for number in (0, 1, 2, 64)]
    entries = (entry for each in files for _, entry in each)
    used = {word for entry in entries for word in words_of(entry)}
    known = {*SHAPES, *ACTORS, *DRIVES, *SENSORS, *map(str, JointKind)}
    assert known <= used


@pytest.mark.slow
@pytest.mark.usefixtures('collected')
@pytest.mark.parametrize('kind', KINDS)
def test_a_file_four_times_as_long_takes_some_four_times_as_long(kind: str) -> None:
    part, whole = (least_costs(KINDS[kind], length) for length in (PART, WHOLE))
    row = ', '.join(f'{what} {1e3 * took:.0f} ms' for what, took in whole.items())
    print(f'{kind}: {row}')  # noqa: T201 - the table
    assert whole['longest part'] < LONGEST_PART
    for what, took in whole.items():
        assert took < MOST * max(part[what], LEAST), what
