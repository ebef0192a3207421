# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Rate and latency: how often messages come, and how long they, or commands, are on their way.

Law: a latency depends on seed, name and step alone, so that a rewind repeats it.
"""

from physsim_ros.model.checks import Numbers, Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.noise import uniform
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point

# Messages in a second of simulation time.
MESSAGE_RATE = Within(0.01, 1000.0, 'Hz')
# Longest latency [s]. Commands on their way are part of the state, at most one for each step.
LONGEST_DELAY = 5.0
_DELAY = Within(0.0, LONGEST_DELAY, 's')
# Looks for a command in a second: at most as many as a world makes steps.
COMMAND_RATE = Within(0.0, 1e4, 'Hz')
# Everyday words for both.
LATENCY_WORDS = Words('delay', 'dead_time', 'lag')
COMMAND_RATE_WORDS = Words('update_rate', 'control_rate', 'control_frequency')


def delays(value: object, name: str) -> Point:
    """
    Return the least and the greatest latency [s] of a list of both, or of a number that is both.

    :param name: of the field, for the refusal
    :raises Malformed: there are not two numbers, or one is not finite
    :raises BadProperty: one is out of range, or they are out of order
    """
    if not isinstance(value, list | tuple):
        value = (value, value)
    low, high = Numbers((_DELAY, _DELAY))(value, name)
    if low > high:
        template = '{field} is [{low:g}, {high:g}]; the least time is first'
        raise BadProperty(template, field=name, low=low, high=high)
    return low, high


def delay(latency: Point, seed: int, name: str, step: int) -> float:
    """
    Return the latency of a command or a reading that leaves at a step [s].

    :param latency: least and greatest time [s]
    :param seed: of all noise
    :param name: of the command or the reading
    :param step: number of steps since the world began
    """
    low, high = latency
    return low if low == high else low + (high - low) * uniform(seed, name, step)
