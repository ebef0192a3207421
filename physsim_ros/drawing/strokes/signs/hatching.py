# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hatching: lines inside a body make it heavier."""

from __future__ import annotations

from functools import partial

from physsim_ros.drawing.strokes.meanings import Context, Interpretation, Outcome
from physsim_ros.drawing.strokes.polyline import point_of
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody

# Factor on the density of a body by each line of its hatching.
HEAVIER = 1.25
# The least share of the stroke on the body: ends may cross its edge.
_INSIDE = 0.95


def hatched_body(context: Context) -> str | None:
    """Return the name of the topmost dynamic body that all of the stroke lies on, if any."""
    points, scene = context.drawn.points, context.scene
    for name in scene.bodies_at(point_of(points[len(points) // 2])):
        if scene.body(name).dynamic and scene.covers(name, points).mean() >= _INSIDE:
            return name
    return None


def interpretation(body: str, lines: int, context: Context, *, weight: float) -> Interpretation:
    """
    Return the interpretation of a line as hatching.

    :param body: that the stroke lies on
    :param lines: number of lines of the hatching
    """
    return Interpretation(
        meaning='hatching', weight=weight, build=partial(_make_heavier, body, lines, context)
    )


def _make_heavier(name: str, lines: int, context: Context) -> Outcome:
    body = context.scene.body(name)
    density = body.total_mass / body.shape.form.area * HEAVIER**lines
    heavier = ChangeBody(name=name, properties=Properties(density=density))
    return Outcome(
        requests=(heavier,),
        subject=name,
        message=f'{name} is heavier by {HEAVIER**lines - 1.0:.0%}: {density:.3g} kg/m²',
        outline=context.drawn.points,
    )
