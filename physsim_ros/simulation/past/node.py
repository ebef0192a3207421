# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past as one version tree: the theory, and what the tree is made of.

Theory of operation
-------------------

*Nodes.* A node is a request that changed the world, with the run of the world after it: the
checkpoints that were made up to the next request, and the last step that was reached. Its parent
is the request before. The root is the state with which the world began. The requests from the root
to a node, each at its step, decide every bit of the world; two requests after the same one are two
branches. Nodes never change: a node is added at an end, and removed when nothing uses it.

*The cursor.* A line of events is a node, its tip, with the last step that was reached there, its
head. One line is in force. The tree has it as flat lists, from the oldest checkpoint that is kept
to the tip. The cursor is a world at a moment of that line: a step, and the number of requests up
to it, the serial of the last one. Everything that a person does with time moves it:

- Rewind, seek and play move it to another moment of the line in force.
- A request adds a node at the cursor, the new tip. If steps or requests lay ahead, that line is
  left as a course, with its number, and the line in force gets the next number.
- Undo moves it to the moment before a gesture. The node before it is the new tip, and the line
  keeps the number of its course. The line with the gesture is kept for redo, until the next
  request.
- Redo moves it back to the line and the moment of the undo.
- The return to a course moves it to that line. The line that was in force is left as a course.
- Reset moves it to a root of its own, with the state that was loaded last. The line before is
  kept, and undo at the root returns to it.

*A course after an undo in it* ends where the undo went, and continues from there. The undone
gesture is lost with the next request, or with the return to another course. Other courses lose
nothing, even if they began in the undone gesture: each is a line with all of its requests.

*Checkpoints* belong to a node; with its moment and the digest of the world, a checkpoint is a
keyframe. At each one the world moves into a space that is built from it, and so does every line
that passes it; a line that parted before it does not. Several lines may run from one node: they
have the same bits, and the first line at a step makes the checkpoint that all lines use. A request
at the step of a checkpoint comes before or after it, which `Node.after` says. The requests alone
decide when a checkpoint is due, not the frames in which steps are made.

*Dropping.* The tree counts the users of each node: its children and the lines that end with it. A
node without users is removed. The oldest checkpoint of the line in force is the root of all
moments that can be shown: when it is dropped, the next one replaces it, and lines that part before
that are lost. `Past` has the order in which things are dropped.

*Ghosts* are the frames that a course has shown, and keeps when it is left. The frames of the line
in force are in the frame cache.

Source: Driscoll, Sarnak, Sleator, Tarjan, "Making data structures persistent", 1989, full
persistence. Editors know such a tree as an undo tree.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.requests import HandRequest, Request, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts, Snapshot

# A step, and the number of requests up to it.
Moment = tuple[int, int]


class Keyframe(NamedTuple):
    """
    A checkpoint and its moment.

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
        return self.step, self.serial


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
    :param opening: serial of the first request of the gesture
    :param author: name of the person who did it; '' is nobody
    :param subject: name of the body or joint concerned, or ''
    :param adds: whether it has added a body or joint
    :param size: memory of the request [bytes]
    :param shown: whether its step was shown with it; in a running world, a request is first shown
        in the next frame

    :ivar serial: number of requests from the beginning of the world to this one
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
    opening: int = 0
    author: str = ''
    subject: str = ''
    adds: bool = False
    size: int = 0
    shown: bool = False
    serial: int = field(init=False, default=0)
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
        # All moves of a hand are one drag.
        more = count > 1 and not isinstance(self.request, HandRequest)
        return f'{phrase} and {count - 1} more' if more else phrase

    def __post_init__(self) -> None:
        self.end, parent = self.step, self.parent
        if parent is not None:
            self.serial, self.total = parent.serial + 1, parent.total + self.size
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
    :param moment: at which it is shown when it is in force again; a serial of None is that with
        which the step was shown
    :param course: number of its course
    :param era: number of resets before it
    :param words: phrase for the gesture that was undone in it, or for the reset after it; '' is
        none

    :ivar ghost: frames that it has shown, in the order of time, since it parted from the line that
        replaced it
    :ivar size: memory of the ghost [bytes]
    """

    tip: Node
    head: int
    moment: tuple[int, int | None]
    course: int
    era: int
    words: str = ''
    ghost: list[CachedFrame] = field(default_factory=list)
    size: int = 0
