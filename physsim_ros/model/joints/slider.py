# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A slider: translation along a line, within limits, no rotation (Box2D's prismatic joint)."""

from physsim_ros.model.joints.schema import JointSchema, LIMITS
from physsim_ros.model.shapes import SMALLEST

SCHEMA = JointSchema(kind='slider', points=2, own=LIMITS, least_distance=SMALLEST, has_axis=True)
