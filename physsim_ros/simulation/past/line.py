# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A line of events: its requests and checkpoints; the one in force is flat, by step and by serial.

Laws: a moment is a step and the number of requests up to it, the serial of the last one; requests
are counted from the beginning of the world, and a serial never changes.

Time mostly goes on at the end of the line: there, nothing is searched for.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.names import ADDED, BODY, JOINT
from physsim_ros.model.requests import Request, Restore
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.sizes import request_size
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.model.translation import Text


class Moment(NamedTuple):
    """
    A moment of a line.

    :ivar step: of the world
    :ivar serial: number of requests up to it
    """

    step: int
    serial: int


class Keyframe(NamedTuple):
    """
    A checkpoint on a line: with its moment, and the digest that each replay must have there.

    :ivar step: of the checkpoint
    :ivar serial: number of requests up to it
    :ivar checkpoint: at that moment
    :ivar digest: of the world then
    :ivar size: memory of the checkpoint [bytes]
    """

    step: int
    serial: int
    checkpoint: Checkpoint
    digest: str
    size: int

    @property
    def moment(self) -> Moment:
        """Return step and serial."""
        return Moment(self.step, self.serial)


class CachedFrame(NamedTuple):
    """
    The state after a step, as it was shown.

    :ivar snapshot: of the world
    :ivar contacts: since the frame before; None if contacts were not reported
    """

    snapshot: Snapshot
    contacts: Contacts | None

    def copy(self) -> CachedFrame:
        """Return a copy whose snapshot has no cached properties."""
        return CachedFrame(self.snapshot.copy(), self.contacts)


class Loaded(NamedTuple):
    """
    The state that was loaded last.

    :ivar serial: of the request that loaded it; 0 for the root
    :ivar state: that was loaded
    """

    serial: int
    state: WorldState


@dataclass(slots=True, eq=False, kw_only=True)
class Node:
    """
    A request that changed the world, and the run of the world up to the next one.

    :param parent: the node before; None at the root
    :param step: at which it was applied, and branches off the run of its parent
    :param request: that was applied; of a root, the one that loads the state
    :param settings: of the world after the request
    :param gesture: number of its gesture; requests of one gesture are undone together
    :param author: name of the person who did it; '' is nobody
    :param subject: name of the body or joint concerned, or ''
    :param joined: names of the bodies whose joints it added, replaced or removed
    :param adds: whether it has added a body or joint
    :param shown: whether its step was shown with it; in a running world, a request is first shown
        in the next frame

    :ivar serial: number of requests from the beginning of the world to this one
    :ivar gesture_start: serial of the first request of the gesture
    :ivar size: memory of the request [bytes], that of a root is not counted
    :ivar after: step of the last checkpoint of its parent before it; -1 is none
    :ivar loaded: the state that was loaded last
    :ivar total: memory of all requests from the beginning to this one [bytes]
    :ivar end: the last step that was reached without another request
    :ivar keyframes: up to that step
    :ivar users: number of children, and of lines that end with it
    """

    parent: Node | None
    step: int
    request: Request
    settings: WorldSettings
    gesture: int = 0
    author: str = ''
    subject: str = ''
    joined: frozenset[str] = frozenset()
    adds: bool = False
    shown: bool = False
    serial: int = field(init=False, default=0)
    gesture_start: int = field(init=False, default=0)
    size: int = field(init=False, default=0)
    after: int = field(init=False, default=-1)
    loaded: Loaded = field(init=False)
    total: int = field(init=False, default=0)
    end: int = field(init=False)
    keyframes: list[Keyframe] = field(init=False, default_factory=list)
    users: int = field(init=False, default=0)

    def phrase(self, count: int) -> str:
        """
        Return the phrase for a gesture that begins with it: `spawn ball/0 and 2 more`.

        :param count: number of requests of the gesture
        """
        phrase = self.request.phrase(self.subject)
        more = count > 1 and not self.request.is_whole_gesture
        return (
            Text('{gesture} and {count} more', gesture=phrase, count=count - 1) if more else phrase
        )

    def __post_init__(self) -> None:
        self.end, parent = self.step, self.parent
        if parent is not None:
            self.serial, self.size = parent.serial + 1, request_size(self.request)
            self.total = parent.total + self.size
            steps = (keyframe.step for keyframe in parent.keyframes)
            self.after = max((step for step in steps if step <= self.step), default=-1)
            self.loaded = parent.loaded
            parent.users += 1
        if isinstance(self.request, Restore):
            self.loaded = Loaded(self.serial, self.request.state)


@dataclass(slots=True, eq=False, kw_only=True)
class Line:
    """
    A line of events that is not in force, and the moment at which it was left.

    :param tip: its last node
    :param head: the last step that it has reached
    :param moment: at which it was left
    :param course: number of its course
    :param reset_count: number of resets before it
    :param words: phrase for the gesture that was undone in it, or for the reset after it; '' is
        none

    :ivar frames: that only it has shown, in the order of time; of a course that was left
    :ivar size: memory of these frames [bytes]
    """

    tip: Node
    head: int
    moment: Moment
    course: int
    reset_count: int
    words: str = ''
    frames: list[CachedFrame] = field(default_factory=list)
    size: int = 0


class LineInForce:
    """
    The nodes and checkpoints of the line in force, from the oldest that is kept.

    :param length: number of steps that are kept, which the tree may change
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
        self._gesture_starts: dict[int, int] = {}

    # Changes, by the tree

    def replace_after(self, kept: int, nodes: Sequence[Node], head: int) -> list[Node]:
        """
        Keep some nodes, replace those after them by others, and return those replaced.

        :param kept: number of nodes that are kept
        :param head: the last step that the line has reached then
        """
        left, self.head = self.nodes[kept:], head
        self.nodes[kept:] = nodes
        if left:
            self._gesture_starts.clear()
        if not kept:
            self.keyframes.clear()
        for node in self.nodes if left else nodes:
            self._gesture_starts[node.gesture] = node.gesture_start
        # Keyframes of the last node in common depend on the node after it.
        last = max(0, kept - 1)
        while self.keyframes and self.keyframes[-1].serial >= self.nodes[last].serial:
            self.keyframes.pop()
        for node, following in pairwise(self.nodes[last:]):
            self.keyframes += [
                keyframe for keyframe in node.keyframes if keyframe.step <= following.after
            ]
        self.keyframes += self.tip.keyframes
        return left

    def begin_at(self, place: int) -> Node:
        """Drop what is before a keyframe, by its place; return its node, the root from then on."""
        root = self.node(self.keyframes[place].serial)
        del self.keyframes[:place]
        del self.nodes[: root.serial - self._first]
        # A gesture that began before the root keeps its start, the serial of a dropped node.
        self._gesture_starts = {each.gesture: each.gesture_start for each in self.nodes}
        return root

    def add_keyframe(self, keyframe: Keyframe) -> None:
        """Add a keyframe of the tip, the last one."""
        self.tip.keyframes.append(keyframe)
        self.keyframes.append(keyframe)

    def reach(self, step: int) -> None:
        """Extend the line to a step, which the world has reached."""
        self.tip.end = max(self.tip.end, step)
        self.head = max(self.head, step)

    @contextmanager
    def reaching(self, step: int) -> Iterator[None]:
        """Have the line count as reached up to a step, while others act within the block."""
        reached, self.head = self.head, step
        yield
        # No `finally`: an exception in the block has put another line in force.
        self.head = reached

    def mark_shown(self, step: int, serial: int) -> None:
        """Mark the requests of a step up to a serial as shown."""
        place = serial - self._first
        while place > 0 and self.nodes[place].step == step and not self.nodes[place].shown:
            self.nodes[place].shown = True
            place -= 1

    # Moments

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
        return Moment(self.head, self.tip.serial)

    @property
    def _first(self) -> int:
        return self.nodes[0].serial if self.nodes else 0

    def apart_from(self, tip: Node) -> tuple[int, list[Node]]:
        """
        Return the number of nodes in common with another line, and its other nodes.

        :param tip: of the other line
        """
        apart: list[Node] = []
        node: Node | None = tip
        while node is not None:
            place = node.serial - self._first
            if 0 <= place < len(self.nodes) and self.nodes[place] is node:
                return place + 1, apart[::-1]
            apart.append(node)
            node = node.parent
        return 0, apart[::-1]

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
            return self.keyframes[-1], self.head
        place = bisect_left(self.keyframes, step, key=lambda each: each.step)
        first = self.keyframes[max(0, place - 1)]
        end = self.head
        if place < len(self.keyframes):
            end = min(end, self.keyframes[place].step)
        return first, end

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

    def start_of(self, node: Node) -> int:
        """Return the serial of the first request of the gesture of a node, which may be new."""
        return min(self._gesture_starts.get(node.gesture, node.serial), node.serial)

    def last_gesture(self, serial: int) -> tuple[Node, int] | None:
        """
        Return the first request of the last gesture up to a serial.

        :return: its node, and the number of requests from there to the serial, those of other
            gestures included, since an undo goes back before them; None if the beginning of the
            gesture is not kept, since it is undone as a whole or not at all
        """
        if serial <= self._first:
            return None
        start = self.node(serial).gesture_start
        return (self.node(start), serial - start + 1) if start > self._first else None

    def last_gesture_of(self, author: str) -> Node | None:
        """Return the first request of the last gesture of a person; None if none is kept."""
        for node in reversed(self.nodes[1:]):
            if node.author == author:
                return self.node(node.gesture_start) if node.gesture_start > self._first else None
        return None

    def added_by(self, author: str, scene: Scene) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """
        Return the bodies and the joints of a scene that a person was the last to add.

        What others have changed in place stays theirs who added it.
        """
        bodies: dict[str, str] = {}
        joints: dict[str, str] = {}
        for node in (each for each in self.nodes[1:] if each.adds):
            bodies |= dict.fromkeys(node.request.noted(BODY, ADDED), node.author)
            if node.request.FOUND == JOINT:
                joints[node.subject] = node.author
        return (
            tuple(name for name in scene.names if bodies.get(name) == author),
            tuple(joint.name for joint in scene.joints if joints.get(joint.name) == author),
        )

    def moment_before_gesture(self, gesture: int, serial: int) -> Moment | None:
        """Return the moment before the first request of a gesture up to a serial, if kept."""
        start = self._gesture_starts.get(gesture, serial + 1)
        kept = self._first < start <= serial
        return Moment(self.node(start).step, start - 1) if kept else None
