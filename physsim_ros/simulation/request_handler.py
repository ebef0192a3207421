# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The handler of requests: it applies those that wait, in their order, and collects the answers.

Law: every request that waits has one answer, but for the moves of hands and for amendments, whose
requests have one each; answers keep the order of requests.
"""

from __future__ import annotations

from collections.abc import Iterator

from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Grab, HandRequest, KeepHand, LetGo, MoveHand, Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.hands import Hands, placing
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.queue_entries import Amend, Call, Seek, Waiting
from physsim_ros.simulation.request_queue import RequestQueue


class RequestHandler:
    """
    Applies requests at the moment that is shown.

    :param past: whose timeline has the world
    :param playback: of it
    :param queue: requests that wait

    :ivar hands: that drag bodies
    :ivar answers: that wait for the next frame
    """

    def __init__(self, past: Past, playback: Playback, queue: RequestQueue) -> None:
        self.hands = Hands()
        self.answers: list[Answer] = []
        self._past = past
        self._playback = playback
        self._queue = queue

    @property
    def changes_world(self) -> bool:
        """Return whether a request waits that is to be applied to the world."""
        return self._queue.has_requests

    def apply_waiting(self) -> None:
        """Apply the requests that wait, and collect their answers."""
        self._apply(self._queue.take())

    def apply_up_to_seek(self) -> None:
        """Apply the requests that wait, but those behind a seek, which wait for its end."""
        self._apply(self._queue.take(lambda: self._playback.is_there))

    def _apply(self, requests: Iterator[Waiting]) -> None:
        for waiting in requests:
            request = waiting.request
            if isinstance(request, Answer):
                self.answers.append(request)
                continue
            if isinstance(request, Call):
                self.answers += request.call()
                continue
            if isinstance(request, Amend):
                self.answers += self._amend(request, waiting)
                continue
            # A seek that is refused shows nothing new.
            self._playback.changed |= not isinstance(request, Seek)
            answer = self._answer(request, waiting)
            if answer.code or not isinstance(request, MoveHand | KeepHand):
                self.answers.append(answer)

    def apply(self, request: Request, gesture: int) -> tuple[str, str]:
        """
        Apply a request now.

        :param gesture: that it is part of; a drag has one of its own
        :return: the body or joint concerned, or '', and a sentence that says what was done
        :raises Refusal: and nothing is changed
        """
        timeline = self._past.timeline
        before = timeline.moment
        if isinstance(request, HandRequest):
            done = self._drag(request, gesture)
        else:
            done = self._apply_to_world(request, gesture)
        if timeline.moment != before:
            # On a new course, grips without a hand are removed.
            self.release_grips()
        return done

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns] now, and return a message about it.

        :raises OutOfHistory: it is kept no more, or has not come yet
        """
        self._playback.seek(stamp)
        self.hands.clear()
        return f'at {self._playback.time}'

    def release_grips(self) -> None:
        """Remove the grips of hands that are gone, unless the history has their end."""
        timeline = self._past.timeline
        if self._playback.is_frame_cached or not timeline.world.grips or not timeline.is_newest:
            return
        for grip in timeline.world.grips:
            if grip.hand not in self.hands:
                # Undone together with the request before.
                gesture = timeline.history.node(timeline.serial).gesture or self._queue.gesture
                self._apply_to_world(LetGo(hand=grip.hand), gesture)
                message = f'{grip.hand} is silent and has let go of {grip.body}'
                self.answers.append(
                    Answer(topic='~/drag/feedback', subject=grip.body, message=message)
                )

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that wait, and drop them."""
        answers = tuple(self.answers)
        self.answers.clear()
        return answers

    def report_oldest(self, more: str = '') -> None:
        """Answer that the moment that is shown is the oldest; nobody has asked for it."""
        message = f'{self._playback.time} is the oldest that is kept{more}'
        self.answers.append(Answer(topic='history', message=message))

    def _answer(self, request: Request | Seek | Refusal, waiting: Waiting) -> Answer:
        """Apply a request that waited, and return its answer."""
        topic, subject, asker = waiting.topic, waiting.subject, waiting.asker
        try:
            if isinstance(request, Refusal):
                raise request
            if isinstance(request, Seek):
                message = self.seek(request.stamp)
            else:
                subject, message = self.apply(request, waiting.gesture)
        except Refusal as refusal:
            return Answer.refused(
                refusal, topic=topic, subject=subject, field=waiting.field, asker=asker
            )
        return Answer(topic=topic, subject=subject, message=message, asker=asker)

    def _amend(self, amend: Amend, waiting: Waiting) -> Iterator[Answer]:
        """Replace the requests of earlier gestures, and yield the answers to the new ones."""
        self._playback.seek_shown()
        done = self._past.amend(amend.gestures, amend.requests)
        self._playback.note_jump()
        topic, field, asker = waiting.topic, waiting.field, waiting.asker
        for each in done:
            if isinstance(each, Refusal):
                yield Answer.refused(each, topic=topic, field=field, asker=asker)
            else:
                yield Answer(topic=topic, subject=each[0], message=each[1], asker=asker)

    def _drag(self, request: HandRequest, gesture: int) -> tuple[str, str]:
        if request.hand not in self.hands and not isinstance(request, Grab):
            # A grip of the past that is shown belongs to no hand of now.
            return '', f'{request.hand} holds no body'
        if self._playback.speed == 0.0:
            request = placing(request)
        gesture = self.hands.gesture_of(request, gesture)
        done = self._apply_to_world(request, gesture)
        self.hands.note_request(request, gesture)
        if isinstance(request, Grab):
            self.hands.drop_without_grip(self._past.timeline.world.grips)
        return done

    def _apply_to_world(self, request: Request, gesture: int) -> tuple[str, str]:
        self._playback.seek_shown()
        return self._past.apply(request, gesture)
