# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reliability of confidence: of the readings said to be so sure, how many are right.

The area under the curve (AUC) is the chance that a right reading has more confidence than a wrong
one.
"""

from __future__ import annotations

import itertools

import numpy as np

# Bounds of the classes of confidence.
_BOUNDS = (0.0, 0.5, 0.7, 0.9, 0.95, 0.99, 1.0)


class Reliability:
    """Confidences of readings, and whether each was right."""

    def __init__(self) -> None:
        self._confidences: list[float] = []
        self._right: list[bool] = []

    def add(self, confidence: float, *, right: bool) -> None:
        """Add a reading."""
        self._confidences.append(confidence)
        self._right.append(right)

    def show(self, where: str) -> None:
        """Print a row for each class of confidence, and the area under the curve."""
        confidences, right = np.array(self._confidences), np.array(self._right)
        print(f'\n{f"{where}, said to be sure by":<34}{"mean":>8}{"right":>8}')
        for low, high in itertools.pairwise(_BOUNDS):
            rows = (confidences > low) & (confidences <= high)
            if rows.any():
                name = f'{low:.0%} to {high:.0%}'
                said, true = confidences[rows].mean(), right[rows].mean()
                print(f'{name:<34}{said:8.1%}{true:8.1%} of {rows.sum()}')
        print(f'{"AUC of right against wrong":<34}{self.auc():8.2f}\n')

    def auc(self) -> float:
        """Return the area under the curve, 0 .. 1; ties count half."""
        confidences, right = np.array(self._confidences), np.array(self._right)
        wrong, well = np.sort(confidences[~right]), confidences[right]
        if not len(wrong) or not len(well):
            return 1.0
        below = np.searchsorted(wrong, well, 'left'), np.searchsorted(wrong, well, 'right')
        return float(np.mean(below) / len(wrong))
