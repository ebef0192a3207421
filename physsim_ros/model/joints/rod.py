# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A rod: constant distance between two points (Pymunk's PinJoint, Box2D's distance joint)."""

from physsim_ros.model.joints.schema import JointSchema
from physsim_ros.model.shapes import SMALLEST

SCHEMA = JointSchema(kind='rod', points=2, least_distance=SMALLEST)
