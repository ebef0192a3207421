# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A gear: constant ratio of the angles of two bodies (Pymunk's GearJoint)."""

from physsim_ros.model.checks import Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints.schema import JointSchema, Property

# Greatest ratio, and the inverse of the least: between the fastest and the slowest wheel of a
# clock it is 1e6.
_MOST_RATIO = 1e6
# Greatest phase [rad]: exact to a nanometre at an arm of a metre.
_MOST_PHASE = 1e6


def _ratio(value: object, name: str) -> float:
    ratio = Within(-_MOST_RATIO, _MOST_RATIO)(value, name)
    if abs(ratio) < 1.0 / _MOST_RATIO:
        raise BadProperty(f'{name} is {ratio:g}; it must not be 0', field=name)
    return ratio


SCHEMA = JointSchema(
    kind='gear',
    points=1,
    own={
        # Angle of a over angle of b; negative for opposite directions.
        'ratio': Property(check=_ratio, default=1.0),
        # Angle of b times ratio, less angle of a.
        'phase': Property(check=Within(-_MOST_PHASE, _MOST_PHASE, 'rad'), as_drawn=True),
    },
)
