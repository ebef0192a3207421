# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Columns of Rerun from arrays: `Archetype.columns` and `partition` (Rerun 0.41) take twice the time.

A column has one row for each frame; its batch holds the values of all rows, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Singles
import pyarrow as pa
import rerun as rr

# A component: its descriptor, and the batch class of its values.
Slot = tuple[rr.ComponentDescriptor, Callable[[Any], Any]]


class RotationBatch:
    """Rotations about z as an Arrow array; `RotationAxisAngleBatch` (Rerun 0.41) is a loop."""

    def __init__(self, yaws: Singles) -> None:
        self._yaws = yaws

    def as_arrow_array(self) -> pa.Array:
        """Return a struct of axis and angle for each yaw."""
        axes = np.zeros((len(self._yaws), 3), dtype=np.float32)
        axes[:, 2] = 1.0
        return pa.StructArray.from_arrays(
            [vectors(axes), pa.array(self._yaws)],
            fields=[
                pa.field('axis', _VECTOR, nullable=False),
                pa.field('angle', pa.float32(), nullable=False),
            ],
        )


class StripBatch:
    """Line strips as an Arrow array; `LineStrip3DBatch` (Rerun 0.41) is a loop in Python."""

    def __init__(self, strips: tuple[Singles, NDArray[np.intp]]) -> None:
        self._corners, self._lengths = strips

    def as_arrow_array(self) -> pa.Array:
        """Return a list of corners for each strip."""
        offsets = np.concatenate(([0], np.cumsum(self._lengths))).astype(np.int32)
        kind = pa.list_(pa.field('item', _VECTOR, nullable=False))
        return pa.ListArray.from_arrays(pa.array(offsets), vectors(self._corners), type=kind)


_VECTOR = pa.list_(pa.field('item', pa.float32(), nullable=False), 3)


def vectors(values: Singles) -> pa.Array:
    """Return (k, 3) float32 as an Arrow array of k vectors."""
    flat = pa.array(np.ascontiguousarray(values, dtype=np.float32).ravel())
    return pa.FixedSizeListArray.from_arrays(flat, type=_VECTOR)


def column(slot: Slot, values: Any, lengths: Sequence[int]) -> rr.ComponentColumn:
    """
    Return values as a column.

    :param slot: of the component
    :param values: of all rows, as the batch class of the slot takes them
    :param lengths: number of values of each row
    """
    descriptor, batch = slot
    return rr.ComponentColumn(descriptor, batch(values), lengths=lengths)


def _slot(columns: rr.ComponentColumnList, batch: Callable[[Any], Any]) -> Slot:
    (only,) = columns
    return only.descriptor, batch


_AXIS_ANGLE = rr.RotationAxisAngle(axis=(0, 0, 1), radians=1)
TRANSLATIONS = _slot(
    rr.InstancePoses3D.columns(translations=[(0, 0, 0)]), rr.components.Translation3DBatch
)
ROTATIONS = _slot(rr.InstancePoses3D.columns(rotation_axis_angles=[_AXIS_ANGLE]), RotationBatch)
SCALES = _slot(rr.InstancePoses3D.columns(scales=[(1, 1, 1)]), rr.components.Scale3DBatch)
STRIPS = _slot(rr.LineStrips3D.columns(strips=[[(0, 0, 0), (1, 0, 0)]]), StripBatch)
STRIP_COLORS = _slot(rr.LineStrips3D.columns(colors=[(0, 0, 0)]), rr.components.ColorBatch)
STRIP_RADII = _slot(rr.LineStrips3D.columns(radii=[1.0]), rr.components.RadiusBatch)
ORIGINS = _slot(rr.Arrows3D.columns(origins=[(0, 0, 0)]), rr.components.Position3DBatch)
VECTORS = _slot(rr.Arrows3D.columns(vectors=[(1, 0, 0)]), rr.components.Vector3DBatch)
POSITIONS = _slot(rr.Points3D.columns(positions=[(0, 0, 0)]), rr.components.Position3DBatch)
POINT_LABELS = _slot(rr.Points3D.columns(labels=['']), rr.components.TextBatch)
POINT_COLORS = _slot(rr.Points3D.columns(colors=[(0, 0, 0)]), rr.components.ColorBatch)
POINT_RADII = _slot(rr.Points3D.columns(radii=[1.0]), rr.components.RadiusBatch)
SCALARS = _slot(rr.Scalars.columns(scalars=[0.0]), rr.components.ScalarBatch)
