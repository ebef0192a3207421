# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A spring: a damped force along the line between two points (Pymunk's DampedSpring)."""

from physsim_ros.model.checks import HEAVIEST, Within
from physsim_ros.model.joints.schema import JointSchema, Property
from physsim_ros.model.shapes import LARGEST

SCHEMA = JointSchema(
    kind='spring',
    points=2,
    own={
        'stiffness': Property(check=Within(0.0, HEAVIEST, 'N/m'), default=100.0),
        'damping': Property(check=Within(0.0, HEAVIEST, 'N s/m'), default=0.0),
        'rest_length': Property(check=Within(0.0, LARGEST, 'm'), as_drawn=True),
    },
)
