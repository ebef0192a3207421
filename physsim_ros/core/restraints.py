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

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from physsim_ros.core.arrays import Floats
from physsim_ros.core.description import Joint
from physsim_ros.core.graph import Rows
from physsim_ros.core.joint_properties import JointKind
from physsim_ros.core.joints import EngineJoint
from physsim_ros.core.rotation import turned
import pymunk

_PIVOTS = (JointKind.PIN, JointKind.AXLE, JointKind.MOTOR)
_TURNS = (JointKind.PIN, JointKind.SLIDER, JointKind.GEAR)


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
        whats = [each.joint for each in joints]

        def rows(wanted: Callable[[Joint], object]) -> Rows:
            return np.array([row for row, joint in enumerate(whats) if wanted(joint)], np.intp)

        def of(*kinds: JointKind) -> Rows:
            return rows(lambda joint: joint.kind in kinds)

        a, b = (
            np.array([places.get(body, background) for body in bodies], np.intp)
            for bodies in ([each.ends.a for each in joints], [each.ends.b for each in joints])
        )
        self._ends = np.concatenate((a, b))
        self._at = np.array(
            [each.ends.at_a for each in joints] + [each.ends.at_b for each in joints]
        )
        lines = np.array([(joint.seat.ux, joint.seat.uy) for joint in whats])

        pivots, rods, ropes = of(*_PIVOTS), of(JointKind.ROD), of(JointKind.ROPE)
        self._straight, self._sliders = np.concatenate((rods, ropes)), of(JointKind.SLIDER)
        slider, axle = JointKind.SLIDER, JointKind.AXLE
        most = rows(lambda each: each.kind is slider and each.properties.upper is not None)
        least = rows(lambda each: each.kind is slider and each.properties.lower is not None)
        # Which number is along the line of which slider, and how that lies on its second body.
        self._slid = np.concatenate((self._sliders, most, least))
        across = lines[self._sliders][:, ::-1] * (-1.0, 1.0)
        self._axes = np.concatenate((across, lines[most], -lines[least]))
        self._points = np.concatenate((pivots, pivots, self._straight, self._slid))
        self._offsets = np.concatenate(
            (
                np.zeros(2 * len(pivots)),
                [whats[row].seat.length for row in rods],
                [whats[row].rest_length for row in ropes],
                np.zeros(len(self._sliders)),
                [_said(whats[row].properties.upper) for row in most],
                [-_said(whats[row].properties.lower) for row in least],
            )
        )

        turns = of(*_TURNS)
        most = rows(lambda each: each.kind is axle and each.properties.upper is not None)
        least = rows(lambda each: each.kind is axle and each.properties.lower is not None)
        self._angles = np.concatenate((turns, most, least))
        # How the turns of the two bodies count, and what they come to.
        ratios = [whats[row].number('ratio') for row in turns]
        self._with_a = np.concatenate(
            (-np.ones(len(turns)), np.ones(len(most)), -np.ones(len(least)))
        )
        self._with_b = np.concatenate((ratios, -np.ones(len(most)), np.ones(len(least))))
        phase = np.array([joint.seat.phase for joint in whats])
        self._comes_to = np.concatenate(
            (
                phase[turns],
                [_said(whats[row].properties.upper) for row in most] - phase[most],
                phase[least] - [_said(whats[row].properties.lower) for row in least],
            )
        )

        self.owner = np.concatenate((self._points, self._angles))
        self.sides = np.concatenate((a[self.owner], b[self.owner]))
        self.angles_from = len(self._points)
        self.has_both = [joint.kind in (JointKind.PIN, JointKind.SLIDER) for joint in whats]
        self.limits = np.zeros(len(self.owner), dtype=np.bool_)
        ropes_from = 2 * len(pivots) + len(rods)
        ropes_to = ropes_from + len(ropes)
        limits_from, limits_to = ropes_to + len(self._sliders), len(self._points)
        turns_to = limits_to + len(turns)
        self.limits[ropes_from:ropes_to] = True
        self.limits[limits_from:limits_to] = True
        self.limits[turns_to:] = True
        inverse = np.zeros((background + 1, 3))
        for each in joints:
            for body in (each.ends.a, each.ends.b):
                if body.body_type == pymunk.Body.DYNAMIC:
                    inverse[places[body]] = 1 / body.mass, 1 / body.mass, 1 / body.moment
        self.inverse = inverse[self.sides]
        # What of the pushes is always the same, and where in them the other directions are.
        self._pushes = np.zeros((2 * len(self.owner), 3))
        self._pushes[: 2 * len(pivots), :2] = np.repeat(np.eye(2), len(pivots), axis=0)
        second = len(self.owner) + self.angles_from
        first = slice(self.angles_from, len(self.owner))
        self._pushes[first, 2] = self._with_a
        self._pushes[second:, 2] = self._with_b
        slid_from = 2 * len(pivots) + len(self._straight)
        self._along, self._aside = slice(2 * len(pivots), slid_from), slice(slid_from, None)

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
        joints, count, rows = len(places) // 2, self.angles_from, len(self.owner)
        apart = places[:joints] - places[joints:]

        pushes = self._pushes.copy()
        direction = pushes[:count, :2]
        if len(self._straight):
            between = apart[self._straight]
            length = np.hypot(between[:, 0], between[:, 1])[:, None]
            direction[self._along] = np.where(
                length > 0, between / np.maximum(length, 1e-300), (1.0, 0.0)
            )
        if len(self._slid):
            direction[self._aside] = turned(self._axes, yaw[joints:][self._slid])
            # The line turns with the second body, all the way out to where the first one is.
            arms[joints:][self._sliders] += apart[self._sliders]
        second = slice(rows, rows + count)
        pushes[second, :2] = -direction
        pushes[:count, 2] = _cross(arms[:joints][self._points], direction)
        pushes[second, 2] = -_cross(arms[joints:][self._points], direction)

        gaps = np.empty(rows)
        gaps[:count] = _dot(apart[self._points], direction) - self._offsets
        angles = self._with_a * yaw[:joints][self._angles]
        angles += self._with_b * yaw[joints:][self._angles]
        gaps[count:] = angles - self._comes_to
        return gaps, pushes


def _said(value: float | None) -> float:
    """Return a number that is known to be said."""
    assert value is not None  # noqa: S101 - who has none was left out
    return value


def _cross(a: Floats, b: Floats) -> Floats:
    product: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]
    return product
