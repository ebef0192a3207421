# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Hypotheses: the forms that a stroke can have, each with a weight.

The weight of a sign is its probability (`evidence`). The rest is shared among lines and outlines
by soft conditions (logistic functions), each 0.5 at its limit. The limits lie between the figures
of the hand-drawn forms that they separate; `make evaluate` measures how often a form is read.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

from physsim_ros.model.arrays import Floats

# Hypotheses and interpretations of a lower weight are dropped. A rival of a hundredth tells right
# readings from wrong ones.
LEAST = 0.002


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Hypothesis:
    """
    A form that a stroke may have.

    :param primitive: name of the form: `disc`, `line`, `arrow` and so on; its module defines it
    :param weight: how well the stroke fits the form, 0 .. 1
    :param points: (n, 2) float64: the points that describe the form, in the world [m]
    """

    primitive: str
    weight: float
    points: Floats


def rises(value: float, limit: float, width: float) -> float:
    """Return the logistic function: 0 far below a limit, 0.5 there, 1 far above."""
    return 1.0 / (1.0 + math.exp(min(max((limit - value) / width, -50.0), 50.0)))


def falls(value: float, limit: float, width: float) -> float:
    """Return the logistic function: 1 far below a limit, 0.5 there, 0 far above."""
    return rises(-value, -limit, width)
