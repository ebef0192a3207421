# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The key that signs the cookies of pages: kept in the user's state directory.

Law: a page that was logged in is still so after a restart of the node, without its token; tokens
themselves are kept nowhere.
"""

from __future__ import annotations

import os
from pathlib import Path
import secrets
import stat

from physsim_ros.files import user_directory, write_file

# Of the key [bytes], as long as the digest of SHA-256, by which tornado signs.
_LENGTH = 32
_NAME = 'cookie_key'


def cookie_key() -> bytes:
    """Return the user's key, made where there is none; a passing one where it cannot be kept."""
    directory = user_directory('XDG_STATE_HOME', '.local', 'state')
    try:
        directory.mkdir(mode=0o700, parents=True, exist_ok=True)
        return _read(directory / _NAME) or _make(directory / _NAME)
    except OSError:
        # Without the file, pages log in again after a restart.
        return secrets.token_bytes(_LENGTH)


def _read(path: Path) -> bytes:
    """
    Return the key of a file; empty where another user could know it, or where it is none.

    :raises OSError: it cannot be read
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except FileNotFoundError:
        return b''
    with os.fdopen(descriptor, 'rb') as file:
        status = os.fstat(file.fileno())
        private = status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o077
        key = file.read(_LENGTH + 1) if stat.S_ISREG(status.st_mode) and private else b''
    return key if len(key) == _LENGTH else b''


def _make(path: Path) -> bytes:
    """
    Write a new key, whole or not at all, in place of what is there.

    :raises OSError: it cannot be written
    """
    key = secrets.token_bytes(_LENGTH)
    write_file(path, key, mode=0o600)
    return key
