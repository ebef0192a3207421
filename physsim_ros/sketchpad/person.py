# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The people at the pages: each has a name, unfinished drawings, and a material for new bodies."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
import time

from physsim_ros.drawing import DrawingSession, DrawingSettings
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.colors import Color
from physsim_ros.model.requests import Request, Spawn
from physsim_ros.sketchpad.results import Result
from physsim_ros.sketchpad.rights import Role

# Beginning of the names of people who have chosen none; their numbers follow.
UNNAMED = 'Page '
# Name of a teacher who has chosen none.
TEACHER = 'Teacher'
# End of the names of teachers as authors; names that people choose are printable.
_TEACHES = '\n'


class Person:
    """
    A person, who outlives the connections of a page.

    :param number: of the person
    :param role: at the first page
    :param settings: of drawing

    :ivar name: of the person
    :ivar unnamed: name before one is chosen
    :ivar drawing: strokes and clicks
    :ivar material: properties of the bodies to draw; those that are unset are the world's
    :ivar color: of the bodies to draw; None is the world's choice
    :ivar answered: last answer to a lesson; empty where there is none
    :ivar raised: whether the person has raised a hand
    """

    def __init__(self, number: int, role: Role, settings: DrawingSettings) -> None:
        self.name = self.unnamed = TEACHER if role is Role.TEACH else f'{UNNAMED}{number}'
        self.drawing = DrawingSession(settings, clock=time.thread_time)
        self.material = Properties()
        self.color: Color | None = None
        self.answered: Result = {}
        self.raised = False

    def with_material(self, requests: Iterable[Request]) -> tuple[Request, ...]:
        """Return the requests of a drawing, with the person's material for the bodies they add."""
        return tuple(
            self._with_material(each) if isinstance(each, Spawn) else each for each in requests
        )

    def _with_material(self, spawn: Spawn) -> Spawn:
        chosen = self.material.explicit()
        if spawn.properties.anchored:
            # A wall does not move.
            chosen.pop('velocity', None)
        properties = replace(spawn.properties, **chosen)
        return replace(spawn, color=self.color or spawn.color, properties=properties)


def author_of(name: str, role: Role) -> str:
    """Return the author of the requests of a person: a teacher is no pupil of that name."""
    return name + _TEACHES if role is Role.TEACH else name
