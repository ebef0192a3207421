# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The actions of a node that the services of `simulation_interfaces` use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationControl:
    """
    The actions of a node that the services of `simulation_interfaces` use; they return messages.

    :param simulation: the world and its time
    :param values: of the parameters of the node, by name, always up to date
    :param current_snapshot: applies the waiting requests; returns the snapshot that is shown
    :param actions: of the services for time, by name; each raises a Refusal
    :param load_world: loads the world of a name; raises a PhysSimError
    :param note_change: has parameters and pages follow what was changed
    :param world_dir: directory of the user's worlds
    """

    simulation: Simulation
    values: Mapping[str, Any]
    current_snapshot: Callable[[], Snapshot]
    actions: Mapping[str, Callable[[], str]]
    load_world: Callable[[str], str]
    note_change: Callable[[], None]
    world_dir: Path

    @property
    def frame_id(self) -> str:
        """Return the name of the world frame."""
        return str(self.values['frame_id'])
