# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Observation: what is read of a space, as fresh arrays in spawn order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.stages.half_step import StartState
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import rotated_each


def observe_bodies(table: BodyTable, start: StartState) -> tuple[Floats, Floats]:
    """
    Return poses of the bodies' origins and true twists of their centres of mass.

    :param start: the state that the next step begins with
    :return: (n, 3) float64 each: x, y [m], yaw [rad]; velocity [m/s], spin [rad/s]
    """
    poses, twists = start.state[:, :3].copy(), start.state[:, 3:].copy()
    offsets = table.columns.offsets
    if np.count_nonzero(offsets):
        poses[:, :2] -= rotated_each(offsets, poses[:, 2])
    if np.count_nonzero(start.free):
        twists -= np.where(start.free[:, None], table.leads, 0.0)
    return poses, twists


def digest_parts(
    table: BodyTable, start: StartState, pushed: Sequence[RigidBody]
) -> Iterator[bytes]:
    """
    Yield scene, poses, velocities and wrenches as bytes, in a fixed order.

    :param start: the state that the next step begins with
    :param pushed: bodies on which a wrench acts, in spawn order
    """
    yield table.scene.key
    yield start.state.tobytes()
    yield start.free.tobytes()
    for rigid in pushed:
        yield f'{rigid.body.name} {rigid.wrench!r} {rigid.wrench_until}'.encode()
