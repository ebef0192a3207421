# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Colours: from text, and the default ones of bodies.

Default colours are Vega's scheme `tableau10` (https://vega.github.io/vega/docs/schemes/): distinct
on white and on black, for colour-blind people too.
"""

from __future__ import annotations

import re
from typing import Any
import zlib

from physsim_ros.model.checks import check_finite, number, shown
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.names import split_name
from physsim_ros.model.texts import Words

# Red, green, blue, alpha, each 0 .. 1.
Color = tuple[float, float, float, float]

_TABLEAU10 = (
    '#4c78a8', '#f58518', '#e45756', '#72b7b2', '#54a24b',
    '#eeca3b', '#b279a2', '#ff9da6', '#9d755d', '#bab0ac',
)  # fmt: skip

# The least luminance on which a dark line has more contrast than a light one.
_BRIGHT = 0.35


def color_from(text: str) -> Color:
    """
    Return the colour of '#rrggbb' or '#rrggbbaa'.

    :raises BadProperty: it is neither
    """
    if not re.fullmatch('#([0-9a-fA-F]{2}){3,4}', text):
        raise BadProperty(
            "color must be '#rrggbb' or '#rrggbbaa', not {value}", field='color', value=shown(text)
        )
    red, green, blue, alpha = (each / 255 for each in (*bytes.fromhex(text[1:]), 255)[:4])
    return red, green, blue, alpha


# Everyday words for a colour.
COLOR_WORDS = Words('colour', 'rgb', 'rgba')


def color_value(value: object, name: str) -> Color:
    """
    Return the colour of '#rrggbb', '#rrggbbaa' or [r, g, b, a], each 0 .. 1.

    :param name: of the field, for the refusal
    :raises BadProperty: it is none of them
    """
    if isinstance(value, str):
        return color_from(value)
    if not isinstance(value, list | tuple) or len(value) != 4:
        raise BadProperty('{field} must be a string or [r, g, b, a]', field=name)
    return check_color(tuple(number(each, name) for each in value), name)


def check_color(color: Any, name: str) -> Color:
    """
    Return a colour, its channels as plain floats.

    :param name: of the field, for the refusal
    :raises Malformed: it has not four channels, or one is not finite
    :raises BadProperty: a channel lies outside 0 .. 1
    """
    red, green, blue, alpha = channels = check_finite(color, 4, name)
    if not all(0.0 <= channel <= 1.0 for channel in channels):
        raise BadProperty('each channel of {field} must lie in 0 .. 1', field=name)
    return red, green, blue, alpha


def color_of(name: str) -> Color:
    """
    Return the default colour of a body, by its name; consecutive ids have different colours.

    It does not depend on the number of bodies, which would be a state of the world in no file.
    """
    namespace, id_ = split_name(name)
    number = zlib.crc32(namespace.encode()) + id_
    red, green, blue = bytes.fromhex(_TABLEAU10[number % len(_TABLEAU10)][1:])
    return red / 255, green / 255, blue / 255, 1.0


def is_bright(color: Color) -> bool:
    """Return whether a dark mark on a colour has more contrast than a light one."""
    red, green, blue, _ = color
    # Luminance as of ITU-R BT.601.
    return 0.299 * red + 0.587 * green + 0.114 * blue > _BRIGHT
