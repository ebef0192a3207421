# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The phrase for a gesture, by which undo and redo name it: `spawn ball/0 and 2 more`.

Law: a phrase is a verb and its object, so that it reads well after undo, redo and undid.
"""

from __future__ import annotations

from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    Configure,
    DeleteAll,
    DeleteBodies,
    Grab,
    GrabToPlace,
    LetGo,
    MoveBodies,
    Restore,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.simulation.past.tree import Node

# Verbs of the requests whose class name is no verb.
_VERBS = {
    ChangeBody: 'change',
    Configure: 'change',
    DeleteAll: 'delete',
    DeleteBodies: 'delete',
    Grab: 'drag',
    GrabToPlace: 'place',
    LetGo: 'drag',
    MoveBodies: 'move',
    Restore: 'load',
    Unjoin: 'delete',
    UnjoinAll: 'delete',
}
# Objects of the requests that concern no single body or joint.
_OBJECTS = {
    Command: 'several bodies',
    Configure: 'settings',
    DeleteAll: 'all bodies',
    DeleteBodies: 'several bodies',
    MoveBodies: 'several bodies',
    Restore: 'world',
    UnjoinAll: 'all joints',
}


def gesture_phrase(first: Node, count: int) -> str:
    """
    Return the phrase for a gesture.

    :param first: its first request
    :param count: number of its requests
    """
    request = first.request
    verb = _VERBS.get(type(request), type(request).__name__.lower())
    phrase = f'{verb} {first.subject or _OBJECTS.get(type(request), "")}'.rstrip()
    if isinstance(request, DeleteAll | UnjoinAll) and request.namespace is not None:
        phrase += f' of {request.namespace or "no namespace"}'
    # All moves of a hand are one drag.
    more = count > 1 and not isinstance(request, Grab)
    return f'{phrase} and {count - 1} more' if more else phrase
