# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A program collects the garbage among all objects seldom, and does not visit what is loaded."""

from collections.abc import Iterator
import gc
from typing import Any

from physsim_ros.ros.programs import collector
from physsim_ros.ros.programs.collector import Collector
from physsim_ros.runtime.garbage_collection import suspended_collection
import pytest

# Objects that a test makes [1]; CPython collects the youngest whenever there are 700 more.
MANY = 200_000


@pytest.fixture
def collections() -> Iterator[list[int]]:
    """Give a test the generations of the collections that are made meanwhile."""
    made: list[int] = []

    def note(phase: str, info: dict[str, Any]) -> None:
        if phase == 'stop':
            made.append(info['generation'])

    thresholds, was_enabled = gc.get_threshold(), gc.isenabled()
    gc.callbacks.append(note)
    yield made
    gc.callbacks.remove(note)
    gc.set_threshold(*thresholds)
    (gc.enable if was_enabled else gc.disable)()


class Cycle:
    """An object that only a collection frees."""

    def __init__(self) -> None:
        self.itself = self


def test_growth_alone_has_not_all_objects_visited(collections: list[int]) -> None:
    Collector()
    collections.clear()
    kept = [Cycle() for _ in range(MANY)]
    assert len(kept) == MANY
    assert set(collections) == {0, 1}


def test_all_objects_are_visited_for_a_thousandth_of_the_time(
    collections: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 0.0
    monkeypatch.setattr(collector.time, 'monotonic', lambda: now)
    monkeypatch.setattr(collector.time, 'thread_time', lambda: 0.2 * collections.count(2))
    it = Collector()
    collections.clear()
    for count in (1, 2):
        garbage = [Cycle() for _ in range(MANY // 2)]
        assert garbage
        del garbage
        while collections.count(2) < count and now < 1000.0:
            now += 1.0
            it.collect_if_due()
    assert collections.count(2) == 2
    # A collection takes 0.2 s here, and as much for each block of memory.
    assert now >= 2 * 0.2 * 1000.0 * 0.5


def test_nothing_is_visited_where_nothing_has_grown(collections: list[int]) -> None:
    it = Collector()
    it._ended -= 1e6  # noqa: SLF001 - long ago
    collections.clear()
    it.collect_if_due()
    assert 2 not in collections


def test_what_is_made_while_collection_is_suspended_is_not_visited_after_it(
    collections: list[int],
) -> None:
    gc.enable()
    gc.unfreeze()
    gc.collect()
    with suspended_collection():
        kept = [Cycle() for _ in range(MANY)]
    young = sum(gc.get_count())
    assert len(kept) == MANY
    assert len(gc.get_objects(generation=0)) < MANY / 10 > young
