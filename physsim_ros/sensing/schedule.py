# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""When sensors read: at their rate in simulation time, each at a moment of its own."""

from __future__ import annotations

import zlib


def is_due(name: str, rate: float, before: int, now: int) -> bool:
    """
    Return whether a sensor reads between two frames; at most once.

    It depends on these times alone, so that a rewind repeats the readings. Sensors of one rate
    read in different frames, by their names, so that the cost is spread.

    :param name: of body and sensor
    :param rate: readings a second [Hz]
    :param before: simulation time of the frame before [ns]
    :param now: simulation time of this frame [ns]
    """
    period = max(round(1e9 / rate), 1)
    phase = zlib.crc32(name.encode()) % period
    return (now + phase) // period > (before + phase) // period
