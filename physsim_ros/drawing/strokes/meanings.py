# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Meanings of the forms of a stroke in the scene that it was drawn over.

Law: the meanings of a form share its weight.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.bodies_under import joint_ends, wheels_passed
from physsim_ros.drawing.strokes.evidence import LEAST
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import (
    BETWEEN,
    Context,
    DISC,
    Form,
    LINE,
    Meaning,
    OVAL,
    POLYGON,
    RECTANGLE,
)

# The function from each form to its meanings, by the form's name.
_MEANINGS: dict[str, Callable[[Form, Context], Iterator[Meaning]]] = {
    **{sign.name: sign.meanings for sign in SIGNS},
    LINE: open_lines.meanings,
    DISC: closed_shapes.disc_meanings,
    OVAL: closed_shapes.oval_meanings,
    RECTANGLE: closed_shapes.rectangle_meanings,
    POLYGON: closed_shapes.polygon_meanings,
}
# Forms that enclose an area.
_OUTLINES = frozenset({DISC, OVAL, RECTANGLE, POLYGON})


def in_scene(features: Features, scene: SceneQuery, settings: DrawingSettings) -> Context:
    """Return a stroke in the scene that it was drawn over."""
    points = features.stroke.points
    ends = joint_ends(points, scene, settings.snap)
    return Context(
        features=features,
        scene=scene,
        settings=settings,
        ends=ends,
        wheels=wheels_passed(points, ends, scene, settings.snap) if ends else (),
    )


def meanings_of(forms: Iterable[Form], context: Context) -> Iterator[Meaning]:
    """
    Yield the meanings of forms of a stroke in its scene; several forms may have the same one.

    :param forms: that the stroke may have
    """
    rope = open_lines.rope_around_wheels(context)
    for form in forms:
        found = _MEANINGS[form.name](form, context)
        if rope is not None and form.name in _OUTLINES:
            # A line from body to body that runs around a wheel encloses nothing.
            yield replace(rope, weight=form.weight * BETWEEN)
            found = (replace(each, weight=each.weight * (1.0 - BETWEEN)) for each in found)
        yield from (each for each in found if each.weight >= LEAST)
