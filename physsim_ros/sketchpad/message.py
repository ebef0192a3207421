# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Messages of pages: untrusted text becomes a kind and its checked arguments; answers to them.

Laws: text that is not JSON, not Unicode or nested too deeply is refused here; the role of the page
and every field are checked on the server's thread, before the world's thread receives the message.

The decorator `message` declares a kind at the function that carries it out; `messages` has these
functions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import json
from string import Formatter
from typing import Any, NamedTuple, TypeVar

from physsim_ros.model.answer import Answer
from physsim_ros.model.checks import shown
from physsim_ros.model.declarations import check_key
from physsim_ros.model.errors import Malformed, Refusal
from physsim_ros.model.texts import abbreviated
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.garbage_collection import suspended_collection
from physsim_ros.simulation.entries import Origin
from physsim_ros.sketchpad.rights import check_right, Right, Role

# Levels of nested lists and mappings; a stroke has three, a body five.
DEEPEST = 8
# Types of JSON's values that have levels; JSON makes no subclass.
_NESTING = list, dict
# Length of the identifier of a message [characters].
LONGEST_ID = 64

# A message to a page, to become JSON; a function is called on the server's thread.
Content = dict[str, Any] | Callable[[], dict[str, Any]]
# Returns the checked value of a field from the given value and the name of the field; raises a
# Refusal.
Read = Callable[[Any, str], Any]
_Handler = TypeVar('_Handler', bound=Callable[..., object])


class Optional(NamedTuple):
    """A field that a message may lack; the function has a default value for it."""

    read: Read


class Kind(NamedTuple):
    """
    A kind of message.

    :ivar topic: that its answers name
    :ivar right: that a page needs to send it
    :ivar fields: checks by the name of the field
    :ivar handle: carries it out on the world's thread, with the page's session, the origin of the
        message and the checked fields
    :ivar for_world: whether it does; else it is carried out on the server's thread, with the
        socket, the open page and the checked fields, and has no answer but a refusal
    """

    topic: str
    right: Right
    fields: Mapping[str, Read | Optional]
    handle: Callable[..., object]
    for_world: bool = True


class Message(NamedTuple):
    """
    A checked message.

    :ivar request: identifier that the page gave to it; its answers carry it
    :ivar kind: what it is
    :ivar arguments: checked fields by name
    """

    request: str
    kind: Kind
    arguments: dict[str, Any]


# By the type that messages name.
KINDS: dict[str, Kind] = {}


def message(
    type_: str, topic: str, right: Right = Right.CHANGE, /, **fields: Read | Optional
) -> Callable[[_Handler], _Handler]:
    """
    Declare a kind of message at the function that carries it out.

    :param type_: that messages name
    :param topic: that its answers name
    :param right: that a page needs to send it
    :param fields: checks by the name of the field
    """

    def declare(handle: _Handler) -> _Handler:
        KINDS[type_] = Kind(topic, right, fields, handle)
        return handle

    return declare


def server_message(
    type_: str, right: Right, /, **fields: Read | Optional
) -> Callable[[_Handler], _Handler]:
    """Declare a kind of message that the world's thread never receives, as `message` does."""

    def declare(handle: _Handler) -> _Handler:
        KINDS[type_] = Kind('', right, fields, handle, for_world=False)
        return handle

    return declare


def read_message(text: str, role: Role, boundary: ErrorBoundary) -> tuple[str, Message | Refusal]:
    """
    Return the identifier of a message ('' if it cannot be read), and the message or its refusal.

    The refusal names an unknown type, an unknown field, or a field whose value is out of range;
    or the page may not send this message.

    :param role: of the page
    :param boundary: of the server
    """
    request = ''
    try:
        with boundary.refusing('page'):
            fields = json_object(text)
            request = _request_from(fields.pop('id', ''))
            return request, _checked(request, fields.pop('type', None), fields, role)
    except Refusal as refusal:
        return request, refusal


def _checked(request: str, type_: object, fields: dict[str, Any], role: Role) -> Message:
    if not isinstance(type_, str):
        raise Malformed('the message has no type', field='type')
    kind = KINDS.get(type_)
    if kind is None:
        raise Malformed('there is no message {value}', field='type', value=shown(type_))
    check_right(kind.right, role)
    for name in fields:
        check_key(name, dict.fromkeys(kind.fields, ()))
    arguments = {}
    for name, read in kind.fields.items():
        if not isinstance(read, Optional):
            arguments[name] = read(fields.get(name), name)
        elif name in fields:
            arguments[name] = read.read(fields[name], name)
    return Message(request, kind, arguments)


def _request_from(value: object) -> str:
    if not isinstance(value, str) or len(value) > LONGEST_ID:
        raise Malformed(
            '{field} must be text of at most {most} characters', field='id', most=LONGEST_ID
        )
    return value


@suspended_collection()
def json_object(text: str | bytes) -> dict[str, Any]:
    """
    Return the JSON object of a text, or of its bytes in UTF-8.

    :raises Malformed: it is no JSON object, or has too many levels
    """
    try:
        text = text if isinstance(text, str) else text.decode()
        value = json.loads(text, parse_constant=_refuse_constant)
        if '\\u' in text:
            # JSON may escape half of a surrogate pair (RFC 8259, section 8.2), which no file name
            # and no ROS message holds.
            json.dumps(value, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise Malformed('the message is not JSON', field='message') from error
    if not isinstance(value, dict):
        raise Malformed('the message is not a JSON object', field='message')
    _check_depth(value)
    return value


def _refuse_constant(name: str) -> float:
    """Refuse NaN and Infinity, which Python reads and JSON does not have."""
    raise ValueError(name)


def _check_depth(value: dict[str, Any]) -> None:
    """
    Refuse a value that is nested too deeply.

    :raises Malformed: it has more than `DEEPEST` levels
    """
    level: list[Any] = [value]
    for _ in range(DEEPEST):
        level = [
            child
            for each in level
            for child in (each.values() if type(each) is dict else each)
            if type(child) in _NESTING
        ]
        if not level:
            return
    raise Malformed('the message has more than {most} levels', field='message', most=DEEPEST)


# Answers


def asker_key(page: int, request: str) -> str:
    """
    Return the key that goes with a request, and comes back with its answers.

    :param page: number of the page that asks
    :param request: identifier of the page's message
    """
    return f'{page}:{request}'


def asker_of(key: str) -> tuple[int, str]:
    """Return page and identifier of the key of an answer; -1 where no page has asked."""
    page, _, request = key.partition(':')
    return (int(page), request) if page else (-1, '')


def request_of(origin: Origin) -> str:
    """Return the identifier of the page's message from which a request comes."""
    return asker_of(origin.asker)[1]


def text_content(text: str) -> list[Any]:
    """
    Return a text for pages: its template, and its values by name, each a string or such a text.

    A text that pages do not translate is its own template.
    """
    if not isinstance(text, Text):
        return [text, {}]
    formats = {name: format_ for _, name, format_, _ in Formatter().parse(text.template) if name}
    values = {
        name: text_content(value)
        if isinstance(value, Text)
        else abbreviated(format(value, formats.get(name) or ''))
        for name, value in text.values.items()
    }
    return [text.template, values]


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
        'text': text_content(answer.message),
        'subject': answer.subject,
        'topic': answer.topic,
        'field': answer.field,
        'values': dict(answer.values),
    }
