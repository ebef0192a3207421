# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests in this folder."""

from __future__ import annotations

import math

from physsim_ros.ros import frame_loop
from physsim_ros.testing import PhysSim
import pytest

from .journey import Journey
from ..client import Client


@pytest.fixture
def machine_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give a frame all the time that it takes: the machine that tests run on may be slow."""
    monkeypatch.setattr(frame_loop, 'MOST_TICK_NS', math.inf)


@pytest.fixture
def journey(physsim: PhysSim, client: Client, machine_in_time: None) -> Journey:
    """Give a test a world whose wall clock it turns."""
    return Journey(physsim, client)
