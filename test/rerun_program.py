# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs of Rerun's that tests start, each on a port of its own."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
import socket
import subprocess

from .outside import ENDS_WITH_US


def rerun(*arguments: object) -> subprocess.Popen[bytes]:
    """Start the program of the wheel, which says nothing and is open to this machine alone."""
    spec = importlib.util.find_spec('rerun_cli')
    assert spec is not None
    assert spec.origin is not None
    program = Path(spec.origin).with_name('rerun')
    return subprocess.Popen(
        [*ENDS_WITH_US, program, '--bind=127.0.0.1', *map(str, arguments)],
        env={**os.environ, 'CI': '1'},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        port: int = probe.getsockname()[1]
        return port


def is_open(port: int) -> bool:
    """Tell whether anybody listens on a port."""
    with socket.socket() as probe:
        return probe.connect_ex(('127.0.0.1', port)) == 0
