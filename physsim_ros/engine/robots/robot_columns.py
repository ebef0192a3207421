# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Columns of the robots of a scene, for r robots."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.graph_search import Rows
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import Point, Pose


class RobotColumns(NamedTuple):
    """
    Columns that follow from the scene alone.

    :ivar rows: (r,) intp: of the body table
    :ivar names: of the robots
    :ivar robots: in the order of the rows
    :ivar rims: for each robot, speed of the rim of each wheel by the velocity of the floor
    :ivar curvatures: greatest of the way of each [1/m]
    :ivar centers: centre of mass of each in the frame of the body [m]
    """

    rows: Rows
    names: tuple[str, ...]
    robots: tuple[Robot, ...]
    rims: tuple[tuple[Pose, ...], ...]
    curvatures: tuple[float, ...]
    centers: tuple[Point, ...]


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def robot_columns(scene: Scene) -> RobotColumns:
    """Return the columns of the robots of a scene."""
    found = [
        (row, body, body.robot) for row, body in enumerate(scene.bodies) if body.robot is not None
    ]
    robots = tuple(robot for _, _, robot in found)
    return RobotColumns(
        rows=np.array([row for row, _, _ in found], np.intp),
        names=tuple(body.name for _, body, _ in found),
        robots=robots,
        rims=tuple(tuple(robot.drive.wheels.values()) for robot in robots),
        curvatures=tuple(robot.drive.most_curved for robot in robots),
        centers=tuple(body.shape.form.centroid for _, body, _ in found),
    )
