# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests: everything that can be asked of a world, as frozen values.

A constructor checks the values of its request alone; the world checks them against its bodies when
it applies the request. Poses are (x, y, yaw) in metres and radians, in the world or, where `frame`
names a body, relative to that body as it is when the request is applied. Start with `bodies`. A
new request is a class here, a member of `Request`, and a line in the table of handlers in
`simulation.world.world`.
"""

from physsim_ros.model.requests.bodies import (
    Anchor,
    AtPoint,
    ChangeBody,
    Delete,
    DeleteAll,
    DeleteBodies,
    MoveBodies,
    Release,
    Spawn,
)
from physsim_ros.model.requests.command import Command, DriveRobot
from physsim_ros.model.requests.hands import (
    Grab,
    GrabToPlace,
    KeepHand,
    LetGo,
    MoveHand,
    PlaceHand,
)
from physsim_ros.model.requests.joints import (
    Axle,
    Join,
    join_from,
    joined_from,
    Pin,
    Unjoin,
    UnjoinAll,
    unset_in,
)
from physsim_ros.model.requests.world import Configure, Restore

HandRequest = Grab | GrabToPlace | MoveHand | PlaceHand | KeepHand | LetGo
Request = (
    Spawn
    | ChangeBody
    | MoveBodies
    | Command
    | Anchor
    | Release
    | Delete
    | DeleteBodies
    | DeleteAll
    | Join
    | Unjoin
    | UnjoinAll
    | Pin
    | Axle
    | HandRequest
    | DriveRobot
    | Configure
    | Restore
)

__all__ = [
    'Anchor',
    'AtPoint',
    'Axle',
    'ChangeBody',
    'Command',
    'Configure',
    'Delete',
    'DeleteAll',
    'DeleteBodies',
    'DriveRobot',
    'Grab',
    'GrabToPlace',
    'HandRequest',
    'Join',
    'KeepHand',
    'LetGo',
    'MoveBodies',
    'MoveHand',
    'Pin',
    'PlaceHand',
    'Release',
    'Request',
    'Restore',
    'Spawn',
    'Unjoin',
    'UnjoinAll',
    'join_from',
    'joined_from',
    'unset_in',
]
