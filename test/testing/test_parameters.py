# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parameters of a test's world are those of the node, and refused where it has not them."""

from __future__ import annotations

from collections.abc import Callable

from physsim_ros.model.errors import PhysSimError, UnknownProperty
from physsim_ros.testing import PhysSim
import pytest

from ..client import parameter


@pytest.mark.parametrize(
    ('wrong', 'told'),
    [
        ('gravty', "; nearest is 'gravity'"),
        ('world_fil', "; nearest is 'world_file'"),
        ('zzz', ''),
    ],
)
def test_a_parameter_that_there_is_not_is_refused_and_the_nearest_named(
    start: Callable[..., PhysSim], wrong: str, told: str
) -> None:
    with pytest.raises(UnknownProperty) as refused:
        start(**{wrong: [0.0, 0.0]})
    assert str(refused.value) == f"there is no parameter '{wrong}'{told}"
    assert refused.value.field == wrong


def test_a_value_out_of_range_is_refused(start: Callable[..., PhysSim]) -> None:
    with pytest.raises(PhysSimError, match='physics_rate is'):
        start(physics_rate=1.0)


def test_simulation_time_is_a_parameter_of_every_node(start: Callable[..., PhysSim]) -> None:
    assert not parameter(start(use_sim_time=False), 'use_sim_time')
