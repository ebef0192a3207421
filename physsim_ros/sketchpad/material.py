# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""The material of what a page draws: its own choice, before that of the world."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.colors import Color
from physsim_ros.model.requests import Request, Spawn
from physsim_ros.sketchpad.messages import DrawWith


class Material:
    """The material of what a page draws next; unset properties are those of the world."""

    def __init__(self) -> None:
        self._properties = Properties()
        self._color: Color | None = None

    def choose(self, choice: DrawWith) -> None:
        """Take over what a message sets."""
        self._properties = replace(self._properties, **choice.properties.explicit())
        if choice.color is not None:
            self._color = choice.color or None

    def applied(self, requests: Iterable[Request]) -> tuple[Request, ...]:
        """Return requests of a drawing, with this material where they add bodies."""
        return tuple(self._applied(each) if isinstance(each, Spawn) else each for each in requests)

    def _applied(self, spawn: Spawn) -> Spawn:
        chosen = self._properties.explicit()
        if spawn.properties.anchored:
            # A wall stays where it is.
            chosen.pop('velocity', None)
        return replace(
            spawn,
            color=self._color or spawn.color,
            properties=replace(spawn.properties, **chosen),
        )
