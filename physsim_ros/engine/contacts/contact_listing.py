# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Pairs of bodies that touch, by rows of the scene: the contacts of several shapes become one.

A manifold is a column of five numbers: normal, count of points, mean point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.pair_ids import same_ids
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.snapshot import Contacts

# The mean of the normals of a pair that is shorter than this has no direction: the first body is
# squeezed from both sides.
OPPOSED = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class PairListing:
    """
    The pairs of a frame in the order of the scene; the same from frame to frame in a pile at rest.

    :param touching: (k, 2) uint64: the engine's ids of the bodies of each contact
    :param table: of the bodies
    :param pairs: (m, 2) int64: rows of each pair, the earlier spawned first
    :param order: (l,) intp: indices of the contacts, pair after pair
    :param first: (m,) intp: index in `order` of the first contact of each pair
    :param sign: (l,) float64: -1 where the engine has the bodies of a pair swapped, in that order
    """

    touching: Ids
    table: BodyTable
    pairs: Ints
    order: NDArray[np.intp]
    first: NDArray[np.intp]
    sign: Floats

    def is_of(self, touching: Ids, table: BodyTable) -> bool:
        """Return whether the listing was made of these pairs."""
        return self.table is table and same_ids(self.touching, touching)

    def merge_contacts(
        self, manifolds: Floats, sums: Floats, current: int
    ) -> tuple[Contacts, Flags]:
        """
        Return the contacts, one for each pair.

        :param manifolds: (5, k) float64, in the engine's order
        :param sums: (k, 2) float64: impulses [N s]
        :param current: count of the contacts that touch at the end of the frame, listed first
        :return: the contacts, and (m,) bool: overlaps without points, of sensors
        """
        # The engine's impulse acts on the first body; a contact reports that on the second.
        impulses = sums.take(self.order, axis=0).T * -self.sign
        manifolds = manifolds.take(self.order, axis=1)
        manifolds[:2] *= self.sign
        if len(self.first) < len(self.order):
            impulses = np.add.reduceat(impulses, self.first, axis=1)
            manifolds = self._one_each(manifolds, self.order < current)
        contacts = Contacts(
            pairs=self.pairs, points=manifolds[3:].T, normals=manifolds[:2].T, impulses=impulses.T
        )
        return contacts, manifolds[2] == 0

    def _one_each(self, manifolds: Floats, current: Flags) -> Floats:
        """
        Return (5, m) float64: the manifold of each pair.

        :param current: (l,) bool: contacts that touch at the end of the frame
        """
        counts = np.diff(self.first, append=len(self.order))
        several = counts > 1
        rows = np.repeat(several, counts)
        counts = counts[several]
        result = manifolds.take(self.first, axis=1)
        result[:, several] = _means(manifolds[:, rows], current[rows], np.cumsum(counts) - counts)
        return result


def _means(manifolds: Floats, current: Flags, first: NDArray[np.intp]) -> Floats:
    """
    Return the mean manifold of each pair over its points.

    The mean does not depend on the order, which the engine takes from addresses.

    :param manifolds: (5, l) float64, pair after pair
    :param current: (l,) bool: contacts that touch at the end of the frame; the others count only
        where no contact of their pair does
    :param first: (m,) intp: index of the first contact of each pair
    """
    pairs = np.repeat(np.arange(len(first)), np.diff(first, append=len(current)))
    counts = manifolds[2] * (current | ~np.logical_or.reduceat(current, first)[pairs])
    means = np.add.reduceat(manifolds * counts, first, axis=1)
    means[2] = np.add.reduceat(counts, first)
    means[3:] /= np.maximum(means[2], 1.0)
    length = np.hypot(means[0], means[1])
    # Opposed normals: the highest of them, then the rightmost.
    order = np.lexsort((manifolds[0], manifolds[1], pairs))
    highest = order[np.append(first[1:], len(pairs)) - 1]
    means[:2] = np.where(
        length > OPPOSED * means[2],
        means[:2] / np.maximum(length, 1e-300),
        manifolds[:2, highest],
    )
    return means


def list_pairs(touching: Ids, table: BodyTable) -> PairListing:
    """Return the pairs of contacts by rows, from the engine's ids, (k, 2) uint64."""
    count = len(table.bodies)
    # The background has no row in a scene.
    a, b = (np.where(rows < count, rows, -1) for rows in table.rows_of(touching).T)
    swap = (b >= 0) & ((a > b) | (a < 0))
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    keys = a * (count + 1) + b
    order = np.argsort(keys, kind='stable')
    order = order[a[order] >= 0]
    first = np.flatnonzero(np.diff(keys[order], prepend=-2))
    leading = order[first]
    return PairListing(
        touching=touching,
        table=table,
        pairs=np.column_stack((a[leading], b[leading])),
        order=order,
        first=first,
        sign=np.where(swap, -1.0, 1.0)[order],
    )


def set_overlap_manifolds(contacts: Contacts, overlaps: NDArray[np.intp], centers: Floats) -> None:
    """
    Set point and normal of overlaps of two bodies, of which the engine has none.

    :param overlaps: (k,) intp: rows of these contacts
    :param centers: (n, 2) float64: centres of mass of the bodies [m]
    """
    a, b = centers[contacts.pairs[overlaps, 0]], centers[contacts.pairs[overlaps, 1]]
    apart = b - a
    length = np.hypot(apart[:, 0], apart[:, 1])[:, None]
    contacts.points[overlaps] = (a + b) / 2
    contacts.normals[overlaps] = np.where(
        length > 0, apart / np.maximum(length, 1e-300), (1.0, 0.0)
    )


def set_wall_manifolds(
    contacts: Contacts, overlaps: NDArray[np.intp], centers: Floats, table: BodyTable
) -> None:
    """
    Set point and normal of overlaps with walls, of which the engine has none.

    The point is the centre of mass projected onto the wall that the body is in deepest.

    :param overlaps: (k,) intp: rows of these contacts
    :param centers: (n, 2) float64: centres of mass of the bodies [m]
    :param table: of the bodies
    """
    bounds = table.scene.settings.bounds
    if bounds is None:
        return
    for overlap in overlaps.tolist():
        row = contacts.pairs[overlap, 0]
        boxes = [shape.bb for shape in table.bodies[row].pm_body.shapes]
        depths = (
            bounds[0] - min(box.left for box in boxes),
            bounds[1] - min(box.bottom for box in boxes),
            max(box.right for box in boxes) - bounds[2],
            max(box.top for box in boxes) - bounds[3],
        )
        side = int(np.argmax(depths))
        axis = side % 2
        contacts.points[overlap] = centers[row]
        contacts.points[overlap, axis] = bounds[side]
        contacts.normals[overlap] = 0.0
        contacts.normals[overlap, axis] = -1.0 if side < 2 else 1.0
