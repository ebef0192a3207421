# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Grips: the bodies that hands have grabbed."""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.model.transform import Point


class Grip(NamedTuple):
    """
    The grip of a hand on a body; Box2D's mouse joint.

    :ivar hand: name of the hand, unique in its world
    :ivar body: name of the body
    :ivar anchor: point of the body that is drawn to the hand, in the body's frame [m]
    :ivar target: position of the hand in the world [m]
    """

    hand: str
    body: str
    anchor: Point
    target: Point
