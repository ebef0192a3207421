# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file costs the world's thread what its length says, whatever it is full of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import math
import time
from typing import Any

from physsim_ros import Simulation
from physsim_ros.files import load_mapping, state_from
from physsim_ros.model.settings import WorldSettings
import pytest
import yaml

pytestmark = pytest.mark.slow

# Length of a file, a quarter of the greatest that a page may send, and of a part [characters].
WHOLE, PART = 2**18, 2**16
# CPU time of the whole by that of the part: 4 where work is proportional, 16 by the square.
MOST = 8.0


def disc(number: int, x: float, y: float, **more: Any) -> dict[str, Any]:
    return {'name': f'b/{number}', 'circle': {'radius': 0.2}, 'at': [x, y], **more}


def row(number: int) -> Iterator[tuple[str, dict[str, Any]]]:
    yield 'bodies', disc(number, 0.5 * number, 0.0)


def joined(number: int) -> Iterator[tuple[str, dict[str, Any]]]:
    x = 0.5 * number
    yield from row(number)
    ends = {'a': f'b/{number}', 'b': f'b/{max(number - 1, 0)}' if number else 'world'}
    yield (
        'joints',
        {'name': f'j/{number}', 'kind': 'rod', **ends, 'points': [[x, 0], [x - 0.5, 0]]},
    )


def pinned(number: int) -> Iterator[tuple[str, dict[str, Any]]]:
    yield from row(number)
    yield 'joints', {'name': f'j/{number}', 'kind': 'pin', 'points': [[0.5 * number, 0.0]]}


def text_of(entries: Callable[[int], Iterator[tuple[str, dict[str, Any]]]], length: int) -> str:
    """Return the text of a file of a length, full of entries."""
    lists: dict[str, list[str]] = {'bodies': [], 'joints': []}
    number = size = 0
    while size < length:
        for name, entry in entries(number):
            line = yaml.safe_dump([entry], default_flow_style=True, width=math.inf)[1:-2]
            lists[name].append(f'- {line}\n')
            size += len(line) + 3
        number += 1
    parts = (f'{name}:\n{"".join(lines)}' for name, lines in lists.items() if lines)
    return f'format: 1\ngravity: [0, 0]\n{"".join(parts)}'


@pytest.mark.parametrize('entries', [row, joined, pinned])
def test_a_file_four_times_as_long_takes_some_four_times_as_long(
    entries: Callable[[int], Iterator[tuple[str, dict[str, Any]]]],
) -> None:
    took = []
    for length in (PART, WHOLE):
        text = text_of(entries, length)
        began = time.thread_time()
        content = load_mapping(text, field='world')
        world = Simulation()
        world.begin(state_from(content, WorldSettings(), 240.0))
        world.advance_frame()
        world.past.cursor.add_keyframe()
        took.append(time.thread_time() - began)
    print(f'{entries.__name__}: {took[0]:.2f}, {took[1]:.2f} s')  # noqa: T201 - for the log
    assert took[1] < MOST * took[0]
