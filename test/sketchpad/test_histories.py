# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Random histories whose requests, seeks and courses are messages of a page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import (
    ChangeBody,
    Delete,
    DeleteBodies,
    MoveBodies,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.snapshot import Frame
import pytest

from .browser import Browser
from ..simulation.histories import history_of_node, NodePlayer, play
from ..simulation.random_history import SETTINGS

SEEDS = range(800, 808)


def _said(properties: Properties) -> dict[str, Any]:
    said = properties.explicit()
    for key in said.keys() & {'actor', 'robot'}:
        said[key] = said[key].entry()
    return said


def message_of(request: Request) -> tuple[str, dict[str, Any]] | None:
    """Return type and fields of the message of a request; None where a page has none."""
    match request:
        case Spawn(name=name, shape=shape, pose=pose, color=color, lifetime=lifetime):
            body = {'name': name, shape.KEY: shape.entry(), 'at': pose, 'lifetime': lifetime}
            colored = {} if color is None else {'color': color}
            return 'spawn', {'body': body | colored | _said(request.properties)}
        case ChangeBody(name=name, properties=properties):
            return 'change', {'name': name, 'properties': _said(properties)}
        case MoveBodies(names=names, by=by):
            return 'move_bodies', {'names': names, 'by': by}
        case Delete(name=name):
            return 'delete', {'names': [name]}
        case DeleteBodies(names=names):
            return 'delete', {'names': names}
        case Unjoin(name=name):
            return 'unjoin', {'name': name}
    return None


class PagePlayer(NodePlayer):
    """A player that asks the world of a node on its page, where it can."""

    def __init__(self, browser: Browser) -> None:
        super().__init__(browser.physsim.node.simulation)
        self.page = browser.open_page()
        self.page.until(lambda: self.page.of_type('scene'))
        # A page has the world show what it has asked: frames that were not looked at yet.
        self.pending: list[Frame] = []

    def look(self, frame: Frame | None) -> None:
        pending, self.pending = self.pending, []
        for each in (*pending, frame):
            super().look(each)

    def send(self, request: Request) -> bool:
        message = message_of(request)
        if message is None:
            return False
        self.page.ask(message[0], **message[1])
        self.look(None)
        return True

    def _seek(self, stamp: int) -> None:
        self.page.ask('seek', time=stamp / 1e9)

    def _return_to_course(self, number: int) -> None:
        assert self.page.ask('course', course=number)['ok']


@pytest.mark.slow
@pytest.mark.parametrize('seed', SEEDS)
def test_a_history_on_a_page_shows_what_its_requests_show_when_they_are_played_from_nothing(
    seed: int, browse: Callable[..., Browser], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert SETTINGS.bounds is not None
    browser = browse(bounds=[*SETTINGS.bounds])
    player, outputs = PagePlayer(browser), browser.physsim.node.outputs
    show = outputs.show

    def note(frame: Frame) -> None:
        player.pending.append(frame)
        show(frame)

    monkeypatch.setattr(outputs, 'show', note)
    play(history_of_node(seed), player)
    assert player.sent
