# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The work of reading a file grows with its length, and not with a power of that."""

from __future__ import annotations

from collections.abc import Callable
import gc

from physsim_ros.files import load_mapping, state_from
from physsim_ros.model.settings import WorldSettings
from physsim_ros.sketchpad.message import json_object
import pytest

from ..work import calls_of

# Between 2, where work is proportional, and 4, where it grows by the square.
TWICE = 2.5


def text_of_row(count: int, members: str) -> str:
    """Return the text of a file: discs in a row, each joined to the next one."""
    bodies = (
        f'- {{name: b/{n}, circle: {{radius: .1}}, at: [{n}, 0], group: 1}}' for n in range(count)
    )
    joints = (
        f'- {{name: j/{n}, kind: rod, {members.format(n, (n + 1) % count)}'
        f'points: [[{n}, 0], [{(n + 1) % count}, 0]]}}'
        for n in range(count)
    )
    return '\n'.join(('format: 1', 'bodies:', *bodies, 'joints:', *joints))


@pytest.mark.parametrize('members', ['a: b/{}, b: b/{}, ', ''])
def test_joints_by_hand_of_twice_as_many_bodies_are_twice_the_work(members: str) -> None:
    def read(count: int) -> int:
        content = load_mapping(text_of_row(count, members), field='x')
        joints = state_from(content, WorldSettings(), 240.0).joints
        assert [joint.a for joint in joints] == [f'b/{n}' for n in range(count)]
        assert [joint.b for joint in joints] == [f'b/{(n + 1) % count}' for n in range(count)]
        return calls_of(lambda: state_from(content, WorldSettings(), 240.0))

    assert read(200) <= TWICE * read(100)


@pytest.mark.parametrize('read', [load_mapping, lambda text, field: {field: json_object(text)}])
def test_no_garbage_is_collected_while_a_text_is_read(read: Callable[..., object]) -> None:
    """A collection among the million objects of a text stops all threads for half a second."""
    phases: list[str] = []
    gc.callbacks.append(lambda phase, _: phases.append(phase))
    try:
        read(f'{{"bodies": [{"[0, 0], " * 5000}[]]}}', field='world')
    finally:
        gc.callbacks.pop()
    # Before it and after it; of so many lists there would be seven.
    assert phases.count('start') <= 2
