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
One page on the world's thread: its tool, its unfinished gesture, its materials.

Law: a session changes nothing itself; it submits requests, and answers those that it refuses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, Protocol

from physsim_ros.drawing import DrawingSession, DrawingSettings, reading_answer
from physsim_ros.model.errors import NotRecognised, PhysSimError, Refusal
from physsim_ros.model.preview import Preview
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.messages import (
    Click,
    Drop,
    Message,
    Perform,
    Seek,
    SetSpeed,
    Stroke,
    Submit,
)
from physsim_ros.sketchpad.server import asker_key

Send = Callable[[dict[str, Any]], None]


class WorldControl(Protocol):
    """What the node does for its pages."""

    @property
    def simulation(self) -> Simulation:
        """Return the world and its time."""

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""

    def current_snapshot(self) -> Snapshot:
        """Apply the waiting requests, and return the snapshot that is shown."""

    def perform(self, action: str, world: str) -> str:
        """
        Perform what a service does, and return a message about it.

        :param action: name of the service
        :param world: name of the world to save or load; '' is that of parameter `world_file`
        :raises PhysSimError: it is refused
        """

    def set_speed(self, speed: float) -> str:
        """
        Set the speed of time, and return a message about it.

        :raises Refusal: it is out of range
        """

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns], and return a message about it.

        :raises Refusal: it is not in the history
        """


class PageSession:
    """
    The session of one page.

    :param world: that it draws in
    :param page: number of the page
    :param role: of the page
    :param send: sends a message to the page
    """

    def __init__(self, world: WorldControl, *, page: int, role: Role, send: Send) -> None:
        self.role = role
        self._world = world
        self._page = page
        self._send = send
        self._drawing = DrawingSession(world.drawing_settings)
        self._preview: Preview = self._drawing.preview

    def handle(self, id_: str, message: Message) -> None:
        """
        Do what a message asks for.

        :param id_: of the message, for its answers
        """
        asker = asker_key(self._page, id_)
        match message:
            case Submit(requests=requests, topic=topic):
                self._submit_all(requests, topic, asker)
            case Click():
                self._click(message, asker)
            case Stroke():
                self._stroke(message, asker, id_)
            case Drop():
                self._drawing = DrawingSession(self._world.drawing_settings, self._drawing.tool)
            case Perform(action=action, world=world):
                self._report(f'~/{action}', asker, lambda: self._world.perform(action, world))
            case SetSpeed(speed=speed):
                self._report('~/speed', asker, lambda: self._world.set_speed(speed))
            case Seek(time=time):
                self._report('~/seek', asker, lambda: self._world.seek(round(time * 1e9)))
        self._send_preview()

    def close(self) -> None:
        """End what the page has begun."""

    def _submit_all(self, requests: Iterable[Request], topic: str, asker: str) -> None:
        """Submit requests that are undone together."""
        for number, request in enumerate(requests):
            self._world.simulation.submit(request, topic=topic, joined=number > 0, asker=asker)

    def _click(self, click: Click, asker: str) -> None:
        self._drawing.settings = self._world.drawing_settings
        self._drawing.tool = click.tool
        try:
            snapshot = self._world.current_snapshot()
            result = self._drawing.click(click.point, '', snapshot)
        except Refusal as refusal:
            self._refuse(refusal, 'clicked_point', asker)
            return
        if result.message:
            self._tell(Answer(topic='clicked_point', message=result.message, asker=asker))
        self._submit_all(result.requests, 'clicked_point', asker)

    def _stroke(self, stroke: Stroke, asker: str, id_: str) -> None:
        self._drawing.settings = self._world.drawing_settings
        try:
            snapshot = self._world.current_snapshot()
            reading = self._drawing.stroke(stroke.samples, '', snapshot)
        except Refusal as refusal:
            if isinstance(refusal, NotRecognised):
                self._send_reading(id_, dict(refusal.values), outline=[], built=False)
            self._refuse(refusal, '~/stroke', asker)
            return
        self._send_reading(id_, dict(reading.values), outline=reading.outline.tolist(), built=True)
        self._tell(replace(reading_answer(reading, topic='~/stroke'), asker=asker))
        self._submit_all(reading.requests, '~/stroke', asker)

    def _send_reading(
        self, id_: str, values: dict[str, str], *, outline: list[list[float]], built: bool
    ) -> None:
        ranked = (('reading', 'confidence'), ('runner_up', 'runner_up_confidence'))
        guesses = [
            (values[name], float(values[share])) for name, share in ranked if values.get(name)
        ]
        (meaning, confidence), (second, second_confidence) = [*guesses, ('', 0.0), ('', 0.0)][:2]
        self._send(
            {
                'type': 'reading',
                'request': id_,
                'meaning': meaning,
                'confidence': confidence,
                'runner_up': second,
                'runner_up_confidence': second_confidence,
                'guesses': guesses,
                'outline': outline,
                'built': built,
            }
        )

    def _report(self, topic: str, asker: str, action: Callable[[], str]) -> None:
        """Perform an action, and queue the answer of its message or of its refusal."""
        try:
            message = action()
        except Refusal as refusal:
            self._refuse(refusal, topic, asker)
        except PhysSimError as error:
            self._tell(Answer(topic=topic, message=str(error), code='refused', asker=asker))
        else:
            self._tell(Answer(topic=topic, message=message, asker=asker))

    def _refuse(self, refusal: Refusal, topic: str, asker: str) -> None:
        self._world.simulation.refuse(refusal, topic=topic, subject='', asker=asker)

    def _tell(self, answer: Answer) -> None:
        self._world.simulation.tell(answer)

    def _send_preview(self) -> None:
        preview = self._drawing.preview
        if preview != self._preview:
            self._preview = preview
            lines = [*preview.lines, *([preview.points] if preview.points else [])]
            self._send({'type': 'preview', 'lines': lines, 'label': preview.label})
