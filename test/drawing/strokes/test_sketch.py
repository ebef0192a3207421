# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A sketch: the last figures of a person, however they were read."""

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.figure import Figure
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.grouping import MOST_STROKES
from physsim_ros.drawing.strokes.sketch import Sketch
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.simulation.world import World
from tools.evaluation.figures import pigtail

SETTINGS = DrawingSettings()


def test_a_sketch_has_the_last_figures_alone_even_where_nothing_is_recognised() -> None:
    scene, sketch = SceneQuery(World().snapshot()), Sketch()
    drawn = resample_stroke(pigtail(np.random.default_rng(0)).path)
    for number in range(2 * MOST_STROKES):
        figure = Figure.read(
            classification_of(drawn),
            scene,
            SETTINGS,
            strokes=(drawn.points,),
            began=9.0 * number,
            ended=9.0 * number + 1.0,
        )
        sketch = sketch.with_stroke(figure, SETTINGS, lambda: 0.0)

        assert figure.chosen is None
        assert sketch.figures[-1] is figure
        assert len(sketch.figures) == min(number + 1, MOST_STROKES)
