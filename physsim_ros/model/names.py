# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Names of bodies and joints: `<namespace>/<id>` of their markers, in one canonical spelling."""

from __future__ import annotations

from collections.abc import Iterable

from physsim_ros.model.checks import text
from physsim_ros.model.errors import Malformed
from physsim_ros.model.spelling import has_invisible
from physsim_ros.model.texts import abbreviated, is_printable, LONGEST_WORD
from physsim_ros.model.translation import Text

# Name of the background in joints, contacts and frames.
WORLD = 'world'
# Notes at fields of requests: their values name bodies, joints, or what the request adds.
BODY, JOINT, ADDED = 'body', 'joint', 'added'
# Characters of a name; names are frames and strings of messages too.
LONGEST_NAME = 1000
# Between the two names of a contact.
PAIR_SEPARATOR = '|'
# The character that decoders put in place of bytes that are not UTF-8.
REPLACEMENT = '\ufffd'
# Prefixes of the namespaces of markers that are no bodies: joints (`~/join` accepts it), their
# lines, the x of an anchored body; and the namespaces of the walls and of hands. A body and a
# joint of one name are two markers.
JOINT_PREFIX, LINES_PREFIX, CROSS_PREFIX = 'joint:', 'lines:', 'anchor:'
WALLS, HANDS = 'physsim:bounds', 'physsim:hands'


def check_name(value: object, field: str = 'name') -> str:
    """
    Return a name that is `<namespace>/<id>`, the id a 32-bit whole number.

    :param field: for the refusal
    :raises Malformed: it is not, or is too long, or has an unprintable or invisible character
    """
    name = text(value, field)
    namespace, id_ = split_name(name)
    if not namespace:
        template = '{name!r} is not a name: <namespace>/<id>, the id a whole number'
        raise Malformed(template, field=field, name=name)
    if len(name) > LONGEST_NAME:
        raise Malformed(
            'a name has at most {most} characters', field=field, most=str(LONGEST_NAME)
        )
    _check_visible(name, field)
    if REPLACEMENT in name:
        raise Malformed('{name!r} is not UTF-8', field=field, name=name)
    if not -(2**31) <= id_ < 2**31:
        raise Malformed('the id of {name!r} does not fit into 32 bits', field=field, name=name)
    return name


def check_body_name(value: object, field: str = 'name') -> str:
    """
    Return a name that a body can have.

    :param field: for the refusal
    :raises Malformed: it is not `<namespace>/<id>`, or its prefix is that of other markers,
        or it would make the name of a contact ambiguous
    """
    name = check_name(value, field)
    if name.startswith((JOINT_PREFIX, LINES_PREFIX, CROSS_PREFIX, WALLS, HANDS)):
        raise Malformed('{name!r} is no body in the picture', field=field, name=name)
    if PAIR_SEPARATOR in name:
        template = '{name!r} holds a {separator}, which separates the names of a contact'
        raise Malformed(template, field=field, name=name, separator=PAIR_SEPARATOR)
    return name


def check_hand_name(value: object, field: str) -> str:
    """
    Return a name that a hand can have.

    :param field: for the refusal
    :raises Malformed: it is empty or too long, or has an unprintable or invisible character
    """
    name = text(value, field)
    if not 0 < len(name) <= LONGEST_NAME:
        raise Malformed(
            'the name of a hand has 1 to {most} characters', field=field, most=LONGEST_NAME
        )
    _check_visible(name, field)
    return name


def _check_visible(name: str, field: str) -> None:
    if not is_printable(name):
        raise Malformed(
            '{name!r} contains a character that cannot be printed', field=field, name=name
        )
    if has_invisible(name):
        raise Malformed('{name!a} contains an invisible character', field=field, name=name)


def shown_name(name: str) -> str:
    """Return a name for answers: unchanged, or abbreviated if it is too long for a body."""
    return abbreviated(name, LONGEST_NAME if len(name) <= LONGEST_NAME else LONGEST_WORD)


def shown_end(name: str) -> str:
    """Return a body of a joint for messages: its name, or the background."""
    return Text('the background') if name == WORLD else name


def split_name(name: str) -> tuple[str, int]:
    """Return namespace and id of a name; the namespace is '' if it is not canonical."""
    namespace, _, id_ = name.rpartition('/')
    try:
        number = int(id_)
    except ValueError:
        return '', 0
    # A number has one spelling, that of a marker's id: '7', not '07' or '+7'.
    return (namespace, number) if str(number) == id_ else ('', 0)


def names_in(names: Iterable[str], namespace: str | None) -> list[str]:
    """Return the names that are in a namespace; None is every namespace."""
    return [name for name in names if namespace is None or split_name(name)[0] == namespace]
