# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parameters of a test's world are those of the node, and refused where it has not them."""

from __future__ import annotations

from typing import Any

from physsim_ros.model.errors import PhysSimError, UnknownProperty
from physsim_ros.testing import own_context, PhysSim
import pytest


@pytest.mark.parametrize(
    ('wrong', 'told'),
    [
        ('gravty', "; nearest is 'gravity'"),
        ('world_fil', "; nearest is 'world_file'"),
        ('zzz', ''),
    ],
)
def test_a_parameter_that_there_is_not_is_refused_and_the_nearest_named(
    monkeypatch: pytest.MonkeyPatch, wrong: str, told: str
) -> None:
    parameters: Any = {wrong: [0.0, 0.0]}
    with own_context(monkeypatch) as context, pytest.raises(UnknownProperty) as refused:
        PhysSim(context, **parameters)
    assert str(refused.value) == f"there is no parameter '{wrong}'{told}"
    assert refused.value.field == wrong


def test_a_value_out_of_range_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with own_context(monkeypatch) as context, pytest.raises(PhysSimError, match='physics_rate is'):
        PhysSim(context, physics_rate=1.0)


def test_simulation_time_is_a_parameter_of_every_node(monkeypatch: pytest.MonkeyPatch) -> None:
    parameters: Any = {'use_sim_time': False}
    with own_context(monkeypatch) as context, PhysSim(context, **parameters) as physsim:
        assert not physsim.node.get_parameter('use_sim_time').value
