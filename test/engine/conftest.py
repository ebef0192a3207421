# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests in this folder."""

from physsim_ros.simulation.world import World
import pytest

from ..building import NOWHERE


@pytest.fixture
def world() -> World:
    """Return an empty world without gravity, friction or loss."""
    return World(settings=NOWHERE)
