# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Support graph: which bodies rest on something, and which have lost all that they rested on.

Problem: where a floor, an anchor or a joint is removed, the engine still warm-starts with the
impulses that carried the pile on it, which would accelerate its bodies upward; and a body that
falls from that moment on has no half-step lead yet, so that its reported velocity would begin with
half a step of gravity upward.
Method: a search in the contact graph, for that moment only. Bodies that contacts or joints tie to
nothing that stands are in free fall as one, without the impulses of the step before.
Cost: none in a step before which nothing was removed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import reachable, Rows
from physsim_ros.model.arrays import Flags, Ints
import pymunk
from pymunk import batch

_F = batch.ArbiterFields
_PRESSING = _F.BODY_A_ID | _F.BODY_B_ID | _F.TOTAL_IMPULSE


def find_unsupported(
    pm_space: pymunk.Space, io: BatchIO, table: BodyTable, released: Sequence[int]
) -> Flags:
    """
    Return (n,) bool: which bodies have lost their support.

    :param pm_space: its `collision_persistence` is 1, so that it lists only contacts of the last
        step
    :param io: of the space
    :param table: of its bodies
    :param released: rows of the dynamic bodies that lost a neighbour since that step
    """
    loose = np.zeros(len(table.ids), np.bool_)
    loose[list(released)] = True
    pm_bodies = [table.bodies[row].pm_body for row in released]
    pairs = np.concatenate(
        (_contacts(pm_space, io, table, loose, pm_bodies), table.columns.joined)
    )
    supported = reachable(~table.columns.dynamic, pairs)
    return reachable(loose & ~supported, pairs)[:-1]


def _contacts(
    pm_space: pymunk.Space,
    io: BatchIO,
    table: BodyTable,
    loose: Flags,
    pm_bodies: list[pymunk.Body],
) -> Rows:
    """
    Return (k, 2) intp: rows of the pairs of bodies that support each other.

    Contacts that pressed in the last step do; those of released bodies are searched for anew,
    and count if they pressed or are new, not if the two only lie side by side.
    """
    ints, floats = io.read_contacts(_PRESSING)
    presses = floats.reshape(-1, 2).any(axis=1)
    pairs = table.rows_of(ints.reshape(-1, 2))
    now = table.rows_of(np.array([*_touching(pm_space, pm_bodies)], np.uint64).reshape(-1, 2))
    known, new = (_keys(each, len(loose)) for each in (pairs, now))
    now = now[np.isin(new, known[presses]) | ~np.isin(new, known)]
    return np.concatenate((pairs[presses & ~loose[pairs].any(axis=1)], now))


def _touching(pm_space: pymunk.Space, pm_bodies: list[pymunk.Body]) -> Iterator[tuple[int, int]]:
    """Yield the engine's ids of pairs that touch where all is now, as the next step finds it."""
    for body in pm_bodies:
        for shape in body.shapes:
            for hit in pm_space.shape_query(shape):
                other = hit.shape
                if other and other.body and not (shape.sensor or other.sensor):
                    yield body.id, other.body.id


def _keys(pairs: Rows, count: int) -> Ints:
    """Return (k,) int64: one number for each pair, whichever of the two comes first."""
    keys: Ints = pairs.min(axis=1, initial=count) * (count + 1) + pairs.max(axis=1, initial=0)
    return keys
