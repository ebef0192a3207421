# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The results of lessons in a world: who has answered what, right or not, when, after how many tries.

Laws: results outlive pages and restarts, in one file of the user, which one node writes; an answer
that was right is not lost by later ones. Beyond the number of results, the oldest one of the
visitor with most gives way: nobody drives out others by names or titles.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
import json
from pathlib import Path
import time
from typing import Any

from physsim_ros.files import DirectoryLock, read_bytes, write_file

# Results that are kept, each of one person and lesson: a class of thirty, and all lessons.
MOST_RESULTS = 600
# Size of the file [bytes].
_MOST_BYTES = 2**20

# The fields `person`, `lesson` (its title), `answer` as typed, `right`, `at` [s since 1970], and
# `tries` up to the first right answer.
Result = dict[str, Any]
_TYPES = {'person': str, 'lesson': str, 'answer': str, 'right': bool, 'at': int, 'tries': int}
# The person and the title.
_Key = tuple[str, str]


def results_file(world_dir: Path) -> Path:
    """Return the file of the results of a world, by the directory of its user's worlds."""
    return world_dir / '.results.json'


def read_results(path: Path) -> list[Result]:
    """Return the results of a file, the latest last; there may be no such file."""
    # A file that a person has spoilt.
    with suppress(OSError, ValueError, RecursionError):
        results = json.loads(read_bytes(path, _MOST_BYTES))
        # JSON may escape half of a surrogate pair, which no file holds.
        _text_of(results)
        if isinstance(results, list):
            return [each for each in results if _is_result(each)][-MOST_RESULTS:]
    return []


def _is_result(value: object) -> bool:
    """Return whether a value has the fields of a result, and nothing else."""
    return (
        isinstance(value, dict) and {name: type(field) for name, field in value.items()} == _TYPES
    )


def _text_of(results: object) -> bytes:
    return json.dumps(results, ensure_ascii=False).encode()


class Results:
    """
    The results of a world.

    :param path: of their file
    :param lock: of its directory
    """

    def __init__(self, path: Path, lock: DirectoryLock) -> None:
        self._path = path
        self._lock = lock
        # Who has noted a result; those of earlier starts were noted by their persons.
        self._visitors: dict[_Key, str] = {}
        self._read()

    def _read(self) -> None:
        """Read the file, which no other node changes if the lock is held."""
        self._is_own = self._lock.is_held
        self._results = {
            (each['person'], each['lesson']): each for each in read_results(self._path)
        }

    def __iter__(self) -> Iterator[Result]:
        """Iterate over the results, the latest last."""
        return iter(self._results.values())

    def note(self, person: str, lesson: str, answer: str, *, right: bool, visitor: str) -> Result:
        """
        Note an answer, and return what is known of it.

        :param lesson: title of the lesson
        :param visitor: who it is, whatever name is chosen
        :raises InUse: another node writes the file; nothing is noted
        :raises OSError: the file cannot be written; nothing is noted
        """
        self._acquire()
        before = self._results.get((person, lesson), {})
        tries = before.get('tries', 0) + 1
        result = {
            'person': person,
            'lesson': lesson,
            'answer': answer,
            'right': right,
            'at': round(time.time()),
            'tries': tries,
        }
        if not before.get('right'):
            results = dict(self._results)
            results.pop((person, lesson), None)
            results[person, lesson] = result
            self._visitors[person, lesson] = visitor
            if len(results) > MOST_RESULTS:
                del results[self._oldest_of_most(results)]
            self._replace(results)
        return result

    def _oldest_of_most(self, results: dict[_Key, Result]) -> _Key:
        """Return the key of the oldest result of the visitor who has most."""
        visitors = {key: self._visitors.get(key, key[0]) for key in results}
        ((most, _),) = Counter(visitors.values()).most_common(1)
        return next(key for key, visitor in visitors.items() if visitor == most)

    def last_of(self, person: str) -> Result:
        """Return the latest result of a person; empty where there is none."""
        own = [result for (name, _), result in self._results.items() if name == person]
        return own[-1] if own else {}

    def forget(self) -> None:
        """
        Forget all results.

        :raises InUse: another node writes the file; nothing is forgotten
        :raises OSError: the file cannot be written; nothing is forgotten
        """
        self._acquire()
        self._replace({})

    def _acquire(self) -> None:
        """Acquire the lock; the first time, read what another node has written before."""
        self._lock.acquire()
        if not self._is_own:
            self._read()

    def _replace(self, results: dict[_Key, Result]) -> None:
        """Have other results, once they are in the file."""
        write_file(self._path, _text_of(list(results.values())), mode=0o600)
        self._results = results
        self._visitors = {key: each for key, each in self._visitors.items() if key in results}
