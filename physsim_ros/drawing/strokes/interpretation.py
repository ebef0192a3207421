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

"""
Interpretation: the most likely meaning of a stroke in the scene that it was drawn over.

Law: interpretation changes nothing; a reading holds ordinary requests, to be submitted.

Each form that the stroke may have has a weight, and the scene divides that weight among the
meanings of the form. The confidence in a meaning is its share of the sum of all weights and of
`DOUBT`, the weight of no meaning at all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.context import Context, Interpretation, Outcome
from physsim_ros.drawing.strokes.glyphs import SIGNS
from physsim_ros.drawing.strokes.hypothesis import Hypothesis, LEAST
from physsim_ros.drawing.strokes.recogniser import recognise_form
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised

# The weight of no meaning at all.
DOUBT = 0.12

Interpret = Callable[[Hypothesis, Context], Iterator[Interpretation]]

# The interpretations of each form, by its name.
_INTERPRET: dict[str, Interpret] = {
    **{sign.PRIMITIVE: sign.interpretations for sign in SIGNS},
    open_lines.LINE: open_lines.interpretations,
    closed_shapes.DISC: closed_shapes.disc_interpretations,
    closed_shapes.OVAL: closed_shapes.oval_interpretations,
    closed_shapes.RECTANGLE: closed_shapes.rectangle_interpretations,
    closed_shapes.POLYGON: closed_shapes.polygon_interpretations,
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading(Outcome):
    """
    The most likely meaning of a stroke, and its outcome.

    :param meaning: the meaning: `disc`, `anchor` and so on
    :param confidence: in it, 0 .. 1
    :param runner_up: the second most likely meaning; '' where there is none
    :param runner_up_confidence: in that, 0 .. 1
    """

    meaning: str
    confidence: float
    runner_up: str
    runner_up_confidence: float

    @property
    def values(self) -> tuple[tuple[str, str], ...]:
        """Return meaning and runner-up with their confidences, as pairs of key and value."""
        ranked = [(self.meaning, self.confidence)]
        if self.runner_up:
            ranked.append((self.runner_up, self.runner_up_confidence))
        return _values(ranked)


def interpret_stroke(samples: Floats, scene: SceneQuery, settings: DrawingSettings) -> Reading:
    """
    Return the most likely meaning of a stroke.

    :param samples: (n, 2) float64: positions of the pen in the world, in order [m]; or (n, 3), the
        third column the time of each, by which they are ordered where it differs
    :param scene: the world that it was drawn over
    :param settings: of drawing
    :raises Malformed: there are no samples, or one is not finite
    :raises BadSize: the stroke is too small to be anything, or too large
    :raises BadOutline: its outline cannot be simulated
    :raises NothingThere: it is a sign for a body, and there is none
    :raises NotRecognised: no meaning is likely enough; the message names the two likeliest
    """
    context = Context(drawn=resample_stroke(samples), scene=scene, settings=settings)
    weights: dict[str, float] = {}
    # The likeliest interpretation of each meaning.
    best: dict[str, Interpretation] = {}
    for hypothesis in recognise_form(context.drawn):
        for each in _INTERPRET[hypothesis.primitive](hypothesis, context):
            if each.weight < LEAST:
                continue
            weights[each.meaning] = weights.get(each.meaning, 0.0) + each.weight
            if each.meaning not in best or each.weight > best[each.meaning].weight:
                best[each.meaning] = each
    total = sum(weights.values()) + DOUBT
    ranked = sorted(weights, key=lambda meaning: -weights[meaning])
    confidences = [(meaning, weights[meaning] / total) for meaning in ranked]
    if not confidences or confidences[0][1] < settings.sketch_confidence:
        raise NotRecognised(
            _doubt(confidences[:2]), field='poses', values=_values(confidences[:2])
        )
    (meaning, confidence), *others = confidences
    outcome = best[meaning].build()
    runner_up, runner_up_confidence = others[0] if others else ('', 0.0)
    return Reading(
        meaning=meaning,
        confidence=confidence,
        runner_up=runner_up,
        runner_up_confidence=runner_up_confidence,
        requests=outcome.requests,
        subject=outcome.subject,
        message=outcome.message,
        outline=outcome.outline,
    )


def _values(ranked: Sequence[tuple[str, float]]) -> tuple[tuple[str, str], ...]:
    """Return meanings and confidences in them, the likeliest first, as pairs of key and value."""
    keys = (('reading', 'confidence'), ('runner_up', 'runner_up_confidence'))
    return tuple(
        pair
        for (name, share), (meaning, confidence) in zip(keys, ranked, strict=False)
        for pair in ((name, meaning), (share, f'{confidence:.3f}'))
    )


def _doubt(confidences: list[tuple[str, float]]) -> str:
    """Return the message about a stroke that was not recognised."""
    if not confidences:
        return 'the stroke looks like nothing that can be drawn'
    words = ' or '.join(f'{meaning} ({share:.0%})' for meaning, share in confidences)
    return f'the stroke is not clear enough; it might be: {words}. Nothing was drawn'
