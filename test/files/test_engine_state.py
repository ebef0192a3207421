# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""State that only the engine reads: arrays and robots come back to the bit, or are refused."""

from __future__ import annotations

import base64
from dataclasses import replace
from typing import Any
import zlib

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files import impulse_cache
from physsim_ros.files.engine_state import state_entry, with_saved_state
from physsim_ros.files.impulse_cache import pack, unpack
from physsim_ros.model.checkpoint import BodyState
from physsim_ros.model.checks import LONGEST
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.latency import LONGEST_DELAY
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.states import NEVER, RobotState, SPAWNED
from physsim_ros.simulation.world import World
import pytest

from ..sensing.worlds import add_robot, plane


@given(st.lists(st.floats(), max_size=50))
def test_numbers_come_back_to_the_bit(numbers: list[float]) -> None:
    array = np.array(numbers, dtype=np.float64)
    assert unpack(pack(array), 'it', np.float64).tobytes() == array.tobytes()


@pytest.mark.parametrize('rows', [4, 0])
@pytest.mark.parametrize('dtype', [np.float64, np.int64, np.uint64])
def test_rows_come_back_as_rows(dtype: Any, rows: int) -> None:
    array = np.arange(3 * rows, dtype=dtype).reshape(-1, 3)
    np.testing.assert_array_equal(unpack(pack(array), 'it', dtype, 3), array, strict=True)


@pytest.mark.parametrize(
    'text',
    [
        *('', 'no base64!', 'ä', None, 7),
        base64.b64encode(b'not compressed').decode(),
        *(base64.b64encode(zlib.compress(odd)).decode() for odd in (b'five!', b'eight by')),
    ],
)
def test_what_was_not_packed_is_refused(text: object) -> None:
    with pytest.raises(BadProperty) as refused:
        unpack(text, 'impulses', np.float64, 2)
    assert refused.value.field == 'impulses'


def test_a_line_that_would_fill_the_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(impulse_cache, 'MOST_BYTES', 800)
    with pytest.raises(BadProperty, match='no end'):
        unpack(pack(np.zeros(10_000)), 'it', np.float64)


COVARIANCE = (1e-3, -2e-4, 2e-3, 3e-5, 4e-5, 5e-4)


@pytest.fixture
def robot() -> BodyState:
    """Return the state of a robot that slips."""
    world = plane()
    row = add_robot(world, robot={'drive': {'kind': 'omni'}, 'odometry': {'slip': [0.1, 0.2]}})
    return world.save().bodies[row]


def driven(robot: BodyState, entry: object) -> RobotState:
    """Return the state of a robot by the entry of its state."""
    state = with_saved_state(robot, {'driven': entry}, 240.0).driven
    assert state is not None
    return state


def test_the_state_of_a_robot_that_was_saved_is_read(robot: BodyState) -> None:
    state = SPAWNED._replace(covariance=COVARIANCE, odometry=(1.0, 2.0, 0.5))
    assert driven(robot, state_entry(replace(robot, driven=state), 240.0)['driven']) == state
    assert driven(robot, {}) == SPAWNED._replace(until=NEVER)


@pytest.mark.parametrize('rate', [240.0, 240.1])
def test_a_command_on_its_way_is_read_however_long_it_counts(rate: float) -> None:
    world = World(physics_rate=rate, settings=plane().settings)
    row = add_robot(world, robot={'drive': {'kind': 'omni', 'latency': LONGEST_DELAY}})
    world.apply(DriveRobot(name='robot/0', velocity=(1.0, 0.0, 0.0), timeout=LONGEST))
    state = world.save().bodies[row]

    read = with_saved_state(replace(state, coming=()), state_entry(state, rate), rate)

    assert state.coming
    assert read.coming == state.coming


@pytest.mark.parametrize(
    'wrong',
    [[0.0] * 5, 'none', [float('nan')] * 6, [-1.0, *COVARIANCE[1:]], [*COVARIANCE[:5], 1e99]],
)
def test_a_covariance_that_cannot_be_is_refused(robot: BodyState, wrong: Any) -> None:
    with pytest.raises(Refusal) as caught:
        driven(robot, {'covariance': wrong})
    assert caught.value.field == 'covariance'
