# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An axle: two bodies rotate about a common point, within limits (Box2D's revolute joint)."""

from physsim_ros.model.joints.schema import JointSchema, LIMITS

SCHEMA = JointSchema(kind='axle', points=1, own=LIMITS)
