# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The state of a robot in a world file: what was saved is read."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from physsim_ros.files.engine_state import state_entry, with_saved_state
from physsim_ros.model.checkpoint import BodyState
from physsim_ros.model.errors import Refusal
from physsim_ros.model.states import NEVER, RobotState, SPAWNED
import pytest

from ..sensing.worlds import add_robot, plane

COVARIANCE = (1e-3, -2e-4, 2e-3, 3e-5, 4e-5, 5e-4)


@pytest.fixture
def robot() -> BodyState:
    """Give a test a robot."""
    world = plane()
    row = add_robot(world, robot={'drive': {'kind': 'omni'}, 'odometry': {'slip': [0.1, 0.2]}})
    return world.save().bodies[row]


def driven(robot: BodyState, entry: object) -> RobotState:
    """Return the state of a robot by the entry of its state."""
    state = with_saved_state(robot, {'driven': entry}, 240.0).driven
    assert state is not None
    return state


def test_what_was_saved_is_read(robot: BodyState) -> None:
    state = SPAWNED._replace(covariance=COVARIANCE, odometry=(1.0, 2.0, 0.5))
    assert driven(robot, state_entry(replace(robot, driven=state), 240.0)['driven']) == state
    assert driven(robot, {}) == SPAWNED._replace(until=NEVER)


@pytest.mark.parametrize(
    'wrong',
    [
        [0.0] * 5,
        'none',
        [float('nan')] * 6,
        [-1.0, *COVARIANCE[1:]],
        [*COVARIANCE[:5], 1e99],
    ],
)
def test_a_covariance_that_cannot_be_is_refused(robot: BodyState, wrong: Any) -> None:
    with pytest.raises(Refusal) as caught:
        driven(robot, {'covariance': wrong})
    assert caught.value.field == 'covariance'
