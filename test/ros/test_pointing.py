# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A point on `~/anchor` or `~/release` means the topmost body under it, at any rotation."""

from __future__ import annotations

import math

from physsim_ros.testing import box, PhysSim, point
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, Event

# A box of 2 m by 1 m, turned; just inside and just outside of the middle of its right side [m].
AT = (3.0, -2.0, 0.7)
INSIDE, OUTSIDE = 1.0 - 1e-6, 1.0 + 1e-6


@pytest.mark.parametrize('frame', ['', 'a/0'])
def test_a_body_is_anchored_and_released_at_a_point_up_to_its_edge(
    physsim: PhysSim, client: Client, frame: str
) -> None:
    pictures = client.listen(MarkerArray, '~/markers')
    physsim.spawn(box('a/0', size=(2.0, 1.0), at=AT))

    def at(reach: float) -> tuple[float, float]:
        if frame:
            return reach, 0.0
        return AT[0] + reach * math.cos(AT[2]), AT[1] + reach * math.sin(AT[2])

    def symbols() -> list[int]:
        physsim.step(0)
        return [each.action for each in pictures[-1].markers if each.ns == 'anchor:a']

    for topic, shown in (('~/anchor', Marker.ADD), ('~/release', Marker.DELETE)):
        before = physsim.digest()
        (event,) = client.ask(topic, point(*at(OUTSIDE), frame))
        assert event == Event(2, topic, '', event.message, 'nothing_there', 'point')
        assert physsim.digest() == before
        (event,) = client.ask(topic, point(*at(INSIDE), frame))
        assert event == Event(0, topic, 'a/0', event.message, 'ok', '')
        assert symbols() == [shown]
    physsim.step(2)
    assert physsim.twist('a/0').vy < 0.0
