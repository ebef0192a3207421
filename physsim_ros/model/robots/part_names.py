# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Names of the parts of a robot, in its file and in the world.

A link `upper` of the robot `arm/0` is the body `arm/0/upper/0`, a joint likewise.
"""

from __future__ import annotations

import re

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty

# The body of a robot itself, in its joints and sensors.
BASE = 'base'
# A token of ROS, as links are frames.
_PART = re.compile(r'[A-Za-z_][A-Za-z0-9_]{0,49}')


def part_name(body: str, part: str) -> str:
    """
    Return the name of a part in the world.

    :param body: name of the robot's body
    :param part: name of a link or joint; `BASE` is the body itself
    """
    return body if part == BASE else f'{body}/{part}/0'


def check_part(value: object, name: str) -> str:
    """
    Return a name of a link or joint.

    :param name: of the field, for the refusal
    :raises BadProperty: it is no token of ROS
    """
    if not isinstance(value, str) or not _PART.fullmatch(value):
        raise BadProperty(
            '{field} {value} is not the name of a part: letters, digits and _, not a digit first, '
            'at most 50 characters',
            field=name,
            value=shown(value),
        )
    return value
