# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Wrenches: forces and torques of commands, which act on bodies until a step.

The engine clears forces after each step, so that they are set for each.
"""

from __future__ import annotations

from collections.abc import Iterator

from physsim_ros.engine.body import RigidBody
from physsim_ros.model.transform import NO_WRENCH, Wrench


class Wrenches:
    """The wrenches that act in a space; each is stored with its body."""

    def __init__(self) -> None:
        self._acting: dict[str, RigidBody] = {}

    def set_wrench(self, rigid: RigidBody, wrench: Wrench, until: int | None) -> None:
        """
        Set the wrench on a body.

        :param wrench: force [N] and torque [N m] at the centre of mass
        :param until: step at which it ends; None is never
        """
        rigid.wrench, rigid.wrench_until = wrench, until
        if wrench == NO_WRENCH:
            self._acting.pop(rigid.body.name, None)
        else:
            self._acting[rigid.body.name] = rigid

    def forget_body(self, rigid: RigidBody) -> None:
        """Drop a body that is removed from the space; it keeps its wrench."""
        self._acting.pop(rigid.body.name, None)

    def acting(self) -> list[RigidBody]:
        """Return the bodies on which a wrench acts, in spawn order."""
        return sorted(self._acting.values(), key=lambda rigid: rigid.serial)

    def ended(self, step: int) -> Iterator[RigidBody]:
        """Yield the bodies whose wrench ends at a step or before."""
        for rigid in list(self._acting.values()):
            if rigid.wrench_until is not None and rigid.wrench_until <= step:
                yield rigid

    def apply_wrenches(self) -> None:
        """Set forces and torques for the coming step of the engine, which clears them after it."""
        for rigid in self._acting.values():
            fx, fy, rigid.pm_body.torque = rigid.wrench
            rigid.pm_body.force = fx, fy
