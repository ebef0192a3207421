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
The pen in somebody's hand: its tool, what is half drawn, what is shown, which names are taken.

Law: it changes nothing but itself. What it returns are ordinary requests, for somebody to submit.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from physsim_ros.drawing.clicks.gesture import Gesture
from physsim_ros.drawing.clicks.tools import Step, Tool
from physsim_ros.drawing.scene_query import DRAWN, View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.interpretation import read, Reading
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised
from physsim_ros.model.names import split_name
from physsim_ros.model.preview import Line, NO_PREVIEW, Preview
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.model.transform import Point

# Below that confidence a runner-up is not worth a word in the picture.
_WORTH = 0.05
# Points of a stroke that is shown as it was drawn.
_MOST_SHOWN = 200


class Pen:
    """
    What somebody draws with.

    :param settings: of drawing; may be changed at any time
    :param tool: that clicks are made with

    :ivar preview: what is to be shown of what is not in the world
    """

    def __init__(self, settings: DrawingSettings, tool: Tool = Tool.NONE) -> None:
        self.settings = settings
        self.preview: Preview = NO_PREVIEW
        self._gesture = Gesture(tool)
        # The lowest numbers that no body and no joint of this pen's has had.
        self._body = self._joint = 0

    @property
    def tool(self) -> Tool:
        """Return the tool in hand; taking another one drops what is half drawn."""
        return self._gesture.tool

    @tool.setter
    def tool(self, tool: Tool) -> None:
        if tool is not self.tool:
            self._gesture = Gesture(tool)
            self.preview = NO_PREVIEW

    def click(self, point: Point, frame: str, snapshot: Snapshot) -> Step:
        """
        Click with the tool in hand.

        :param point: [m]
        :param frame: of the point: '' for the world, or a body's name
        :param snapshot: the world as it is seen
        :raises Refusal: nothing can be drawn of it
        """
        try:
            step = self._gesture.click(point, frame, self._view(snapshot), self.settings)
        finally:
            self.preview = self._gesture.preview(self.settings)
        self._remember(step.requests)
        return step

    def stroke(self, samples: Floats, frame: str, snapshot: Snapshot) -> Reading:
        """
        Draw a stroke.

        :param samples: (n, 3) float64: x, y [m], time [s]
        :param frame: of the samples: '' for the world, or a body's name
        :param snapshot: the world as it is seen
        :raises Refusal: it cannot be read
        """
        view = self._view(snapshot)
        self.preview = NO_PREVIEW
        placed = _placed(samples, frame, view)
        try:
            reading = read(placed, view, self.settings)
        except NotRecognised:
            self.preview = _unread(placed)
            raise
        self.preview = _shown(reading)
        self._remember(reading.requests)
        return reading

    def _view(self, snapshot: Snapshot) -> View:
        return View(snapshot, first=self._body, first_joint=self._joint)

    def _remember(self, requests: Iterable[Request]) -> None:
        """See to it that no name is given twice, also where the world has lost or refused it."""
        for request in requests:
            match request:
                case Spawn(name=name) if split_name(name)[0] == DRAWN:
                    self._body = max(self._body, 1 + split_name(name)[1])
                case Join(name=name) if split_name(name)[0] == DRAWN:
                    self._joint = max(self._joint, 1 + split_name(name)[1])


def told(reading: Reading, *, topic: str) -> Answer:
    """Return the answer that tells how a stroke was read; those to its requests follow."""
    values = (*reading.values, ('requests', str(len(reading.requests))))
    return Answer(topic=topic, subject=reading.subject, message=reading.message, values=values)


def _placed(samples: Floats, frame: str, view: View) -> Floats:
    """Return samples of a frame as they lie in the world."""
    if not frame:
        return samples
    origin, ahead = view.placed((0.0, 0.0), frame), view.placed((1.0, 0.0), frame)
    cos, sin = ahead[0] - origin[0], ahead[1] - origin[1]
    turn = np.array(((cos, sin, 0.0), (-sin, cos, 0.0), (0.0, 0.0, 1.0)))
    return np.asarray(samples @ turn + (*origin, 0.0))


def _unread(samples: Floats) -> Preview:
    """Return a stroke that was not recognised, as it was drawn."""
    stride = 1 + len(samples) // _MOST_SHOWN
    return Preview(lines=(_line(samples[::stride]),), label='not recognised')


def _line(points: Floats) -> Line:
    return tuple((x, y) for x, y in points[:, :2].tolist())


def _shown(reading: Reading) -> Preview:
    label = f'{reading.what} {reading.confidence:.0%}'
    if reading.runner_up is not None and reading.runner_up_confidence >= _WORTH:
        label += f', or {reading.runner_up} {reading.runner_up_confidence:.0%}'
    return Preview(lines=(_line(reading.outline),), label=label)
