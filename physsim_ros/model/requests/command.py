# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands of bodies: poses, twists and wrenches; the velocity at which a robot drives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats, greatest
from physsim_ros.model.checks import check_finite, FARTHEST, FASTEST, HEAVIEST
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.transform import Twist

# Shared by all commands without such an array.
_NO_ROWS: Floats = np.empty((0, 3))
_NO_ROWS.flags.writeable = False


def _no_rows() -> Floats:
    return _NO_ROWS


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Command:
    """
    Set poses, twists or wrenches of named bodies; if one is refused, nothing is set.

    Each array is copied and is read-only afterwards; n is the number of names.

    :param names: the bodies, each once
    :param poses: (n, 3) float64: x, y [m], yaw [rad] of each, or empty
    :param twists: (n, 3) float64: vx, vy [m/s], spin [rad/s], world axes, or empty
    :param wrenches: (n, 3) float64: fx, fy [N], torque [N m], world axes, or empty; they act at
        the centre of mass until the next one, at most for the world's `command_timeout`
    :param frame: of the poses: '' for the world, or a body's name
    :raises Malformed: lengths do not fit, a name comes twice, a number is not finite
    :raises BadProperty: a value is out of range
    """

    names: tuple[str, ...]
    poses: Floats = field(default_factory=_no_rows)
    twists: Floats = field(default_factory=_no_rows)
    wrenches: Floats = field(default_factory=_no_rows)
    frame: str = ''

    def __post_init__(self) -> None:
        if not self.names:
            raise Malformed('the command names no body', field='joint_names')
        if len(set(self.names)) != len(self.names):
            raise Malformed('the command names a body twice', field='joint_names')
        for array, name in (('poses', 'transforms'), ('twists', 'twist'), ('wrenches', 'wrench')):
            rows = _checked_rows(getattr(self, array), len(self.names), name)
            object.__setattr__(self, array, rows)
        if greatest(self.poses[:, :2]) > FARTHEST:
            raise BadProperty(
                f'transforms is further away than {FARTHEST:g} m', field='transforms'
            )
        if greatest(self.poses[:, 2]) > FARTHEST:
            raise BadProperty('the yaw of transforms is too large', field='transforms')
        # The coordinates first, so that their squares do not overflow.
        if greatest(self.twists) > FASTEST or greatest(np.hypot(*self.twists.T[:2])) > FASTEST:
            raise BadProperty(f'twist is faster than {FASTEST:g} m/s or rad/s', field='twist')
        if greatest(self.wrenches) > HEAVIEST:
            raise BadProperty(f'wrench exceeds {HEAVIEST:g} N or N m', field='wrench')

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Command):
            return NotImplemented
        return (self.names, self.frame) == (other.names, other.frame) and all(
            np.array_equal(one, two) for one, two in zip(self._arrays, other._arrays, strict=True)
        )

    def __hash__(self) -> int:
        return hash((self.names, self.frame))

    @property
    def nbytes(self) -> int:
        """Memory of its arrays [bytes]."""
        return sum(array.nbytes for array in self._arrays)

    @property
    def _arrays(self) -> tuple[Floats, ...]:
        return self.poses, self.twists, self.wrenches

    def share_names(self, names: tuple[str, ...]) -> None:
        """Have the names in memory once for many commands: `names` are equal to its own."""
        object.__setattr__(self, 'names', names)


def _checked_rows(values: Any, count: int, name: str) -> Floats:
    """
    Return a read-only copy of as many rows of three finite numbers, or none.

    :param name: of the field, for the refusal
    :raises Malformed: they are something else
    """
    if len(values) == 0:
        return _NO_ROWS
    if len(values) != count:
        raise Malformed(f'{name} has {len(values)} entries for {count} bodies', field=name)
    if any(len(row) != 3 for row in values):
        raise Malformed(f'each {name} needs 3 numbers', field=name)
    rows = np.array(values, dtype=np.float64)
    if not np.isfinite(rows).all():
        raise Malformed(f'{name} is not finite', field=name)
    rows.flags.writeable = False
    return rows


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRobot:
    """
    Drive at a velocity, until the next command or the timeout of the drive.

    The drive does what it can of it: a velocity beyond its limits is cut off.

    :param name: of the body of the robot
    :param velocity: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]
    :raises Malformed: a number is not finite, or there are not three
    :raises BadProperty: it is faster than anything may be
    """

    name: str
    velocity: Twist

    def __post_init__(self) -> None:
        check_finite(self.velocity, 3, 'velocity')
        object.__setattr__(self, 'velocity', tuple(map(float, self.velocity)))
        if max(map(abs, self.velocity)) > FASTEST:
            raise BadProperty(
                f'velocity is faster than {FASTEST:g} m/s or rad/s', field='velocity'
            )
