# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world with the services of `simulation_interfaces`, whose classes are built for the test."""

from __future__ import annotations

from collections.abc import Callable

from physsim_ros.testing import PhysSim
import pytest

from .caller import Caller
from ..built_interfaces import import_built


@pytest.fixture
def caller(request: pytest.FixtureRequest, start: Callable[..., PhysSim]) -> Caller:
    """Give a test a world, paused at time 0, with the services."""
    import_built('simulation_interfaces', request)
    return Caller(start(speed=0.0, gravity=[0.0, 0.0]))
