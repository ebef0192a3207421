# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The key of cookies lasts over restarts, and is nobody else's."""

import errno
import os
from pathlib import Path
import stat

from physsim_ros.sketchpad.server.access import Access, cookie_key, Role
import pytest


@pytest.fixture(autouse=True)
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the path of the key in a state directory of its own."""
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    return tmp_path / 'physsim_ros' / 'cookie_key'


def test_the_key_is_kept_where_its_user_alone_reads_it(path: Path) -> None:
    key = cookie_key()
    assert cookie_key() == key == path.read_bytes()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700


@pytest.mark.parametrize('mode', [0o640, 0o604, 0o660])
def test_a_key_that_others_could_read_is_replaced(path: Path, mode: int) -> None:
    key = cookie_key()
    path.chmod(mode)
    assert cookie_key() != key
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_what_is_no_key_is_replaced(path: Path) -> None:
    path.parent.mkdir()
    path.write_bytes(b'short')
    path.chmod(0o600)
    assert len(cookie_key()) == 32
    other = path.with_name('other')
    path.rename(other)
    path.symlink_to(other)
    # A link leads elsewhere: nothing is read or written through it.
    before = other.read_bytes()
    assert cookie_key() != before == other.read_bytes()


def test_a_directory_that_cannot_be_written_leaves_a_key_of_this_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / 'file'
    blocked.touch()
    monkeypatch.setenv('XDG_STATE_HOME', str(blocked))
    assert cookie_key() != cookie_key()


def test_a_key_that_cannot_be_written_leaves_no_file(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: int) -> None:
        raise OSError(errno.ENOSPC, 'the disk is full')

    monkeypatch.setattr(os, 'fsync', fail)
    assert cookie_key() != cookie_key()
    assert list(path.parent.iterdir()) == []


def test_a_cookie_outlives_a_restart_with_its_role_on_its_port() -> None:
    before, after = Access('127.0.0.1', 8765), Access('127.0.0.1', 8765)
    for role in Role:
        cookie = before.signed_cookie(role).decode()
        assert after.role_of_cookie(cookie) is role
        assert Access('127.0.0.1', 8766).role_of_cookie(cookie) is None
        assert after.role_of(before.tokens[role]) is None
    content, bar, _ = before.signed_cookie(Role.VIEW).decode().rpartition('|')
    *_, signature = before.signed_cookie(Role.DRAW).decode().rpartition('|')
    forged = content + bar + signature
    assert after.role_of_cookie(forged) is None
    assert after.role_of_cookie('') is None
