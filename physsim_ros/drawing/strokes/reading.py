# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading a stroke: its stages in their order, and what each returns.

Laws: a stage changes nothing, and its result depends on its arguments alone. A reading holds
ordinary requests, to be submitted.

=========================  ==================  ====================================================
stage                      returns             which is
=========================  ==================  ====================================================
`stroke.resample_stroke`   `Stroke`            samples cleaned, a path of evenly spaced points
`features.features_of`     `Features`          its bends, swings and crossings
`forms.classification_of`  `Classification`    the forms that it may have, each with a weight:
                                               signs and shapes of outlines by evidence, lines by
                                               their corners
`meanings.in_scene`        `Context`           the stroke over the bodies at its ends
`meanings.meanings_of`     `Meaning`           of each form what it would be in this scene
`choice.guesses_among`     `Guess`, at most 3  the likeliest meanings
`judge.doubted`            `Guess`, at most 3  the same, and how sure the first one is
`choice.reading_of`        `Reading`           the requests of one of them, and words about these
=========================  ==================  ====================================================

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
from physsim_ros.drawing.strokes.judge import doubted
from physsim_ros.drawing.strokes.meanings import in_scene, meanings_of
from physsim_ros.drawing.strokes.stages import Classification, Guess


def guesses_of(
    stroke: Classification, scene: SceneQuery, settings: DrawingSettings
) -> tuple[Guess, ...]:
    """
    Return the most likely meanings of a stroke, and how sure the first one is.

    :param stroke: with the forms that it may have
    :param scene: the world that it was drawn over
    """
    return doubted(guesses_by_rules(stroke, scene, settings), stroke, scene)


def guesses_by_rules(
    stroke: Classification, scene: SceneQuery, settings: DrawingSettings
) -> tuple[Guess, ...]:
    """Return the guesses of `guesses_of`, the first one not yet doubted."""
    context = in_scene(stroke.features, scene, settings)
    return guesses_among(meanings_of(stroke.forms, context), stroke.unexplained)
