# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints over topics: markers on `~/join`, points on `~/pin` and `~/axle`, what comes back."""

from __future__ import annotations

from typing import Any

from physsim_ros.testing import box, delete, marker, PhysSim, point
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, Event, KEPT

KINDS = {
    'pin': ([(0.4, 0.0)], ''),
    'axle': ([(0.4, 0.0)], ', lower: -1, upper: 1'),
    'motor': ([(0.4, 0.0)], ', rate: 2, max_torque: 5'),
    'spring': ([(0.4, 0.0), (1.0, 0.0)], ', stiffness: 40, damping: 0.1'),
    'rod': ([(0.4, 0.0), (1.0, 0.0)], ''),
    'rope': ([(0.4, 0.0), (1.0, 0.0)], ', length: 2'),
    'slider': ([(0.4, 0.0), (1.0, 0.0)], ', lower: -0.5, upper: 0.5'),
    'gear': ([(0.4, 0.0)], ', ratio: -2'),
}


def joint(text: str, points: list[tuple[float, float]], **options: Any) -> Marker:
    """Return the marker of a joint."""
    return marker(Marker.LINE_LIST, name='joint/0', points=points, text=text, **options)


def pair(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', at=(0.0, 0.0, 0.0)))
    physsim.spawn(box('a/1', at=(0.8, 0.0, 0.0)))


@pytest.mark.parametrize('kind', KINDS)
def test_a_marker_joins_and_its_picture_joins_again_to_the_bit(
    physsim: PhysSim, client: Client, kind: str
) -> None:
    points, properties = KINDS[kind]
    pair(physsim)
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    (event,) = client.ask('~/join', joint(f'{{kind: {kind}{properties}}}', points))
    assert event == Event(0, '~/join', 'joint/0', event.message, 'ok', '')
    physsim.run(0.5)
    drawn = {each.ns: each for each in pictures[-1].markers}
    assert f'kind: {kind}' in drawn['joint:joint'].text
    assert drawn['lines:joint'].points
    # Once, so that what is as drawn is said; and from then on nothing changes.
    physsim.join(drawn['joint:joint'])
    before = physsim.digest()
    physsim.step(0)
    (event,) = client.ask('~/join', drawn['joint:joint'])
    assert event.code == 'ok'
    assert physsim.digest() == before


def test_a_point_pins_and_another_one_lets_go(physsim: PhysSim, client: Client) -> None:
    pair(physsim)
    (event,) = client.ask('~/pin', point(0.4, 0.0))
    assert event == Event(0, '~/pin', 'pin/0', event.message, 'ok', '')
    assert physsim.axle((0.4, 0.0)) == 'axle/0'
    assert physsim.joints == ('pin/0', 'axle/0')
    physsim.release((0.4, 0.0))
    assert physsim.joints == ()


def test_a_joint_is_deleted_by_marker_and_leaves_the_picture(
    physsim: PhysSim, client: Client
) -> None:
    pair(physsim)
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    physsim.axle((0.4, 0.0))
    physsim.step()
    (event,) = client.ask('~/join', delete('axle/0'))
    assert (event.hardware_id, event.code) == ('axle/0', 'ok')
    physsim.step()
    actions = {each.ns: each.action for each in pictures[-1].markers}
    assert actions['joint:axle'] == actions['lines:axle'] == Marker.DELETE


def test_a_joint_that_breaks_is_told(
    physsim: PhysSim, client: Client, capfd: pytest.CaptureFixture[str]
) -> None:
    physsim.spawn(box('a/0', text='{mass: 1}'))
    physsim.join(joint('{kind: axle, break_force: 5}', [(0.0, 0.0)]))
    before = len(client.events)
    physsim.step(3)
    (event,) = client.events[before:]
    assert (event.level, event.name, event.hardware_id) == (2, 'joint_broken', 'joint/0')
    assert event.code == 'joint_broken'
    assert ']: joint_broken: joint/0 broke at' in capfd.readouterr().err
