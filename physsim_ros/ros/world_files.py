# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world file of the node, which two services and the parameter `world_file` use."""

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
from physsim_ros.model.texts import counted
from physsim_ros.ros.parameters import SPECS
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import Beginning, beginning_of


class WorldFiles:
    """
    Reads and writes the world file that parameter `world_file` names.

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
        Start the simulation with the file, from any directory.

        :raises Refusal: there is no such file, or it is refused
        """
        state, _ = finish(self._read(confined=False))
        self._simulation.begin(state)

    async def load(self, *, confined: bool) -> str:
        """
        Replace the world by the file, and return a message about it; time goes on.

        :param confined: whether only files below `world_dir` and the shipped worlds may be read
        :raises Refusal: there is no such file, or it is refused
        """
        beginning, path = await self._build(confined=confined)
        return f'{self._simulation.load(beginning)} from {path.name}'

    async def open_world(self) -> str:
        """
        Begin with the world of the file, at time 0, and return a message about it.

        Only files below `world_dir` and the shipped worlds may be read.

        :raises Refusal: there is no such file, or it is refused
        """
        beginning, path = await self._build(confined=True)
        return f'{self._simulation.open_world(beginning)} from {path.name}'

    async def save(self) -> str:
        """
        Write the world to the file, and return a message about it; time goes on.

        :raises BadWorldFile: it cannot be written, or lies outside `world_dir`
        """
        # All of this moment: the world goes on while a thread writes.
        saved, rate = self._simulation.saver(), self._simulation.physics_rate
        name, directory = self._values['world_file'], self.directory

        def write() -> tuple[WorldState, Path]:
            state = saved()
            return state, save_world(state, name, world_dir=directory, physics_rate=rate)

        state, path = await on_thread(write, finishes=True)
        message = f'saved {counted(len(state.bodies), "body")} to {path.name}'
        if hides_shipped(path, world_dir=directory):
            message += '; from now on it comes before the shipped world of that name'
        return message

    async def _build(self, *, confined: bool) -> tuple[Beginning, Path]:
        state, path = await self._read(confined=confined)
        begin = partial(beginning_of, state, self._simulation.physics_rate)
        return await on_thread(begin), path

    async def _read(self, *, confined: bool) -> tuple[WorldState, Path]:
        name, simulation = self._values['world_file'], self._simulation
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
