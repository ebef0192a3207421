# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The grips of hands on bodies, as requests make them and as the core pulls by them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.core import dtype_of
from physsim_ros.engine.core_world import Table
from physsim_ros.model.snapshot import Grip

_GRIP = dtype_of('Grip')


class GripSet:
    """The grips of hands, one a hand, in the order in which they were made."""

    def __init__(self) -> None:
        self._by_hand: dict[str, Grip] = {}
        # Whether the core has them as they are, for the bodies of now.
        self._is_told = False

    def __iter__(self) -> Iterator[Grip]:
        return iter(self._by_hand.values())

    def __len__(self) -> int:
        return len(self._by_hand)

    def of(self, hand: str) -> Grip | None:
        """Return the grip of a hand; None if it has none."""
        return self._by_hand.get(hand)

    def put(self, grip: Grip) -> None:
        """Add a grip; it replaces that of the same hand in its place."""
        self._is_told = False
        self._by_hand[grip.hand] = grip

    def remove(self, hand: str) -> None:
        """Remove the grip of a hand."""
        self._is_told = False
        del self._by_hand[hand]

    def remove_from(self, body: str) -> None:
        """Remove all grips on a body."""
        self._is_told = False
        self._by_hand = {hand: grip for hand, grip in self._by_hand.items() if grip.body != body}

    def note_rows(self) -> None:
        """Note that bodies have other rows."""
        self._is_told = False

    def changed_records(self, rigids: Mapping[str, RigidBody]) -> Table | None:
        """
        Return the grips as the core is to have them; None if it has them since the last call.

        :param rigids: bodies by name
        :return: (n,) `Grip`, in the order of their bodies
        """
        was_told, self._is_told = self._is_told, True
        return None if was_told else self._records(rigids)

    def _records(self, rigids: Mapping[str, RigidBody]) -> Table:
        records = np.zeros(len(self), _GRIP)
        in_order = sorted(self, key=lambda grip: rigids[grip.body].row)
        for record, grip in zip(records, in_order, strict=True):
            rigid = rigids[grip.body]
            (x, y), offset = grip.anchor, rigid.offset
            record['body'], record['target'] = rigid.row, grip.target
            record['anchor'] = x - offset[0], y - offset[1]
        return records
