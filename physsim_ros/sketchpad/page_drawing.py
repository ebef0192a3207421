# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The drawing of one page: its strokes, clicks and material."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import time

import numpy as np
from physsim_ros.drawing import DrawingSession, Reading, submit_reading, Tool
from physsim_ros.model.errors import NotRecognised, Refusal
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad import messages
from physsim_ros.sketchpad.answers import request_of
from physsim_ros.sketchpad.material import Material
from physsim_ros.sketchpad.page_requests import PageRequests, Send
from physsim_ros.sketchpad.world_control import WorldControl


class PageDrawing:
    """
    The strokes, clicks and material of one page, on the world's thread.

    :param world: that it draws in
    :param requests: of the page
    :param send: sends a message to the page
    """

    def __init__(self, world: WorldControl, requests: PageRequests, send: Send) -> None:
        self._world = world
        self._requests = requests
        self._send = send
        self._session = DrawingSession(world.drawing_settings)
        self._preview: Preview = NO_PREVIEW
        self._material = Material()

    def update_settings(self) -> None:
        """Draw with the settings of the world from now on."""
        self._session.settings = self._world.drawing_settings

    def send_preview(self) -> None:
        """Send the page what is half drawn, where it has changed."""
        if self._session.preview == self._preview:
            return
        self._preview = preview = self._session.preview
        lines = [*preview.lines, *([preview.points] if preview.points else [])]
        self._send({'type': 'preview', 'lines': lines, 'label': preview.label})

    def click(self, message: messages.Click, asker: str) -> None:
        """Take the next point of a tool, and submit what is complete with it."""
        self._session.tool = message.tool
        try:
            snapshot = self._world.current_snapshot()
            result = self._session.click(message.point, '', snapshot)
        except Refusal as refusal:
            self._requests.refuse(refusal, 'clicked_point', asker)
            return
        if result.message:
            answer = Answer(topic='clicked_point', message=result.message, asker=asker)
            self._requests.tell(answer)
        self._requests.submit(self._material.applied(result.requests), 'clicked_point', asker)

    def drop(self, _: messages.Drop, asker: str) -> None:
        """Drop what is half drawn."""
        # Another tool drops the unfinished gesture.
        tool, self._session.tool = self._session.tool, Tool.NONE
        self._session.tool = tool
        self._requests.answer_page(asker, 'dropped what was unfinished')

    def copy_body(self, message: messages.Copy, asker: str) -> None:
        """Copy a body to a point."""
        try:
            snapshot = self._world.current_snapshot()
            copy = self._session.copy(message.name, message.to, snapshot)
        except Refusal as refusal:
            self._requests.refuse(refusal, '~/spawn', asker)
        else:
            self._requests.submit((copy,), '~/spawn', asker)

    def choose_material(self, message: messages.DrawWith, asker: str) -> None:
        """Choose the material of what is drawn next."""
        self._material.choose(message)
        self._requests.answer_page(asker, 'the material of what is drawn next')

    def read_stroke(self, message: messages.Stroke, asker: str) -> None:
        """Read a stroke, and submit what it asks for."""
        took = float(np.ptp(message.samples[:, 2])) if len(message.samples) else 0.0
        began = time.monotonic() - took

        def read() -> Reading:
            snapshot = self._world.current_snapshot()
            return self._session.stroke(message.samples, '', snapshot, began=began)

        self._submit_reading(read, '~/stroke', asker)

    def read_instead(self, message: messages.Instead, asker: str) -> None:
        """Read the last stroke as something else."""

        def read() -> Reading:
            # Requests that wait come before.
            self._world.current_snapshot()
            return self._session.instead(message.meaning)

        self._submit_reading(read, '~/instead', asker)

    def _submit_reading(self, read: Callable[[], Reading], topic: str, asker: str) -> None:
        """Read a stroke, tell the page, and submit what it asks for."""
        try:
            reading = read()
        except Refusal as refusal:
            if isinstance(refusal, NotRecognised):
                self._send_reading(asker, dict(refusal.values), outline=[], built=False)
            self._requests.refuse(refusal, topic, asker)
            return
        outline = reading.outline.tolist()
        self._send_reading(asker, dict(reading.values), outline=outline, built=True)
        reading = replace(reading, requests=self._material.applied(reading.requests))
        simulation = self._world.simulation
        submit_reading(simulation, self._session, reading, topic=topic, asker=asker)

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
