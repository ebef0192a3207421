# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading and writing regular files: bounded, whole, and without waiting.

Laws: reading never waits. A FIFO, a device, a directory, and a file that is larger than its limit
are errors at once. What is made here is for this user alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
import errno
import os
from pathlib import Path
import secrets
import stat

# The open files of the process, by which one without a name is named (open(2), O_TMPFILE).
_DESCRIPTORS = Path('/proc/self/fd')
# Size of a part of a file [bytes].
_PART = 2**18


def read_file(path: Path, most: int) -> str:
    """
    Return the text of a file in UTF-8.

    :param path: of the file
    :param most: greatest size [bytes]
    :raises OSError: it cannot be read, is not a regular file, or is larger
    :raises UnicodeDecodeError: it is no text
    """
    return read_bytes(path, most).decode()


def read_bytes(path: Path, most: int) -> bytes:
    """
    Return the content of a file.

    :param path: of the file
    :param most: greatest size [bytes]
    :raises OSError: it cannot be read, is not a regular file, or is larger
    """
    return b''.join(read_parts(path, most))


def read_parts(path: Path, most: int) -> Iterator[bytes]:
    """
    Yield the content of a file in parts; see `read_bytes`.

    A file whose size tells that it is larger is an error before the first part.
    """
    # Looked at before it is opened too: opening a device may do something.
    _check(path.stat(), most)
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    with os.fdopen(descriptor, 'rb', buffering=0) as file:
        _check(os.fstat(file.fileno()), most)
        # Files of /proc have a size of 0, whatever they hold.
        left = most
        while part := os.read(file.fileno(), _PART):
            left -= len(part)
            if left < 0:
                raise _too_large(most)
            yield part


def make_directory(path: Path) -> None:
    """
    Make a directory, and those above it that are missing, as the XDG specification has it.

    :raises OSError: it cannot be made
    """
    if not path.is_dir():
        make_directory(path.parent)
        path.mkdir(mode=0o700, exist_ok=True)


def write_file(
    path: Path, data: bytes, *, mode: int | None = None, kept: Path | None = None
) -> None:
    """
    Write a file whole or not at all.

    :param path: of the file, without symbolic links
    :param data: that it has then
    :param mode: that it has then; None is that of the file that is there, or 0600
    :param kept: path at which the file that is there is kept, in place of what is there; None is
        nowhere
    :raises OSError: it cannot be written, and both files are as they were
    """
    temporary = _temporary_in(path.parent)
    if mode is None:
        mode = stat.S_IMODE(path.stat().st_mode) if path.exists() else 0o600
    descriptor, is_named = _open_temporary(temporary)
    try:
        with os.fdopen(descriptor, 'wb') as file:
            os.fchmod(file.fileno(), mode)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            if not is_named:
                # With a directory that counts for no absolute path, Python calls linkat, which
                # follows the link of the descriptor.
                unnamed = _DESCRIPTORS / str(descriptor)
                os.link(unnamed, temporary, src_dir_fd=descriptor)
        if kept is None:
            temporary.replace(path)
        else:
            move_and_keep(temporary, path, kept)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def move_and_keep(file: Path, path: Path, kept: Path) -> None:
    """
    Move a file to a path, and the one that is there to a path where it is kept.

    :param file: that is moved; it may be the one that is kept
    :param path: of it then
    :param kept: path at which the file that was there is kept, in place of what is there
    :raises OSError: a file cannot be moved, and all are as they were
    """
    if not path.is_file():
        file.replace(path)
        return
    make_directory(kept.parent)
    before = _temporary_in(kept.parent)
    # Files are written anew and never changed, so that two names may share one.
    before.hardlink_to(path)
    try:
        file.replace(path)
        try:
            before.replace(kept)
        except OSError:
            path.replace(file)
            before.replace(path)
            raise
    finally:
        # It is there if a file could not be moved, or if it is the one that is kept already.
        before.unlink(missing_ok=True)


def _temporary_in(directory: Path) -> Path:
    """Return the path of a new file, short, since the name of a file has 255 bytes at most."""
    return directory / f'.{secrets.token_hex(8)}.tmp'


def _open_temporary(path: Path) -> tuple[int, bool]:
    """
    Open a new file to write, readable by no other user; return its descriptor, and if it is named.

    One without a name is gone with the process, whatever ends that; some file systems have none.

    :param path: its name, or the one that it gets
    :raises OSError: it cannot be opened
    """
    flags = os.O_WRONLY | os.O_CLOEXEC
    if hasattr(os, 'O_TMPFILE') and _DESCRIPTORS.is_dir():
        with suppress(OSError):
            return os.open(path.parent, flags | os.O_TMPFILE, 0o600), False
    return os.open(path, flags | os.O_CREAT | os.O_EXCL, 0o600), True


def _check(status: os.stat_result, most: int) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, 'it is not a regular file')
    if status.st_size > most:
        raise _too_large(most)


def _too_large(most: int) -> OSError:
    return OSError(errno.EFBIG, f'it is larger than {most / 2**20:g} MiB')
