# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values that a test reads of a world, and errors that it catches."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from physsim_ros.model.errors import Refusal


class Pose(NamedTuple):
    """
    Pose of a body in the world.

    :ivar x: of the origin of its shape [m]
    :ivar y: of the same [m]
    :ivar yaw: counter-clockwise from the x axis [rad]
    """

    x: float
    y: float
    yaw: float


class Twist(NamedTuple):
    """
    Twist of a body, in axes of the world.

    :ivar vx: velocity of its centre of mass along x [m/s]
    :ivar vy: the same along y [m/s]
    :ivar spin: angular velocity, counter-clockwise [rad/s]
    """

    vx: float
    vy: float
    spin: float


class Contact(NamedTuple):
    """
    Two bodies that touched during the last frame.

    :ivar a: name of the body that was spawned first
    :ivar b: name of the other one, or 'world' for the walls of `bounds`
    :ivar impulse: x, y of the impulse of a on b over the frame [N s]
    :ivar point: x, y of the mean contact point [m]
    :ivar normal: x, y of the unit vector from a to b
    """

    a: str
    b: str
    impulse: tuple[float, float]
    point: tuple[float, float]
    normal: tuple[float, float]


class Refused(Exception):
    """
    A request was refused.

    :ivar code: the stable code of the refusal
    :ivar field: the offending field, or ''
    """

    def __init__(self, code: str, message: str, field: str) -> None:
        super().__init__(f'{code}: {message}')
        self.code = code
        self.field = field


class UnknownName(KeyError):
    """No body or joint has that name; the message tells the nearest one."""

    def __str__(self) -> str:
        """Return the message as it is, which a KeyError quotes."""
        return str(self.args[0])


@contextmanager
def refusals_as_refused() -> Iterator[None]:
    """Raise `Refused` in place of a refusal of the world."""
    try:
        yield
    except Refusal as refusal:
        raise Refused(refusal.code, str(refusal), refusal.field) from refusal
