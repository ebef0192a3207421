# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
After any requests in any order, every step of the past is as it was, by any way, to the bit.

HISTORIES says how many histories are played, 20 where it does not; `histories` has the oracle.
"""

from __future__ import annotations

import os
from pathlib import Path
import subprocess
import sys

from physsim_ros.model.requests import Command, Request
from physsim_ros.simulation.world import World
import pytest

from .histories import check, Difference, difference_of, history_of, play, script, shrunk

SEEDS = range(int(os.environ.get('HISTORIES', '20')))


@pytest.mark.parametrize('seed', SEEDS)
def test_a_history_shows_what_its_requests_show_when_they_are_played_from_nothing(
    seed: int,
) -> None:
    check(seed)


@pytest.mark.slow
def test_a_history_shows_the_same_in_another_process() -> None:
    root = str(Path(__file__).parents[2])
    done = subprocess.run(
        [sys.executable, '-m', 'test.simulation.histories', '7', '--digest'],
        env={**os.environ, 'PYTHONHASHSEED': '7'},
        cwd=root,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=120,
    )
    assert done.stdout.strip() == play(history_of(7)).digest()


@pytest.mark.slow
def test_a_replay_that_leaves_out_requests_is_found_and_shrunk_to_a_short_program(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    replay = World.replay

    def forgetful(world: World, request: Request) -> None:
        if not isinstance(request, Command):
            replay(world, request)

    monkeypatch.setattr(World, 'replay', forgetful)
    found = next(seed for seed in range(40) if difference_of(history_of(seed)))
    with pytest.raises(Difference, match=f'seed {found}: '):
        check(found)
    short = shrunk(history_of(found), 20.0)
    assert len(short) <= 8
    assert script(short).splitlines()[0] == 'player = Player()'
    assert 'Command(' in script(short)
