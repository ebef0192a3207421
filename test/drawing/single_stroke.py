# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A stroke that is read by itself, without those before it: the reading of its likeliest guess."""

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.interpretation import (
    guess_meanings,
    is_likely,
    not_recognised,
    Reading,
    reading_of,
)
from physsim_ros.model.arrays import Floats


def interpret_stroke(samples: Floats, scene: SceneQuery, settings: DrawingSettings) -> Reading:
    """
    Return the reading of a stroke; parameters as of `guess_meanings`.

    :raises Refusal: no guess is likely enough, or the likeliest cannot be built
    """
    guesses = guess_meanings(samples, scene, settings)
    if not is_likely(guesses, settings):
        raise not_recognised(guesses)
    return reading_of(guesses, 0)
