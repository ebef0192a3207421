# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The actions of a node that its pages use, besides the requests of its world.

Law: a page can do nothing that a service, a topic or a parameter cannot do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldControl:
    """
    The actions of a node that its pages use; a returned text is a message about it.

    :param simulation: the world and its time
    :param drawing_settings: returns the settings of drawing
    :param current_snapshot: applies the waiting requests; returns the snapshot that is shown
    :param submit_call: makes a call at its time and tells its answers; raises Busy where too many
        requests wait
    :param services: actions by the names of the services, with their times; each raises a
        PhysSimError where it is refused
    :param load_world: loads the world of a name; raises a PhysSimError
    :param save_world: saves the world under a name; raises a PhysSimError
    :param set_speed: sets the speed [simulation seconds a second]; raises a Refusal
    :param seek: goes to a simulation time [ns]; raises a Refusal
    """

    simulation: Simulation
    drawing_settings: Callable[[], DrawingSettings]
    current_snapshot: Callable[[], Snapshot]
    submit_call: Callable[[Callable[[], Iterable[Answer]], Wait], None]
    services: Mapping[str, tuple[Callable[[], str], Wait]]
    load_world: Callable[[str], str]
    save_world: Callable[[str], str]
    set_speed: Callable[[float], str]
    seek: Callable[[int], str]
