# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The glyphs of all joints of a scene as arrays, in the poses and colours of a frame.

Law: corners are computed once for a scene; array operations place them. A strip that keeps its
form may be drawn as a symbol instead, which has a pose; symbols that look alike are one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance.joint_colors import JointColors
from physsim_ros.appearance.joint_strips import Corner, is_rigid, joint_strips, ON_PATH, Strip
from physsim_ros.appearance.rope_corners import corner_count, path_corners
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point, rotated_each

# The smallest and the largest half size of a symbol [m].
_SMALL, _LARGE = 0.03, 0.15
# Decimals that corners are rounded to, so that equal symbols are equal: a micrometre.
_DIGITS = 6
# The lines of a symbol, each through its corners, about a point of its joint [m].
Symbol = tuple[tuple[Point, ...], ...]


class Place(NamedTuple):
    """
    The frame of a symbol.

    :ivar joint: row of the joint
    :ivar point: 0 or 1: the first or the second point of the joint, about which it is drawn
    :ivar side: 0 or 1: the body a or b, with which it turns
    """

    joint: int
    point: int
    side: int


class _Corners(NamedTuple):
    """
    The corners of strips, but those of ropes past guides, as columns of `Corner`.

    :ivar places: (c,) intp: indices among all corners
    :ivar joints: (c,) intp: rows of their joints
    :ivar rows: (c,) intp: rows of the bodies in whose frames the arms are
    :ivar along: (c, 1) float64 [1]
    :ivar across: (c, 1) float64 [m]
    :ivar sag: (c, 1) float64 [1]
    :ivar arms: (c, 2) float64 [m]
    """

    places: NDArray[np.intp]
    joints: NDArray[np.intp]
    rows: NDArray[np.intp]
    along: Floats
    across: Floats
    sag: Floats
    arms: Floats


class _Paths(NamedTuple):
    """
    The paths of the ropes that pass the same number of guides.

    :ivar corners: (r, c) intp: indices of the corners of each, those of the circles at its ends
        excepted
    :ivar rows: (r, k) intp: of the bodies that it passes, its ends among them
    :ivar anchors: (r, k, 2) float64: in their frames [m]
    :ivar radii: (r, k) float64: as in `model.rope_path` [m]
    """

    corners: NDArray[np.intp]
    rows: NDArray[np.intp]
    anchors: Floats
    radii: Floats


class JointGlyphs:
    """
    The glyphs of the joints of a scene.

    :param scene: with the joints
    :param least: half the size of the smallest one [m]
    :param with_symbols: whether strips that keep their form are symbols, and no lines

    :ivar sizes: half the size of each glyph, a third of the smaller of its bodies [m]
    :ivar owner: (s,) intp: index of the joint of each strip
    :ivar lengths: (s,) intp: number of corners of each strip
    :ivar symbols: the lines of each, and the frames in which it is drawn
    """

    def __init__(self, scene: Scene, *, least: float = _SMALL, with_symbols: bool = False) -> None:
        self.scene = scene
        inner = [body.shape.form.inner for body in scene.bodies]
        self.sizes = [
            max(min(min(inner[row] for row in rows if row >= 0) / 3, _LARGE), least)
            for rows in scene.joint_rows.tolist()
        ]
        glyphs = [*map(joint_strips, scene.joints, self.sizes)]
        self.symbols = _symbols(glyphs) if with_symbols else {}
        owned = [
            (number, strip)
            for number, strips in enumerate(glyphs)
            for strip in strips
            if not (with_symbols and is_rigid(strip))
        ]
        self.owner = np.array([number for number, _ in owned], np.intp)
        self.lengths = np.array([len(strip) for _, strip in owned], np.intp)
        on_path = np.array([strip[0] is ON_PATH for _, strip in owned], np.bool_)
        starts = np.cumsum(self.lengths) - self.lengths
        self._paths = _paths_by_guides(scene, self.owner[on_path], starts[on_path])
        free = np.flatnonzero(~np.repeat(on_path, self.lengths))
        corners = [corner for _, strip in owned if strip[0] is not ON_PATH for corner in strip]
        joints = np.repeat(self.owner, self.lengths)[free]
        self._corners = _corner_columns(scene, corners, free, joints)
        self._colors = JointColors(scene)
        self._seats = _drawn_seats(scene)
        self._rope_lengths = _slack_lengths(scene)
        self._down = _direction_of_gravity(scene)
        places = [place for each in self.symbols.values() for place in each]
        self._places = np.array(places, np.intp).reshape(-1, 3).T

    @property
    def segment_ends(self) -> NDArray[np.intp]:
        """Return the number of ends of line segments of each joint, (j,) intp."""
        ends = np.bincount(self.owner, 2 * self.lengths - 2, len(self.sizes))
        return ends.astype(np.intp)

    def colors(self, snapshot: Snapshot) -> NDArray[np.float32]:
        """Return red, green, blue and alpha of each joint by its force, (j, 4) float32."""
        return self._colors.at(snapshot)

    def points(self, poses: Floats) -> Floats:
        """
        Return the two points of each joint.

        :param poses: (..., n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :return: (..., j, 2, 2) float64 [m]
        """
        return self._points(_with_background(poses))

    def corners(self, poses: Floats) -> Floats:
        """
        Return all corners of all strips, one strip after the other.

        :param poses: (..., n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :return: (..., c, 2) float64 [m]
        """
        frames = _with_background(poses)
        free = self._free_corners(frames)
        if not self._paths:
            return free
        corners = np.empty((*poses.shape[:-2], int(self.lengths.sum()), 2))
        corners[..., self._corners.places, :] = free
        for paths in self._paths:
            stops = frames[..., paths.rows, :]
            places = stops[..., :2] + rotated_each(paths.anchors, stops[..., 2])
            corners[..., paths.corners, :] = path_corners(places, paths.radii)
        return corners

    def symbol_poses(self, poses: Floats) -> Floats:
        """
        Return the poses of all symbols, one after the other, (..., p, 3) float64.

        :param poses: (..., n, 3) float64: of the bodies, x, y [m], yaw [rad]
        """
        joints, points, sides = self._places
        frames = _with_background(poses)
        result = np.empty((*poses.shape[:-2], len(joints), 3))
        result[..., :2] = self._points(frames)[..., joints, points, :]
        result[..., 2] = frames[..., self.scene.joint_rows[joints, sides], 2]
        return result

    def moved_symbols(self, moved: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """
        Return whether a body of the joint of each symbol has moved, (p,) bool.

        :param moved: (n,) bool: whether each body has
        """
        either: NDArray[np.bool_] = np.append(moved, False)[
            self.scene.joint_rows[self._places[0]]
        ].any(axis=1)
        return either

    def _points(self, frames: Floats) -> Floats:
        """Return `points`, of poses with the background."""
        ends = frames[..., self.scene.joint_rows, :]
        return ends[..., :2] + rotated_each(self._seats, ends[..., 2])

    def _free_corners(self, frames: Floats) -> Floats:
        """Return the corners that are no part of a path, of poses with the background."""
        points = self._points(frames)
        first, span = points[..., 0, :], points[..., 1, :] - points[..., 0, :]
        length = np.hypot(span[..., 0], span[..., 1])
        side = np.stack((-span[..., 1], span[..., 0]), axis=-1)
        side /= np.maximum(length, 1e-9)[..., None]
        # Depth of a shallow arc: https://en.wikipedia.org/wiki/Parabola#Arc_length.
        slack = np.maximum(0.0, self._rope_lengths - length)
        depth = np.sqrt(3 / 8 * slack * self._rope_lengths)[..., None] * self._down
        each, joints = self._corners, self._corners.joints
        free: Floats = first[..., joints, :] + each.along * span[..., joints, :]
        free += each.across * side[..., joints, :] + each.sag * depth[..., joints, :]
        free += rotated_each(each.arms, frames[..., each.rows, 2])
        return free


def _with_background(poses: Floats) -> Floats:
    """Return poses of bodies, (..., n, 3), with that of the background, which is row -1."""
    background = np.zeros((*poses.shape[:-2], 1, 3))
    return np.concatenate((poses, background), axis=-2)


def _corner_columns(
    scene: Scene, corners: Sequence[Corner], places: NDArray[np.intp], joints: NDArray[np.intp]
) -> _Corners:
    """
    Return corners as columns.

    :param places: (c,) intp: as of the result
    :param joints: (c,) intp: as of the result
    """
    numbers = [(each.along, each.across, each.sag, *each.arm) for each in corners]
    along, across, sag, *arms = np.array(numbers, np.float64).reshape(-1, 5).T
    on_b = np.array([each.on_b for each in corners], np.intp)
    return _Corners(
        places=places,
        joints=joints,
        rows=scene.joint_rows[joints, on_b],
        along=along[:, None],
        across=across[:, None],
        sag=sag[:, None],
        arms=np.column_stack(arms),
    )


def _slack_lengths(scene: Scene) -> Floats:
    """Return the length of each rope that may sag, (j,) float64 [m]; 0 of any other joint."""
    return np.array(
        [
            # A winch keeps its rope taut.
            joint.rest_length
            if joint.kind is JointKind.ROPE and not joint.properties.rate
            else 0.0
            for joint in scene.joints
        ]
    )


def _direction_of_gravity(scene: Scene) -> Floats:
    """Return the unit vector along gravity, (2,) float64; without gravity, down."""
    gravity = np.array(scene.settings.gravity)
    strength = float(np.hypot(*gravity))
    return gravity / strength if strength > 0 else np.array((0.0, -1.0))


def _symbols(glyphs: Sequence[Sequence[Strip]]) -> dict[Symbol, list[Place]]:
    symbols: defaultdict[Symbol, list[Place]] = defaultdict(list)
    for number, strips in enumerate(glyphs):
        lines: defaultdict[Place, Symbol] = defaultdict(tuple)
        for strip in filter(is_rigid, strips):
            place = Place(number, int(strip[0].along), int(strip[0].on_b))
            arms = (corner.arm for corner in strip)
            lines[place] += (tuple((round(x, _DIGITS), round(y, _DIGITS)) for x, y in arms),)
        for place, symbol in lines.items():
            symbols[symbol].append(place)
    return symbols


def _paths_by_guides(
    scene: Scene, joints: NDArray[np.intp], starts: NDArray[np.intp]
) -> list[_Paths]:
    """
    Return the paths of all ropes past guides.

    :param joints: (r,) intp: numbers of these
    :param starts: (r,) intp: index of the first corner of each
    """
    guides = np.array([len(scene.joints[number].guides) for number in joints], np.intp)
    return [
        _paths_of(
            scene,
            joints[guides == count],
            starts[guides == count, None] + np.arange(corner_count(count)),
        )
        for count in np.unique(guides).tolist()
    ]


def _paths_of(scene: Scene, numbers: NDArray[np.intp], corners: NDArray[np.intp]) -> _Paths:
    """
    Return the paths of ropes that pass the same number of guides.

    :param numbers: (r,) intp: of the joints
    :param corners: (r, c) intp: as of the result
    """
    joints = [scene.joints[number] for number in numbers]
    seats = scene.seats[numbers, :4].reshape(-1, 2, 1, 2)
    guides = np.array([[each[1:4] for each in joint.guides] for joint in joints], np.float64)
    passed = [[scene.row_of[guide.body] for guide in joint.guides] for joint in joints]
    ends = scene.joint_rows[numbers]
    return _Paths(
        corners,
        np.column_stack((ends[:, 0], np.array(passed, np.intp), ends[:, 1])),
        np.concatenate((seats[:, 0], guides[..., :2], seats[:, 1]), axis=1),
        np.pad(guides[..., 2], ((0, 0), (1, 1))),
    )


def _drawn_seats(scene: Scene) -> Floats:
    """Return the points of joints in body frames, (j, 2, 2) float64 [m]; a gear has centroids."""
    seats = scene.seats[:, :4].reshape(-1, 2, 2).copy()
    for number, joint in enumerate(scene.joints):
        if joint.kind is JointKind.GEAR:
            for side, row in enumerate(scene.joint_rows[number].tolist()):
                if row >= 0:
                    seats[number, side] = scene.centroids[row]
    return seats


def segment_corners(lengths: Sequence[int]) -> NDArray[np.intp]:
    """
    Return the indices of the two corners of each segment, (2 s,) intp.

    :param lengths: number of corners of each strip
    """
    ends = np.cumsum(lengths)
    first = np.delete(np.arange(ends[-1]), ends - 1)
    return np.column_stack((first, first + 1)).ravel()
