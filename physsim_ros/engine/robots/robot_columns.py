# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Columns of the robots of a scene, for r robots."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.graph_search import Rows
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene


class RobotColumns(NamedTuple):
    """
    Columns that follow from the scene alone.

    :ivar rows: (r,) intp: of the body table
    :ivar names: of the robots
    :ivar robots: in the order of the rows
    :ivar rims: (r, w, 3) float64: speed of the rim of each wheel by the velocity of the floor
    :ivar acceleration: (r,) float64: greatest of a rim [m/s²]
    :ivar curvature: (r,) float64: greatest of its way [1/m]
    :ivar centers: (r, 2) float64: centre of mass in the frame of the body [m]
    :ivar slip: (r, 2) float64: drift of the odometry (`model.robots.Odometry`)
    """

    rows: Rows
    names: tuple[str, ...]
    robots: tuple[Robot, ...]
    rims: Floats
    acceleration: Floats
    curvature: Floats
    centers: Floats
    slip: Floats


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def robot_columns(scene: Scene) -> RobotColumns:
    """Return the columns of the robots of a scene."""
    found = [
        (row, body, body.robot) for row, body in enumerate(scene.bodies) if body.robot is not None
    ]
    robots = tuple(robot for _, _, robot in found)
    wheels = [list(robot.drive.wheels.values()) for robot in robots]
    rims = np.zeros((len(robots), max(map(len, wheels), default=0), 3))
    for number, factors in enumerate(wheels):
        rims[number, : len(factors)] = factors
    return RobotColumns(
        rows=np.array([row for row, _, _ in found], np.intp),
        names=tuple(body.name for _, body, _ in found),
        robots=robots,
        rims=rims,
        acceleration=np.array([robot.drive.acceleration for robot in robots]),
        curvature=np.array([robot.drive.most_curved for robot in robots]),
        centers=np.array([body.shape.form.centroid for _, body, _ in found]).reshape(-1, 2),
        slip=np.array([robot.odometry.slip for robot in robots]).reshape(-1, 2),
    )
