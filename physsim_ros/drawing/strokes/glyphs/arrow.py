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

"""The arrow, drawn in free space: the new direction of gravity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import regularisation
from physsim_ros.drawing.strokes.context import Context, Interpretation, MISPLACED, Outcome
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis, LEAST, rises
from physsim_ros.drawing.strokes.polyline import point_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised
from physsim_ros.model.requests import Configure

PRIMITIVE = 'arrow'
# The least gap between the ends of an arrow, in shares of its length.
_LEAST_GAP = 0.1


def hypothesis(features: Features) -> Hypothesis:
    """Return the hypothesis of a shaft and a head, in either order; points: tail and tip."""
    stroke, absence = features.stroke, features.swings.absence
    if absence < LEAST or stroke.gap < _LEAST_GAP:
        return Hypothesis(primitive=PRIMITIVE, weight=0.0, points=stroke.points[[0, -1]])
    orders = stroke.points, stroke.points[::-1]
    best = max((_arrow_from_tail(points) for points in orders), key=lambda each: each.weight)
    return replace(best, weight=best.weight * absence)


def _arrow_from_tail(points: Floats) -> Hypothesis:
    """Return the hypothesis of an arrow whose tail is the first point."""
    tail = points[0]
    tip = points[int(((points - tail) ** 2).sum(axis=1).argmax())]
    along = tip - tail
    # In shares of its length; the tip lies at (1, 0).
    frame = (points - tail) @ np.column_stack((along, (-along[1], along[0]))) / (along @ along)
    x, y = frame.T
    # The shaft ends at the point at which the pen turns back or aside.
    ahead = x[4:] - x[:-4]
    over = (ahead < 0.55 * np.median(ahead[:40])) & (x[:-4] > 0.4)
    end = int(over.argmax()) if over.any() else len(points) - 1
    head = frame[end:]
    left, right = int(head[:, 1].argmax()), int(head[:, 1].argmin())
    up, down = float(head[left, 1]), -float(head[right, 1])
    path = float(np.hypot(*np.diff(head, axis=0).T).sum())
    weight = (
        falls(float(np.abs(y[:end]).max(initial=0.0)), 0.12, 0.01)
        * rises(min(up, down) / max(up, down, 1e-12), 0.25, 0.03)
        * rises(up + down, 0.09, 0.012)
        * falls(up + down, 0.85, 0.04)
        * rises(float(head[:, 0].min()), 0.47, 0.025)
        * falls(float(max(head[left, 0], head[right, 0])), 0.985, 0.012)
        * falls(float(head[[left, right], 0].max() - head[:, 0].min()), 0.22, 0.02)
        * rises(path, 0.22, 0.02)
        * falls(path, 2.6, 0.12)
    )
    return Hypothesis(primitive=PRIMITIVE, weight=weight, points=np.array((tail, tip)))


def interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield a turn of gravity."""
    points = hypothesis.points
    free = not context.scene.bodies_at(point_of(points[0]))
    yield Interpretation(
        meaning='gravity',
        weight=hypothesis.weight * (1.0 if free else MISPLACED),
        build=partial(_turn_gravity, points, context),
    )


def _turn_gravity(points: Floats, context: Context) -> Outcome:
    """Turn gravity into the direction from tail to tip; its magnitude stays."""
    tail = context.scene.bodies_at(point_of(points[0]))
    if tail:
        raise NotRecognised(
            f'an arrow in free space turns gravity; this one begins on {tail[0]}', field='poses'
        )
    strength = context.scene.gravity_strength()
    ends = regularisation.line(points, context.settings.beautify)
    x, y = (ends[1] - ends[0]).tolist()
    length = math.hypot(x, y)
    gravity = strength * x / length, strength * y / length
    return Outcome(
        requests=(Configure(changes={'gravity': gravity}),),
        subject='',
        message=f'gravity towards ({gravity[0]:.3g}, {gravity[1]:.3g}) m/s²',
        outline=context.drawn.points,
    )
