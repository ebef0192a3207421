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

"""Requests that change settings, or replace the world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.settings import check_setting


@dataclass(frozen=True, slots=True, kw_only=True)
class Configure:
    """
    Change settings of the world.

    :param changes: new values by the field of WorldSettings
    """

    changes: Mapping[str, Any]

    def __post_init__(self) -> None:
        object.__setattr__(self, 'changes', dict(self.changes))
        for name in self.changes:
            check_setting(name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Restore:
    """Replace all bodies, joints and settings by those of a saved state."""

    state: WorldState
