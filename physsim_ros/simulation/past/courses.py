# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Courses: a tree of the courses of events, one of which is in force.

A request in the past starts a new course; what lay ahead of it is cut off the log and kept as the
tail of the course that is left. Each course that was left begins in the log of another one, its
parent, at the moment at which the two part.

Law: a course that is returned to has the same requests and checkpoints as before, and so the same
bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from physsim_ros.model.errors import OutOfHistory
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.records import is_beyond, Moment, Tail

# Courses that are kept, at most, as many as a person tells apart; the one that was left first
# goes first.
MOST_COURSES = 16


@dataclass(slots=True, eq=False)
class LeftCourse:
    """
    A course that is not in force.

    :param number: of the course
    :param parent: number of the course in whose log it begins
    :param begins: the moment at which the two part
    :param tail: its log and checkpoints from there on

    :ivar size: memory that these take [bytes]
    """

    number: int
    parent: int
    begins: Moment
    tail: Tail
    size: int = field(init=False)

    def __post_init__(self) -> None:
        self.size = self.tail.size


class Courses:
    """
    The courses of one history.

    :param numbers: yields the numbers of new courses

    :ivar current: number of the course in force
    """

    def __init__(self, numbers: Iterator[int]) -> None:
        self._numbers = numbers
        self.current = next(numbers)
        self._left: dict[int, LeftCourse] = {}

    @property
    def size(self) -> int:
        """Return the memory that the courses take that were left [bytes]."""
        return sum(course.size for course in self._left.values())

    def drop_oldest(self) -> int:
        """Drop the course that was left first; return the memory that it took [bytes]."""
        before = self.size
        self._drop([*self._left.values()][:1])
        return before - self.size

    def reachable(self, history: History) -> list[LeftCourse]:
        """Return the courses that can be returned to, by number."""
        self._drop(each for each in self._left.values() if self._is_lost(each, history))
        # A course that begins in a log that was undone is not reachable until that is redone.
        found, parents = [], {self.current}
        for course in sorted(self._left.values(), key=lambda course: course.begins):
            cut = course.parent == self.current and is_beyond(course.begins, history.end)
            if course.parent in parents and not cut:
                parents.add(course.number)
                found.append(course)
        return sorted(found, key=lambda course: course.number)

    def branch(self, begins: Moment, tail: Tail) -> int:
        """
        Begin a new course, and keep the one that was in force.

        :param begins: the moment at which they part
        :param tail: of the course that is left
        :return: number of the course that is left
        """
        left = self._leave(begins, tail, next(self._numbers))
        if len(self._left) > MOST_COURSES:
            self.drop_oldest()
        return left

    def drop_after(self, moment: Moment) -> None:
        """Drop the courses that part later than at a moment: the log goes on differently."""
        current = self.current
        self._drop(
            each
            for each in self._left.values()
            if each.parent == current and is_beyond(each.begins, moment)
        )

    def path_to(self, number: int, history: History) -> list[LeftCourse]:
        """
        Return the courses to return to one after the other, the last of which has that number.

        :raises OutOfHistory: it is kept no more
        """
        path: list[LeftCourse] = []
        known = {course.number: course for course in self.reachable(history)}
        while number != self.current:
            if number not in known:
                raise OutOfHistory(f'course {number} is not kept', field='course')
            path.insert(0, known[number])
            number = known[number].parent
        return path

    def exchange(self, course: LeftCourse, tail: Tail) -> None:
        """
        Put a course in force that begins in the one in force now.

        :param tail: of the course that is left instead
        """
        del self._left[course.number]
        self._leave(course.begins, tail, course.number)

    def _leave(self, begins: Moment, tail: Tail, number: int) -> int:
        """Leave the course in force for another one, with which it has the log up to a moment."""
        old, self.current = self.current, number
        for each in self._left.values():
            if each.parent == old and not is_beyond(each.begins, begins):
                each.parent = number
        self._left[old] = LeftCourse(old, number, begins, tail)
        return old

    def _is_lost(self, course: LeftCourse, history: History) -> bool:
        """Return whether the checkpoint before a course's beginning is kept no more."""
        oldest = history.checkpoints[0].moment
        return course.parent == self.current and course.tail.after < oldest

    def _drop(self, courses: Iterator[LeftCourse] | list[LeftCourse]) -> None:
        """Drop courses, and those that begin in them."""
        dropped = [course.number for course in courses]
        while dropped:
            number = dropped.pop()
            self._left.pop(number, None)
            dropped += [each.number for each in self._left.values() if each.parent == number]
