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
Requests: everything that can be asked of a world, as frozen values.

A constructor checks the values of its request alone; the world checks them against its bodies when
it applies the request. Poses are (x, y, yaw) in metres and radians, in the world or, where `frame`
names a body, relative to that body as it is when the request is applied. Start with `bodies`. A
new request is a class here, a member of a union below, and a method of `simulation.world`.
"""

from physsim_ros.model.requests.at_point import Anchor, AtPoint, Axle, Pin, Release
from physsim_ros.model.requests.bodies import (
    ChangeBody,
    Delete,
    DeleteAll,
    DeleteBodies,
    MoveBodies,
    Spawn,
)
from physsim_ros.model.requests.command import Command
from physsim_ros.model.requests.hands import (
    Grab,
    GrabToPlace,
    KeepHand,
    LetGo,
    MoveHand,
    PlaceHand,
)
from physsim_ros.model.requests.joints import Join, join_from, joined_from, Unjoin, UnjoinAll
from physsim_ros.model.requests.world import Configure, Restore

BodyRequest = (
    Spawn
    | ChangeBody
    | MoveBodies
    | Command
    | Anchor
    | Release
    | Delete
    | DeleteBodies
    | DeleteAll
)
JointRequest = Join | Unjoin | UnjoinAll | Pin | Axle
HandRequest = Grab | MoveHand | KeepHand | LetGo
Request = BodyRequest | JointRequest | HandRequest | Configure | Restore

__all__ = [
    'Anchor',
    'AtPoint',
    'Axle',
    'BodyRequest',
    'ChangeBody',
    'Command',
    'Configure',
    'Delete',
    'DeleteAll',
    'DeleteBodies',
    'Grab',
    'GrabToPlace',
    'HandRequest',
    'Join',
    'JointRequest',
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
]
