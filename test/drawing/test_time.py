# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawing is the same while the world runs, while it stands, and in its past."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from physsim_ros.drawing.click import Tool
from physsim_ros.drawing.session import DrawingSession
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.answer import Answer
from physsim_ros.model.requests import Command, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.transform import Point
from physsim_ros.simulation.simulation import Simulation
import pytest

TICK = 1_000_000_000 // 60
STATES = ('running', 'paused', 'past')


class Studio:
    """A world in one of its states of time, in which somebody draws on what is seen."""

    def __init__(self, state: str) -> None:
        self.simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
        self.pen = DrawingSession(DrawingSettings())
        self._now = 0
        # One that moves at 1 m/s, and one that stands.
        self.ask(Spawn(name='a/0', shape=Disc(radius=0.5)))
        self.ask(Spawn(name='a/1', shape=Disc(radius=0.5), pose=(0.0, 5.0, 0.0)))
        self.ask(Command(names=('a/0',), twists=((1.0, 0.0, 0.0),)))
        self.frame: Frame = self.simulation.advance_frame()
        for _ in range(119):
            self.frame = self.simulation.advance_frame()
        if state in ('paused', 'past'):
            self.simulation.speed = 0.0
        if state == 'past':
            self.simulation.seek(1_000_000_000)
        self.tick()

    def ask(self, request: Any) -> None:
        self.simulation.requests.submit(request, topic='~/test')

    def tick(self) -> tuple[Answer, ...]:
        """Let a sixtieth of a second pass, and return what is answered."""
        self._now += TICK
        answers: tuple[Answer, ...] = ()
        for frame in self.simulation.advance(self._now):
            self.frame = frame
            answers += frame.answers
        # A change in the past begins a course, which is an event too.
        return tuple(answer for answer in answers if answer.topic == '~/test')

    def x(self, name: str = 'a/0') -> float:
        """Return where a body is seen."""
        snapshot = self.frame.snapshot
        return float(snapshot.poses[snapshot.scene.names.index(name), 0])

    def draw(self, tool: Tool, *clicks: Callable[[Studio], Point]) -> tuple[Answer, ...]:
        """Click, a tick after each, and return the answers to what the last one asks for."""
        self.pen.tool = tool
        answers: tuple[Answer, ...] = ()
        for click in clicks:
            step = self.pen.click(click(self), '', self.frame.snapshot)
            for request in step.requests:
                self.ask(request)
            answers = self.tick()
        return answers


@pytest.fixture(params=STATES)
def studio(request: pytest.FixtureRequest) -> Studio:
    """Give a studio in each of the states of time."""
    return Studio(request.param)


def at(x: float, y: float) -> Callable[[Studio], Point]:
    return lambda _: (x, y)


def on_the_moving_one(studio: Studio) -> Point:
    return studio.x(), 0.0


def test_the_studio_is_in_the_state_that_it_says() -> None:
    seen = {state: Studio(state) for state in STATES}
    before = {state: each.x() for state, each in seen.items()}
    for each in seen.values():
        each.tick()
    moved = {state: each.x() - before[state] for state, each in seen.items()}
    # m: a frame at 1 m/s
    assert moved['running'] == pytest.approx(1 / 60)
    assert moved['paused'] == moved['past'] == 0.0
    assert before['past'] == pytest.approx(1.0)


NINE = at(9, 9), at(8, 8), at(9, 8)


@pytest.mark.parametrize(
    ('tool', 'clicks', 'names'),
    [
        (Tool.CIRCLE, NINE[:2], ('a/0', 'a/1', 'drawn/0')),
        (Tool.CIRCLE_DIAMETER, NINE[:2], ('a/0', 'a/1', 'drawn/0')),
        (Tool.RECTANGLE, NINE, ('a/0', 'a/1', 'drawn/0')),
        (Tool.POLYGON, (*NINE, NINE[0]), ('a/0', 'a/1', 'drawn/0')),
        (Tool.WALL, NINE[:2], ('a/0', 'a/1', 'drawn/0')),
        (Tool.DELETE, [on_the_moving_one], ('a/1',)),
    ],
)
def test_a_body_is_drawn_or_deleted_there_and_then(
    studio: Studio, tool: Tool, clicks: Any, names: tuple[str, ...]
) -> None:
    (answer,) = studio.draw(tool, *clicks)
    assert (answer.code, answer.subject) == ('', 'drawn/0' if 'drawn/0' in names else 'a/0')
    assert studio.frame.snapshot.scene.names == studio.simulation.world.scene.names == names


def test_what_is_clicked_is_what_is_seen(studio: Studio) -> None:
    (answer,) = studio.draw(Tool.ANCHOR, on_the_moving_one)
    assert (answer.code, answer.subject) == ('', 'a/0')
    held = studio.x()
    studio.simulation.speed = 1.0
    studio.tick()
    studio.tick()
    assert studio.x() == held


def test_what_is_drawn_in_the_past_is_there_from_then_on_and_not_before() -> None:
    studio = Studio('past')
    studio.draw(Tool.CIRCLE, at(9, 9), at(9, 8))
    studio.simulation.seek(500_000_000)
    studio.tick()
    assert studio.frame.snapshot.scene.names == ('a/0', 'a/1')
    studio.simulation.speed = 1.0
    while studio.frame.snapshot.stamp < 1_100_000_000:
        studio.tick()
    assert studio.frame.snapshot.scene.names == ('a/0', 'a/1', 'drawn/0')


def test_a_click_on_a_world_that_goes_back_hits_what_is_seen() -> None:
    studio = Studio('running')
    studio.simulation.speed = -1.0
    studio.tick()
    seen = studio.x()
    (answer,) = studio.draw(Tool.DELETE, on_the_moving_one)
    assert (answer.code, answer.subject) == ('', 'a/0')
    # It goes on going back, to where it had not been deleted yet.
    assert studio.x() < seen
