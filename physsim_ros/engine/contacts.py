# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contacts of a frame, as the core has summed them (`core/contact_report.c`)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.model.arrays import Floats
from physsim_ros.model.snapshot import Contacts, NO_CONTACTS


def take_contacts(core: CoreWorld, table: BodyTable, centers: Callable[[], Floats]) -> Contacts:
    """
    Return the contacts since the last call, each pair once, and begin the next sums.

    :param table: of the bodies
    :param centers: returns (n, 2) float64: centres of mass [m], by which overlaps without points
        are placed
    """
    listed, begun, steps = core.take_contacts()
    if steps == 0:
        return NO_CONTACTS
    if not len(listed) and not len(begun):
        return replace(NO_CONTACTS, steps=steps)
    contacts = Contacts(
        pairs=listed['pair'],
        points=listed['point'],
        normals=listed['normal'],
        impulses=listed['impulse'],
        steps=steps,
        begun=begun['pair'],
        begun_at=begun['time'],
    )
    pointless = listed['points'] == 0
    if pointless.any():
        with_wall, places = contacts.pairs[:, 1] < 0, centers()
        _place_overlaps(contacts, np.flatnonzero(pointless & ~with_wall), places)
        _place_on_walls(contacts, np.flatnonzero(pointless & with_wall), places, table)
    return contacts


def _place_overlaps(contacts: Contacts, overlaps: NDArray[np.intp], centers: Floats) -> None:
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


def _place_on_walls(
    contacts: Contacts, overlaps: NDArray[np.intp], centers: Floats, table: BodyTable
) -> None:
    """
    Set point and normal of overlaps with walls, of which the engine has none.

    The point is the centre of mass projected onto the wall that the body is in deepest.

    :param overlaps: (k,) intp: rows of these contacts
    :param centers: (n, 2) float64: centres of mass of the bodies [m]
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
