# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A stroke that is read by itself, without those before it: the reading of its likeliest guess."""

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import is_likely, not_recognised, reading_of
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.reading import guesses_of
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats


def interpret_stroke(samples: Floats, scene: SceneQuery, settings: DrawingSettings) -> Reading:
    """
    Return the reading of a stroke; parameters as of `resample_stroke` and `guesses_of`.

    :raises Refusal: no guess is likely enough, or the likeliest cannot be built
    """
    guesses = guesses_of(classification_of(resample_stroke(samples)), scene, settings)
    if not is_likely(guesses, settings):
        raise not_recognised(guesses)
    return reading_of(guesses, 0)
