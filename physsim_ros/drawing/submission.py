# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The submission of a reading, a click or a copy: its answer, and its requests as one gesture."""

from __future__ import annotations

from collections.abc import Sequence

from physsim_ros.drawing.session import DrawingSession
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.model.answer import Answer, request_count
from physsim_ros.model.errors import values_of
from physsim_ros.model.requests import Request
from physsim_ros.model.translation import NOTHING, Text
from physsim_ros.simulation.entries import Amend, Origin
from physsim_ros.simulation.simulation import Simulation


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
    queue.tell(_answer(reading, origin))
    if reading.amends:
        queue.submit(Amend(reading.amends, reading.requests), origin, joined=True)
        session.note_gesture(reading.amends[0])
    elif reading.requests:
        session.note_gesture(queue.submit_gesture(reading.requests, origin))


def submit_told(
    simulation: Simulation,
    requests: Sequence[Request],
    origin: Origin,
    *,
    message: Text = NOTHING,
    gesture: int | None = None,
) -> int:
    """
    Submit requests that are undone together, after a message about all, as of a click.

    :param message: that is answered first; '' is none
    :param gesture: number of an earlier gesture that they are in, too
    :return: number of their gesture; 0 where there is no request
    """
    queue = simulation.requests
    if message:
        values = (request_count(len(requests)),) if requests else ()
        topic, asker = origin.topic, origin.asker
        queue.tell(Answer(topic=topic, message=message, values=values, asker=asker))
    return queue.submit_gesture(requests, origin, gesture) if requests else 0


def _answer(reading: Reading, origin: Origin) -> Answer:
    """Return the answer that reports a reading; the answers to its requests follow."""
    values = (*values_of(reading.confidences), request_count(len(reading.requests)))
    return Answer(
        topic=origin.topic,
        subject=reading.subject,
        message=reading.message,
        values=values,
        asker=origin.asker,
    )
