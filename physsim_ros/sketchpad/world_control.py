# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The actions of a node for its pages and the services of `simulation_interfaces`, besides requests.

Law: a page can do nothing that a service, a topic or a parameter cannot do; but only people at
pages have names, and an undo of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.simulation.request_queue import Wait
from physsim_ros.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldControl:
    """
    The actions of a node; a returned text is a message about it.

    :param boundary: of the node
    :param simulation: the world and its time
    :param values: of the parameters of the node, by name, always up to date
    :param set_parameter: sets a parameter by its name; raises a Refusal
    :param world_dir: directory of the user's worlds
    :param drawing_settings: returns the settings of drawing
    :param current_snapshot: applies the waiting requests; returns the snapshot that is shown
    :param submit_call: makes a call at its time and tells its answers; raises Busy where too many
        requests wait
    :param services: actions by the names of the services, with their times; each raises a
        PhysSimError where it is refused
    :param note_change: has parameters follow what was changed, and a short seek be done at once
    :param perform_on: performs a service, `load_world` or `save_world`, on the world of a name;
        raises a PhysSimError
    :param set_speed: sets the speed [simulation seconds a second]; raises a Refusal
    :param seek: goes to a simulation time [ns]; raises a Refusal
    :param locked_bodies: returns patterns of the names of bodies that pupils do not change
    :param end_program: ends the program after the replies that wait; returns False, and does
        nothing, where it is not the program of this world alone
    """

    boundary: ErrorBoundary
    simulation: Simulation
    values: Mapping[str, Any]
    set_parameter: Callable[[str, str | bool], None]
    world_dir: Path
    drawing_settings: Callable[[], DrawingSettings]
    current_snapshot: Callable[[], Snapshot]
    submit_call: Callable[[Callable[[], Iterable[Answer]], Wait], None]
    services: Mapping[str, tuple[Callable[[], str], Wait]]
    note_change: Callable[[], None]
    perform_on: Callable[[str, str], str]
    set_speed: Callable[[float], str]
    seek: Callable[[int], str]
    locked_bodies: Callable[[], tuple[str, ...]]
    end_program: Callable[[], bool]

    @property
    def is_frozen(self) -> bool:
        """Whether pages of pupils change nothing."""
        return bool(self.values['sketchpad_frozen'])
