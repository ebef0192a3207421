# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Answers as messages to pages, and the origin by which they find the page that asked."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from physsim_ros.model.snapshot import Answer

# A message to a page, to become JSON; a function is called on the server's thread.
Content = dict[str, Any] | Callable[[], dict[str, Any]]


class Origin(NamedTuple):
    """
    The origin of a request.

    :ivar page: number of the page that asks
    :ivar request: identifier of the page's message
    :ivar topic: that the answers name
    """

    page: int
    request: str
    topic: str

    @property
    def asker(self) -> str:
        """Return the key that goes with a request, and comes back with its answer."""
        return f'{self.page}:{self.request}'


def asker_of(key: str) -> tuple[int, str]:
    """Return page and identifier of the key of an answer; -1 where no page has asked."""
    page, _, request = key.partition(':')
    return (int(page), request) if page else (-1, '')


def answer_content(answer: Answer, request: str) -> dict[str, Any]:
    """
    Return the message of an answer.

    :param request: identifier of the message that it answers; '' for events and other pages
    """
    return {
        'type': 'answer',
        'request': request,
        'ok': not answer.code,
        'code': answer.code,
        'message': answer.message,
        'subject': answer.subject,
        'topic': answer.topic,
        'field': answer.field,
        'values': dict(answer.values),
    }
