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
