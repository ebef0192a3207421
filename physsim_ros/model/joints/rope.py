# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A rope: greatest distance between two points, unilateral (Pymunk's SlideJoint)."""

from physsim_ros.model.checks import Within
from physsim_ros.model.joints.schema import JointSchema, Property
from physsim_ros.model.shapes import LARGEST

SCHEMA = JointSchema(
    kind='rope',
    points=2,
    own={'length': Property(check=Within(0.0, LARGEST, 'm'), as_drawn=True)},
)
