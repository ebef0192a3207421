# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The symbols of joints: strips that keep their form, each in the frame of one body.

A symbol belongs to the mesh of its body, so it costs nothing while it moves. That of two bodies at
one point is drawn on the later spawned one, which lies above the other.
"""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import Point
from physsim_ros.view.joints.joint_glyphs import is_rigid, joint_strips, Strip, symbol_size
from physsim_ros.view.joints.joint_lines import JointLines
from physsim_ros.view.meshes.mesh import Strips

# Decimals that corners are rounded to, so that equal symbols are equal: a micrometre.
_DIGITS = 6
# Kinds whose two points are one.
_POINTED = {JointKind.PIN, JointKind.AXLE, JointKind.MOTOR}


class LooseSymbol(NamedTuple):
    """
    A symbol at the point of one body that turns with the other, or one on the background.

    :ivar joint: row of the joint
    :ivar point: 0 or 1, its first or second point
    :ivar side: 0 or 1: the body with which it turns, a or b
    :ivar strips: about the point
    """

    joint: int
    point: int
    side: int
    strips: Strips


def symbols_of(scene: Scene, sizes: list[float]) -> tuple[dict[int, Strips], list[LooseSymbol]]:
    """
    Return the symbols of a scene: of each body by its row, and all others.

    :param sizes: half the size of the symbol of each joint [m]
    """
    fixed: defaultdict[int, list[tuple[Point, ...]]] = defaultdict(list)
    loose: defaultdict[tuple[int, int, int], list[tuple[Point, ...]]] = defaultdict(list)
    if not scene.joints:
        return {}, []
    seats = JointLines(scene).seats
    for number, (joint, size) in enumerate(zip(scene.joints, sizes, strict=True)):
        rows = scene.joint_rows[number].tolist()
        top = int(np.argmax(rows))
        for strip in filter(is_rigid, joint_strips(joint, size)):
            point, side = int(strip[0].along), int(strip[0].on_b)
            if joint.kind in _POINTED:
                point = side = top
            if point == side and rows[side] >= 0:
                fixed[rows[side]].append(_placed(strip, tuple(seats[number, side].tolist())))
            else:
                loose[number, point, side].append(_placed(strip, (0.0, 0.0)))
    return (
        {row: tuple(strips) for row, strips in fixed.items()},
        [LooseSymbol(*key, tuple(strips)) for key, strips in loose.items()],
    )


def symbol_sizes(scene: Scene, least: float) -> list[float]:
    """
    Return half the size of the symbol of each joint [m].

    :param least: half the size of the smallest symbol [m]
    """
    bodies = dict(zip(scene.names, scene.bodies, strict=True))
    return [symbol_size(joint, bodies, least=least) for joint in scene.joints]


def _placed(strip: Strip, at: Point) -> tuple[Point, ...]:
    """Return the corners of a strip about a point."""
    return tuple(
        (round(corner.arm[0] + at[0], _DIGITS), round(corner.arm[1] + at[1], _DIGITS))
        for corner in strip
    )
