# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands on their way: those of drives and motors that these do not obey yet."""

from __future__ import annotations

from collections.abc import Iterable
from typing import cast, Generic, TypeVar

from physsim_ros.model.motor_command import TimedCommand
from physsim_ros.model.states import DriveCommand

_Command = TypeVar('_Command', bound=DriveCommand | TimedCommand)


class ComingCommands(Generic[_Command]):
    """
    Commands on their way, in their order, by the name of the body or joint that is to obey them.

    Each has the step at which it begins, `begun`.
    """

    def __init__(self) -> None:
        self._by_name: dict[str, tuple[_Command, ...]] = {}

    def __bool__(self) -> bool:
        return bool(self._by_name)

    def of(self, name: str) -> tuple[_Command, ...]:
        """Return the commands of a name."""
        return self._by_name.get(name, ())

    def put(self, name: str, commands: tuple[_Command, ...]) -> None:
        """Set the commands of a name."""
        if commands:
            self._by_name[name] = commands
        else:
            self._by_name.pop(name, None)

    def add(self, name: str, command: _Command) -> None:
        """
        Add a command; one that would begin before the last one begins with it, in its place.

        :param name: of what is to obey it
        """
        coming = self.of(name)
        is_last = not coming or coming[-1].begun < command.begun
        earlier = coming if is_last else coming[:-1]
        begun = command.begun if is_last else coming[-1].begun
        self._by_name[name] = (*earlier, cast('_Command', command._replace(begun=begun)))

    def in_order(self, names: Iterable[str]) -> list[tuple[str, tuple[_Command, ...]]]:
        """Return the commands of each name that has some, in the order of the names."""
        return [(name, self._by_name[name]) for name in names if name in self._by_name]

    def take(self, step: int, names: Iterable[str]) -> list[tuple[str, _Command]]:
        """
        Drop the commands that begin at a step, or have begun; return the last one of each name.

        :param names: all, in the order in which they obey
        """
        last = []
        for name, coming in self.in_order(names):
            begun = [command for command in coming if command.begun <= step]
            if begun:
                self.put(name, tuple(command for command in coming if command.begun > step))
                last.append((name, begun[-1]))
        return last

    @property
    def steps(self) -> list[int]:
        """Return the steps at which the next command of each name begins."""
        return [coming[0].begun for coming in self._by_name.values()]
