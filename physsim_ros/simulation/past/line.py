# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The line of events in force, flat: what was asked and kept, by step and by serial.

Laws: a moment is a step and the number of requests up to it, the serial of the last one; requests
are counted from the beginning of the world, and a serial never changes.

Time mostly goes on at the end of the line: there, nothing is searched for.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection

from physsim_ros.model.requests import Axle, Cut, Join, Pin, Spawn
from physsim_ros.model.scene import Scene
from physsim_ros.simulation.past.node import Keyframe, Moment, Node


class LineInForce:
    """
    The nodes and checkpoints of the line in force, from the oldest that is kept.

    :param length: number of steps that are kept
    :param spacing: greatest number of steps from one checkpoint to the next

    :ivar nodes: of the line, the root first
    :ivar keyframes: of its nodes, oldest first; also those ahead, where another line has run
        before
    :ivar head: the last step that it has reached
    """

    def __init__(self, *, length: int, spacing: int) -> None:
        self.length = length
        self.spacing = spacing
        self.nodes: list[Node] = []
        self.keyframes: list[Keyframe] = []
        self.head = 0
        # Serial of the first request of each gesture.
        self._openings: dict[int, int] = {}

    @property
    def oldest(self) -> int:
        """Return the oldest step that can be shown."""
        root, first = self.nodes[0], self.keyframes[0].step
        # The root's step was shown without its request, and so it cannot be shown again.
        begins_later = root.step == first and not root.shown
        return min(self.head, max(first + begins_later, self.head - self.length))

    @property
    def tip(self) -> Node:
        """Return the last node."""
        return self.nodes[-1]

    @property
    def end(self) -> Moment:
        """Return the last moment that was reached."""
        return self.head, self.tip.serial

    @property
    def _first(self) -> int:
        return self.nodes[0].serial if self.nodes else 0

    def node(self, serial: int) -> Node:
        """Return the node of a serial."""
        return self.nodes[serial - self._first]

    def nodes_between(self, serial: int, end: int) -> list[Node]:
        """Return the nodes after a serial, up to another one."""
        first, last = serial - self._first + 1, end - self._first + 1
        return self.nodes[first:last]

    def nodes_of(self, gestures: Collection[int]) -> list[Node]:
        """Return the requests of gestures that are kept, by the numbers of these."""
        return [node for node in self.nodes[1:] if node.gesture in gestures]

    def serial_at(self, step: int) -> int:
        """Return the serial of the last request before or at a step."""
        if self.nodes[-1].step <= step:
            return self.nodes[-1].serial
        place = bisect_right(self.nodes, step, key=lambda each: each.step)
        return self._first + max(0, place - 1)

    def serial_shown_at(self, step: int) -> int:
        """Return the serial of the last request with which a step was shown."""
        # At one step, the requests that were shown come first.
        not_shown = (step, True)
        place = bisect_left(self.nodes, not_shown, key=lambda each: (each.step, not each.shown))
        return self._first + max(0, place - 1)

    def keyframe_before(self, step: int, serial: int) -> Keyframe:
        """Return the last keyframe from which a moment can be reached."""
        place = bisect_right(self.keyframes, (step, serial), key=lambda each: each.moment)
        return self.keyframes[place - 1]

    def keyframe_at(self, step: int, serial: int) -> Keyframe | None:
        """Return the keyframe at a moment, if there is one."""
        if self.keyframes[-1].step < step:
            return None
        keyframe = self.keyframe_before(step, serial)
        return keyframe if keyframe.moment == (step, serial) else None

    def segment(self, step: int) -> tuple[Keyframe, int]:
        """Return the keyframe before a step, and the step of the next one or the last step."""
        if self.keyframes[-1].step < step:
            return self.keyframes[-1], max(step, self.head)
        place = bisect_left(self.keyframes, step, key=lambda each: each.step)
        first = self.keyframes[max(0, place - 1)]
        end = self.head
        if place < len(self.keyframes):
            end = min(end, self.keyframes[place].step)
        return first, max(step, end)

    def next_stop(self, step: int, end: int) -> int:
        """Return the next step with a request or a checkpoint, or the end."""
        if self.keyframes[-1].step > step:
            place = bisect_right(self.keyframes, step, key=lambda each: each.step)
            end = min(end, self.keyframes[place].step)
        elif (due := self.keyframes[-1].step + self.spacing) > step:
            # A checkpoint comes at the same step, however many steps are made in a call.
            end = min(end, due)
        if self.nodes[-1].step > step:
            place = bisect_right(self.nodes, step, key=lambda each: each.step)
            end = min(end, self.nodes[place].step)
        return end

    # Gestures

    def last_gesture(self, serial: int) -> tuple[Node, int] | None:
        """
        Return the first request of the last gesture up to a serial.

        :return: its node, and the number of requests from there to the serial, those of other
            gestures included, since an undo goes back before them; None if the beginning of the
            gesture is not kept, since it is undone as a whole or not at all
        """
        if serial <= self._first:
            return None
        opening = self.node(serial).opening
        return (self.node(opening), serial - opening + 1) if opening > self._first else None

    def last_gesture_of(self, author: str) -> Node | None:
        """Return the first request of the last gesture of a person; None if none is kept."""
        for node in reversed(self.nodes[1:]):
            if node.author == author:
                return self.node(node.opening) if node.opening > self._first else None
        return None

    def added_by(self, author: str, scene: Scene) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """
        Return the bodies and the joints of a scene that a person was the last to add.

        What others have changed in place stays theirs who added it.
        """
        bodies: dict[str, str] = {}
        joints: dict[str, str] = {}
        for node in (each for each in self.nodes[1:] if each.adds):
            match node.request:
                case Spawn(name=name):
                    bodies[name] = node.author
                case Cut(pieces=pieces):
                    new = (each.name for each in pieces if isinstance(each, Spawn))
                    bodies |= dict.fromkeys(new, node.author)
                case Join() | Pin() | Axle():
                    joints[node.subject] = node.author
        return (
            tuple(name for name in scene.names if bodies.get(name) == author),
            tuple(joint.name for joint in scene.joints if joints.get(joint.name) == author),
        )

    def gesture_start(self, gesture: int, serial: int) -> Moment | None:
        """Return the moment before the first request of a gesture up to a serial, if kept."""
        opening = self._openings.get(gesture, serial + 1)
        kept = self._first < opening <= serial
        return (self.node(opening).step, opening - 1) if kept else None

    def note_shown(self, step: int, serial: int) -> None:
        """Note that a step was shown with the requests up to a serial."""
        place = serial - self._first
        while place > 0 and self.nodes[place].step == step and not self.nodes[place].shown:
            self.nodes[place].shown = True
            place -= 1
