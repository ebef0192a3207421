# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
