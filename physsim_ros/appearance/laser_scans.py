# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The last scans of robots, as the page and Rerun show them.

Laws: a laser that nobody shows is not read; one that is shown is read at its rate, as its topic
is, or less often where all readings of a frame exceed their budget: the oldest come first.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robots.sensors import Laser
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.sensing import is_due, read_laser, reading_name, scan_points, Surroundings

# Beams after which no further laser is read in a frame: ten lasers of 360 beams take some 3 ms.
BUDGET = 3600
# Beams that leave a smaller gap in a turn go all the way round [rad].
_GAP = 1e-3


class _Scan(NamedTuple):
    """
    A reading.

    :ivar points: (k, 3) float64, see `LaserScans.points`
    """

    laser: Laser
    snapshot: Snapshot
    points: Floats


class LaserScans:
    """The last scans of the robots that are shown; of several lasers of a robot, the first."""

    def __init__(self) -> None:
        # By the name of the robot, the oldest first.
        self._scans: dict[str, _Scan] = {}

    def points(self, name: str) -> Floats | None:
        """
        Return (k, 3) float64: x, y [m] and 1 for a hit; None where a robot has no scan.

        The first point is the laser; the others are the ends of its beams, counter-clockwise.

        :param name: of the robot's body
        """
        scan = self._scans.get(name)
        return None if scan is None else scan.points

    def hits(self) -> Floats:
        """Return (k, 2) float64: x, y [m] of all that the scans of all robots have hit."""
        hits = [scan.points[scan.points[:, 2] > 0.0, :2] for scan in self._scans.values()]
        return np.concatenate(hits) if hits else np.empty((0, 2))

    def read(self, snapshot: Snapshot, names: set[str]) -> bool:
        """
        Read the lasers of robots that are due.

        :param snapshot: that is shown
        :param names: of the robots that are shown; scans of others are forgotten
        :return: whether there is another scan than before, or one less
        """
        known = len(self._scans)
        if not names:
            self._scans.clear()
            return known > 0
        lasers = _lasers(snapshot, names)
        self._scans = {name: scan for name, scan in self._scans.items() if name in lasers}
        changed = len(self._scans) < known
        surroundings, beams = Surroundings(snapshot), 0
        for name in [*(each for each in lasers if each not in self._scans), *self._scans]:
            row, laser = lasers[name]
            before = self._scans.get(name)
            if before is not None and not _is_due(name, before, laser, snapshot):
                continue
            self._scans.pop(name, None)
            self._scans[name] = _Scan(laser, snapshot, _points(surroundings, row, laser))
            changed = True
            beams += laser.beams
            if beams >= BUDGET:
                break
        return changed


def _lasers(snapshot: Snapshot, names: set[str]) -> dict[str, tuple[int, Laser]]:
    """Return row and first laser of robots by their names."""
    scene = snapshot.scene
    found: dict[str, tuple[int, Laser]] = {}
    for row, robot in zip(scene.robot_rows.tolist(), scene.robots, strict=True):
        name = scene.names[row]
        laser = next((each for each in robot.sensors if isinstance(each, Laser)), None)
        if name in names and laser is not None:
            found[name] = row, laser
    return found


def _is_due(name: str, before: _Scan, laser: Laser, now: Snapshot) -> bool:
    """Return whether a laser reads, in either direction of time, or bodies were moved."""
    if before.laser != laser:
        return True
    if before.snapshot.stamp == now.stamp:
        return not np.array_equal(before.snapshot.poses, now.poses)
    earlier, later = sorted((before.snapshot.stamp, now.stamp))
    return is_due(reading_name(name, laser.name), laser.rate, earlier, later)


def _points(surroundings: Surroundings, row: int, laser: Laser) -> Floats:
    snapshot = surroundings.snapshot
    ranges = read_laser(surroundings, row, laser)
    hits = np.concatenate(((False,), np.isfinite(ranges)))
    points = np.column_stack((scan_points(snapshot, row, laser, ranges), hits))
    if laser.beams * laser.increment > math.tau - _GAP:
        # All round: the light has no gap between the last beam and the first.
        points = np.vstack((points, points[1:2]))
    return points
