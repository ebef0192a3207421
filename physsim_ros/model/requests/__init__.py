# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests: everything that can be asked of a world, as frozen values.

A constructor checks types and values of its request alone; the world checks them against its
bodies when it applies the request. Poses are (x, y, yaw) in metres and radians, in the world or,
where `frame` names a body, relative to that body as it is when the request is applied.

Start with `request`, the base class. A new request is a class of this folder and a name below, a
handler, and its line in the table of handlers in `simulation.world.world`.
"""

from physsim_ros.model.requests.bodies import (
    Anchor,
    ChangeBody,
    Command,
    Delete,
    DeleteAll,
    DeleteBodies,
    DriveRobot,
    MoveBodies,
    Release,
    Spawn,
)
from physsim_ros.model.requests.hands import Grab, HandRequest, KeepHand, LetGo, MoveHand
from physsim_ros.model.requests.joints import (
    Axle,
    CommandMotors,
    Cut,
    Join,
    join_from,
    Pin,
    Rejoin,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.requests.parts import parts_of
from physsim_ros.model.requests.request import AtPoint, Configure, OfNamespace, Request, Restore

__all__ = [
    'Anchor',
    'AtPoint',
    'Axle',
    'ChangeBody',
    'Command',
    'CommandMotors',
    'Configure',
    'Cut',
    'Delete',
    'DeleteAll',
    'DeleteBodies',
    'DriveRobot',
    'Grab',
    'HandRequest',
    'Join',
    'KeepHand',
    'LetGo',
    'MoveBodies',
    'MoveHand',
    'OfNamespace',
    'Pin',
    'Rejoin',
    'Release',
    'Request',
    'Restore',
    'Spawn',
    'Unjoin',
    'UnjoinAll',
    'join_from',
    'parts_of',
]
