# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The requests of one page, and their answers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from physsim_ros.model.errors import Busy, PhysSimError, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.sketchpad.answers import answer_content, request_of
from physsim_ros.sketchpad.world_control import WorldControl

# Of a message to a page, to become JSON; a function is called on the server's thread.
Content = dict[str, Any] | Callable[[], dict[str, Any]]
Send = Callable[[Content], None]


class PageRequests:
    """
    The requests of one page; each has an answer, which the queue of the world keeps in order.

    An `asker` is the key of the message of the page that asks (`answers.asker_key`).

    :param world: that they go to
    :param send: sends a message to the page
    """

    def __init__(self, world: WorldControl, send: Send) -> None:
        self._world = world
        self._send = send

    def submit(self, requests: Iterable[Request], topic: str, asker: str) -> None:
        """Submit requests that are undone together."""
        queue = self._world.simulation.requests
        for number, request in enumerate(requests):
            queue.submit(request, topic=topic, joined=number > 0, asker=asker)

    def refuse(self, refusal: Refusal, topic: str, asker: str) -> None:
        """Queue the refusal of a message."""
        self._world.simulation.requests.refuse(refusal, topic=topic, subject='', asker=asker)

    def tell(self, answer: Answer) -> None:
        """Queue an answer."""
        self._world.simulation.requests.tell(answer)

    def answer_page(
        self,
        asker: str,
        message: str,
        *,
        code: str = '',
        values: tuple[tuple[str, str], ...] = (),
    ) -> None:
        """Answer this page alone, and at once, since no other page is concerned."""
        answer = Answer(topic='page', message=message, code=code, values=values, asker=asker)
        self._send(answer_content(answer, request_of(asker)))

    def perform(self, topic: str, asker: str, action: Callable[[], str]) -> None:
        """
        Perform an action, and queue its answer.

        :param action: returns a message about it; raises a PhysSimError where it is refused
        """
        self.tell(_answer_of(topic, asker, action))

    def submit_action(self, topic: str, asker: str, action: Callable[[], str], wait: Wait) -> None:
        """Perform an action when it may come, and queue its answer."""
        self.submit_call(topic, asker, lambda: [_answer_of(topic, asker, action)], wait)

    def submit_call(
        self, topic: str, asker: str, call: Callable[[], Iterable[Answer]], wait: Wait
    ) -> None:
        """Call something when it may come; refuse it where too many wait."""
        try:
            self._world.submit_call(call, wait)
        except Busy as refusal:
            self.refuse(refusal, topic, asker)


def _answer_of(topic: str, asker: str, action: Callable[[], str]) -> Answer:
    """Perform an action, and return the answer of its message or of its refusal."""
    try:
        return Answer(topic=topic, message=action(), asker=asker)
    except Refusal as refusal:
        return Answer.refused(refusal, topic=topic, asker=asker)
    except PhysSimError as error:
        return Answer(topic=topic, message=str(error), code='refused', asker=asker)
