# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for the topmost bodies, or joints, at a point."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.checks import check_point
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class AtPoint:
    """A request for the topmost bodies, or joints, at a point [m]."""

    point: Point
    frame: str = ''

    def __post_init__(self) -> None:
        check_point(self.point, 'point')


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin(AtPoint):
    """Weld the two topmost bodies at a point, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(AtPoint):
    """Join the two topmost bodies at a point by an axle, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(AtPoint):
    """Fix the topmost body at a point to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Release(AtPoint):
    """Undo the anchoring of the topmost body at a point, and remove pins and axles there."""
