# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file is written whole or not at all, whatever ends the process meanwhile."""

from __future__ import annotations

import os
from pathlib import Path
import signal
import subprocess
import sys

from physsim_ros.files import regular_file
import pytest

# Ends as it waits for the disk.
ENDED = """
import os, signal, sys
from pathlib import Path
from physsim_ros.files.regular_file import write_file

os.fsync = lambda _: os.kill(os.getpid(), int(sys.argv[2]))
write_file(Path(sys.argv[1]), b'new')
"""


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGKILL])
def test_a_process_that_ends_as_it_writes_leaves_nothing_beside_the_file(
    tmp_path: Path, number: signal.Signals
) -> None:
    path = tmp_path / 'a.yaml'
    path.write_text('old')
    command = [sys.executable, '-c', ENDED, str(path), str(int(number))]
    assert subprocess.run(command, check=False).returncode == -number
    assert {each.name: each.read_text() for each in tmp_path.iterdir()} == {'a.yaml': 'old'}


@pytest.mark.parametrize('has_unnamed', [True, False])
def test_a_file_is_written_over_and_keeps_its_mode(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, has_unnamed: bool
) -> None:
    if not has_unnamed:
        monkeypatch.delattr(os, 'O_TMPFILE')
    path = tmp_path / 'a.yaml'
    regular_file.write_file(path, b'one')
    assert path.stat().st_mode & 0o777 == 0o600
    path.chmod(0o640)
    regular_file.write_file(path, b'two')
    assert (path.read_bytes(), path.stat().st_mode & 0o777) == (b'two', 0o640)
    path.unlink()
    path.mkdir()
    with pytest.raises(OSError, match='directory'):
        regular_file.write_file(path, b'three')
    assert [*tmp_path.iterdir()] == [path]
