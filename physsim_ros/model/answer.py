# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Answers to requests, and reports of events without one."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.errors import Refusal
from physsim_ros.model.names import shown_name
from physsim_ros.model.translation import NOTHING, Text

# The field of every request with a point or pose, besides the point or pose itself.
_FRAME = 'header.frame_id'


def request_count(count: int) -> tuple[str, str]:
    """Return the value of an answer that says how many answers to requests follow it."""
    return 'requests', str(count)


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """
    The answer to one request, or the report of an event without one.

    :param topic: of the request, as '~/spawn', or the event, as 'body_lost'; '' until it is known
    :param subject: name of the body or joint, '' if there is none
    :param message: a sentence; one that pages translate is a `Text`
    :param code: '' for success, else the stable code of the refusal
    :param field: the offending field of a refusal
    :param values: further pairs of key and value
    :param asker: key of the message that asked, '' for one of ROS and for events
    """

    topic: str = ''
    subject: str = ''
    message: Text = NOTHING
    code: str = ''
    field: str = ''
    values: tuple[tuple[str, str], ...] = ()
    asker: str = ''

    @classmethod
    def refused(
        cls,
        refusal: Refusal,
        *,
        topic: str,
        subject: str = '',
        field: str = '',
        asker: str = '',
    ) -> Answer:
        """
        Return the answer to a refused request.

        :param field: the only field of the request; '' if it has several
        :param asker: key of the message that asked
        """
        body = [('body', shown_name(refusal.concerns))] if refusal.concerns else []
        return cls(
            topic=topic,
            subject=shown_name(subject),
            message=refusal.text,
            code=refusal.code,
            field=refusal.field if refusal.field == _FRAME or not field else field,
            values=(*refusal.details, *body),
            asker=asker,
        )
