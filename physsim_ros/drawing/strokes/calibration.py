# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Calibration: a weight becomes a confidence, the share of guesses of that weight that are right.

Platt scaling (Platt, 1999): a logistic function of the log odds of a weight against the others.
The constants were fitted to the strokes of the tuning half of `make evaluate`, all kinds and all
faults, by maximum likelihood; `make evaluate` prints how well they hold on the report half.
"""

from __future__ import annotations

import math

# Weight of the possibility that a stroke means nothing.
DOUBT = 0.02
# Log odds of a group being right at equal weights, and their growth with the log odds of weights.
GROUP_BIAS, GROUP_SLOPE = -0.4, 1.9
# The same for a meaning within its group.
SHARE_BIAS, SHARE_SLOPE = 0.36, 0.86
# The least share of either side, so that log odds are finite.
_LEAST = 1e-3


def group_confidence(weight: float, total: float) -> float:
    """
    Return the confidence in a group of meanings, 0 .. 1.

    :param weight: of the group
    :param total: of all groups
    """
    return _platt(weight / (total + DOUBT), GROUP_BIAS, GROUP_SLOPE)


def share_confidence(share: float) -> float:
    """
    Return the confidence in a meaning where its group is right, 0 .. 1.

    :param share: weight of the meaning, as a share of the weight of its group
    """
    return _platt(share, SHARE_BIAS, SHARE_SLOPE)


def _platt(share: float, bias: float, slope: float) -> float:
    odds = max(share, _LEAST) / max(1.0 - share, _LEAST)
    return 1.0 / (1.0 + math.exp(-bias - slope * math.log(odds)))
