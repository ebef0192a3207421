# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A stroke that is read by itself, without those before it: the reading of its likeliest guess."""

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.meanings import Context
from physsim_ros.drawing.strokes.reading import (
    guess_meanings,
    is_likely,
    not_recognised,
    Reading,
    reading_of,
    recognise_form,
)
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats


def interpret_stroke(samples: Floats, scene: SceneQuery, settings: DrawingSettings) -> Reading:
    """
    Return the reading of a stroke; parameters as of `resample_stroke` and `guess_meanings`.

    :raises Refusal: no guess is likely enough, or the likeliest cannot be built
    """
    drawn = Features.of(resample_stroke(samples))
    context = Context(features=drawn, scene=scene, settings=settings)
    guesses = guess_meanings(recognise_form(drawn), context)
    if not is_likely(guesses, settings):
        raise not_recognised(guesses)
    return reading_of(guesses, 0)
