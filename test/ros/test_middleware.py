# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Nobody misses an answer for the sake of another: slow listeners, and another middleware."""

from __future__ import annotations

import psutil
import pytest

from ..outside import Outside

# In two bursts: more than the 5,000 messages that Fast DDS keeps for a listener that takes none.
COUNT = 4000


def test_a_listener_that_takes_nothing_costs_the_others_no_answer(outside: Outside) -> None:
    # A world that plays keeps 11 MB a second of the past of so many bodies while answers wait.
    with outside.start_world(gravity='[0.0, 0.0]', speed=0.0) as world:
        world.wait_for('ready')
        process = psutil.Process(world.process.pid)
        with outside.start_elsewhere('deaf') as deaf:
            deaf.wait_for('DEAF')
            before = process.memory_info().rss
            seen = outside.run_program('flood', COUNT, 'paused')
            grown = process.memory_info().rss - before
        assert world.interrupt() == 0
    for topic in ('spawn', 'spawn_array'):
        assert seen[topic]['answers'] == seen[topic]['ok'] == COUNT
        assert seen[topic]['in_order']
    # Twice 4,000 bodies, and the answers that wait: 53 MB measured, as many without the listener.
    assert grown < 80e6


def test_every_answer_reaches_a_reader_of_cyclone_dds_that_reads_all_streams(
    outside: Outside,
) -> None:
    pytest.importorskip('cyclonedds', reason='cyclonedds is not installed: make test')
    with outside.start_world(gravity='[0.0, 0.0]') as world:
        world.wait_for('ready')
        seen = outside.run_program('cyclone', outside.partition, 2, 150)
        assert world.interrupt() == 0
    assert seen['missing'] == []
    assert seen['in_order']
    assert all(seen['messages'].values())
