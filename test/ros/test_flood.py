# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
