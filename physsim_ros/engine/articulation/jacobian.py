# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What joints keep: numbers that are zero, or not above zero, while nothing is strained.

Law: a number changes with the velocities of its two bodies, along one direction and with their
turning; this knows how much it is now and how it changes, for all joints by arrays alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.islands import Rows
from physsim_ros.engine.joints import EngineJoint
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import turned
import pymunk

_PIVOTS = (JointKind.PIN, JointKind.AXLE, JointKind.MOTOR)
_TURNS = (JointKind.PIN, JointKind.SLIDER, JointKind.GEAR)


class _Points(NamedTuple):
    """
    How far two points of joints are apart, in some direction.

    In this order: pivots across and up, rods and ropes along themselves, sliders across their
    lines, and their ends along them.

    :ivar joint: (p,) the joint of each
    :ivar offset: (p,) float64: how far they are to be apart [m]
    :ivar limits: (p,) bool: whether they may be nearer
    :ivar pivots: how many joints are pivots
    :ivar straight: (s,) joints that are rods, then ropes
    :ivar sliders: those that are sliders
    :ivar slid: (l,) sliders, then those with an upper end, then those with a lower one
    :ivar axes: (l, 2) float64: the direction of each of these, in the frame of the second body
    """

    joint: Rows
    offset: Floats
    limits: NDArray[np.bool_]
    pivots: int
    straight: Rows
    sliders: Rows
    slid: Rows
    axes: Floats

    @property
    def along(self) -> slice:
        """Where rods and ropes are."""
        return slice(2 * self.pivots, 2 * self.pivots + len(self.straight))

    @property
    def aside(self) -> slice:
        """Where sliders are, which come last."""
        return slice(2 * self.pivots + len(self.straight), None)


class _Angles(NamedTuple):
    """
    How far two bodies of joints are turned, as sums of their turns.

    In this order: pins, sliders and gears; axles with an upper limit; those with a lower one.

    :ivar joint: (q,) the joint of each
    :ivar with_a: (q,) float64: how the turn of the first body counts
    :ivar with_b: (q,) float64: the same of the second
    :ivar comes_to: (q,) float64: what the sum is to be [rad]
    :ivar limits: (q,) bool: whether it may be less
    """

    joint: Rows
    with_a: Floats
    with_b: Floats
    comes_to: Floats
    limits: NDArray[np.bool_]


class Restraints:
    """
    The numbers that joints keep, one a row.

    :param joints: whose they are
    :param places: of the engine's bodies in the rows that states come in
    :param background: the row of all others

    :ivar owner: (r,) the joint of each row
    :ivar sides: (2 r,) the place of the first body of each row, then of the second
    :ivar inverse: (2 r, 3) float64: 1 / mass, 1 / mass, 1 / moment of these
    :ivar limits: (r,) bool: whether the number may be below zero
    :ivar angles_from: from which row on the number is an angle
    :ivar has_both: for each joint, whether it keeps a place and an angle
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        places: Mapping[pymunk.Body, int],
        background: int,
    ) -> None:
        described = [each.joint for each in joints]
        a, b = (
            np.array([places.get(body, background) for body in bodies], np.intp)
            for bodies in ([each.ends.a for each in joints], [each.ends.b for each in joints])
        )
        self._ends = np.concatenate((a, b))
        self._at = np.array(
            [each.ends.at_a for each in joints] + [each.ends.at_b for each in joints]
        )
        self._points, self._angles = _points(described), _angles(described)
        self.owner = np.concatenate((self._points.joint, self._angles.joint))
        self.sides = np.concatenate((a[self.owner], b[self.owner]))
        self.limits = np.concatenate((self._points.limits, self._angles.limits))
        self.angles_from = len(self._points.joint)
        self.has_both = [joint.kind in (JointKind.PIN, JointKind.SLIDER) for joint in described]
        inverse = np.zeros((background + 1, 3))
        for each in joints:
            for body in (each.ends.a, each.ends.b):
                if body.body_type == pymunk.Body.DYNAMIC:
                    inverse[places[body]] = 1 / body.mass, 1 / body.mass, 1 / body.moment
        self.inverse = inverse[self.sides]
        self._pushes = self._lasting_pushes()

    def _lasting_pushes(self) -> Floats:
        """Return (2 r, 3) float64: what of the pushes is always the same; zero elsewhere."""
        pushes, pivots = np.zeros((2 * len(self.owner), 3)), self._points.pivots
        pushes[: 2 * pivots, :2] = np.repeat(np.eye(2), pivots, axis=0)
        rows, angles = len(self.owner), slice(self.angles_from, None)
        first, second = pushes[:rows], pushes[rows:]
        first[angles, 2] = self._angles.with_a
        second[angles, 2] = self._angles.with_b
        return pushes

    def read(self, states: Floats) -> tuple[Floats, Floats]:
        """
        Return how far each number is from zero, and how it changes.

        :param states: (m + 1, 6) float64: poses and velocities of the bodies, then the background
        :return: (r,) float64 [m, rad], and (2 r, 3) float64: direction and moment on the first
            body of each row, then on the second
        """
        ends = states[self._ends]
        yaw = ends[:, 2]
        arms = turned(self._at, yaw)
        places = ends[:, :2] + arms
        points, angles, count = self._points, self._angles, self.angles_from
        joints, rows = len(yaw) // 2, len(self.owner)
        yaw_a, yaw_b, arms_a, arms_b = yaw[:joints], yaw[joints:], arms[:joints], arms[joints:]
        apart = places[:joints] - places[joints:]

        pushes = self._pushes.copy()
        first, second = pushes[:rows], pushes[rows:]
        # Those of pivots are always the same.
        direction = first[:count, :2]
        if len(points.straight):
            between = apart[points.straight]
            length = np.hypot(between[:, 0], between[:, 1])[:, None]
            direction[points.along] = np.where(
                length > 0, between / np.maximum(length, 1e-300), (1.0, 0.0)
            )
        if len(points.slid):
            direction[points.aside] = turned(points.axes, yaw_b[points.slid])
            # The line turns with the second body, all the way out to where the first one is.
            arms_b[points.sliders] += apart[points.sliders]
        second[:count, :2] = -direction
        first[:count, 2] = _cross(arms_a[points.joint], direction)
        second[:count, 2] = -_cross(arms_b[points.joint], direction)

        gaps = np.empty(rows)
        gaps[:count] = _dot(apart[points.joint], direction) - points.offset
        turns = angles.with_a * yaw_a[angles.joint]
        turns += angles.with_b * yaw_b[angles.joint]
        gaps[count:] = turns - angles.comes_to
        return gaps, pushes


def _points(joints: Sequence[Joint]) -> _Points:
    """Return the numbers that tell how far two points are apart."""
    pivots, sliders = _of(joints, *_PIVOTS), _of(joints, JointKind.SLIDER)
    rods, ropes = _of(joints, JointKind.ROD), _of(joints, JointKind.ROPE)
    upper, most = _bounded(joints, JointKind.SLIDER, 'upper')
    lower, least = _bounded(joints, JointKind.SLIDER, 'lower')
    lines = np.array([(joint.seat.ux, joint.seat.uy) for joint in joints])
    straight, slid = np.concatenate((rods, ropes)), np.concatenate((sliders, upper, lower))
    across = lines[sliders][:, ::-1] * (-1.0, 1.0)
    offsets = (
        np.zeros(2 * len(pivots)),
        [joints[row].seat.length for row in rods],
        [joints[row].rest_length for row in ropes],
        np.zeros(len(sliders)),
        most,
        -least,
    )
    # Ropes and the ends of sliders.
    bounded = np.array((False, False, True, False, True, True))
    return _Points(
        joint=np.concatenate((pivots, pivots, straight, slid)),
        offset=np.concatenate(offsets),
        limits=np.repeat(bounded, [len(each) for each in offsets]),
        pivots=len(pivots),
        straight=straight,
        sliders=sliders,
        slid=slid,
        axes=np.concatenate((across, lines[upper], -lines[lower])),
    )


def _angles(joints: Sequence[Joint]) -> _Angles:
    """Return the numbers that tell how far two bodies are turned against each other."""
    turns = _of(joints, *_TURNS)
    upper, most = _bounded(joints, JointKind.AXLE, 'upper')
    lower, least = _bounded(joints, JointKind.AXLE, 'lower')
    phase = np.array([joint.seat.phase for joint in joints])
    ratios = [joints[row].number('ratio') for row in turns]
    sizes = len(turns), len(upper), len(lower)
    return _Angles(
        joint=np.concatenate((turns, upper, lower)),
        with_a=np.repeat((-1.0, 1.0, -1.0), sizes),
        with_b=np.concatenate((ratios, np.repeat((-1.0, 1.0), sizes[1:]))),
        comes_to=np.concatenate((phase[turns], most - phase[upper], phase[lower] - least)),
        limits=np.repeat(np.array((False, True, True)), sizes),
    )


def _of(joints: Sequence[Joint], *kinds: JointKind) -> Rows:
    """Return the places of joints of some kinds."""
    return np.array([row for row, joint in enumerate(joints) if joint.kind in kinds], np.intp)


def _bounded(joints: Sequence[Joint], kind: JointKind, name: str) -> tuple[Rows, Floats]:
    """Return the places of joints of a kind that have a limit of that name, and their limits."""
    limits = {
        row: limit
        for row in _of(joints, kind).tolist()
        if (limit := getattr(joints[row].properties, name)) is not None
    }
    return np.array(list(limits), np.intp), np.array(list(limits.values()), np.float64)


def _cross(a: Floats, b: Floats) -> Floats:
    product: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]
    return product
