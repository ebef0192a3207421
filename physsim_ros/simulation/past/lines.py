# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Lines of events that are not in force: courses that were left, undone lines, lines before resets.

Law: a line is independent of other lines; its ghost has the frames that it has shown, to the bit,
and no others. See `tree` for the theory of operation.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.past.frame_cache import CachedFrame, size_of_frames
from physsim_ros.simulation.past.tree import Node, Tree

# Greatest number of courses that are kept, as many as a person tells apart; the one that was left
# first is dropped first.
MOST_COURSES = 16


@dataclass(slots=True, eq=False, kw_only=True)
class Line:
    """
    A line of events, and the moment at which it was left.

    :param tip: its last node
    :param head: the last step that it has reached
    :param moment: at which it is shown when it is in force again; a serial of None is that with
        which the step was shown
    :param course: number of its course
    :param era: number of resets before it
    :param words: phrase for the gesture that was undone in it; '' is none

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


class Lines:
    """
    The lines that are not in force.

    :param tree: with all lines

    :ivar left: courses that were left, by number, in the order in which they were left
    :ivar undone: lines to which redo returns, the next one last
    :ivar resets: lines before each reset, the latest last
    """

    def __init__(self, tree: Tree) -> None:
        self._tree = tree
        self.left: dict[int, Line] = {}
        self.undone: list[Line] = []
        self.resets: list[Line] = []

    def __iter__(self) -> Iterator[Line]:
        """Iterate over all lines, the first to be dropped first."""
        yield from self.left.values()
        yield from self.undone
        yield from self.resets

    def keep_ghost(self, line: Line, ghost: Sequence[CachedFrame]) -> None:
        """Keep the frames that a line has shown, in the order of time."""
        line.ghost = [frame._replace(contacts=None) for frame in ghost]
        line.size = size_of_frames(line.ghost)
        self._tree.size += line.size

    def drop(self, line: Line) -> None:
        """Drop a line."""
        if self.left.get(line.course) is line:
            del self.left[line.course]
        for stack in (self.undone, self.resets):
            if line in stack:
                stack.remove(line)
        self.drop_ghost(line)
        self._tree.release(line.tip)

    def drop_ghost(self, line: Line) -> None:
        """Drop the ghost of a line."""
        self._tree.size -= line.size
        line.ghost, line.size = [], 0

    def clear_undone(self, era: int) -> None:
        """Drop the undone lines, and the courses of eras that were undone: there is no redo."""
        undone = [line for line in self.left.values() if line.era > era]
        for line in [*self.undone, *undone]:
            self.drop(line)

    def drop_where(self, is_lost: Callable[[Line], bool]) -> None:
        """
        Drop the lines for which a function is true.

        Redo returns to one undone line after another: those behind a lost one go with it.
        """
        lost = [line for line in self if is_lost(line)]
        places = [place for place, line in enumerate(self.undone) if line in lost]
        behind = self.undone[: max(places, default=0)]
        for line in [*lost, *(line for line in behind if line not in lost)]:
            self.drop(line)

    def drop_oldest_ghost(self) -> bool:
        """Drop the ghost of the line that was left first; return whether there was one."""
        line = next((line for line in self if line.size), None)
        if line is not None:
            self.drop_ghost(line)
        return line is not None

    def drop_oldest(self) -> bool:
        """Drop the first line; return whether there was one."""
        line = next(iter(self), None)
        if line is not None:
            self.drop(line)
        return line is not None

    def ghost_at(self, course: int, step: int) -> Snapshot | None:
        """Return the last snapshot that a course has shown up to a step, if it is kept."""
        line = self.left.get(course)
        ghost = line.ghost if line is not None else []
        place = bisect_right(ghost, step, key=lambda frame: frame.snapshot.step)
        return ghost[place - 1].snapshot if place else None
