# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages that drive robots."""

from __future__ import annotations

from physsim_ros.model.checks import number
from physsim_ros.model.errors import Malformed
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.transform import REST, Twist
from physsim_ros.sketchpad.message import message, Origin
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.page_session import PageSession


def _velocity(value: object, name: str) -> Twist:
    """Return vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]."""
    if not isinstance(value, list) or len(value) != 3:
        raise Malformed(f'{name} must be [forward, left, turn]', field=name)
    forward, left, turn = (number(each, name) for each in value)
    return forward, left, turn


@message('drive', 'cmd_vel', name=fields.text, velocity=_velocity)
def drive(page: PageSession, origin: Origin, name: str, velocity: Twist) -> None:
    """Drive a robot at a velocity; all commands up to one of rest are undone together."""
    driven, gesture = page.driven
    request = DriveRobot(name=name, velocity=velocity)
    gesture = page.submit(origin, (request,), gesture=gesture if driven == name else None)
    page.driven = ('', 0) if velocity == REST else (name, gesture)
