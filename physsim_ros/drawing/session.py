# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A drawing session: the chosen tool, an unfinished gesture, its preview, and the next free names.

Law: a session changes only itself; it returns ordinary requests, to be submitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
import math

import numpy as np
from physsim_ros.drawing import copies
from physsim_ros.drawing.click import ClickResult, Tool
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import not_recognised, reading_of
from physsim_ros.drawing.strokes.figure import Figure
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.grouping import likeliest_group, MOST_STROKES
from physsim_ros.drawing.strokes.marks import mark_reading, marked_solid
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.drawing.strokes.waiting import readings_over
from physsim_ros.drawing.tools import Gesture
from physsim_ros.drawing.waiting_joints import requests_with_waiting_joints
from physsim_ros.model.answer import Answer, request_count
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised, Refusal, values_of
from physsim_ros.model.names import split_name
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.requests import Cut, Join, Request, Spawn
from physsim_ros.model.shapes import as_tuples
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point, rotated_each
from physsim_ros.simulation.entries import Amend, Origin
from physsim_ros.simulation.simulation import Simulation

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
        # The last figures, the earliest first.
        self._figures: tuple[Figure, ...] = ()
        # The mark on the last figure.
        self._marks: tuple[Figure, ...] = ()
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
        self.preview = NO_PREVIEW
        drawn = resample_stroke(_in_world(samples, frame, scene))
        last = Figure.read(
            classification_of(drawn),
            scene,
            self.settings,
            strokes=(drawn.points,),
            began=began,
            ended=began + (float(np.ptp(samples[:, 2])) if len(samples) else 0.0),
        )
        if not self._marks and marked_solid(self._figures, last, self.settings):
            # The solid stays the last figure: another reading of it may follow.
            return self._keep(self._figures, (last,), mark_reading(last), check)
        # A second line may make an x of a mark.
        marks = (replace(each, scene=scene) for each in self._marks)
        earlier = [*self._figures, *marks]
        figure = likeliest_group(earlier, last, self.settings, self._clock)
        if figure is None:
            figure = last
        else:
            while earlier and earlier[-1].began >= figure.began:
                earlier.pop()
        if figure.chosen is None:
            self._figures, self._marks = (*earlier, figure), ()
            self.preview = _unrecognised_preview(drawn.points)
            raise not_recognised(figure.guesses)
        try:
            built, marked, reading = self._built(figure, figure.chosen, earlier)
        except Refusal:
            # A sign over nothing waits for what it is to change.
            self._figures, self._marks = (*earlier, figure), ()
            raise
        return self._keep((*earlier, built), marked, reading, check)

    def instead(self, meaning: str = '', *, check: Check = _all_may_be) -> Reading:
        """
        Return the reading of the last figure by another guess, which replaces the last one.

        :param meaning: of the guess; '' is the next one that the world can have
        :param check: raises a Refusal of a reading that may not be; the session is then as before
        :raises NotRecognised: there is no such guess
        :raises Refusal: the world cannot have its outcome
        """
        refusals: list[Refusal] = []
        for figure in self._figures[-1:]:
            for number in figure.other_guesses:
                if meaning not in {'', figure.guesses[number].meaning}:
                    continue
                earlier = self._figures[:-1]
                try:
                    built, marked, reading = self._built(figure, number, earlier)
                except Refusal as refusal:
                    refusals.append(refusal)
                    continue
                return self._keep((*earlier, built), marked or self._marks, reading, check)
        nothing = NotRecognised('there is no other reading of what was drawn last', field='poses')
        raise next(iter(refusals), nothing)

    def note_gesture(self, gesture: int) -> None:
        """Note the number of the gesture with which the last reading was submitted."""
        *earlier, last = self._figures
        self._figures = (*earlier, replace(last, gestures=(gesture,)))

    def _built(
        self, figure: Figure, number: int, earlier: Sequence[Figure]
    ) -> tuple[Figure, tuple[Figure, ...], Reading]:
        """
        Return a figure by one of its guesses, the marks that earlier ones are on it, its reading.

        :raises Refusal: the world cannot have its outcome
        """
        reading = reading_of(figure.guesses, number, amends=figure.gestures)
        requests = requests_with_waiting_joints(reading.requests, figure.scene, self.settings.snap)
        figure = replace(figure, chosen=number, requests=requests)
        message, also = reading.message, []
        marks: tuple[Figure, ...] = ()
        for (stroke, *_), over in readings_over(figure, earlier, self.settings):
            requests += over.requests
            message += f'; {over.message}'
            also.append(over.meaning)
            if over.meaning == 'mark':
                marks = (replace(stroke, requests=(), gestures=()),)
            elif over.meaning == 'velocity':
                figure = figure.with_gravity()
                reading = replace(reading, guesses=figure.guesses)
        reading = replace(reading, requests=requests, message=message, also=tuple(also))
        return replace(figure, requests=requests), marks, reading

    def _keep(
        self,
        figures: Iterable[Figure],
        marks: tuple[Figure, ...],
        reading: Reading,
        check: Check,
    ) -> Reading:
        """Return a reading that may be, after its figures, preview and names are kept."""
        check(reading)
        self._figures, self._marks = tuple(figures)[-MOST_STROKES:], marks
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
            match request:
                case Spawn(name=name) if split_name(name)[0] == DRAWN:
                    self._next_body = max(self._next_body, 1 + split_name(name)[1])
                case Cut(pieces=pieces):
                    self._reserve_names(pieces)
                case Join(name=name) if split_name(name)[0] == DRAWN:
                    self._next_joint = max(self._next_joint, 1 + split_name(name)[1])


def submit_reading(
    simulation: Simulation,
    session: DrawingSession,
    reading: Reading,
    origin: Origin | None = None,
    *,
    topic: str = '',
) -> None:
    """
    Answer a stroke by its reading, and submit its requests as one gesture.

    The requests of a reading that amends earlier gestures replace those.

    :param session: whose last reading it is
    :param origin: the message of the stroke; None is one of `topic`
    :param topic: its source, where nothing else is known of the message
    """
    queue, origin = simulation.requests, origin or Origin(topic)
    queue.tell(replace(reading_answer(reading, topic=origin.topic), asker=origin.asker))
    if reading.amends:
        amend = Amend(reading.amends, reading.requests)
        queue.submit(amend, origin, joined=True)
        session.note_gesture(reading.amends[0])
        return
    for number, request in enumerate(reading.requests):
        queue.submit(request, origin, joined=number > 0)
    if reading.requests:
        session.note_gesture(queue.gesture)


def reading_answer(reading: Reading, *, topic: str) -> Answer:
    """Return the answer that reports a reading; the answers to its requests follow."""
    values = (*values_of(reading.confidences), request_count(len(reading.requests)))
    return Answer(topic=topic, subject=reading.subject, message=reading.message, values=values)


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
