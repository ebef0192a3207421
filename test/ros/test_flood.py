# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A flood of requests from another process loses none, and each is answered once."""

from __future__ import annotations

from typing import Any

import pytest

from ..outside import Outside

COUNT = 5000


@pytest.fixture(scope='module')
def floods(outside: Outside) -> dict[str, Any]:
    """Return how a world answered a burst of messages, and one array of as many, from outside."""
    with outside.start_world(gravity='[0.0, 0.0]') as world:
        world.wait_for('ready')
        seen = outside.run_program('flood', COUNT)
        assert world.interrupt() == 0
        return seen


@pytest.mark.parametrize('topic', ['spawn', 'spawn_array'])
def test_a_burst_of_thousands_loses_none_and_each_is_answered_once_in_order(
    floods: dict[str, Any], topic: str
) -> None:
    seen = floods[topic]
    text = f'{COUNT} on {topic}: sent in {seen["sent"]:.2f} s, answered in {seen["answered"]:.2f}'
    print(text)  # noqa: T201 - for who reads the log
    assert seen['answers'] == COUNT
    assert seen['ok'] == COUNT
    assert seen['in_order']
    assert seen['topics'] == [f'~/{topic}']


@pytest.mark.parametrize('topic', ['spawn', 'spawn_array'])
def test_a_burst_of_thousands_is_listed_in_spawn_order(floods: dict[str, Any], topic: str) -> None:
    assert floods[topic]['listed_in_order']
