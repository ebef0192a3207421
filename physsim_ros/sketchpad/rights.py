# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The rights of pages: each kind of message needs one, which a role has or not."""

from __future__ import annotations

from enum import auto, Enum

from physsim_ros.model.errors import Frozen, TeacherOnly, ViewOnly


class Role(Enum):
    """The rights of a page."""

    DRAW = 'draw'
    VIEW = 'view'
    TEACH = 'teach'

    @property
    def draws(self) -> bool:
        """Whether its pages change the world."""
        return self is not Role.VIEW


class Right(Enum):
    """
    The right that a page needs for a message.

    :cvar LOOK: of every page
    :cvar DRAW: of the pages that draw, for what changes no world
    :cvar CHANGE: of the pages that draw; those of pupils have it while they are not frozen
    :cvar TEACH: of the pages of teachers
    """

    LOOK = auto()
    DRAW = auto()
    CHANGE = auto()
    TEACH = auto()


def check_right(right: Right, role: Role, *, frozen: bool = False) -> None:
    """
    Refuse what a page has no right to.

    :param frozen: whether the pages of pupils are, which the world's thread knows
    :raises ViewOnly: it only shows the world
    :raises TeacherOnly: it is not a teacher's
    :raises Frozen: it is a pupil's
    """
    if right is not Right.LOOK and not role.draws:
        raise ViewOnly('this page only shows the world')
    if right is Right.TEACH and role is not Role.TEACH:
        raise TeacherOnly('this is for teachers')
    if right is Right.CHANGE and role is not Role.TEACH and frozen:
        raise Frozen('a teacher has frozen this world')
