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
One page on the world's thread: its pen, its tool, its hand and its materials.

Law: a session changes nothing itself; it submits requests, and each message has an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
import time
from typing import Any

import numpy as np
from physsim_ros.drawing import DrawingSession, Reading, submit_reading, Tool
from physsim_ros.model.errors import Busy, NotRecognised, PhysSimError, Refusal, WorldFull
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.requests import KeepHand, LetGo, Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad import messages
from physsim_ros.sketchpad.answers import answer_content, asker_key, request_of
from physsim_ros.sketchpad.body_past import body_past
from physsim_ros.sketchpad.material import Material
from physsim_ros.sketchpad.world_control import WorldControl

# From one request of a hand that holds still to the next [s]; one that is silent for 5 s lets go.
HAND_PERIOD = 2.0
# Length of a world that a page may have as text [characters].
MOST_SHARED = 2**20

Send = Callable[[dict[str, Any]], None]


class PageSession:
    """
    The session of one page.

    :param world: that it draws in
    :param page: number of the page
    :param send: sends a message to the page
    :param on_save: called when a world was saved
    """

    def __init__(
        self, world: WorldControl, *, page: int, send: Send, on_save: Callable[[], None]
    ) -> None:
        self._on_save = on_save
        self._world = world
        self._page = page
        self._send = send
        self._drawing = DrawingSession(world.drawing_settings)
        self._preview: Preview = NO_PREVIEW
        self._material = Material()
        self._hand = f'page {page}'
        # Steady time of the last request of the hand [s]; None while it holds nothing.
        self._hand_used: float | None = None
        self._actions: dict[type, Callable[[Any, str], None]] = {
            messages.Submit: self._submit,
            messages.Stroke: self._stroke,
            messages.Click: self._click,
            messages.Drop: self._drop,
            messages.Instead: self._instead,
            messages.UseHand: self._use_hand,
            messages.DrawWith: self._draw_with,
            messages.Copy: self._copy,
            messages.Watch: self._watch,
            messages.Share: self._share,
            messages.Upload: self._upload,
            messages.Perform: self._perform,
            messages.SetSpeed: self._set_speed,
            messages.Seek: self._seek,
            messages.ReturnToCourse: self._return_to_course,
        }

    def handle(self, message: messages.Message, request_id: str) -> None:
        """
        Do what a message asks for.

        :param request_id: of the message, for its answers
        """
        self._drawing.settings = self._world.drawing_settings
        self._actions[type(message)](message, asker_key(self._page, request_id))
        if self._drawing.preview != self._preview:
            self._preview = preview = self._drawing.preview
            lines = [*preview.lines, *([preview.points] if preview.points else [])]
            self._send({'type': 'preview', 'lines': lines, 'label': preview.label})

    def keep_hand(self, now: float) -> None:
        """
        Keep what the hand holds still, as long as the page is open.

        :param now: steady time [s]
        """
        if self._hand_used is not None and now - self._hand_used > HAND_PERIOD:
            self._hand_used = now
            self._submit_all((KeepHand(hand=self._hand),), '~/drag/feedback', '')

    def close(self) -> None:
        """Let go of what the hand of the page holds."""
        if self._hand_used is not None:
            self._submit_all((LetGo(hand=self._hand),), '~/drag/feedback', '')

    # Requests

    def _submit(self, message: messages.Submit, asker: str) -> None:
        self._submit_all(message.requests, message.topic, asker)

    def _use_hand(self, message: messages.UseHand, asker: str) -> None:
        holds = not isinstance(message.request, LetGo)
        self._hand_used = time.monotonic() if holds else None
        self._submit_all((replace(message.request, hand=self._hand),), '~/drag/feedback', asker)

    def _copy(self, message: messages.Copy, asker: str) -> None:
        try:
            snapshot = self._world.current_snapshot()
            copy = self._drawing.copy(message.name, message.to, snapshot)
        except Refusal as refusal:
            self._refuse(refusal, '~/spawn', asker)
        else:
            self._submit_all((copy,), '~/spawn', asker)

    def _submit_all(self, requests: Iterable[Request], topic: str, asker: str) -> None:
        """Submit requests that are undone together."""
        queue = self._world.simulation.requests
        for number, request in enumerate(requests):
            queue.submit(request, topic=topic, joined=number > 0, asker=asker)

    # Drawing

    def _click(self, message: messages.Click, asker: str) -> None:
        self._drawing.tool = message.tool
        try:
            snapshot = self._world.current_snapshot()
            result = self._drawing.click(message.point, '', snapshot)
        except Refusal as refusal:
            self._refuse(refusal, 'clicked_point', asker)
            return
        if result.message:
            self._tell(Answer(topic='clicked_point', message=result.message, asker=asker))
        self._submit_all(self._material.applied(result.requests), 'clicked_point', asker)

    def _drop(self, _: messages.Drop, asker: str) -> None:
        # Another tool drops the unfinished gesture.
        tool, self._drawing.tool = self._drawing.tool, Tool.NONE
        self._drawing.tool = tool
        self._answer(asker, 'dropped what was unfinished')

    def _stroke(self, message: messages.Stroke, asker: str) -> None:
        took = float(np.ptp(message.samples[:, 2])) if len(message.samples) else 0.0
        began = time.monotonic() - took

        def read() -> Reading:
            snapshot = self._world.current_snapshot()
            return self._drawing.stroke(message.samples, '', snapshot, began=began)

        self._read(read, '~/stroke', asker)

    def _instead(self, message: messages.Instead, asker: str) -> None:
        def read() -> Reading:
            # Requests that wait come before.
            self._world.current_snapshot()
            return self._drawing.instead(message.meaning)

        self._read(read, '~/instead', asker)

    def _read(self, read: Callable[[], Reading], topic: str, asker: str) -> None:
        """Read a stroke, tell the page, and submit what it asks for."""
        try:
            reading = read()
        except Refusal as refusal:
            if isinstance(refusal, NotRecognised):
                self._send_reading(asker, dict(refusal.values), outline=[], built=False)
            self._refuse(refusal, topic, asker)
            return
        outline = reading.outline.tolist()
        self._send_reading(asker, dict(reading.values), outline=outline, built=True)
        reading = replace(reading, requests=self._material.applied(reading.requests))
        simulation = self._world.simulation
        submit_reading(simulation, self._drawing, reading, topic=topic, asker=asker)

    def _send_reading(
        self, asker: str, values: dict[str, str], *, outline: list[list[float]], built: bool
    ) -> None:
        ranked = (
            ('reading', 'confidence'),
            ('runner_up', 'runner_up_confidence'),
            ('third', 'third_confidence'),
        )
        guesses = [
            (values[name], float(values[share])) for name, share in ranked if values.get(name)
        ]
        (meaning, confidence), (second, second_confidence) = [*guesses, ('', 0.0), ('', 0.0)][:2]
        self._send(
            {
                'type': 'reading',
                'request': request_of(asker),
                'meaning': meaning,
                'confidence': confidence,
                'runner_up': second,
                'runner_up_confidence': second_confidence,
                'guesses': guesses,
                'outline': outline,
                'built': built,
            }
        )

    def _draw_with(self, message: messages.DrawWith, asker: str) -> None:
        self._material.choose(message)
        self._answer(asker, 'the material of what is drawn next')

    # Time and worlds

    def _perform(self, message: messages.Perform, asker: str) -> None:
        action, world = message.action, message.world

        def perform() -> str:
            done = self._world.perform(action, world)
            if action == 'save_world':
                self._on_save()
            return done

        self._report_in_turn(action, asker, perform)

    def _set_speed(self, message: messages.SetSpeed, asker: str) -> None:
        self._report('~/speed', asker, lambda: self._world.set_speed(message.speed))

    def _seek(self, message: messages.Seek, asker: str) -> None:
        self._report_in_turn('seek', asker, lambda: self._world.seek(message.stamp))

    def _return_to_course(self, message: messages.ReturnToCourse, asker: str) -> None:
        simulation = self._world.simulation
        self._report_in_turn(
            'timeline', asker, lambda: simulation.return_to_course(message.course)
        )

    def _upload(self, message: messages.Upload, asker: str) -> None:
        content = message.content
        self._report_in_turn('load_world', asker, lambda: self._world.replace_world(content))

    def _share(self, _: messages.Share, asker: str) -> None:
        text = self._world.world_text()
        if len(text) > MOST_SHARED:
            message = f'the world as text is longer than {MOST_SHARED} characters'
            self._answer(asker, message, code=WorldFull.code)
        else:
            self._answer(asker, 'the world as text', values=(('yaml', text),))

    def _watch(self, message: messages.Watch, asker: str) -> None:
        past = body_past(self._world.simulation, message.name)
        request = request_of(asker)
        self._send({'type': 'body', 'request': request, 'name': message.name, **past})

    # Answers

    def _report(self, topic: str, asker: str, action: Callable[[], str]) -> None:
        """Perform an action, and queue its answer."""
        self._tell(self._perform_action(topic, asker, action))

    def _report_in_turn(self, service: str, asker: str, action: Callable[[], str]) -> None:
        """Perform an action when it is the turn of its service, and queue its answer."""
        topic = f'~/{service}'
        try:
            self._world.call_in_turn(service, lambda: [self._perform_action(topic, asker, action)])
        except Busy as refusal:
            self._refuse(refusal, topic, asker)

    def _perform_action(self, topic: str, asker: str, action: Callable[[], str]) -> Answer:
        """Perform an action, and return the answer of its message or of its refusal."""
        try:
            return Answer(topic=topic, message=action(), asker=asker)
        except Refusal as refusal:
            return Answer.refused(refusal, topic=topic, asker=asker)
        except PhysSimError as error:
            return Answer(topic=topic, message=str(error), code='refused', asker=asker)

    def _refuse(self, refusal: Refusal, topic: str, asker: str) -> None:
        self._world.simulation.requests.refuse(refusal, topic=topic, subject='', asker=asker)

    def _tell(self, answer: Answer) -> None:
        self._world.simulation.requests.tell(answer)

    def _answer(
        self,
        asker: str,
        message: str,
        *,
        code: str = '',
        values: tuple[tuple[str, str], ...] = (),
    ) -> None:
        """Answer this page alone, since no other page is concerned."""
        answer = Answer(topic='page', message=message, code=code, values=values, asker=asker)
        self._send(answer_content(answer, request_of(asker)))
