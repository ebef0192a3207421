# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Hands of people that drag a body at the moment that is shown.

Laws: a drag, from the grab until the hand lets go, is one gesture; requests of a hand whose grip
is gone, or after a seek, a rewind, another course or another world, change nothing. In a paused
world hands place bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from physsim_ros.model.answer import Answer
from physsim_ros.model.requests import (
    Grab,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
)
from physsim_ros.model.translation import Text
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.world.hand_requests import holds_nothing

# Steady time without a request after which a hand lets go [ns]: its page is gone.
LONGEST_SILENCE = 5 * 10**9


@dataclass(slots=True)
class _Hand:
    """
    A hand that drags a body.

    :param gesture: number of the gesture of the drag
    :param silent_since: first steady time after its last request, or after a pause [ns]; None
        until then
    """

    gesture: int
    silent_since: int | None = None


class Hands:
    """
    The hands of people that drag a body at the moment that is shown.

    :param past: of the world
    :param playback: the moment that is shown
    """

    def __init__(self, past: Past, playback: Playback) -> None:
        self._past = past
        self._playback = playback
        self._dragging: dict[str, _Hand] = {}

    def __contains__(self, hand: str) -> bool:
        return hand in self._dragging

    def use(self, request: HandRequest, gesture: int, author: str) -> Answer:
        """
        Apply a request of a hand now.

        :param gesture: its own; requests of a drag have that of the grab
        :param author: name of the person who did it; '' is nobody
        :raises Refusal: and nothing is changed
        """
        hand = self._dragging.get(request.hand)
        if hand is None and not isinstance(request, Grab):
            # Grips of a past moment belong to no present hand.
            return holds_nothing(request)
        if hand is not None and not isinstance(request, Grab):
            gesture = hand.gesture
        if isinstance(request, Grab | MoveHand):
            request = replace(request, paused=self._playback.speed == 0.0)
        self._playback.send_cursor()
        answer = self._past.apply(request, gesture, author)
        match request:
            case Grab(hand=name):
                self._dragging[name] = _Hand(gesture)
                # Hands without a grip are dropped: their bodies have been deleted.
                with_grip = {grip.hand for grip in self._past.cursor.arrive().grips}
                for other in self._dragging.keys() - with_grip:
                    del self._dragging[other]
            case MoveHand(hand=name) | KeepHand(hand=name):
                self._dragging[name].silent_since = None
            case LetGo(hand=name):
                self._dragging.pop(name, None)
        return answer

    def release_grips(self) -> list[Answer]:
        """Remove the grips of hands that are gone, unless their release lies ahead."""
        cursor = self._past.cursor
        if self._playback.is_frame_cached or not (grips := cursor.arrive().grips):
            return []
        if not cursor.is_newest:
            return []
        events = []
        for grip in grips:
            if grip.hand not in self:
                self._past.apply_unasked(LetGo(hand=grip.hand))
                template = 'released {body}: no message from {hand}'
                message = Text(template, body=grip.body, hand=grip.hand)
                events.append(Answer(topic='~/drag/feedback', subject=grip.body, message=message))
        return events

    def drop_silent(self, now_ns: int, *, paused: bool) -> None:
        """
        Drop the hands that have been silent for too long.

        :param now_ns: steady time, never going back [ns]
        :param paused: whether the world is paused; then the time does not count
        """
        for name, hand in list(self._dragging.items()):
            if paused or hand.silent_since is None:
                hand.silent_since = now_ns
            elif now_ns - hand.silent_since > LONGEST_SILENCE:
                del self._dragging[name]

    def clear(self) -> None:
        """Drop all hands, since another moment or world is shown."""
        self._dragging.clear()
