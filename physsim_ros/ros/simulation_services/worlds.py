# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Worlds, by the services of `simulation_interfaces`: files by their names.

The empty world that a node starts with is a world, of no file; none is there only after
`unload_world`, until one is loaded or something is done by the topics of the node.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from physsim_ros.files import shipped_lessons, shipped_worlds, title_of, worlds_in
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.simulation_services.entities import passes_tags
from physsim_ros.ros.simulation_services.results import coded, CodedRefusal
from simulation_interfaces.msg import Resource, Result, WorldResource
from simulation_interfaces.srv import GetAvailableWorlds, GetCurrentWorld, LoadWorld, UnloadWorld


class Worlds:
    """
    The services for worlds; each returns a message about what was done, '' for nothing.

    :param control: of the node
    """

    def __init__(self, control: NodeControl) -> None:
        self._control = control
        # The empty state that `unload` has put in place of a world; None before the first.
        self._unloaded: WorldState | None = None

    @property
    def is_none_loaded(self) -> bool:
        """Whether the world was unloaded, and nothing has been done since then."""
        simulation = self._control.simulation
        return (
            self._unloaded is not None
            and simulation.loaded is self._unloaded
            and not (simulation.speed or simulation.step or len(simulation.world))
        )

    def check_loaded(self) -> None:
        """
        Refuse what needs a world.

        :raises CodedRefusal: the world was unloaded
        """
        if self.is_none_loaded:
            raise coded('no world is loaded; load one first', Result.RESULT_INCORRECT_STATE)

    def available(self, request: Any, response: Any) -> str:
        """List the worlds that `load` takes by name."""
        unknown, own = unknown_sources(request.additional_sources), self._control.files.directory
        if not request.continue_on_error:
            if unknown:
                raise coded(unknown, Result.RESULT_FEATURE_UNSUPPORTED, field='additional_sources')
            if not _is_readable(own):
                raise coded(
                    f'{own.name}, the directory of own worlds, cannot be read',
                    GetAvailableWorlds.Response.DEFAULT_SOURCES_FAILED,
                )
        response.worlds = [
            _resource(name, *found)
            for name, found in sorted(self._files().items())
            if passes_tags({found[0]}, request.filter)
        ]
        response.result.error_message = unknown
        return ''

    async def load(self, request: Any, response: Any) -> str:
        """Load a world of a name, and stop."""
        codes = LoadWorld.Response
        uri = request.uri
        if not (uri or request.resource_string):
            raise coded('uri names no world', codes.NO_RESOURCE, field='uri')
        if not uri:
            raise coded(
                'a world is loaded by its name', Result.RESULT_FEATURE_UNSUPPORTED, field='uri'
            )
        if Path(uri).suffix not in ('', '.yaml'):
            raise coded('a world is a YAML file', codes.UNSUPPORTED_FORMAT, field='uri')
        try:
            message = await self._control.load_world(uri)
        except BadWorldFile as refusal:
            # One that is there, but no world, has a cause.
            result = codes.RESOURCE_PARSE_ERROR if refusal.cause else Result.RESULT_NOT_FOUND
            raise CodedRefusal(refusal, result) from refusal
        await self._stop()
        response.world = self._current()
        return message

    async def unload(self, _: Any, __: Any) -> str:
        """Delete all bodies and joints, and stop; settings stay."""
        if self.is_none_loaded:
            raise coded('no world is loaded', UnloadWorld.Response.NO_WORLD_LOADED)
        simulation = self._control.simulation
        self._unloaded = WorldState(settings=simulation.settings)
        simulation.load(self._unloaded)
        self._control.set_parameter('world_file', '')
        await self._stop()
        return 'unloaded the world'

    def current(self, _: Any, response: Any) -> str:
        """Tell the world that was loaded."""
        if self.is_none_loaded or not self._control.values['world_file']:
            raise coded(
                'no world was loaded from a file', GetCurrentWorld.Response.NO_WORLD_LOADED
            )
        response.world = self._current()
        return ''

    async def _stop(self) -> None:
        self._control.time.pause()
        await self._control.time.reset()

    def _current(self) -> WorldResource:
        uri = str(self._control.values['world_file'])
        name = Path(uri).stem
        # A path is that of another file, whatever worlds have its last name.
        found = self._files().get(name) if uri in (name, f'{name}.yaml') else None
        if found is None:
            return WorldResource(name=name, world_resource=Resource(uri=uri))
        return _resource(name, *found)

    def _files(self) -> dict[str, tuple[str, Path]]:
        """Return tag and file of each world by its name, as `find_world` finds them."""
        directories = (
            ('own', self._control.files.directory),
            ('lesson', self._control.files.lessons),
            ('shipped', shipped_worlds()),
            ('lesson', shipped_lessons()),
        )
        return {
            name: (tag, path)
            for tag, directory in reversed(directories)
            for name, path in worlds_in(directory).items()
        }


def _resource(name: str, tag: str, path: Path) -> WorldResource:
    """Return the world of a file."""
    uri = Resource(uri=name)
    return WorldResource(name=name, world_resource=uri, description=title_of(path), tags=[tag])


def unknown_sources(sources: list[str]) -> str:
    """Return a message about sources, of which none is known; '' for none."""
    return f'unknown sources: {", ".join(sources)}'[:500] if sources else ''


def _is_readable(directory: Path) -> bool:
    """Return whether a directory can be listed, or is none yet."""
    if not directory.exists():
        return True
    return directory.is_dir() and os.access(directory, os.R_OK | os.X_OK)
