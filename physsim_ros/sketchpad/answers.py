# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""Answers on their way to the pages, and the keys by which they find the one that asked."""

from __future__ import annotations

from typing import Any

from physsim_ros.model.snapshot import Answer


def asker_key(page: int, request_id: str) -> str:
    """Return the key of a message of a page, for its answers."""
    return f'{page}:{request_id}'


def asker_of(key: str) -> tuple[int, str]:
    """Return page and identifier of a key; -1 where it is of no page."""
    page, _, request_id = key.partition(':')
    return (int(page), request_id) if page else (-1, '')


def request_of(asker: str) -> str:
    """Return the identifier of the message of a key."""
    return asker_of(asker)[1]


def answer_content(answer: Answer, request_id: str) -> dict[str, Any]:
    """
    Return the message of an answer.

    :param request_id: of the message that it answers; '' for others and events
    """
    return {
        'type': 'answer',
        'request': request_id,
        'ok': not answer.code,
        'code': answer.code,
        'message': answer.message,
        'subject': answer.subject,
        'topic': answer.topic,
        'field': answer.field,
        'values': dict(answer.values),
    }
