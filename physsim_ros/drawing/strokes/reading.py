# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading a stroke: its stages in their order, and what each returns.

Laws: a stage changes nothing, and its result depends on its arguments alone. A reading holds
ordinary requests, to be submitted.

=======================  ==================  ======================================================
stage                    returns             which is
=======================  ==================  ======================================================
`stroke.resample_stroke` `Stroke`            samples cleaned, a path of evenly spaced points
`features.features_of`   `Features`          its bends, swings and crossings
`forms.forms_of`         `Form` of each kind its looks, each with a weight: signs and the shapes of
                                             outlines by evidence, lines by their corners
`meanings.in_scene`      `Context`           all that, over the bodies at its ends
`meanings.meanings_of`   `Meaning`           of each form what it would be in this scene
`choice.guesses_among`   `Guess`, at most 3  the likeliest meanings, and how sure the first one is
`choice.reading_of`      `Reading`           the requests of one of them, and words about these
=======================  ==================  ======================================================

The scene divides the weight of a form among the meanings of the form. Meanings are chosen by
group: closed outlines are one group, since circles, ovals and rounded polygons look alike; open
lines are another; every sign is a group of its own. The likeliest group is chosen first, and then
the likeliest meaning in it. A stroke is refused when the confidence in the group is too small.

Several strokes may be one figure (`grouping`), and a new body may change what earlier strokes are
(`waiting`, `marks`): these are read by the same stages again.
"""

from __future__ import annotations

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import guesses_among
from physsim_ros.drawing.strokes.features import features_of
from physsim_ros.drawing.strokes.forms import forms_of
from physsim_ros.drawing.strokes.meanings import in_scene, meanings_of
from physsim_ros.drawing.strokes.stages import Context, Guess
from physsim_ros.drawing.strokes.stroke import Stroke


def stroke_in_scene(stroke: Stroke, scene: SceneQuery, settings: DrawingSettings) -> Context:
    """Return a stroke in the scene that it was drawn over, with all forms that it may have."""
    features = features_of(stroke)
    return in_scene(features, forms_of(features), scene, settings)


def guesses_of(context: Context) -> tuple[Guess, ...]:
    """Return the most likely meanings of a stroke in its scene, and how sure the first one is."""
    return guesses_among(meanings_of(context), context)
