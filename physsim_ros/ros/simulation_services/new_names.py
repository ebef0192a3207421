# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Names of new bodies: of a stem, the one with the least number that is free.

Cost: n names of a stem among N bodies take N + n look-ups, not N for each.
"""

from __future__ import annotations

from collections.abc import Mapping


class NewNames:
    """
    The names of the bodies that a call adds.

    :param taken: what there is of each name that a body has
    """

    def __init__(self, taken: Mapping[str, object]) -> None:
        self._taken = taken
        self._added: set[str] = set()
        # Number of each stem below which all are taken.
        self._least: dict[str, int] = {}

    def __contains__(self, name: str) -> bool:
        """Return whether a body has a name."""
        return name in self._added or name in self._taken

    def add(self, name: str) -> None:
        """Note a name that a body has from now on."""
        self._added.add(name)

    def free_name(self, stem: str) -> str:
        """Return the name of a stem with the least number that is free."""
        number = self._least.get(stem, 0)
        while f'{stem}/{number}' in self:
            number += 1
        self._least[stem] = number
        return f'{stem}/{number}'
