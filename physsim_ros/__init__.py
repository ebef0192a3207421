# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An interactive two-dimensional physics world on ROS 2, and its front for Python without ROS.

`from physsim_ros import Disc, Simulation, Spawn`: a world takes requests and returns frames.
docs/python.md has an example of each. The node is `ros`, the fixture of tests `testing`.

Law: this module imports a name when it is first used (PEP 562), since every program of the
package, and every run of pytest, imports it; NumPy and Pymunk take 0.3 s.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from physsim_ros.files import find_world, load_world, robot_spawn, save_world
    from physsim_ros.model.answer import Answer
    from physsim_ros.model.body_properties import Properties
    from physsim_ros.model.errors import PhysSimError, Refusal
    from physsim_ros.model.joints import JointKind, JointProperties
    from physsim_ros.model.requests import (
        Anchor,
        Axle,
        ChangeBody,
        Command,
        Configure,
        Delete,
        DeleteAll,
        Grab,
        Join,
        LetGo,
        MoveBodies,
        MoveHand,
        Pin,
        Release,
        Request,
        Spawn,
        Unjoin,
        UnjoinAll,
    )
    from physsim_ros.model.settings import WorldSettings
    from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape, Triangles
    from physsim_ros.model.snapshot import Contacts, Frame, Snapshot
    from physsim_ros.sensing import OdometryReading
    from physsim_ros.simulation.robot import Robot
    from physsim_ros.simulation.simulation import SavedMoment, Simulation

__all__ = [
    'Anchor',
    'Answer',
    'Axle',
    'Box',
    'Chain',
    'ChangeBody',
    'Command',
    'Compound',
    'Configure',
    'Contacts',
    'Delete',
    'DeleteAll',
    'Disc',
    'Frame',
    'Grab',
    'Join',
    'JointKind',
    'JointProperties',
    'LetGo',
    'MoveBodies',
    'MoveHand',
    'OdometryReading',
    'PhysSimError',
    'Pin',
    'Polygon',
    'Properties',
    'Refusal',
    'Release',
    'Request',
    'Robot',
    'SavedMoment',
    'Shape',
    'Simulation',
    'Snapshot',
    'Spawn',
    'Triangles',
    'Unjoin',
    'UnjoinAll',
    'WorldSettings',
    'find_world',
    'load_world',
    'robot_spawn',
    'save_world',
]
# The modules that have them, each after those that it imports.
_MODULES = (
    'model.errors',
    'model.settings',
    'model.shapes',
    'model.joints',
    'model.body_properties',
    'model.requests',
    'model.snapshot',
    'sensing',
    'simulation.simulation',
    'files',
)


def __getattr__(name: str) -> Any:
    """Import a name of the front."""
    if name in __all__:
        # The robot of a simulation: that of a body, in the model, has its name.
        for module in ('simulation.robot',) if name == 'Robot' else _MODULES:
            found = import_module(f'{__name__}.{module}')
            if hasattr(found, name):
                return getattr(found, name)
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')


def __dir__() -> list[str]:
    """Return all names, those that are not yet imported too."""
    return sorted({*globals(), *__all__})
