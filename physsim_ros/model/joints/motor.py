# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A motor: an axle that drives the relative angular velocity by a bounded torque."""

from physsim_ros.model.checks import FASTEST, HEAVIEST, Within
from physsim_ros.model.joints.schema import JointSchema, Property

SCHEMA = JointSchema(
    kind='motor',
    points=1,
    own={
        # Of a relative to b, counter-clockwise.
        'rate': Property(check=Within(-FASTEST, FASTEST, 'rad/s'), default=1.0),
        'max_torque': Property(check=Within(0.0, HEAVIEST, 'N m'), default=1000.0),
    },
)
