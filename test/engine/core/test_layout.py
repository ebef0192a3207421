# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Structs of another Chipmunk are found when the engine is imported."""

from physsim_ros.engine import layout
import pymunk
import pytest


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
