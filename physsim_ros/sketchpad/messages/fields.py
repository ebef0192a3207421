# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Checks of the fields of messages.

Each function has the given value and the name of its field, returns the checked value, and raises
a Refusal for a value that is out of range.
"""

from __future__ import annotations

from typing import Any

from physsim_ros.model import checks
from physsim_ros.model.checks import check_point, must_be, number, pair
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.names import LONGEST_NAME
from physsim_ros.model.spelling import has_invisible
from physsim_ros.model.texts import is_printable
from physsim_ros.model.transform import Point

# Length of the name of a person [characters].
LONGEST_PERSON = 24


def text(value: object, name: str) -> str:
    """Return a text of at most the length of a name."""
    words = checks.text(value, name, BadProperty)
    if len(words) > LONGEST_NAME:
        raise BadProperty('{field} has more than {most} characters', field=name, most=LONGEST_NAME)
    return words


def person(value: object, name: str) -> str:
    """Return the name of a person."""
    checked = text(value, name).strip()
    if not 0 < len(checked) <= LONGEST_PERSON or not is_printable(checked):
        raise BadProperty('a name has 1 to {most} characters', field=name, most=LONGEST_PERSON)
    if has_invisible(checked):
        raise BadProperty('the name contains an invisible character', field=name)
    return checked


def names(value: object, name: str) -> tuple[str, ...]:
    """Return the names of a list, at least one."""
    if not isinstance(value, list) or not value:
        raise BadProperty('{field} must be a list of at least one name', field=name)
    return tuple(text(each, name) for each in value)


def mapping(value: object, name: str) -> dict[Any, Any]:
    """Return a mapping."""
    if not isinstance(value, dict):
        raise must_be('a mapping', value, name)
    return value


def point(value: object, name: str) -> Point:
    """Return a point of the world [m]."""
    checked = pair(value, name)
    check_point(checked, name)
    return checked


def three(value: object, name: str, *names: str) -> tuple[float, float, float]:
    """Return the three numbers of a list, which have names."""
    if not isinstance(value, list) or len(value) != 3:
        raise Malformed('{field} must be [{known}]', field=name, known=', '.join(names))
    first, second, third = (number(each, name) for each in value)
    return first, second, third


def color(value: object, name: str) -> Color:
    """Return the colour of a text, as in world files."""
    return color_from(text(value, name))
