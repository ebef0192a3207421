# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The lock of a directory: one owner at once, until it ends, however it ends."""

from __future__ import annotations

import errno
import fcntl
import os
from pathlib import Path
import shutil
import subprocess
import sys

from physsim_ros.files import DirectoryLock
from physsim_ros.model.errors import InUse
import pytest

from ..outside import ROOT

# Acquires the lock of a directory, and keeps it until it is killed.
OWNER = """
import pathlib, sys
from physsim_ros.files import DirectoryLock
lock = DirectoryLock(pathlib.Path(sys.argv[1]))
lock.acquire()
print('acquired', flush=True)
sys.stdin.read()
"""


def test_one_process_at_once_has_the_lock_and_a_killed_one_has_it_no_more(tmp_path: Path) -> None:
    command = [sys.executable, '-c', OWNER, str(tmp_path)]
    with subprocess.Popen(
        command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as owner:
        assert owner.stdout is not None
        assert owner.stdout.readline() == 'acquired\n'
        lock = DirectoryLock(tmp_path)
        with pytest.raises(InUse):
            lock.acquire()
        assert not lock.is_held
        owner.kill()
    lock.acquire()
    assert lock.is_held


def test_a_released_lock_is_the_next_ones_and_leaves_nothing(tmp_path: Path) -> None:
    first, second = DirectoryLock(tmp_path), DirectoryLock(tmp_path)
    first.acquire()
    first.acquire()
    with pytest.raises(InUse):
        second.acquire()
    # One that has nothing takes nothing away.
    second.release()
    with pytest.raises(InUse):
        second.acquire()
    first.release()
    second.acquire()
    assert (first.is_held, second.is_held) == (False, True)
    second.release()
    assert not list(tmp_path.iterdir())


def test_a_directory_that_is_made_again_is_locked_again(tmp_path: Path) -> None:
    directory = tmp_path / 'worlds'
    first, second = DirectoryLock(directory), DirectoryLock(directory)
    first.acquire()
    shutil.rmtree(directory)
    assert not first.is_held
    second.acquire()
    with pytest.raises(InUse):
        first.acquire()


def test_without_locks_in_the_file_system_nobody_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, 'flock', fail)
    for lock in (DirectoryLock(tmp_path), DirectoryLock(tmp_path)):
        lock.acquire()
        assert lock.is_held
