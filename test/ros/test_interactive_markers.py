# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies as interactive markers, as the client of interactive_markers, in RViz, reads them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from physsim_ros.ros.publishers import interactive_markers
from physsim_ros.ros.publishers.interactive_markers import PERIOD
from physsim_ros.testing import box, delete, disc, PhysSim
import pytest
from visualization_msgs.msg import InteractiveMarkerUpdate, Marker
from visualization_msgs.srv import GetInteractiveMarkers

from ..client import Client

# Frames between updates of poses, at 60 Hz.
FRAMES = round(60.0 * PERIOD)


class Viewer:
    """Keeps the markers of a server as RViz does: by the service, then by updates in order."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.updates: list[InteractiveMarkerUpdate] = []
        self.updates = client.listen(InteractiveMarkerUpdate, '~/drag/update')
        self.sizes: list[int] = []
        answer = self.ask()
        self.sizes.append(len(answer.markers))
        self.number = answer.sequence_number
        self.markers: dict[str, Any] = {each.name: each for each in answer.markers}

    def ask(self) -> Any:
        request = GetInteractiveMarkers.Request()
        return self.client.request(
            GetInteractiveMarkers, '~/drag/get_interactive_markers', request
        )

    def catch_up(self) -> dict[str, Any]:
        self.client.physsim.settle()
        while self.updates:
            update = self.updates.pop(0)
            if update.seq_num <= self.number:
                continue
            assert update.seq_num == self.number + 1
            assert update.type == InteractiveMarkerUpdate.UPDATE
            self.number = update.seq_num
            self.sizes.append(len(update.markers))
            self.markers |= {each.name: each for each in update.markers}
            for each in update.poses:
                self.markers[each.name].pose = each.pose
            for name in update.erases:
                self.markers.pop(name, None)
        return self.markers


def test_a_viewer_has_the_bodies_where_they_are(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(disc('ball/0', at=(0.0, 5.0)))
    physsim.step()
    viewer = Viewer(client)
    physsim.spawn(box('wall/0', at=(3.0, 0.0), size=(1.0, 2.0), anchored=True))
    physsim.step(2 * FRAMES)
    markers = viewer.catch_up()
    assert set(markers) == {'ball/0', 'wall/0'}
    # Another one, who comes later, is told the same.
    late = {each.name: each for each in viewer.ask().markers}
    markers = viewer.catch_up()
    assert {name: each.pose for name, each in late.items()} == {
        name: each.pose for name, each in markers.items()
    }
    for name, marker in markers.items():
        position = marker.pose.position
        assert (position.x, position.y) == physsim.pose(name)[:2]
        (control,) = marker.controls
        assert control.interaction_mode == control.MOVE_PLANE
    (drawn,) = markers['wall/0'].controls[0].markers
    assert (drawn.type, drawn.scale.x, drawn.scale.y) == (Marker.CUBE, 1.0, 2.0)
    physsim.spawn(delete('ball/0'))
    physsim.step()
    assert set(viewer.catch_up()) == {'wall/0'}


def test_each_step_of_a_paused_world_is_told(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(disc('ball/0', at=(0.0, 5.0)))
    client.call('~/pause')
    physsim.node.loop.apply_requests()
    viewer = Viewer(client)
    for _ in range(3):
        client.call('~/step')
        physsim.node.loop.apply_requests()

        position = viewer.catch_up()['ball/0'].pose.position
        assert (position.x, position.y) == physsim.pose('ball/0')[:2]
    assert physsim.pose('ball/0').y < 5.0


def test_of_many_bodies_some_are_told_at_a_time_until_all_have_them(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    most, count = 3, 10
    monkeypatch.setattr(interactive_markers, 'MOST_NEW', most)
    for number in range(count):
        physsim.spawn(box(f'box/{number}', at=(3.0 * number, 5.0)))
    client.call('~/pause')
    physsim.node.loop.apply_requests()
    first = Viewer(client)
    for now in range(count):
        physsim.node.tick(now)
    assert set(first.catch_up()) == set(physsim.names)
    assert sum(first.sizes) == count
    # Who comes later is told all, and others again; what is gone meanwhile is gone for both.
    second = Viewer(client)
    physsim.spawn(delete('box/9'))
    physsim.step()
    for now in range(count):
        physsim.node.tick(now)
    for viewer in (first, second):
        markers = viewer.catch_up()
        assert set(markers) == set(physsim.names) == {f'box/{number}' for number in range(9)}
        for name, marker in markers.items():
            position = marker.pose.position
            assert (position.x, position.y) == physsim.pose(name)[:2]
        assert max(viewer.sizes) == most


def test_what_stands_is_not_told_again(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(box('wall/0', anchored=True))
    physsim.step()
    viewer = Viewer(client)
    physsim.step(5 * FRAMES)
    assert viewer.updates == []


def test_poses_are_told_as_often_at_any_rate_of_frames(start: Callable[..., PhysSim]) -> None:
    physsim = start(publish_rate=120.0)
    physsim.spawn(disc('ball/0', at=(0.0, 50.0)))
    client = Client(physsim)
    viewer = Viewer(client)
    physsim.run(10 * PERIOD)
    client.spin_until(lambda: len(viewer.updates) >= 10)
    assert len(viewer.updates) == 10


def test_nothing_is_sent_to_nobody_and_little_to_somebody(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim.spawn(disc('ball/0', at=(0.0, 50.0)))
    physsim.spawn(box('wall/0', at=(3.0, 0.0), anchored=True))
    viewer = Viewer(client)
    physsim.step(5 * FRAMES)
    # Updates come at a lower rate than frames.
    assert len(viewer.updates) == 5
    for subscription in list(client.node.subscriptions):
        if subscription.topic_name.endswith('/update'):
            client.node.destroy_subscription(subscription)
    (publisher,) = [
        each for each in physsim.node.publishers if each.topic_name.endswith('/drag/update')
    ]
    client.spin_until(lambda: not publisher.get_subscription_count())
    encode = 'physsim_ros.ros.publishers.interactive_markers.InteractivePosesEncoder.encode'
    monkeypatch.setattr(encode, lambda *_: pytest.fail('it was encoded for nobody'))
    physsim.step(2 * FRAMES)
