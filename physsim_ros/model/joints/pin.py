# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A pin: a weld of two bodies at one point (Box2D's weld joint)."""

from physsim_ros.model.joints.schema import JointSchema

SCHEMA = JointSchema(kind='pin', points=1)
