# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A recording as an endpoint of frames: a `.rrd` file, which gets its index when it is closed."""

from __future__ import annotations

import errno
from itertools import count
import os
from pathlib import Path
import subprocess
import time

from physsim_ros.view.child_process import rerun_program, start_child
from physsim_ros.view.endpoints import Endpoint
from physsim_ros.view.stream import RerunStream

# Time at the end in which an index that is not done is removed [s].
_REMOVING = 0.2
# Beginning of `.rrd` files, before the digit of their version (Rerun 0.41: RRF2).
_MAGIC = b'RRF'


class FileEndpoint(Endpoint):
    """
    A `.rrd` file.

    :param path: of the file
    :param overwrite: whether a recording of that name is replaced; else another name is taken
    """

    kind, code = 'record', 'record_failed'
    # Long batches take less room; the first frames wait for the import of Rerun, the last for an
    # index, which takes a second for 80 MB on an idle machine.
    period, closing, reopens = 1.0, 9.0, False

    def __init__(self, path: Path, *, overwrite: bool) -> None:
        self.where = str(path)
        self._path = path
        self._overwrite = overwrite
        # Device and inode of the open file.
        self._identity = (0, 0)

    def open_stream(self) -> RerunStream:
        """Create the file, and return a stream to it."""
        import rerun as rr

        # Rerun (0.41) keeps the global interpreter lock while it opens a file: where that blocks,
        # as with a FIFO, all threads would wait.
        try:
            if not self._overwrite:
                self._path = _without_content(self._path)
                self.where = str(self._path)
            self._identity = _create_regular_file(self._path)
        except OSError as error:
            raise ConnectionError(error.strerror) from error
        # A footer would list all chunks, and grow in memory with the recording: 3 MB a minute.
        return RerunStream(rr.FileSink(self._path, write_footer=False))

    def check(self) -> None:
        """Check that the file is still there: Rerun would go on writing to a deleted file."""
        try:
            found = self._path.stat()
        except OSError as error:
            raise ConnectionError(f'the file is gone ({error.strerror})') from error
        if (found.st_dev, found.st_ino) != self._identity:
            raise ConnectionError('the file was replaced by another')

    def complete(self, end_by: float) -> None:
        """Append the index (footer) to the file, if it is done by a steady time [s]."""
        if self._identity == (0, 0):
            return
        path = self._path.resolve()
        indexed = path.with_name(f'.{path.name}.index')
        command = [rerun_program(), 'rrd', 'optimize', str(path), '-o', str(indexed)]
        try:
            program = start_child(command, environment={**os.environ, 'CI': '1'})
            try:
                program.wait(max(0.0, end_by - _REMOVING - time.monotonic()))
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
            self.check()
            if program.returncode == 0:
                indexed.chmod(path.stat().st_mode)
                indexed.replace(path)
        except OSError:
            # The disk is full, or the file gone: what there is can be read as it is.
            return
        finally:
            indexed.unlink(missing_ok=True)


def _create_regular_file(path: Path) -> tuple[int, int]:
    """
    Create a file, or open it, to see that it can be written; return device and inode.

    :raises OSError: it cannot be written, is not a regular file, or holds something else
    """
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, 'it is not a regular file')
    with path.open('a+b') as file:
        found = os.fstat(file.fileno())
        file.seek(0)
        if found.st_size and file.read(len(_MAGIC)) != _MAGIC:
            raise OSError(errno.EEXIST, 'it is no recording, and is not written over')
    return found.st_dev, found.st_ino


def _without_content(path: Path) -> Path:
    """Return a path, or the first of `name-2.rrd`, `name-3.rrd`, ... that has no content."""
    others = (path.with_stem(f'{path.stem}-{number}') for number in count(2))
    while path.exists() and path.stat().st_size > 0:
        path = next(others)
    return path
