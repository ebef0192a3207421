# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A child process ends with the one that started it, however that ends."""

from __future__ import annotations

from pathlib import Path
import signal
import subprocess
import sys
import textwrap

from physsim_ros.view.child_process import end_child, start_child
import pytest

from ..outside import PATIENCE

psutil = pytest.importorskip('psutil')

PARENT = """
    import os, sys, time
    from physsim_ros.view.child_process import start_child

    print(start_child(['sleep', '1000'], environment=os.environ).pid, flush=True)
    sys.stdin.read()
"""


@pytest.mark.slow
@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM])
@pytest.mark.parametrize('frozen', [False, True], ids=['running', 'frozen'])
def test_a_child_does_not_outlive_a_parent_that_is_killed(number, frozen):
    parent = subprocess.Popen(
        [sys.executable, '-c', textwrap.dedent(PARENT)],
        cwd=Path(__file__).parents[2],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with parent:
        child = psutil.Process(int(parent.stdout.readline()))
        while child.name() != 'sleep':
            # Until the launcher has become the program.
            assert child.is_running()
        if frozen:
            child.send_signal(signal.SIGSTOP)

        parent.send_signal(number)
        parent.wait(PATIENCE)

        _, alive = psutil.wait_procs([child], PATIENCE)
    assert not alive


def test_a_program_that_ignores_sigterm_is_killed():
    words = 'trap "" TERM; echo ready; sleep 1000 & wait; sleep 1000'
    program = start_child(['sh', '-c', words], environment={'PATH': '/usr/bin:/bin'})
    process = psutil.Process(program.pid)

    end_child(program, timeout=0.2)

    assert not process.is_running()


def test_a_program_that_is_not_there_is_told():
    with pytest.raises(FileNotFoundError, match='no-such-program'):
        start_child(['no-such-program'], environment={})
