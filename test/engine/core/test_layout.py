# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Structs of another Chipmunk are found when the engine is imported."""

import re

from cffi import FFI
from physsim_ros.engine import layout
from physsim_ros.model.joints import JointKind
import pymunk
import pytest

from ..jointed import pair, points_of, PROPERTIES
from ...building import joining
from ...source_tree import ROOT

HEADER = (ROOT / 'physsim_ros/engine/core/chipmunk.h').read_text('utf-8')
DECLARATIONS = re.sub('^#.*', '', HEADER, flags=re.MULTILINE)
# Pymunk tells nothing of the others.
UNTOLD = 'cpVect', 'cpTransform', 'cpHashSet', 'cpConstraintClass', 'cpPointQueryInfo'
# Structs that stand one after the other: a field more at their end moves the next ones.
IN_ARRAYS = 'cpContact', 'cpSplittingPlane'


def places():
    """Return where a field more can be: a struct, and the offset in the header."""
    structs = re.finditer(r'typedef struct (\w+) {\n(.*?)}', DECLARATIONS, re.DOTALL)
    for struct in structs:
        if struct[1] in UNTOLD:
            continue
        lines = re.finditer('.*;.*\n', struct[2])
        starts = [struct.start(2) + line.start() for line in lines]
        yield from ((struct[1], start) for start in starts)
        if struct[1] in IN_ARRAYS:
            yield struct[1], struct.end(2)


@pytest.mark.parametrize(('struct', 'place'), list(places()))
def test_a_field_more_anywhere_is_told(monkeypatch, struct, place):
    other = FFI()
    other.cdef(f'{DECLARATIONS[:place]} double more; {DECLARATIONS[place:]}')
    monkeypatch.setattr(layout, 'ffi', other)

    with pytest.raises(ImportError) as refused:
        layout.check_layout()

    told = str(refused.value)
    assert told.startswith(f'Pymunk {pymunk.version} has other structs than the core'), struct


def test_the_structs_of_this_pymunk_are_those_of_the_core():
    layout.check_layout()


@pytest.mark.parametrize('kind', JointKind)
def test_the_constraints_of_every_kind_of_joint_are_compared(kind):
    world = pair()
    world.apply(joining(kind, points_of(kind), **PROPERTIES[kind]))

    (joint,) = world.space.joints.by_name.values()

    assert {type(each) for each in joint.constraints} <= layout.KINDS.keys()
