# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A drawing session: a person's tool, unfinished gesture, last strokes, preview, and next free names.

Law: a session changes only itself; it returns ordinary requests, to be submitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
import math

import numpy as np
from physsim_ros.drawing import copies
from physsim_ros.drawing.click import ClickResult, Tool
from physsim_ros.drawing.gesture import Gesture
from physsim_ros.drawing.scene_query import number_above, SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import not_recognised
from physsim_ros.drawing.strokes.figure import Figure
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.marks import mark_reading
from physsim_ros.drawing.strokes.sketch import Sketch
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised, Refusal
from physsim_ros.model.names import ADDED, BODY, JOINT
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.requests import Request
from physsim_ros.model.shapes import as_tuples
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point, rotated_each

# Raises a Refusal of a reading that may not be.
Check = Callable[[Reading], object]
# The least confidence in a runner-up that the label of a preview mentions.
_MENTIONED = 0.05


def _all_may_be(_reading: Reading) -> None:
    """Refuse nothing."""


class DrawingSession:
    """
    The clicks and strokes of one person.

    :param settings: of drawing; may be changed at any time
    :param tool: that clicks use
    :param clock: returns the CPU time of the thread [s], by which the reading of strokes together
        is limited; the default one stands still

    :ivar preview: the unfinished gesture, or the last stroke as it was read
    """

    def __init__(
        self,
        settings: DrawingSettings,
        tool: Tool = Tool.NONE,
        *,
        clock: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self.settings = settings
        self._clock = clock
        self.preview: Preview = NO_PREVIEW
        self._gesture = Gesture(tool)
        self._sketch = Sketch()
        # The lowest numbers that this session has not yet given to a body or joint.
        self._next_body = self._next_joint = 0

    @property
    def tool(self) -> Tool:
        """Return the tool that clicks use; a change drops the unfinished gesture."""
        return self._gesture.tool

    @tool.setter
    def tool(self, tool: Tool) -> None:
        if tool is not self.tool:
            self._gesture = Gesture(tool)
            self.preview = NO_PREVIEW

    def drop(self) -> None:
        """Drop the unfinished gesture; the tool stays."""
        self._gesture = Gesture(self.tool)
        self.preview = NO_PREVIEW

    def click(self, point: Point, frame: str, snapshot: Snapshot) -> ClickResult:
        """
        Add a click to the gesture, and return its requests where that ends it.

        :param point: [m]
        :param frame: of the point: '' for the world, or the name of a body
        :param snapshot: of the world that was clicked
        :raises Refusal: the gesture cannot be drawn
        """
        try:
            result = self._gesture.click(point, frame, self._query(snapshot), self.settings)
        finally:
            self.preview = self._gesture.preview(self.settings)
        self._reserve_names(result.requests)
        return result

    def stroke(
        self,
        samples: Floats,
        frame: str,
        snapshot: Snapshot,
        *,
        began: float = -math.inf,
        check: Check = _all_may_be,
    ) -> Reading:
        """
        Return the reading of a stroke, with its requests.

        A stroke may make a better figure together with the strokes just before it. The reading is
        then that of the figure, and its requests replace those of the earlier strokes.

        :param samples: (n, 3) float64: x, y [m], time from any start [s]
        :param frame: of the samples: '' for the world, or the name of a body
        :param snapshot: of the world that was drawn on
        :param began: time of the first sample [s]; without it the stroke is read by itself
        :param check: raises a Refusal of a reading that may not be; the session is then as before
        :raises Refusal: it is not recognised, or cannot be drawn
        """
        scene = self._query(snapshot)
        drawn = resample_stroke(_in_world(samples, frame, scene))
        stroke = Figure.read(
            classification_of(drawn),
            scene,
            self.settings,
            strokes=(drawn.points,),
            began=began,
            ended=began + (float(np.ptp(samples[:, 2])) if len(samples) else 0.0),
        )
        if self._sketch.is_marked_by(stroke, self.settings):
            return self._keep(self._sketch.with_mark(stroke), mark_reading(stroke), check)
        sketch = self._sketch.with_stroke(stroke, self.settings, self._clock)
        figure = sketch.figures[-1]
        if figure.chosen is None:
            self._sketch, self.preview = sketch, _unrecognised_preview(drawn.points)
            raise not_recognised(figure.guesses)
        try:
            built, reading = sketch.built(figure.chosen, self.settings)
        except Refusal:
            # A sign over nothing waits for what it is to change.
            self._sketch, self.preview = sketch, NO_PREVIEW
            raise
        return self._keep(built, reading, check)

    def instead(self, meaning: str = '', *, check: Check = _all_may_be) -> Reading:
        """
        Return the reading of the last figure by another guess, which replaces the last one.

        :param meaning: of the guess; '' is the next one that the world can have
        :param check: raises a Refusal of a reading that may not be; the session is then as before
        :raises NotRecognised: there is no such guess
        :raises Refusal: the world cannot have its outcome
        """
        refusals: list[Refusal] = []
        for number in self._sketch.other_guesses(meaning):
            try:
                built, reading = self._sketch.built(number, self.settings)
            except Refusal as refusal:
                refusals.append(refusal)
            else:
                return self._keep(built, reading, check)
        nothing = NotRecognised('there is no other reading of what was drawn last', field='poses')
        raise next(iter(refusals), nothing)

    def note_gesture(self, gesture: int) -> None:
        """Note the number of the gesture with which the last reading was submitted."""
        self._sketch = self._sketch.submitted(gesture)

    def _keep(self, sketch: Sketch, reading: Reading, check: Check) -> Reading:
        """Return a reading that may be, after its sketch, preview and names are kept."""
        check(reading)
        self._sketch = sketch
        self.preview = _reading_preview(reading)
        self._reserve_names(reading.requests)
        return reading

    def copy_machine(
        self, names: Sequence[str], by: Point, snapshot: Snapshot
    ) -> tuple[Request, ...]:
        """
        Return the requests for copies of bodies, at rest, and of the joints among them.

        :param names: of the bodies
        :param by: vector from each body to its copy [m]
        :param snapshot: of the world
        :raises UnknownBody: there is no such body
        :raises Malformed: one is named twice
        """
        requests = copies.copy_machine(names, by, self._query(snapshot))
        self._reserve_names(requests)
        return requests

    def _query(self, snapshot: Snapshot) -> SceneQuery:
        return SceneQuery(snapshot, first=self._next_body, first_joint=self._next_joint)

    def _reserve_names(self, requests: Iterable[Request]) -> None:
        """Reserve the names of new bodies and joints, even if the requests are refused later."""
        for request in requests:
            self._next_body = number_above(request.noted(BODY, ADDED), self._next_body)
            self._next_joint = number_above(request.noted(JOINT, ADDED), self._next_joint)


def _in_world(samples: Floats, frame: str, scene: SceneQuery) -> Floats:
    """Return samples of a frame in the world, (n, 3) float64: x, y [m], time [s]."""
    if not frame:
        return samples
    origin = scene.resolve_point((0.0, 0.0), frame)
    placed = samples.copy()
    placed[:, :2] = rotated_each(samples[:, :2], scene.pose(frame)[2]) + origin
    return placed


def _unrecognised_preview(points: Floats) -> Preview:
    """Return the preview of a stroke that was not recognised."""
    return Preview(lines=(as_tuples(points),), label='not recognised')


def _reading_preview(reading: Reading) -> Preview:
    label = f'{reading.meaning} {reading.confidence:.0%}'
    for other in reading.guesses[1:2]:
        if other.confidence >= _MENTIONED:
            label += f', or {other.meaning} {other.confidence:.0%}'
    label = '; '.join((label, *reading.also))
    return Preview(lines=(as_tuples(reading.outline),), label=label)
