# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The lock of a directory, of which one node writes the files that have fixed names.

Laws: of several nodes, also on several machines that share the directory, one has the lock; the
end of its process, whatever ends that, releases it. A directory that is deleted and made again has
another lock. Where the file system knows no locks, nobody is refused.

Method: flock(2) on a file in the directory.
"""

from __future__ import annotations

from contextlib import suppress
import fcntl
import os
from pathlib import Path

from physsim_ros.files.regular_file import make_directory
from physsim_ros.model.errors import InUse

_NAME = '.lock'


class DirectoryLock:
    """
    The lock of a directory; only one thread at once uses it.

    :param directory: of the files
    """

    def __init__(self, directory: Path) -> None:
        self._path = directory / _NAME
        self._descriptor: int | None = None

    @property
    def is_held(self) -> bool:
        """Whether this lock is held, and its file is there."""
        return self._descriptor is not None and self._is_file(self._descriptor)

    def acquire(self) -> None:
        """
        Acquire the lock, unless it is held; the directory is made if it is missing.

        :raises InUse: another node has it
        :raises OSError: its file cannot be opened
        """
        while not self.is_held:
            self._close()
            make_directory(self._path.parent)
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
            self._descriptor = os.open(self._path, flags, 0o600)
            try:
                fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                self._close()
                raise InUse('another node has this world_dir') from error
            except OSError:
                # A file system without locks.
                return

    def release(self) -> None:
        """Release the lock, and delete its file."""
        if self.is_held:
            with suppress(OSError):
                self._path.unlink()
        self._close()

    def _is_file(self, descriptor: int) -> bool:
        """Return whether a descriptor is that of the file: its last owner deletes it."""
        try:
            return os.path.samestat(os.fstat(descriptor), self._path.stat())
        except OSError:
            return False

    def _close(self) -> None:
        descriptor, self._descriptor = self._descriptor, None
        if descriptor is not None:
            os.close(descriptor)
