# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The world files of the node: read at its start, by services, pages and tests; written by two.

Law: a file is named by the caller. A service without a name is about parameter `world_file`.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from physsim_ros.files import (
    find_world,
    hides_shipped,
    load_world,
    on_thread,
    save_world,
    user_lessons,
    user_worlds,
)
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.model.translation import counted, Text
from physsim_ros.ros.parameters import SPECS
from physsim_ros.ros.requests.services import Service
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.entries import Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import Beginning, beginning_of


class WorldFiles:
    """
    Reads and writes world files.

    :param simulation: of the world
    :param values: of the parameters of the node, by name, always up to date

    :ivar directory: of the user's worlds
    :ivar lessons: directory of the user's lessons
    """

    def __init__(self, simulation: Simulation, values: Mapping[str, Any]) -> None:
        self._simulation = simulation
        self._values = values
        # Absolute, whatever the working directory will be.
        self.directory = Path(values['world_dir'] or user_worlds()).absolute()
        self.lessons = Path(values['lesson_dir'] or user_lessons(self.directory)).absolute()

    def begin_with(self) -> None:
        """
        Start the simulation with the file of parameter `world_file`, from any directory.

        :raises Refusal: there is no such file, or it is refused
        """
        state, _ = finish(self._read(self._values['world_file'], confined=False))
        self._simulation.begin(state)

    @property
    def services(self) -> dict[str, Service]:
        """Return the services of the file of parameter `world_file`, by their names."""
        values = self._values
        return {
            'load_world': Service(lambda: self.load(values['world_file']), Wait.FOR_SEEK),
            'save_world': Service(lambda: self.save(values['world_file']), Wait.TO_READ),
        }

    async def load(self, name: str, *, confined: bool = True) -> Text:
        """
        Replace the world by that of a file, and return a message about it; time goes on.

        :param confined: whether only files below `world_dir` and the shipped worlds may be read
        :raises Refusal: there is no such file, or it is refused
        """
        beginning, path = await self._build(name, confined=confined)
        return _loaded(self._simulation.load(beginning), path)

    async def open_world(self, name: str) -> Text:
        """
        Begin with the world of a file, at time 0, and return a message about it.

        Only files below `world_dir` and the shipped worlds may be read.

        :raises Refusal: there is no such file, or it is refused
        """
        beginning, path = await self._build(name, confined=True)
        return _loaded(self._simulation.open_world(beginning), path)

    async def save(self, name: str) -> Text:
        """
        Write the world to a file, and return a message about it; time goes on.

        :raises BadWorldFile: it cannot be written, or lies outside `world_dir`
        """
        # All of this moment: the world goes on while a thread writes.
        saved, rate = self._simulation.saver(), self._simulation.physics_rate
        directory = self.directory

        def write() -> tuple[WorldState, Path]:
            state = saved()
            return state, save_world(state, name, world_dir=directory, physics_rate=rate)

        state, path = await on_thread(write, finishes=True)
        values = {'bodies': counted(len(state.bodies), 'body'), 'world': path.stem}
        message = Text('saved {bodies} to {world}.yaml', **values)
        if hides_shipped(path, world_dir=directory):
            hint = Text('from now on it comes before the shipped world of that name')
            return Text('{first}; {then}', first=message, then=hint)
        return message

    async def _build(self, name: str, *, confined: bool) -> tuple[Beginning, Path]:
        state, path = await self._read(name, confined=confined)
        begin = partial(beginning_of, state, self._simulation.physics_rate)
        return await on_thread(begin), path

    async def _read(self, name: str, *, confined: bool) -> tuple[WorldState, Path]:
        simulation = self._simulation
        try:
            path = find_world(
                name,
                world_dir=self.directory,
                lesson_dir=self.lessons,
                confined=confined,
            )
            load = partial(
                load_world,
                path,
                settings=simulation.settings,
                physics_rate=simulation.physics_rate,
                parameters=SPECS,
            )
            state = await on_thread(load)
        except BadWorldFile as refusal:
            if not confined:
                raise
            # Peers on the graph, who may name any file here, are not told what it holds.
            raise BadWorldFile(refusal.brief, field='world_file') from refusal
        return state, path


def _loaded(done: Text, path: Path) -> Text:
    """Return the message about a world that was loaded from a file."""
    template = '{loaded} from {world}{suffix}'
    return Text(template, loaded=done, world=path.stem, suffix=path.suffix)
