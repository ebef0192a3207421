# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Child processes that end with this process, also where it is killed.

Law: the kernel kills the child when the thread that started it ends (Linux, PR_SET_PDEATHSIG of
prctl(2)), so the thread lives as long as the child is needed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import importlib.util
import os
from pathlib import Path
import shutil
import subprocess
import sys

# Runs in the child, in place of a `preexec_fn`, which may deadlock in a process with threads.
# A parent that ended before the call of prctl would leave the program running.
_LAUNCHER = """
import ctypes, os, signal, sys
PR_SET_PDEATHSIG = 1
ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[2:])
"""


def start_child(
    command: Sequence[str], *, environment: Mapping[str, str]
) -> subprocess.Popen[bytes]:
    """
    Start a program without standard streams, in a process group of its own.

    A group of its own, so that Ctrl-C at a terminal is sent to this process alone, which ends the
    program in its time.

    :param command: the program, by path or by name on PATH, and its arguments
    :param environment: its environment variables
    :raises FileNotFoundError: there is no such program
    """
    name, *arguments = command
    path = shutil.which(name)
    if path is None:
        raise FileNotFoundError(f'no program {name}')
    # Isolated and without `site`: 10 ms, and nothing of another environment is run.
    launcher = [sys.executable, '-I', '-S', '-c', _LAUNCHER, str(os.getpid())]
    return subprocess.Popen(  # noqa: S603  the command is that of the caller
        [*launcher, path, *arguments],
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        process_group=0,
    )


def end_child(program: subprocess.Popen[bytes], *, timeout: float) -> None:
    """
    End a program: SIGTERM, and SIGKILL after a timeout.

    :param timeout: for an end after SIGTERM [s]
    """
    program.terminate()
    try:
        program.wait(timeout)
    except subprocess.TimeoutExpired:
        program.kill()
        program.wait()


def rerun_program() -> str:
    """Return the path of the viewer program of the rerun-sdk wheel, or of that on PATH."""
    spec = importlib.util.find_spec('rerun_cli')
    if spec is not None and spec.origin is not None:
        program = Path(spec.origin).with_name('rerun')
        if program.exists():
            return str(program)
    return shutil.which('rerun') or 'rerun'
