# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A client that asks much costs others at most a share of the server's thread, and no place."""

import asyncio
from collections.abc import Callable, Coroutine
import time

from physsim_ros.sketchpad.server.turns import BURST, QUANTUM, SHARE, Turns
import pytest
from tornado.iostream import StreamClosedError

# CPU time of a turn, after which no other begins in the same pass of the loop [s].
WORK = 1.25 * QUANTUM


def work() -> None:
    """Spend CPU time."""
    end = time.thread_time() + WORK
    while time.thread_time() < end:
        pass


def run(test: Callable[[Turns], Coroutine[None, None, None]]) -> None:
    loop = asyncio.new_event_loop()
    try:
        loop.run_until_complete(test(Turns()))
    finally:
        loop.close()


async def ask(turns: Turns, served: list[str], *clients: str) -> None:
    """Have clients ask at once, each on a connection of its own, and work in their turns."""

    async def take(client: str) -> None:
        await turns.take(object(), client)
        work()
        served.append(client)

    await asyncio.gather(*map(take, clients))


def test_the_client_that_took_least_time_is_next() -> None:
    served: list[str] = []

    async def greedy_and_modest(turns: Turns) -> None:
        greedy = asyncio.create_task(ask(turns, served, *['greedy'] * 20))
        # All of them ask, and the first one's turn begins.
        await asyncio.sleep(0.0)
        await asyncio.gather(greedy, ask(turns, served, *['modest'] * 3))

    run(greedy_and_modest)
    # Others begin before the modest client has asked, and where both took as much.
    assert [served[:8].count(client) for client in ('modest', 'greedy')] == [3, 5]
    assert len(served) == 23


def test_time_that_was_not_asked_for_is_not_saved() -> None:
    served: list[str] = []

    async def early_and_late(turns: Turns) -> None:
        for _ in range(6):
            await ask(turns, served, 'early')
        await ask(turns, served, *['early', 'late'] * 6)

    run(early_and_late)
    assert served[6:12].count('late') <= 4


def test_turns_take_a_share_of_the_time() -> None:
    async def flood(turns: Turns) -> None:
        began, used = time.monotonic(), time.thread_time()
        for _ in range(round(2.0 * BURST / WORK)):
            await turns.take('asker', 'client')
            work()
        passed, used = time.monotonic() - began, time.thread_time() - used
        # Beyond what may be taken at once, and one turn more, which is whole.
        assert used < 1.05 * (BURST + SHARE * passed + WORK)

    run(flood)


def test_an_asker_that_gives_up_takes_no_turn() -> None:
    async def ask(turns: Turns, asker: int) -> None:
        await turns.take(asker, 'client')
        work()

    async def leave(turns: Turns) -> None:
        first, second, third = (asyncio.create_task(ask(turns, asker)) for asker in range(3))
        await asyncio.sleep(0.0)
        for asker in (0, 1):
            turns.give_up(asker)
        await asyncio.gather(first, third)
        with pytest.raises(StreamClosedError):
            await second

    run(leave)
