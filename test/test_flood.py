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

import json

import pytest

from test.outside import Outside

COUNT = 5000


@pytest.mark.parametrize('topic', ['spawn', 'spawn_array'])
def test_a_burst_of_thousands_is_answered_one_by_one_in_order(
    outside: Outside, topic: str
) -> None:
    with outside.start_world(gravity='[0.0, 0.0]') as world:
        world.wait_for('ready')
        program = outside.start_program('flood', COUNT, topic)
        line = program.wait_for('RESULT', 120.0)
        seen = json.loads(line.partition(' ')[2])
        print(
            f'{COUNT} on {topic}: sent in {seen["sent"]:.2f} s, answered in '  # noqa: T201
            f'{seen["answered"]:.2f} s'
        )
        assert program.finish() == 0
        assert seen['answers'] == COUNT
        # The request that came last, and nothing twice.
        assert seen['after'] == 1
        assert seen['ok'] == COUNT
        assert seen['in_order']
        assert seen['topics'] == [f'~/{topic}']
        assert seen['listed_in_order']
        assert world.interrupt() == 0
