# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The glyph of each kind of joint: coil, rod, rope, axle, motor, track, toothed wheels.

Law: a glyph is a list of line strips, whose corners are relative to the two points of the joint.
RViz and Rerun draw them by `JointGlyphs`, which places them by the poses of a frame; the page has
symbols of its own, in pixels, with the same counts (`SYMBOLS`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.appearance.rope_corners import corner_count
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint

# Turns of a coil, turns of the spiral of a torsion spring, teeth of a wheel.
_COILS, _SPIRAL, _TEETH = 8, 3, 10
# Half the length of the track of a slider without limits [half sizes of its symbol].
_TRACK = 8
# The constants of `sketchpad/page/view/joint_view.js`, into which `make tables` writes them.
SYMBOLS = {'COILS': _COILS, 'SPIRAL': _SPIRAL, 'TEETH': _TEETH, 'TRACK': _TRACK}
# Corners of a turn of a coil, of a circle, of a rope.
_COIL_STEPS, _CIRCLE, _ROPE = 8, 16, 12


@dataclass(frozen=True, slots=True)
class Corner:
    """
    A corner of a line strip, relative to the two points of a joint.

    :param along: share of the segment from the first to the second point
    :param across: offset to the left of that segment [m]
    :param sag: share of the sag of a slack rope
    :param arm: offset in the frame of a body [m]
    :param on_b: whether that body is b, not a
    """

    along: float = 0.0
    across: float = 0.0
    sag: float = 0.0
    arm: tuple[float, float] = (0.0, 0.0)
    on_b: bool = False


Strip = list[Corner]
# Each corner of the line of a rope past its guides, of which `JointGlyphs` knows the place.
ON_PATH = Corner(0.5)


def is_rigid(strip: Strip) -> bool:
    """Return whether a strip keeps its form, about one point in the frame of one body."""
    first = strip[0]
    return first.along in {0.0, 1.0} and all(
        (each.along, each.across, each.sag, each.on_b) == (first.along, 0.0, 0.0, first.on_b)
        for each in strip
    )


def joint_strips(joint: Joint, size: float) -> list[Strip]:
    """
    Return the line strips of a joint; a kind without lines of its own is a line with two ends.

    :param size: half the size of its symbol [m]
    """
    match joint.kind:
        case JointKind.PIN:
            corners = ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))
            return [[Corner(arm=(size * x, size * y)) for x, y in corners]]
        case JointKind.AXLE | JointKind.MOTOR:
            return _axle(joint, size)
        case JointKind.SPRING:
            return [list(_coil(size)), _circle(size / 2), _circle(size / 2, at=1.0)]
        case JointKind.ROD:
            sides = [[Corner(0.0, side), Corner(1.0, side)] for side in (-size / 3, size / 3)]
            return [*sides, _circle(size / 2), _circle(size / 2, at=1.0)]
        case JointKind.ROPE if joint.guides:
            path = [ON_PATH] * corner_count(len(joint.guides))
            return [path, _circle(size / 3), _circle(size / 3, at=1.0)]
        case JointKind.ROPE:
            shares = np.linspace(0.0, 1.0, _ROPE + 1).tolist()
            curve = [Corner(share, sag=4 * share * (1 - share)) for share in shares]
            return [curve, _circle(size / 3), _circle(size / 3, at=1.0)]
        case JointKind.SLIDER:
            return _track(joint, size)
        case JointKind.GEAR:
            wheels = [_wheel(2 * size), _wheel(2 * size, at=1.0)]
            return [*wheels, [Corner(0.0), Corner(1.0)]]
        case JointKind.RACK:
            return [_wheel(joint.seat.length), _teeth(joint)]
        case _:
            return [[Corner(0.0), Corner(1.0)], _circle(size / 2), _circle(size / 2, at=1.0)]


def _axle(joint: Joint, size: float) -> list[Strip]:
    if joint.kind is JointKind.MOTOR:
        return [_circle(size), *_arrow(2 * size, math.copysign(1.0, joint.number('rate')))]
    return [_circle(size), *([_spiral(size)] if joint.stiffness else [])]


def _circle(radius: float, at: float = 0.0) -> Strip:
    angles = np.linspace(0.0, math.tau, _CIRCLE + 1).tolist()
    return [Corner(at, arm=_polar(radius, angle), on_b=at > 0) for angle in angles]


def _polar(radius: float, angle: float) -> tuple[float, float]:
    return radius * math.cos(angle), radius * math.sin(angle)


def _spiral(size: float) -> Strip:
    """Return the spiral of a torsion spring, which turns with its body a."""
    corners = []
    for number in range(_SPIRAL * _CIRCLE + 1):
        angle, reach = math.tau * number / _CIRCLE, size * (1.0 + number / _CIRCLE / 2.0)
        corners.append(Corner(arm=_polar(reach, angle)))
    return corners


def _wheel(radius: float, at: float = 0.0) -> Strip:
    """Return a toothed circle that turns with its body."""
    strip = []
    for number in range(2 * _TEETH + 1):
        for half in (-0.4, 0.4):
            angle = (number + half) * math.pi / _TEETH
            reach = radius * (1.15 if number % 2 else 0.85)
            strip.append(Corner(at, arm=_polar(reach, angle), on_b=at > 0))
    return strip


def _teeth(joint: Joint) -> Strip:
    """Return the teeth of a rack, as far apart as those of its pinion, in the frame of b."""
    seat = joint.seat
    pitch = math.tau * seat.length / _TEETH
    strip = []
    for number in range(-2 * _TEETH, 2 * _TEETH + 1):
        for half in (-0.4, 0.4):
            along, down = (number + half) * pitch / 2, pitch * (0.2 if number % 2 else -0.2)
            arm = seat.ux * along + seat.uy * down, seat.uy * along - seat.ux * down
            strip.append(Corner(1.0, arm=arm, on_b=True))
    return strip


def _arrow(radius: float, sense: float) -> list[Strip]:
    """Return an arc with a head, counter-clockwise where the sense is positive."""
    angles = (sense * np.linspace(0.0, 1.5 * math.pi, _CIRCLE + 1)).tolist()
    arc = [Corner(arm=_polar(radius, angle)) for angle in angles]
    # The arc ends at its lowest point, with a horizontal tangent.
    x, y = 0.0, -radius
    barb = 0.5 * radius
    head = [(x - barb, y + barb * 0.8), (x, y), (x - barb, y - barb * 0.8)]
    return [arc, [Corner(arm=(arm_x, sense * arm_y)) for arm_x, arm_y in head]]


def _coil(size: float) -> Iterator[Corner]:
    yield Corner(0.0)
    count = _COILS * _COIL_STEPS
    for number in range(count + 1):
        angle = math.tau * number / _COIL_STEPS
        yield Corner(0.1 + 0.8 * number / count, size * math.sin(angle))
    yield Corner(1.0)


def _track(joint: Joint, size: float) -> list[Strip]:
    """Return a line with stops, in the frame of b, and the block that slides along it."""
    seat, properties = joint.seat, joint.properties
    least = -_TRACK * size if properties.lower is None else properties.lower
    most = _TRACK * size if properties.upper is None else properties.upper

    def at(along: float, across: float) -> tuple[float, float]:
        return seat.ux * along - seat.uy * across, seat.uy * along + seat.ux * across

    rail = [Corner(1.0, arm=at(end, 0.0), on_b=True) for end in (least, most)]
    stops = [
        [Corner(1.0, arm=at(end, side), on_b=True) for side in (-size, size)]
        for end, limit in ((least, properties.lower), (most, properties.upper))
        if limit is not None
    ]
    corners = ((1.5, 1), (-1.5, 1), (-1.5, -1), (1.5, -1), (1.5, 1))
    block = [Corner(arm=at(x * size, y * size * 0.8), on_b=True) for x, y in corners]
    return [rail, *stops, block]
