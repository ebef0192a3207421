# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Any click with any tool is drawn or refused, and the world can go on."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.drawing.click import Tool
from physsim_ros.drawing.session import DrawingSession
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World

from ..building import spawn

# Coordinates of clicks [m]: near one another and near bodies, as people click; and any.
near = st.integers(-8, 8).map(lambda eighths: eighths / 8)
number = st.one_of(near, st.floats(-5, 5), st.floats())
point = st.tuples(number, number)
frame = st.sampled_from(['', '', '', 'a/0', 'a/1', 'drawn/0', 'nobody/0'])
action = st.one_of(
    st.tuples(st.sampled_from(Tool), st.none(), st.none()), st.tuples(st.none(), point, frame)
)


def populated() -> World:
    world = World()
    spawn(world, 'a/0')
    spawn(world, 'a/1', Box(width=2.0, height=0.5), (0.5, 0.25, 0.3))
    return world


def apply_all(world: World, requests: Iterable[Request]) -> None:
    """Apply requests, of which the world may refuse some, and go on a frame."""
    for request in requests:
        with suppress(Refusal):
            world.apply(request)
    world.step(4)


@settings(max_examples=300, deadline=None)
@given(
    st.lists(st.tuples(near, near) | st.tuples(st.floats(-3, 3), st.floats(-3, 3)), max_size=40),
    st.sampled_from([(0.0, 0.0), (math.nan, 0.0), (1e9, 0.0), (1e-9, 1e300)]),
    st.booleans(),
    frame,
)
def test_any_stroke_is_read_or_refused_and_leaves_the_world_sound(
    points: list[tuple[float, float]], odd: tuple[float, float], with_odd: bool, where: str
) -> None:
    world = populated()
    pen = DrawingSession(DrawingSettings(sketch_confidence=0.0))
    samples = np.array([*points, *([odd] if with_odd else [])]).reshape(-1, 2)
    before = world.digest()
    try:
        reading = pen.stroke(
            np.column_stack((samples, np.arange(len(samples)) / 60)), where, world.snapshot()
        )
    except Refusal:
        assert world.digest() == before
        return
    assert 0.0 <= reading.confidence <= 1.0
    assert np.isfinite(reading.outline).all()
    apply_all(world, reading.requests)
    assert np.isfinite(world.snapshot().poses).all()


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(Tool), st.lists(action, max_size=15))
def test_any_clicks_are_drawn_or_refused_and_leave_the_world_sound(
    tool: Tool, actions: list[tuple[Tool | None, tuple[float, float] | None, str | None]]
) -> None:
    world = populated()
    pen = DrawingSession(DrawingSettings(), tool)
    for taken, clicked, where in actions:
        if taken is not None:
            pen.tool = taken
            continue
        before = world.digest()
        try:
            step = pen.click(clicked, where, world.snapshot())
        except Refusal:
            assert world.digest() == before
            continue
        # A click that makes nothing yet is answered with the next one.
        assert step.message or step.requests
        assert not step.message or len(step.requests) != 1
        apply_all(world, step.requests)
    assert np.isfinite(world.snapshot().poses).all()
    assert all(math.isfinite(x) for line in pen.preview.lines for place in line for x in place)
