# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
