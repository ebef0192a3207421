# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Surroundings: all edges and discs of a frame that rays can meet, in the world.

They are placed once for all sensors of a frame, and culled by distance for each. Laws: a robot
alone and among others reads the same bits; what is met is what the engine collides, but for
sensors, to its precision.
"""

from __future__ import annotations

from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.sensing.fan import Fan, Rays
from physsim_ros.sensing.outlines import Outlines, outlines_of

# An origin that is outside an edge by less lies on it, and a ray grazes an edge that it comes
# closer to [m]: a thousandth of the distance at which two points of a shape are one.
GRAZE = 1e-9

_SEEN: WeakKeyDictionary[Scene, Outlines] = WeakKeyDictionary()


class Surroundings:
    """
    Edges and discs of all bodies but sensors, and the walls of `bounds`.

    :param snapshot: of the world
    """

    def __init__(self, snapshot: Snapshot) -> None:
        self.snapshot = snapshot

    @cached_property
    def outlines(self) -> Outlines:
        """Outlines of all bodies but sensors, and walls, in the frames of the bodies."""
        scene = self.snapshot.scene
        outlines = _SEEN.get(scene)
        if outlines is None:
            rows = [row for row, body in enumerate(scene.bodies) if not body.sensor]
            outlines = _SEEN[scene] = outlines_of(scene, rows, walls=True)
        return outlines

    @cached_property
    def _turns(self) -> tuple[Floats, Floats, Floats, Floats]:
        """(n + 1,) float64 each: x, y, cosine and sine of yaw of each body, and of walls."""
        x, y, yaw = np.vstack((self.snapshot.poses, np.zeros((1, 3)))).T
        return x, y, np.cos(yaw), np.sin(yaw)

    @cached_property
    def _edges(self) -> tuple[Floats, Floats, Floats, Floats]:
        """(e,) float64 each: x, y of the beginning of each edge and of its normal, world."""
        ax, ay, nx, ny = self.outlines.edges.T
        x, y, cos, sin = (each.take(self.outlines.edge_rows) for each in self._turns)
        return (
            x + (cos * ax - sin * ay),
            y + (sin * ax + cos * ay),
            cos * nx - sin * ny,
            sin * nx + cos * ny,
        )

    @cached_property
    def _discs(self) -> tuple[Floats, Floats, Floats]:
        """(d,) float64 each: x, y, radius of each disc, world."""
        cx, cy, radius = self.outlines.discs.T
        x, y, cos, sin = (each.take(self.outlines.disc_rows) for each in self._turns)
        return x + (cos * cx - sin * cy), y + (sin * cx + cos * cy), radius.copy()

    def nearest(self, rays: Rays, reach: float, row: int) -> Floats:
        """
        Return (k,) float64: distance along each ray [m]; infinite for nothing within reach.

        All are 0 where the origin lies in a body or a wall. Beyond reach a distance may be
        infinite or true.

        :param reach: greatest distance [m]
        :param row: of the body whose pieces are not met; -1 is none
        """
        near = self._near(rays.origin, reach, row)
        fan = Fan(rays)
        outside = self._meet_edges(fan, rays.origin, reach, near)
        outside = outside and self._meet_discs(fan, rays.origin, reach, near)
        return fan.nearest() if outside else np.zeros(len(rays.x))

    def _near(self, origin: Point, reach: float, row: int) -> Flags:
        """Return (n + 1,) bool: whether each body, and the walls, may be within reach."""
        x, y = self.snapshot.centers.T
        reaches = self.outlines.extents + reach
        near = reaches > 0.0
        near[:-1] &= (x - origin[0]) ** 2 + (y - origin[1]) ** 2 <= reaches[:-1] ** 2
        if row >= 0:
            near[row] = False
        return near

    def _meet_edges(self, fan: Fan, origin: Point, reach: float, near: Flags) -> bool:
        """Meet the edges that face the origin; return whether it is outside all polygons."""
        outlines = self.outlines
        ax, ay, nx, ny = self._edges
        ax, ay = ax - origin[0], ay - origin[1]
        # Distance of the origin from the line of each edge, positive outside.
        height = -(ax * nx + ay * ny)
        near, front = near[outlines.edge_rows], height > GRAZE
        first = outlines.first_edges
        if len(first) and (near[first] & ~np.logical_or.reduceat(front, first)).any():
            return False
        at = (front & near & (height <= reach)).nonzero()[0]
        nx, ny, height = nx.take(at), ny.take(at), -height.take(at)
        # As seen from outside, an edge runs clockwise.
        ends = np.array((outlines.following.take(at), at))
        for part, rays, counts in fan.pairs(ax.take(ends), ay.take(ends)):
            across = fan.x[rays] * nx[part].repeat(counts)
            across += fan.y[rays] * ny[part].repeat(counts)
            fan.meet(rays, height[part].repeat(counts) / across)
        return True

    def _meet_discs(self, fan: Fan, origin: Point, reach: float, near: Flags) -> bool:
        """Meet the discs; return whether the origin is outside all."""
        cx, cy, radius = self._discs
        cx, cy = cx - origin[0], cy - origin[1]
        away2 = cx * cx + cy * cy
        near = near[self.outlines.disc_rows]
        if (near & (away2 <= (radius + GRAZE) ** 2)).any():
            return False
        at = (near & (away2 <= (radius + reach) ** 2)).nonzero()[0]
        cx, cy, radius = cx.take(at), cy.take(at), radius.take(at)
        tangent = np.sqrt(away2.take(at) - radius * radius)
        # From the right tangent to the left one.
        ends_x = np.array((cx * tangent + cy * radius, cx * tangent - cy * radius))
        ends_y = np.array((cy * tangent - cx * radius, cy * tangent + cx * radius))
        for part, rays, counts in fan.pairs(ends_x, ends_y):
            x, y = fan.x[rays], fan.y[rays]
            px, py = cx[part].repeat(counts), cy[part].repeat(counts)
            aside, ahead = x * py - y * px, x * px + y * py
            half2 = (radius[part] * radius[part]).repeat(counts) - aside * aside
            fan.meet(rays, ahead - np.sqrt(np.maximum(half2, 0.0)))
        return True
