# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Random histories whose requests, seeks, undo, redo and resets are messages of another node."""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any

from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Delete,
    DeleteAll,
    Join,
    Pin,
    Release,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
from physsim_ros.testing import (
    box,
    chain,
    command,
    delete,
    delete_all,
    disc,
    joint,
    PhysSim,
    point,
    polygon,
)
import pytest
from visualization_msgs.msg import Marker

from .journey import clock_of
from ..client import Client
from ..simulation.histories import history_of_node, NodePlayer, play
from ..simulation.random_history import SETTINGS

SEEDS = range(700, 708)
TOPICS = {Anchor: '~/anchor', Release: '~/release', Pin: '~/pin', Axle: '~/axle'}


def marker_of(spawn: Spawn) -> Marker | None:
    """Return the marker of a spawn request; None where a marker cannot say it."""
    if spawn.properties.robot is not None:
        return None
    more: dict[str, Any] = {
        'at': spawn.pose,
        'color': spawn.color or (0.0, 0.0, 0.0, 0.0),
        'lifetime': spawn.lifetime,
        'frame': spawn.frame,
    } | spawn.properties.explicit()
    for key in more.keys() & {'actor', 'robot'}:
        more[key] = more[key].entry()
    match spawn.shape:
        case Disc(radius=radius):
            return disc(spawn.name, diameter=2.0 * radius, **more)
        case Box(width=width, height=height):
            return box(spawn.name, size=(width, height), **more)
        case Polygon(outline=outline):
            return polygon(spawn.name, outline=outline, **more)
        case Chain(points=points, thickness=thickness):
            return chain(spawn.name, points=points, thickness=thickness, **more)
        case Compound():
            return None
    raise AssertionError(spawn.shape)


def message_of(request: Request) -> tuple[str, Any] | None:
    """Return topic and message of a request; None where no topic carries it."""
    match request:
        case Spawn():
            marker = marker_of(request)
            return None if marker is None else ('~/spawn', marker)
        case Command(names=names, poses=poses, twists=twists, wrenches=wrenches):
            rows = {'poses': poses, 'twists': twists, 'wrenches': wrenches}
            return '~/command', command(*names, **{key: row.tolist() for key, row in rows.items()})
        case Delete(name=name):
            return '~/spawn', delete(name)
        case DeleteAll():
            return '~/spawn', delete_all()
        case Unjoin(name=name):
            return '~/join', delete(name)
        case Join(name=name, kind=kind, points=points, a=a, b=b, properties=said):
            terms = {} if said.break_force is None else {'break_force': said.break_force}
            return '~/join', joint(kind.value, points, name, a=a, b=b, **terms)
        case Anchor() | Release() | Pin() | Axle():
            return TOPICS[type(request)], point(*request.point, frame=request.frame)
    return None


class TopicsPlayer(NodePlayer):
    """A player that asks the world of a node over its topics and services, where it can."""

    def __init__(self, physsim: PhysSim, client: Client) -> None:
        super().__init__(physsim.node.simulation)
        self.physsim = physsim
        self.client = client

    def send(self, request: Request) -> bool:
        message = message_of(request)
        if message is None:
            return False
        self.client.publish(*message)
        self.physsim.settle()
        return True

    def _perform(self, action: str) -> None:
        response = self.client.call(f'~/{action}')
        if not response.success:
            raise OutOfHistory(response.message)

    def _seek(self, stamp: int) -> None:
        self.client.ask('~/seek', clock_of(stamp))


@pytest.mark.slow
@pytest.mark.parametrize('seed', SEEDS)
def test_a_history_over_topics_shows_what_its_requests_show_when_they_are_played_from_nothing(
    seed: int, start: Callable[..., PhysSim], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert SETTINGS.bounds is not None
    physsim = start(bounds=[*SETTINGS.bounds])
    monkeypatch.setattr('physsim_ros.ros.frame_loop.MOST_TICK_NS', math.inf)
    player = TopicsPlayer(physsim, Client(physsim))
    play(history_of_node(seed), player)
    assert player.sent
