# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Confidence grows with the weight of a guess against that of the others."""

import itertools

from physsim_ros.drawing.strokes.calibration import group_confidence, share_confidence
import pytest


def test_more_weight_is_more_confidence_and_none_is_certain() -> None:
    groups = [group_confidence(share, 1.0) for share in (0.0, 0.2, 0.5, 0.8, 1.0)]
    shares = [share_confidence(share) for share in (0.0, 0.2, 0.5, 0.8, 1.0)]

    for confidences in (groups, shares):
        assert all(less < more for less, more in itertools.pairwise(confidences))
        assert confidences[0] > 0.0
        assert confidences[-1] < 1.0


def test_a_group_alone_is_sure_enough_to_delete_and_one_of_two_equals_is_not_built() -> None:
    assert group_confidence(1.0, 1.0) > 0.9
    assert group_confidence(0.5, 1.0) < 0.6


def test_of_two_equal_meanings_in_a_group_about_every_second_is_right() -> None:
    # The better one of two is the more likely one, by the noise of weights.
    assert share_confidence(0.5) == pytest.approx(0.55, abs=0.1)
