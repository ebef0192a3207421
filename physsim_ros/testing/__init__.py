# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A pytest plugin: a world in the process of a test, which advances its time.

pytest loads `plugin` wherever the package is installed (entry point `pytest11`), in other projects
too; from a source tree alone, `pytest -p physsim_ros.testing.plugin` does. The fixture is
`physsim`, a `PhysSim`. This front has the names and types that a test imports:
`from physsim_ros.testing import disc, PhysSim, Refused`. Start with `world`.

Laws: ROS is not imported before a test uses `PhysSim` or requests the fixture; simulation time
does not depend on the wall clock, which only bounds the wait for an answer; messages that other
nodes send in reaction to a frame have arrived before the next frame, so that every run gives the
same bits; no node of another process hears the world of the fixture or is heard by it.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, TYPE_CHECKING

from physsim_ros.testing.parameters import Parameters
from physsim_ros.testing.plugin import physsim
from physsim_ros.testing.values import Contact, Pose, Refused, Twist, UnknownName

if TYPE_CHECKING:
    from physsim_ros.testing.context import own_context, shared_context
    from physsim_ros.testing.messages import (
        box,
        chain,
        command,
        delete,
        delete_all,
        disc,
        joint,
        marker,
        point,
        polygon,
    )
    from physsim_ros.testing.world import own_world, PhysSim
else:
    # The modules that import ROS, by the name that each is imported for; `messages` by others.
    _WITH_ROS = {
        'PhysSim': 'world',
        'own_context': 'context',
        'own_world': 'world',
        'shared_context': 'context',
    }

    def __getattr__(name: str) -> Any:
        """Import a name when it is first used (PEP 562)."""
        if name not in __all__:
            raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
        return getattr(import_module(f'{__name__}.{_WITH_ROS.get(name, "messages")}'), name)

    def __dir__() -> list[str]:
        """Return all names, those that are imported at their first use too."""
        return sorted({*globals(), *__all__})


__all__ = [
    'Contact',
    'Parameters',
    'PhysSim',
    'Pose',
    'Refused',
    'Twist',
    'UnknownName',
    'box',
    'chain',
    'command',
    'delete',
    'delete_all',
    'disc',
    'joint',
    'marker',
    'own_context',
    'own_world',
    'physsim',
    'point',
    'polygon',
    'shared_context',
]
# `pytest -p physsim_ros.testing` loads the plugin, too.
pytest_plugins = ['physsim_ros.testing.plugin']
