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

"""No other world is heard, in this process or another."""

from __future__ import annotations

import json
from pathlib import Path
import subprocess
import sys

from physsim_ros.testing import own_context, PhysSim
import pytest

from ..client import Client
from ..messages import box


def test_no_other_process_hears_a_world_or_is_heard_by_it(
    physsim: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = Client(physsim)
    path = Path(__file__).parents[1] / 'elsewhere' / 'intruder.py'
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    monkeypatch.setenv('ROS_DOMAIN_ID', str(physsim.context.get_domain_id()))
    with subprocess.Popen([sys.executable, path], stdout=subprocess.PIPE, text=True) as intruder:
        while intruder.poll() is None:
            physsim.step()
        assert intruder.returncode == 0
        assert intruder.stdout is not None
        # Its own second node and nobody else: discovery works on this domain. Fast DDS may have
        # written lines of its own before.
        last = intruder.stdout.read().splitlines()[-1]
        assert json.loads(last) == {'heard': 1, 'nodes': ['first', 'second']}
    assert client.events == []
    assert physsim.names == ()
    assert 'first' not in physsim.node.get_node_names()


def test_two_worlds_of_one_process_do_not_see_each_other(
    physsim: PhysSim, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    with own_context(monkeypatch) as context, PhysSim(context, world_dir=str(tmp_path)) as other:
        physsim.spawn(box('a/0'))
        other.spawn(box('b/0'))
        physsim.step(3)
        assert (physsim.names, other.names) == (('a/0',), ('b/0',))
        assert other.time == 0.0
