# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The choice of the type of a topic to subscribe to, among those that its publishers have.

A process takes one type for a topic. Of publishers of several types, that of the newest is chosen,
as long as it publishes: one that died without a shutdown stays on the graph for some 20 s.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from time import monotonic
from typing import NamedTuple

from physsim_ros.model.translation import NOTHING, Text
from rclpy.qos import ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

# Time without a message of the chosen type after which another type is chosen, where there are
# both [s]: twice the timeout of the shipped drives, in which a command is due. It is doubled by
# each change that brings no message: on a busy machine a publisher takes seconds to find a new
# subscription.
_TIMEOUT, _LONGEST_TIMEOUT = 1.0, 8.0


class Choice(NamedTuple):
    """
    A subscription that matches publishers.

    :ivar kind: type of the messages
    :ivar reliability: that all publishers of known types match
    """

    kind: type
    reliability: ReliabilityPolicy


class TypeChoice:
    """
    The choice for a topic, from one look at its publishers to the next.

    :param types: that can be subscribed to, by their names on the graph
    :param expected: type that is chosen while nobody publishes; None is none
    """

    def __init__(self, types: Mapping[str, type], expected: type | None) -> None:
        self._types, self._expected = types, expected
        # Type that was chosen last, and steady time of that or of the last message [s].
        self._chosen: type | None = None
        self._last_message_at = math.inf
        # Time without a message after which the type changes [s].
        self._timeout = _TIMEOUT
        # Identifiers of the publishers at the last look.
        self._known: set[bytes] = set()

    def note_message(self) -> None:
        """Note a message of the chosen type."""
        self._last_message_at, self._timeout = monotonic(), _TIMEOUT

    def choose(self, publishers: Sequence[TopicEndpointInfo]) -> tuple[Choice | None, Text]:
        """
        Choose anew.

        :param publishers: that are on the graph now
        :return: the choice; why some publishers are ignored, `NOTHING` where none is
        """
        names = {each.topic_type for each in publishers}
        types = [kind for name, kind in self._types.items() if name in names]
        ignored = NOTHING
        if unknown := sorted(names - self._types.keys()):
            words = ' or '.join(kind.__name__ for kind in self._types.values())
            ignored = Text(
                '{unknown} is published; {known} is heard',
                unknown=' and '.join(unknown),
                known=words,
            )
        if len(types) > 1:
            words = ' and of '.join(sorted(each.__name__ for each in types))
            ignored = Text(
                'publishers of {types} are there; the newest is heard, as long as it speaks',
                types=words,
            )
        kind = self._expected
        if types:
            kind = self._choose_type(types, self._take_new_types(publishers))
        if kind is None:
            return None, ignored
        if kind is not self._chosen:
            if self._chosen is not None:
                self._timeout = min(2.0 * self._timeout, _LONGEST_TIMEOUT)
            self._chosen, self._last_message_at = kind, monotonic()
        # Best effort matches publishers of both reliabilities, and may lose a message.
        is_lossy = any(
            each.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
            for each in publishers
            if each.topic_type in self._types
        )
        policy = ReliabilityPolicy.BEST_EFFORT if is_lossy else ReliabilityPolicy.RELIABLE
        return Choice(kind, policy), ignored

    def _take_new_types(self, publishers: Sequence[TopicEndpointInfo]) -> set[type]:
        """Return the types of the publishers that have come since the last call."""
        before = self._known
        self._known = {bytes(each.endpoint_gid) for each in publishers}
        new = (each for each in publishers if bytes(each.endpoint_gid) not in before)
        return {kind for each in new if (kind := self._types.get(each.topic_type)) is not None}

    def _choose_type(self, types: Sequence[type], new: set[type]) -> type:
        """
        Return the type to subscribe to: of a new publisher, else as before, else the next one.

        :param types: that are published
        :param new: of the publishers that have come since the last look
        """
        if self._chosen not in types or (new and self._chosen not in new):
            return next((each for each in types if each in new), types[0])
        is_over = monotonic() > self._last_message_at + self._timeout
        return types[(types.index(self._chosen) + is_over) % len(types)]
