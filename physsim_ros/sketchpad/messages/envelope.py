# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The envelope of a message: untrusted text to identifier, type and fields.

Law: text that is no JSON or no Unicode, too deep or too long goes no further than here.
"""

from __future__ import annotations

import json
from typing import Any, NamedTuple

from physsim_ros.model.errors import Malformed

# Depth of nested lists and mappings; a stroke has three levels, a body five.
DEEPEST = 8
# Length of the identifier of a message [characters].
LONGEST_ID = 64


class Envelope(NamedTuple):
    """
    A message that is not checked yet.

    :ivar request: identifier that the page gave to it; its answers carry it
    :ivar kind: its `type`
    :ivar fields: everything else
    """

    request: str
    kind: str
    fields: dict[str, Any]


def read_envelope(text: str) -> Envelope:
    """
    Return identifier, type and fields of a message.

    :raises Malformed: it is no JSON object, too deep, or without identifier or type
    """
    try:
        value = json.loads(text, parse_constant=_refuse_constant)
        if '\\u' in text:
            # JSON may escape half of a surrogate pair (RFC 8259, section 8.2), which no file name
            # and no ROS message holds.
            json.dumps(value, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise Malformed('the message is not JSON', field='message') from error
    if not isinstance(value, dict):
        raise Malformed('the message is no JSON object', field='message')
    _check_depth(value)
    id_ = value.pop('id', '')
    if not isinstance(id_, str) or len(id_) > LONGEST_ID:
        raise Malformed(f'id must be a text of at most {LONGEST_ID} characters', field='id')
    kind = value.pop('type', None)
    if not isinstance(kind, str):
        raise Malformed('the message has no type', field='type')
    return Envelope(id_, kind, value)


def _refuse_constant(name: str) -> float:
    raise ValueError(name)


def _check_depth(value: object) -> None:
    """
    Refuse a value of too many levels.

    :raises Malformed: it has
    """
    level = [value]
    for _ in range(DEEPEST):
        level = [
            child
            for each in level
            if isinstance(each, list | dict)
            for child in (each.values() if isinstance(each, dict) else each)
            if isinstance(child, list | dict)
        ]
        if not level:
            return
    raise Malformed(f'the message has more than {DEEPEST} levels', field='message')
