# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The tree of all lines of events: the one in force, those that were left, and their memory.

Law: a line that is not in force is independent of the others; a course keeps the frames that it
has shown, to the bit, and no others. `Past.fit_memory` has the order in which entries are dropped.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.checks import Within
from physsim_ros.model.requests import Restore
from physsim_ros.model.sizes import checkpoint_size, frame_size
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.past.line import (
    CachedFrame,
    Keyframe,
    Line,
    LineInForce,
    Moment,
    Node,
)

# Bytes of a megabyte.
MEGABYTE = 10**6
# Least and greatest budget [MB]: a second of a few hundred commands; a large machine.
LEAST_MEMORY, MOST_MEMORY = 1.0, 1e6
# Default budget [MB].
DEFAULT_MEMORY = 256.0

# Greatest number of courses that are kept, as many as a person tells apart; the one that was left
# first is dropped first.
MOST_COURSES = 16
# Share of the budget from which the requests after a checkpoint make the next one due [1], so that
# the past has at least eight parts that can be dropped.
_LOG_SHARE = 1 / 8
# Share of the budget below which the next loss is reported again [1].
_RELIEF = 1 / 2


class Budget:
    """
    The budget of the past.

    :param megabytes: the budget [MB]
    :raises BadProperty: it is out of range
    :raises Malformed: it is not a finite number

    :ivar size: the budget [bytes]
    :ivar used: memory of the past at the last count [bytes]
    """

    def __init__(self, megabytes: float) -> None:
        self.used = 0
        self.megabytes = megabytes

    @property
    def megabytes(self) -> float:
        """Return the budget [MB]."""
        return self.size / MEGABYTE

    @megabytes.setter
    def megabytes(self, megabytes: float) -> None:
        megabytes = Within(LEAST_MEMORY, MOST_MEMORY, 'MB')(megabytes, 'history_memory')
        self.size = round(megabytes * MEGABYTE)
        # Whether users know that the past was shortened.
        self._is_told = False

    @property
    def in_megabytes(self) -> tuple[float, float]:
        """Return the memory of the past at the last count, and the budget [MB]."""
        return self.used / MEGABYTE, self.megabytes

    def count(self, used: int) -> bool:
        """Note the memory of the past [bytes], and return whether it exceeds the budget."""
        self.used = used
        return used > self.size

    def note_relief(self) -> None:
        """Have the next loss be told again, where much less is used."""
        self._is_told &= self.used > _RELIEF * self.size

    def note_loss(self) -> bool:
        """Note that something was dropped, and return whether that is to be told."""
        was_told, self._is_told = self._is_told, True
        return not was_told


class Tree:
    """
    All lines of events.

    :param line: in force
    :param budget: with the memory of the requests after a checkpoint from which the next one is
        due; a checkpoint is dropped only together with the requests after it

    :ivar line: in force
    :ivar size: memory of requests, checkpoints and frames of lines that were left [bytes]
    :ivar course: number of the course of the line in force
    :ivar reset_count: number of resets before it
    :ivar left: courses that were left, by number, in the order in which they were left
    :ivar undone: lines to which redo returns, the next one last
    :ivar resets: lines before each reset, the latest last
    """

    def __init__(self, line: LineInForce, budget: Budget) -> None:
        self.line = line
        self.size = 0
        self.course, self.reset_count = 1, 0
        self.left: dict[int, Line] = {}
        self.undone: list[Line] = []
        self.resets: list[Line] = []
        self._budget = budget
        # Number of the last course that began.
        self._courses = 1
        # By tip and head of another line: the number of nodes that it has in common with this one,
        # and the step at which it parts from this one.
        self._partings: dict[tuple[Node, int], tuple[int, int | None]] = {}
        # The oldest keyframe when lines that part before it were dropped last.
        self._oldest: Keyframe | None = None

    # The line in force

    def is_checkpoint_due(self, step: int) -> bool:
        """Return whether a checkpoint is due at the tip; a loaded state begins with one."""
        last = self.line.keyframes[-1]
        long = step - last.step >= self.line.spacing or self.is_log_long
        return long or self.line.tip.loaded.serial > last.serial

    @property
    def is_log_long(self) -> bool:
        """Whether the memory of the requests since the last checkpoint exceeds the limit."""
        last = self.line.node(self.line.keyframes[-1].serial)
        return self.line.tip.total - last.total > self._budget.size * _LOG_SHARE

    def parting(self, tip: Node, head: int) -> int | None:
        """
        Return the first step at which another line differs from this one.

        :param tip: of the other line
        :param head: the last step that it has reached
        :return: None if they have no kept moment in common
        """
        if (tip, head) not in self._partings:
            line = self.line
            kept, apart = line.apart_from(tip)
            # The last step of the root's run that the other line needs a checkpoint before.
            after = apart[0].after if apart else head
            lost = kept == 0 or (kept == 1 and after < line.keyframes[0].step)
            steps = [each[0].step for each in (line.nodes[kept:], apart) if each]
            step = None if lost else min(steps, default=line.head)
            self._partings[tip, head] = kept, step
        return self._partings[tip, head][1]

    def begin(self, state: WorldState, checkpoint: Checkpoint, digest: str) -> None:
        """Begin a world at a checkpoint; the state was loaded last, at time 0."""
        step, settings = checkpoint.step, checkpoint.scene.settings
        request = Restore(state=state)
        root = Node(parent=None, step=0, request=request, settings=settings, shown=True)
        root.keyframes.append(self._keyframe(Moment(step, 0), checkpoint, digest, None))
        self.follow(root, step)

    def follow(self, tip: Node, head: int) -> int:
        """
        Put another line in force.

        :param tip: of the line
        :param head: the last step that it has reached
        :return: the first step at which it differs from the line before
        """
        kept, apart = self.line.apart_from(tip)
        tip.users += 1
        if self.line.nodes:
            self._release(self.line.tip)
        left = self.line.replace_after(kept, apart, head)
        # A line that grows parts from others where it did, but from those that it goes on from.
        same = {} if left else self._partings
        self._partings = {line: found for line, found in same.items() if found[0] < kept}
        steps = [head, *(each[0].step for each in (left, apart) if each)]
        self._drop_old()
        return min(steps) if kept else 0

    def add_request(self, node: Node) -> None:
        """Add the node of a request that changed the world, and follow it."""
        node.gesture_start = self.line.start_of(node)
        self.size += node.size
        self.follow(node, node.step)

    def add_keyframe(self, moment: Moment, checkpoint: Checkpoint, digest: str) -> None:
        """Add a checkpoint at the tip."""
        before = self.line.keyframes[-1].checkpoint
        self.line.add_keyframe(self._keyframe(moment, checkpoint, digest, before))

    def _keyframe(
        self, moment: Moment, checkpoint: Checkpoint, digest: str, before: Checkpoint | None
    ) -> Keyframe:
        """Return the keyframe of a checkpoint, whose memory counts from now on."""
        keyframe = Keyframe(*moment, checkpoint, digest, checkpoint_size(checkpoint, before))
        self.size += keyframe.size
        return keyframe

    def reach(self, step: int) -> None:
        """Extend the line in force to a step, where the world has reached it first."""
        is_new = step > self.line.head
        self.line.reach(step)
        if is_new:
            self._drop_old()

    def begin_course(self, moment: Moment, frames: Sequence[CachedFrame]) -> Line:
        """
        Leave the line in force as a course, and begin another one; return the line that was left.

        :param moment: at which it is left
        :param frames: that only it has shown
        """
        left = self.line_left_at(moment)
        self.keep_course(left, frames)
        self.drop_undone()
        self._courses += 1
        self.course = self._courses
        return left

    def keep_before_reset(self, before: Line, words: str) -> None:
        """
        Keep the line before that in force, which has begun anew, as another course.

        :param before: that line, to which an undo returns
        :param words: phrase for the reset
        """
        self.drop_undone()
        self.resets.append(replace(before, words=words))
        self._courses += 1
        self.course, self.reset_count = self._courses, self.reset_count + 1

    def put_in_force(self, line: Line) -> None:
        """Have a line whose events are in force again be kept no longer beside these."""
        self.course, self.reset_count = line.course, line.reset_count
        self.drop(line)

    def forget(self) -> None:
        """Drop all lines but the one in force, which has begun as course 1."""
        self.drop_where(lambda _: True)
        self.course = self._courses = 1

    # Lines that are not in force

    def line_left_at(self, moment: Moment) -> Line:
        """Return the line in force, left at a moment and kept from now on."""
        return self.line_to(self.line.tip, self.line.head, moment)

    def line_to(self, tip: Node, head: int, moment: Moment) -> Line:
        """Return a line of the course in force up to a node, kept from now on."""
        tip.users += 1
        return Line(
            tip=tip, head=head, moment=moment, course=self.course, reset_count=self.reset_count
        )

    def lines(self) -> Iterator[Line]:
        """Iterate over the lines that are not in force, the first to be dropped first."""
        yield from self.left.values()
        yield from self.undone
        yield from self.resets

    def courses_left(self) -> list[tuple[Line, int]]:
        """Return the courses that can be returned to, each with the step at which it parts."""
        lines = (line for line in self.left.values() if line.reset_count == self.reset_count)
        partings = ((line, self.parting(line.tip, line.head)) for line in lines)
        return [(line, step) for line, step in partings if step is not None]

    def keep_course(self, line: Line, frames: Sequence[CachedFrame]) -> None:
        """Keep a line as a course that was left, with the frames that only it has shown."""
        line.frames = [frame._replace(contacts=None) for frame in frames]
        line.size = sum(frame_size(*frame) for frame in line.frames)
        self.size += line.size
        self.left[line.course] = line
        since_reset = [each for each in self.left.values() if each.reset_count == line.reset_count]
        if len(since_reset) > MOST_COURSES:
            self.drop(since_reset[0])

    def course_snapshot(self, course: int, step: int) -> Snapshot | None:
        """Return the last snapshot that a course has shown up to a step, if it is kept."""
        line = self.left.get(course)
        frames = line.frames if line is not None else []
        place = bisect_right(frames, step, key=lambda frame: frame.snapshot.step)
        return frames[place - 1].snapshot if place else None

    def drop(self, line: Line) -> None:
        """Drop a line."""
        if self.left.get(line.course) is line:
            del self.left[line.course]
        for stack in (self.undone, self.resets):
            if line in stack:
                stack.remove(line)
        self._drop_frames(line)
        self._release(line.tip)

    def drop_undone(self) -> None:
        """Drop what redo returns to: undone lines, and courses since resets that were undone."""
        undone = [line for line in self.left.values() if line.reset_count > self.reset_count]
        for line in [*self.undone, *undone]:
            self.drop(line)

    @property
    def can_redo(self) -> bool:
        """Whether there is anything to redo."""
        return bool(self.undone) and not self._is_lost(self.undone[-1])

    def undoes_reset(self, serial: int) -> bool:
        """Return whether an undo at a serial reverts a reset: every gesture since is undone."""
        since = self.line.node(serial).gesture_start
        return since == 0 and self.line.oldest == 0 and bool(self.resets)

    def drop_lost(self) -> None:
        """Drop the lines that part from the line in force before the oldest checkpoint."""
        if self._oldest is not self.line.keyframes[0]:
            self._oldest = self.line.keyframes[0]
            self.drop_where(self._is_lost)

    def _is_lost(self, line: Line) -> bool:
        """Return whether a line parts from the line in force before the oldest checkpoint."""
        is_of_reset = line.reset_count == self.reset_count
        return is_of_reset and self.parting(line.tip, line.head) is None

    def drop_where(self, is_lost: Callable[[Line], bool]) -> None:
        """
        Drop the lines for which a function is true.

        Redo returns to one undone line after another: those behind a lost one go with it.
        """
        lost = [line for line in self.lines() if is_lost(line)]
        places = [place for place, line in enumerate(self.undone) if line in lost]
        behind = self.undone[: max(places, default=0)]
        for line in [*lost, *(line for line in behind if line not in lost)]:
            self.drop(line)

    # The budget

    def drop_oldest_frames(self) -> bool:
        """Drop the frames of the line that was left first; return whether there were any."""
        line = next((line for line in self.lines() if line.size), None)
        if line is not None:
            self._drop_frames(line)
        return line is not None

    def drop_oldest_line(self) -> bool:
        """Drop the line that was left first; return whether there was one."""
        line = next(self.lines(), None)
        if line is not None:
            self.drop(line)
        return line is not None

    def limit_length(self, length: int) -> None:
        """Set the number of steps that are kept."""
        self.line.length = length
        self._drop_old()

    def _drop_old(self) -> None:
        """Drop the checkpoints before the last one that is older than `length`."""
        keyframes, oldest = self.line.keyframes, self.line.head - self.line.length
        old = 0
        while old + 1 < len(keyframes) and keyframes[old + 1].step <= oldest:
            old += 1
        if old > 0:
            self._drop_before(old)

    def drop_oldest_checkpoint(self, shown: Moment) -> bool:
        """
        Drop the oldest checkpoint, with the requests up to the next one, if not needed.

        :param shown: the moment that is shown, which needs the checkpoint before it
        """
        if len(self.line.keyframes) == 1 or self.line.keyframes[1].moment > shown:
            return False
        self._drop_before(1)
        return True

    def _drop_before(self, place: int) -> None:
        """Drop the checkpoints before a place in the list, with their requests."""
        keyframe = self.line.keyframes[place]
        root = self.line.begin_at(place)
        kept = root.keyframes.index(keyframe)
        self.size -= root.size + sum(each.size for each in root.keyframes[:kept])
        del root.keyframes[:kept]
        parent, root.parent, root.size = root.parent, None, 0
        root.request = Restore(state=root.loaded.state)
        self._release(parent)
        self._partings.clear()

    def _drop_frames(self, line: Line) -> None:
        self.size -= line.size
        line.frames, line.size = [], 0

    def _release(self, node: Node | None) -> None:
        """Note that a line or child no longer uses a node; remove nodes without users."""
        while node is not None:
            node.users -= 1
            if node.users:
                return
            self.size -= node.size + sum(keyframe.size for keyframe in node.keyframes)
            node = node.parent
