# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Kinds of joints and their properties, one file a kind: points, properties, units, defaults, ranges.

Constraints, Jacobian rows and limits of each kind are in `engine.joints`, glyphs in `view`. Start
with `schema`, then `axle`. A new kind is a file here and a member of `kinds.JointKind`; a property
that no kind has yet is a field of `properties.JointProperties` too.
"""

from physsim_ros.model.joints.kinds import JointKind, kind_from, PROPERTIES
from physsim_ros.model.joints.properties import (
    JOINT_KEYS,
    joint_properties_from,
    JointProperties,
)

__all__ = [
    'JOINT_KEYS',
    'PROPERTIES',
    'JointKind',
    'JointProperties',
    'joint_properties_from',
    'kind_from',
]
