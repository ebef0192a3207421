# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The phrase for a gesture, by which undo and redo name it: `spawn ball/0 and 2 more`.

Law: a phrase is a verb and its object, so that it reads well after undo, redo and undid.
"""

from __future__ import annotations

from physsim_ros.model import requests
from physsim_ros.simulation.past.tree import Node

# Verb of the requests whose class name is no verb, and object of those that concern no single body
# or joint.
_PHRASES = {
    requests.ChangeBody: ('change', ''),
    requests.Command: ('set motion of', 'several bodies'),
    requests.Configure: ('change', 'settings'),
    requests.DeleteAll: ('delete', 'all bodies'),
    requests.DeleteBodies: ('delete', 'several bodies'),
    requests.DriveRobot: ('drive', ''),
    requests.Grab: ('drag', ''),
    requests.GrabToPlace: ('place', ''),
    requests.LetGo: ('drag', ''),
    requests.MoveBodies: ('move', 'several bodies'),
    requests.Restore: ('load', 'world'),
    requests.Unjoin: ('delete', ''),
    requests.UnjoinAll: ('delete', 'all joints'),
}


def gesture_phrase(first: Node, count: int) -> str:
    """
    Return the phrase for a gesture.

    :param first: its first request
    :param count: number of its requests
    """
    request = first.request
    verb, several = _PHRASES.get(type(request), (type(request).__name__.lower(), ''))
    phrase = f'{verb} {first.subject or several}'.rstrip()
    namespace = getattr(request, 'namespace', None)
    if namespace is not None:
        phrase += f' of {namespace or "no namespace"}'
    # All moves of a hand are one drag.
    more = count > 1 and not isinstance(request, requests.Grab)
    return f'{phrase} and {count - 1} more' if more else phrase
