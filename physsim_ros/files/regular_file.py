# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading and writing regular files: bounded, whole, and without waiting.

Law: reading never waits. A FIFO, a device, a directory, and a file that is larger than its limit
are errors at once.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path
import secrets
import stat


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
    # Looked at before it is opened too: opening a device may do something.
    _check_kind(path.stat())
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    with os.fdopen(descriptor, 'rb', buffering=0) as file:
        _check_kind(os.fstat(file.fileno()))
        # Files of /proc have a size of 0, whatever they hold.
        parts, left = [], most + 1
        while left > 0 and (part := os.read(file.fileno(), min(left, 2**20))):
            parts.append(part)
            left -= len(part)
    if left <= 0:
        raise OSError(errno.EFBIG, f'it is larger than {most / 2**20:g} MiB')
    return b''.join(parts)


def write_file(path: Path, data: bytes, *, mode: int | None = None) -> None:
    """
    Write a file whole or not at all.

    :param path: of the file, without symbolic links
    :param data: that it has then
    :param mode: that it has then; None is that of the file that is there
    :raises OSError: it cannot be written, and is as it was
    """
    # Short, since the name of a file has 255 bytes at most.
    temporary = path.parent / f'.{secrets.token_hex(8)}.tmp'
    if mode is None and path.exists():
        mode = stat.S_IMODE(path.stat().st_mode)
    # Readable by no other user before it has its mode; the umask applies to a new one only.
    created = 0o666 if mode is None else 0o600
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, created)
    try:
        with os.fdopen(descriptor, 'wb') as file:
            if mode is not None:
                os.fchmod(file.fileno(), mode)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _check_kind(status: os.stat_result) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, 'it is not a regular file')
