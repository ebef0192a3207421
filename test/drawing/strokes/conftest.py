# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests in this folder."""

from physsim_ros.simulation.world import World
import pytest


@pytest.fixture
def world() -> World:
    """Return an empty world."""
    return World()
