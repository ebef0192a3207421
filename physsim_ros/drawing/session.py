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
A drawing session: the chosen tool, an unfinished gesture, its preview, and the next free names.

Law: a session changes only itself; it returns ordinary requests, to be submitted.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from physsim_ros.drawing import body_requests
from physsim_ros.drawing.clicks.gesture import Gesture
from physsim_ros.drawing.clicks.tools import ClickResult, Tool
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.interpretation import interpret_stroke, Reading
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised, UnknownBody
from physsim_ros.model.names import split_name
from physsim_ros.model.preview import Line, NO_PREVIEW, Preview
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.model.transform import Point

# The least confidence in a runner-up that the label of a preview mentions.
_MENTIONED = 0.05
# The greatest number of points of a stroke in a preview.
_MOST_POINTS = 200


class DrawingSession:
    """
    The clicks and strokes of one person.

    :param settings: of drawing; may be changed at any time
    :param tool: that clicks use

    :ivar preview: the unfinished gesture, or the last stroke as it was read
    """

    def __init__(self, settings: DrawingSettings, tool: Tool = Tool.NONE) -> None:
        self.settings = settings
        self.preview: Preview = NO_PREVIEW
        self._gesture = Gesture(tool)
        # The lowest numbers that no body and no joint of this session has had.
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

    def click(self, point: Point, frame: str, snapshot: Snapshot) -> ClickResult:
        """
        Add a click to the gesture, and return its requests where that ends it.

        :param point: [m]
        :param frame: of the point: '' for the world, or the name of a body
        :param snapshot: of the world that was clicked
        :raises Refusal: the gesture cannot be drawn
        """
        try:
            step = self._gesture.click(point, frame, self._query(snapshot), self.settings)
        finally:
            self.preview = self._gesture.preview(self.settings)
        self._reserve_names(step.requests)
        return step

    def stroke(self, samples: Floats, frame: str, snapshot: Snapshot) -> Reading:
        """
        Return the reading of a stroke, with its requests.

        :param samples: (n, 3) float64: x, y [m], time [s]
        :param frame: of the samples: '' for the world, or the name of a body
        :param snapshot: of the world that it was drawn over
        :raises Refusal: it is not recognised, or cannot be drawn
        """
        scene = self._query(snapshot)
        self.preview = NO_PREVIEW
        placed = _in_world(samples, frame, scene)
        try:
            reading = interpret_stroke(placed, scene, self.settings)
        except NotRecognised:
            self.preview = _unrecognised_preview(placed)
            raise
        self.preview = _reading_preview(reading)
        self._reserve_names(reading.requests)
        return reading

    def copy(self, name: str, position: Point, snapshot: Snapshot) -> Spawn:
        """
        Return the request for a copy of a body, at rest.

        :param name: of the body
        :param position: of the copy [m]
        :param snapshot: of the world
        :raises UnknownBody: there is no such body
        """
        scene = self._query(snapshot)
        if name not in scene.names:
            raise UnknownBody(f'there is no body {name}', field='name')
        request = body_requests.copy(
            scene.next_body(), scene.body(name), (*position, scene.pose(name)[2])
        )
        self._reserve_names((request,))
        return request

    def _query(self, snapshot: Snapshot) -> SceneQuery:
        return SceneQuery(snapshot, first=self._next_body, first_joint=self._next_joint)

    def _reserve_names(self, requests: Iterable[Request]) -> None:
        """Reserve the names of new bodies and joints, even if the requests are refused later."""
        for request in requests:
            match request:
                case Spawn(name=name) if split_name(name)[0] == DRAWN:
                    self._next_body = max(self._next_body, 1 + split_name(name)[1])
                case Join(name=name) if split_name(name)[0] == DRAWN:
                    self._next_joint = max(self._next_joint, 1 + split_name(name)[1])


def reading_answer(reading: Reading, *, topic: str) -> Answer:
    """Return the answer that reports a reading; the answers to its requests follow."""
    values = (*reading.values, ('requests', str(len(reading.requests))))
    return Answer(topic=topic, subject=reading.subject, message=reading.message, values=values)


def _in_world(samples: Floats, frame: str, scene: SceneQuery) -> Floats:
    """Return samples of a frame in the world, (n, 3) float64: x, y [m], time [s]."""
    if not frame:
        return samples
    origin, ahead = scene.resolve_point((0.0, 0.0), frame), scene.resolve_point((1.0, 0.0), frame)
    cos, sin = ahead[0] - origin[0], ahead[1] - origin[1]
    turn = np.array(((cos, sin, 0.0), (-sin, cos, 0.0), (0.0, 0.0, 1.0)))
    return np.asarray(samples @ turn + (*origin, 0.0))


def _unrecognised_preview(samples: Floats) -> Preview:
    """Return the preview of a stroke that was not recognised."""
    stride = 1 + len(samples) // _MOST_POINTS
    return Preview(lines=(_line(samples[::stride]),), label='not recognised')


def _line(points: Floats) -> Line:
    return tuple((x, y) for x, y in points[:, :2].tolist())


def _reading_preview(reading: Reading) -> Preview:
    label = f'{reading.meaning} {reading.confidence:.0%}'
    if reading.runner_up and reading.runner_up_confidence >= _MENTIONED:
        label += f', or {reading.runner_up} {reading.runner_up_confidence:.0%}'
    return Preview(lines=(_line(reading.outline),), label=label)
