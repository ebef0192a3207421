# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bounds of `simulation_interfaces`: the box around a body, in the frame of the body."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Vector3
from physsim_ros.model.shapes import extent_of
from simulation_interfaces.msg import Bounds


def box_around(shape: Any) -> Bounds:
    """Return the box around a shape, in its own frame."""
    low, high = extent_of(shape.form)
    points = [Vector3(x=high[0], y=high[1]), Vector3(x=low[0], y=low[1])]
    return Bounds(type=Bounds.TYPE_BOX, points=points)
