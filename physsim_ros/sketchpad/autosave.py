# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Autosave: the world that pages draw in is written to a file, which the next start offers.

A world with a lesson is kept as soon as a page opens it.

Law: it takes at most a hundredth of the world's time and one file, and no request waits for it; a
world that is too large, a full disk, or another node that has the directory stops nothing, and
people are told. What was not written is tried again. The file begins with a comment that names the
people who drew in it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
import json
from pathlib import Path
import time
from typing import TypeAlias

import numpy as np
from physsim_ros.files import DirectoryLock, read_bytes, read_parts, write_file
from physsim_ros.model.answer import Answer
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import InUse, WorldFull
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.translation import Text
from physsim_ros.sketchpad.file_work import FileWork

# Least time from one autosave to the next while bodies move and while nothing does [s], and its
# least ratio to the time of an autosave.
PERIOD, STILL_PERIOD, SHARE = 10.0, 1.0, 100.0
# Greatest length of the text of a world [characters].
LONGEST = 2**20
# Beginning of the comment with the names of people, as JSON; greatest number of names, and size of
# the comment [bytes].
_BY, MOST_NAMES, _MOST_BY = '# drawn by: ', 12, 2**12
# Topics of requests after which the world is as it was loaded.
_FROM_FILE = frozenset({'~/load_world', '~/reset'})
# Size of the file [bytes]; a character has up to four.
_MOST_BYTES = _MOST_BY + 4 * LONGEST
_NOW, _BEFORE = '.autosave.yaml', '.unsaved.yaml'
# Of its events.
_TOPIC = 'autosave'
# Why a save has failed, None where it has not, and the time that it took [s].
_Failure: TypeAlias = OSError | WorldFull | InUse
_Written: TypeAlias = tuple[_Failure | None, float]


class Autosave:
    """
    The file of unsaved changes.

    :param directory: of the user's worlds
    :param lock: of that directory
    :param file_work: of the world
    :param text: returns a function that, on any thread, returns the world of now as text, or
        raises WorldFull beyond a length [characters]
    :param people: returns the names that people who draw have chosen

    :ivar failure: event that what was drawn could not be saved; None where it is saved
    """

    def __init__(
        self,
        directory: Path,
        lock: DirectoryLock,
        file_work: FileWork,
        text: Callable[[], Callable[[int], str]],
        people: Callable[[], Sequence[str]] = list,
    ) -> None:
        self._file, self._unsaved = directory / _NOW, directory / _BEFORE
        self._lock, self._file_work = lock, file_work
        self._text, self._people = text, people
        self.failure: Answer | None = None
        # Scene of the last frame; that of the world which somebody has saved last.
        self._scene: Scene | None = None
        self._saved: Scene | None = None
        self._changed = False
        self._due = self._due_still = 0.0
        self._poses: Floats = np.empty((0, 3))
        # Whether nothing moves.
        self._still = False
        # The save under way, which ends with why it failed, or None, and its duration [s].
        self._writing: Future[_Written] | None = None
        # Whether the file is that of this start.
        self._has_begun = False
        if directory.is_dir():
            try:
                self._begin()
            except InUse as error:
                self.failure = _failure(error)
            except OSError:
                # As of a directory that can only be read; the first save tells.
                pass

    def _begin(self) -> None:
        """
        Acquire the lock; the first time, keep the unsaved world of the last start.

        :raises InUse: another node has it
        :raises OSError: the directory cannot be written
        """
        self._lock.acquire()
        if not self._has_begun:
            with suppress(FileNotFoundError):
                self._file.replace(self._unsaved)
            self._has_begun = True

    @property
    def unsaved_at(self) -> float:
        """Return when the unsaved world of the last start was written [s since 1970], else 0."""
        try:
            return self._unsaved.stat().st_mtime
        except OSError:
            return 0.0

    @property
    def unsaved_by(self) -> list[str]:
        """Return the names of those who drew the unsaved world of the last start."""
        # There is no such world, or a person has spoilt its file.
        with suppress(OSError, ValueError, RecursionError):
            # The file may be a pipe, which never ends.
            start = next(read_parts(self._unsaved, _MOST_BYTES), b'')
            line = start[:_MOST_BY].partition(b'\n')[0].decode()
            names = json.loads(line.removeprefix(_BY)) if line.startswith(_BY) else []
            if isinstance(names, list):
                return [str(each) for each in names[:MOST_NAMES]]
        return []

    def unsaved_content(self) -> bytes:
        """
        Return the unsaved world of the last start, as the text of a world file.

        :raises OSError: there is no such world
        """
        return read_bytes(self._unsaved, _MOST_BYTES)

    def forget_unsaved(self) -> Text:
        """
        Delete the unsaved world of the last start, and return a message about it.

        :raises InUse: it is that of another node
        :raises OSError: it cannot be deleted
        """
        self._begin()
        self._unsaved.unlink(missing_ok=True)
        return Text('discarded the unsaved world')

    def note_frame(self, frame: Frame, *, drawn: bool) -> None:
        """
        Note a frame that is shown.

        :param drawn: whether pages are open, which may have changed the world
        """
        scene = frame.snapshot.scene
        changed, self._scene = self._scene is not scene, scene
        poses, self._poses = self._poses, frame.snapshot.poses
        self._still = not frame.speed or np.array_equal(poses, self._poses)
        if any(answer.topic in _FROM_FILE and not answer.code for answer in frame.answers):
            # Nobody has drawn yet in what is a file already; a lesson is resumed as it was.
            self._changed, self.failure = drawn and scene.lesson is not None, None
        else:
            self._changed |= changed and drawn and not frame.past and frame.speed >= 0.0
        self._forget_saved()

    def note_saved(self, scene: Scene) -> None:
        """
        Note that somebody has saved the world; what was drawn since is autosaved.

        :param scene: of the world that was saved
        """
        self._saved = scene
        self._forget_saved()

    def _forget_saved(self) -> None:
        """Delete the file, after a save that is under way, if the shown world is saved."""
        if self._saved is None or self._saved is not self._scene:
            return
        self._saved = None
        self._changed, self.failure = False, None

        def forget() -> None:
            if self._has_begun and self._lock.is_held:
                with suppress(OSError):
                    self._file.unlink(missing_ok=True)

        self._file_work.submit(forget)

    def is_due(self, now: float) -> bool:
        """
        Return whether the world is to be saved, and no save is under way.

        :param now: steady time [s]
        """
        due = self._due_still if self._still else self._due
        return self._changed and self._writing is None and now >= due

    def save(self) -> Future[_Written]:
        """Begin to save the world of now on a thread, for whose end nothing waits."""
        self._changed = False
        write = partial(self._write, self._text(), self._people()[:MOST_NAMES])
        self._writing = self._file_work.submit(write)
        return self._writing

    def note_end(self) -> Answer | None:
        """Note the end of the save; return an event if it has failed, or does so no longer."""
        writing = self._writing
        if writing is None or not writing.done():
            return None
        self._writing = None
        error, took = writing.result()
        # A world that is too large stays so until it changes.
        self._changed |= isinstance(error, OSError | InUse)
        now = time.monotonic()
        self._due = now + max(PERIOD, SHARE * took)
        self._due_still = now + max(STILL_PERIOD, SHARE * took)
        before, self.failure = self.failure, None if error is None else _failure(error)
        if self.failure == before:
            return None
        return self.failure or Answer(
            topic=_TOPIC, message=Text('what was drawn is autosaved again')
        )

    def _write(self, text: Callable[[int], str], names: Sequence[str]) -> _Written:
        """
        Write a world and the names of people.

        :return: why that failed, None where it did not, and the time that it took [s]
        """
        began = time.thread_time()
        failed: _Failure | None = None
        try:
            self._begin()
            content = text(LONGEST)
            if names:
                content = f'{_BY}{json.dumps(names)}\n{content}'
            write_file(self._file, content.encode())
        except (OSError, WorldFull, InUse) as error:
            failed = error
        return failed, time.thread_time() - began


def _failure(error: _Failure) -> Answer:
    """Return the event of a failure."""
    # The path is nobody's business on a page.
    reason = error.strerror if isinstance(error, OSError) else error
    message = Text('what was drawn is not autosaved: {reason}', reason=reason)
    code = error.code if isinstance(error, InUse) else 'autosave_failed'
    return Answer(topic=_TOPIC, message=message, code=code)
