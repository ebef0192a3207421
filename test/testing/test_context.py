# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""No other world is heard, in this process or another."""

from __future__ import annotations

from collections.abc import Callable
import json
import os
from pathlib import Path
import subprocess
import sys

from hypothesis import given, settings
from hypothesis.strategies import floats
from physsim_ros.testing import box, disc, own_world, PhysSim
import pytest

from ..client import Client


@pytest.fixture(params=['', 'ROS_LOCALHOST_ONLY=1', 'ROS_STATIC_PEERS=127.0.0.1'])
def variable(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> tuple[str, ...]:
    """Set an environment variable that lets nodes be heard, before a test has its world."""
    named: tuple[str, ...] = tuple(request.param.split('=')) if request.param else ()
    if named:
        monkeypatch.setenv(*named)
    return named


def test_no_other_process_hears_a_world_or_is_heard_by_it(
    variable: tuple[str, str], physsim: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    if variable:
        # The other process has it still.
        monkeypatch.setenv(*variable)
    client = Client(physsim)
    path = Path(__file__).parents[1] / 'elsewhere' / 'intruder.py'
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    monkeypatch.setenv('ROS_DOMAIN_ID', str(physsim.context.get_domain_id()))
    command = [sys.executable, path, 'second']
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as intruder:
        while intruder.poll() is None:
            physsim.step()
        assert intruder.returncode == 0
        assert intruder.stdout is not None
        # The two of them and nobody else: discovery works on this domain. Fast DDS may have
        # written lines of its own before.
        last = intruder.stdout.read().splitlines()[-1]
        assert json.loads(last) == {'heard': 1, 'nodes': ['first', 'second']}
    assert client.events == []
    assert physsim.names == ()
    assert 'first' not in physsim.node.get_node_names()


def test_two_worlds_of_one_process_do_not_see_each_other(
    physsim: PhysSim, start: Callable[..., PhysSim]
) -> None:
    other = start()
    physsim.spawn(box('a/0'))
    other.spawn(box('b/0'))
    physsim.step(3)
    assert (physsim.names, other.names) == (('a/0',), ('b/0',))
    assert other.time == 0.0


def test_a_property_of_many_worlds_has_one_for_each_example() -> None:
    worlds: list[PhysSim] = []

    @settings(max_examples=3, deadline=None, derandomize=True)
    @given(height=floats(1.0, 10.0))
    def falls(height: float) -> None:
        with own_world(gravity=[0.0, -1.0]) as physsim:
            physsim.spawn(disc('ball/0', at=(0.0, height)))
            physsim.run(1.0)
            assert physsim.pose('ball/0').y == pytest.approx(height - 0.5, abs=1e-6)
            assert physsim.time == 1.0
            worlds.append(physsim)

    falls()
    assert len(worlds) == 3
    assert 'ROS_AUTOMATIC_DISCOVERY_RANGE' not in os.environ
