# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Texts about the past for people: the status of the timeline, and phrases for gestures."""

from __future__ import annotations

from physsim_ros.model import requests
from physsim_ros.model.timeline import CourseSpan, TimelineStatus
from physsim_ros.simulation.past.node import Moment, Node
from physsim_ros.simulation.past.tree import Tree


def timeline_status(tree: Tree, shown: Moment, speed: float, rate: float) -> TimelineStatus:
    """
    Return the status of the timeline in force.

    :param shown: the moment that is shown
    :param speed: simulation seconds a second
    :param rate: steps a second of simulation time [Hz]
    """
    if speed < 0.0:
        state = 'rewinding'
    elif shown != tree.end:
        state = 'in the past'
    else:
        state = 'playing' if speed else 'paused'
    gesture, undo = tree.last_gesture(shown[1]), ''
    if gesture is not None:
        undo = gesture_phrase(*gesture)
    elif tree.undoes_reset(shown[1]):
        undo = 'reset'
    redo = tree.undone[-1].words if tree.has_undone else ''
    return TimelineStatus(
        state=state,
        speed=speed,
        oldest=tree.oldest / rate,
        now=shown[0] / rate,
        newest=tree.head / rate,
        course=tree.course,
        undo=undo and f'undo {undo}',
        redo=redo and f'redo {redo}',
        courses=tuple(
            CourseSpan(line.course, min(step, line.head) / rate, line.head / rate)
            for line, step in sorted(tree.courses_left(), key=lambda each: each[0].course)
        ),
    )


# Verb of the requests whose class name is no verb, and object of those that concern no single body
# or joint.
_PHRASES = {
    requests.Axle: ('join axle', ''),
    requests.ChangeBody: ('change', ''),
    requests.Command: ('set motion of', 'several bodies'),
    requests.Configure: ('change', 'settings'),
    requests.Cut: ('cut', 'several bodies'),
    requests.DeleteAll: ('delete', 'all bodies'),
    requests.DeleteBodies: ('delete', 'several bodies'),
    requests.DriveRobot: ('drive', ''),
    requests.Grab: ('drag', ''),
    requests.GrabToPlace: ('place', ''),
    requests.LetGo: ('drag', ''),
    requests.MoveBodies: ('move', 'several bodies'),
    requests.Pin: ('join pin', ''),
    requests.Restore: ('load', 'world'),
    requests.Unjoin: ('delete joint', ''),
    requests.UnjoinAll: ('delete', 'all joints'),
}


def gesture_phrase(first: Node, count: int) -> str:
    """
    Return the phrase by which undo and redo name a gesture: `spawn ball/0 and 2 more`.

    :param first: its first request
    :param count: number of its requests
    """
    request = first.request
    verb, several = _PHRASES.get(type(request), (type(request).__name__.lower(), ''))
    if isinstance(request, requests.Join):
        verb = f'join {request.kind}'
    phrase = f'{verb} {first.subject or several}'.rstrip()
    namespace = getattr(request, 'namespace', None)
    if namespace is not None:
        phrase += f' of {namespace or "no namespace"}'
    # All moves of a hand are one drag.
    more = count > 1 and not isinstance(request, requests.Grab)
    return f'{phrase} and {count - 1} more' if more else phrase
