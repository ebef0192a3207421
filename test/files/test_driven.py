# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The state of a robot in a world file: what was saved is read, of earlier versions too."""

from __future__ import annotations

from typing import Any

from physsim_ros.files.engine_state import driven_entry, driven_from
from physsim_ros.model.errors import Refusal
from physsim_ros.model.robot_states import SPAWNED
from physsim_ros.model.scene import Body
import pytest

from ..sensing.worlds import add_robot, plane

COVARIANCE = (1e-3, -2e-4, 2e-3, 3e-5, 4e-5, 5e-4)


@pytest.fixture
def robot() -> Body:
    """Give a test the body of a robot."""
    world = plane()
    row = add_robot(world, robot={'drive': {'kind': 'omni'}, 'odometry': {'slip': [0.1, 0.2]}})
    return world.snapshot().scene.bodies[row]


def test_what_was_saved_is_read(robot: Body) -> None:
    state = SPAWNED._replace(covariance=COVARIANCE, odometry=(1.0, 2.0, 0.5))
    assert driven_from(driven_entry(state, 240.0), robot, 240.0) == state


def test_a_file_without_a_covariance_has_the_variances_of_its_path(robot: Body) -> None:
    state = driven_from({'path': [3.0, 2.0], 'seconds': 0.0}, robot, 240.0)
    assert state.covariance == pytest.approx((0.03, 0.0, 0.03, 0.0, 0.0, 0.04 * 5.0))
    assert driven_from({}, robot, 240.0).covariance == SPAWNED.covariance


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
def test_a_covariance_that_cannot_be_is_refused(robot: Body, wrong: Any) -> None:
    with pytest.raises(Refusal) as caught:
        driven_from({'covariance': wrong}, robot, 240.0)
    assert caught.value.field == 'covariance'
