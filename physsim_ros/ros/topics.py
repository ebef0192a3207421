# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Topics as rclpy has them: profiles of QoS, the type of a topic, messages that arrive as bytes.

Law: a message that is too large is refused before it is decoded. rclpy drops one that it cannot
decode, without a word, and takes seconds for one of megabytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

# Reliable, KEEP_ALL: a burst of thousands of messages loses none.
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
# Of topics whose last message DDS keeps for late subscribers.
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
# Of services, whose calls wait to be read: 50 clients with 20 calls each.
CALLS = QoSProfile(depth=1000)

# Takes a refusal and its topic: there cannot be such a topic, or a publisher on it is ignored.
Refuse = Callable[[Refusal, str], None]


class Undecodable(Malformed):
    """Bytes that are no message of the type of their topic."""


def decoded(data: bytes, kind: type, most_bytes: int) -> Any:
    """
    Return a message of a type.

    :param most_bytes: greatest size of a message [bytes]
    :raises Malformed: it is too large
    :raises Undecodable: it cannot be decoded
    """
    if len(data) > most_bytes:
        raise Malformed('such a message has at most {most:g} KiB', most=most_bytes / 2**10)
    try:
        return deserialize_message(data, kind)
    except rclpy_implementation.RMWError as error:
        raise Undecodable(
            'the message cannot be decoded as a {name}', name=kind.__name__
        ) from error


@contextmanager
def refusing_another_type(topic: str, refuse: Refuse) -> Iterator[None]:
    """
    Create an end of a topic in the block, which ends where the topic has another type already.

    A topic has one type within a process.
    """
    try:
        yield
    except rclpy_implementation.RCLError:
        template = '{topic} is a topic of another type already'
        refuse(BadProperty(template, field='name', topic=topic), topic)
