# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The work of a stroke or a copy grows with what it is about, and not with a power of that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, scene_query
from physsim_ros.drawing.strokes import bodies_under, figure
from physsim_ros.drawing.strokes.figure import Figure, MOST_STROKES, MOST_TIME
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Malformed, Refusal
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Chain, Shape
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.world.body_description import new_body
import pytest

from ..building import DISC

# Pieces of each chain of a crowd.
PIECES = 99
SHARE = np.linspace(0.0, 1.0, 12)
STROKES = {
    'line': np.column_stack((0.05 + 3.9 * SHARE, 0.05 * SHARE, SHARE)),
    'scribble': np.column_stack((3.5 * SHARE, 0.4 * (-1.0) ** np.arange(12), SHARE)),
    'circle': np.column_stack((2.0 + 0.3 * np.cos(7 * SHARE), 0.3 * np.sin(7 * SHARE), SHARE)),
}


def crowd(count: int, shape: Shape, *, anchored: bool) -> Snapshot:
    """Return a scene of equal bodies at one place."""
    settings, properties = WorldSettings(), Properties(anchored=anchored)
    spawns = (
        Spawn(name=f'drawn/{each}', shape=shape, properties=properties) for each in range(count)
    )
    scene = Scene(
        bodies=tuple(new_body(each, settings, None)[0] for each in spawns), settings=settings
    )
    return Snapshot(
        step=0, stamp=0, scene=scene, poses=np.zeros((count, 3)), twists=np.zeros((count, 3))
    )


@pytest.mark.parametrize('kind', STROKES)
def test_a_stroke_over_twice_as_many_walls_is_twice_the_work(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    share = np.linspace(0.0, 1.0, PIECES + 1)
    points = zip((4.0 * share).tolist(), (0.3 * np.sin(40.0 * share)).tolist(), strict=True)
    wall = Chain(points=tuple(points), thickness=0.1)
    tested: list[int] = []
    surfaces: list[str] = []

    def note(name: str, count: Callable[[Any, Floats], int]) -> None:
        call = getattr(scene_query, name)

        def contain(what: Any, x: Floats, y: Floats, *slack: float) -> Any:
            tested.append(count(what, x))
            return call(what, x, y, *slack)

        monkeypatch.setattr(scene_query, name, contain)

    def surface(*words: Any) -> Any:
        surfaces.append(words[1])
        return nearest(*words)

    note('contains_each', lambda form, x: len(form.pieces) * len(x))
    note('contain_each', lambda forms, _: sum(len(form.pieces) for form in forms))
    nearest = bodies_under._surface  # noqa: SLF001 - once for each pair of bodies, it took seconds
    monkeypatch.setattr(bodies_under, '_surface', surface)

    def work(count: int) -> int:
        session, snapshot = DrawingSession(DrawingSettings()), crowd(count, wall, anchored=True)
        tested.clear()
        surfaces.clear()
        try:
            session.stroke(STROKES[kind], '', snapshot, began=0.0)
        except Refusal:
            assert kind == 'scribble'
        assert len(surfaces) <= 4
        return sum(tested)

    some, more = work(40), work(80)
    assert 0 < more <= 2 * some
    # At most each point of the stroke and a few others.
    assert more <= 80 * PIECES * 2 * 128


def test_a_stroke_is_read_with_the_newest_strokes_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    read = list[int]()
    guess_meanings = figure.guess_meanings
    monkeypatch.setattr(
        figure, 'guess_meanings', lambda *words: read.append(1) or guess_meanings(*words)
    )
    session, snapshot = DrawingSession(DrawingSettings()), crowd(0, DISC, anchored=True)
    for number in range(3 * MOST_STROKES):
        read.clear()
        # A saw of lines, each of which begins where the last one ends.
        line = [(0.5 * each, 0.7 * (each % 2), 0.3 * each) for each in (number, number + 1)]
        reading = session.stroke(np.array(line), '', snapshot, began=0.5 * number)
        assert reading.meaning == 'wall'
        assert len(read) == min(number + 1, MOST_STROKES)


def test_a_stroke_is_read_by_itself_when_the_time_is_over(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now, read = 0.0, Figure.read
    times = list[float]()

    def slow(*words: Any, **options: Any) -> Figure:
        nonlocal now
        times.append(now)
        now += 0.003
        return read(*words, **options)

    monkeypatch.setattr(Figure, 'read', slow)
    session = DrawingSession(DrawingSettings(), clock=lambda: now)
    snapshot = crowd(0, DISC, anchored=True)
    for number in range(2 * MOST_STROKES):
        times.clear()
        line = [(0.5 * each, 0.7 * (each % 2), 0.3 * each) for each in (number, number + 1)]
        session.stroke(np.array(line), '', snapshot, began=0.5 * number)
    # The stroke itself, and then as many groups as are begun in time.
    assert len(times) == 1 + 4
    assert times[-1] - times[1] < MOST_TIME


def test_a_copy_of_twice_as_many_bodies_is_twice_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    split, looked = scene_query.split_name, list[str]()
    monkeypatch.setattr(scene_query, 'split_name', lambda name: looked.append(name) or split(name))

    def work(count: int) -> int:
        session, snapshot = DrawingSession(DrawingSettings()), crowd(count, DISC, anchored=False)
        looked.clear()
        for first in (count, 2 * count):
            copies = session.copy_machine(snapshot.scene.names, (9.0, 0.0), snapshot)
            numbers = range(first, first + count)
            assert [each.name for each in copies] == [f'drawn/{number}' for number in numbers]
        return len(looked)

    assert 0 < work(400) <= 2 * work(200)


def test_no_body_is_copied_twice_at_once() -> None:
    session, snapshot = DrawingSession(DrawingSettings()), crowd(3, DISC, anchored=False)
    with pytest.raises(Malformed, match='named twice'):
        session.copy_machine(('drawn/0', 'drawn/1', 'drawn/0'), (9.0, 0.0), snapshot)
    assert session.copy_machine(('drawn/0',), (9.0, 0.0), snapshot)[0].name == 'drawn/3'
