# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The times at which sensors read, and the noise of their readings, both by names of readings."""

from __future__ import annotations

import zlib

from physsim_ros.model.arrays import Floats
from physsim_ros.model.noise import normals
from physsim_ros.model.robots.sensors import Sensor
from physsim_ros.model.snapshot import Snapshot


def reading_name(body: str, topic: str) -> str:
    """
    Return the name by which the readings of a robot have their times, noise and latencies.

    :param body: name of the robot's body
    :param topic: name of the sensor or topic, below the namespace of the robot
    """
    return f'{body}|{topic}'


def noise_of(snapshot: Snapshot, row: int, sensor: Sensor, count: int) -> Floats:
    """
    Return (count,) float64: normal numbers of mean 0 and variance 1 for a reading.

    :param row: of the body in the scene
    """
    name = reading_name(snapshot.scene.names[row], sensor.name)
    return normals(snapshot.scene.settings.seed, name, snapshot.step, count)


def is_due(name: str, rate: float, before: int, now: int) -> bool:
    """
    Return whether a sensor reads between two frames; at most once.

    It depends on these times alone, so that a rewind repeats the readings. Sensors of one rate
    read in different frames, by their names, so that the cost is spread.

    :param name: as of `reading_name`
    :param rate: readings a second [Hz]
    :param before: simulation time of the frame before [ns]
    :param now: simulation time of this frame [ns]
    """
    period = max(round(1e9 / rate), 1)
    phase = zlib.crc32(name.encode()) % period
    return (now + phase) // period > (before + phase) // period
