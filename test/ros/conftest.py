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

"""Fixtures of the tests in this folder."""

from __future__ import annotations

import math

from physsim_ros.ros import node
from physsim_ros.testing import PhysSim
import pytest

from .journey import Journey
from ..client import Client


@pytest.fixture
def machine_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give a frame all the time that it takes: the machine that tests run on may be slow."""
    monkeypatch.setattr(node, 'MOST_TICK_NS', math.inf)


@pytest.fixture
def journey(physsim: PhysSim, client: Client, machine_in_time: None) -> Journey:
    """Give a test a world whose wall clock it turns."""
    return Journey(physsim, client)
