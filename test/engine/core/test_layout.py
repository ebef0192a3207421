# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Structs of another Chipmunk are found when the engine is imported."""

from physsim_ros.engine import layout
from physsim_ros.model.joints import JointKind
import pymunk
import pytest

from ..jointed import pair, points_of, PROPERTIES
from ...building import joining


def test_the_structs_of_this_pymunk_are_those_of_the_core():
    layout.check_layout()


@pytest.mark.parametrize('kind', layout.KINDS, ids=lambda kind: kind.__name__)
def test_a_field_elsewhere_is_told(kind):
    struct, fields = layout.KINDS[kind]
    one, *_, other = fields
    swapped = fields | {one: fields[other]}

    with pytest.raises(ImportError) as refused:
        layout.check_layout(layout.KINDS | {kind: (struct, swapped)})

    told = str(refused.value)
    assert told.startswith(f'Pymunk {pymunk.version} has other structs than the core')
    assert f'{struct}.{one} is ' in told


@pytest.mark.parametrize('kind', JointKind)
def test_the_constraints_of_every_kind_of_joint_are_compared(kind):
    world = pair()
    world.apply(joining(kind, points_of(kind), **PROPERTIES[kind]))

    (joint,) = world.space.joints.by_name.values()

    assert {type(each) for each in joint.constraints} <= layout.KINDS.keys()
