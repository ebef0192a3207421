# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The program `physsim` in environments that take something from it that others have."""

from __future__ import annotations

from contextlib import ExitStack
import socket
import sys
import time
from typing import Any
from urllib.parse import urlsplit
import urllib.request

import pytest

from ..outside import installed_program, Outside, PATIENCE, Program, until

pytestmark = pytest.mark.slow

# Runs a program with a limit of open files, or with streams closed.
LIMITED = 'ulimit -n {files} && exec "$@"'
MUTE = 'exec "$@" <&- >&- 2>&-'


def start_through_shell(outside: Outside, script: str, **parameters: Any) -> Program:
    """Start the world by a script of the shell, whose arguments are its command."""
    given = {'viewer': 'none'} | parameters
    words = [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]
    command = (installed_program('physsim'), '--ros-args', *words)
    return outside.start('bash', '-c', script, 'bash', *command)


def answer_of(page: str) -> int:
    """Return the status with which a page answers, as soon as it has a connection to spare."""
    browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            with browser.open(page, timeout=10.0) as answer:
                return int(answer.status)
        except OSError:
            if time.monotonic() > deadline:
                raise


def test_it_needs_no_assertions(outside: Outside) -> None:
    words = ('--ros-args', '-p', 'viewer:=none', '-p', 'world_file:=demo')
    program = installed_program('physsim')
    with outside.start(sys.executable, '-OO', program, *words) as world:
        world.wait_for('ready')
        assert world.interrupt() == 0


def test_it_needs_no_locale(outside: Outside) -> None:
    file = outside.directory / 'über.yaml'
    file.write_text('format: 1\nbodies:\n  - {name: ü/0, circle: {radius: 1.0}, at: [0, 0]}\n')
    with start_through_shell(outside, 'LC_ALL=C exec "$@"', world_file=file) as world:
        assert '1 body' in world.wait_for('ready')
        assert world.interrupt() == 0


def test_a_log_that_cannot_be_written_is_told_with_what_helps(outside: Outside) -> None:
    with start_through_shell(outside, 'HOME=/proc/none ROS_LOG_DIR= exec "$@"') as world:
        assert world.finish() == 1
    assert 'ROS_LOG_DIR' in world.lines[-1]
    assert 'Traceback' not in ''.join(world.lines)


def test_a_home_that_cannot_be_written_is_no_matter_where_the_log_can(outside: Outside) -> None:
    script = 'HOME=/proc/none XDG_STATE_HOME= exec "$@"'
    with start_through_shell(outside, script, sketchpad='serve', world_file='demo') as world:
        world.wait_for('ready')
        assert world.interrupt() == 0
        assert 'Traceback' not in ''.join(world.lines)


def test_it_runs_without_standard_streams(outside: Outside) -> None:
    record = outside.directory / 'mute.rrd'
    with start_through_shell(outside, MUTE, sketchpad='serve', record_file=record) as world:
        outside.run_program('watch', 0.5)
        # An end does not wait longer than 9 s for it.
        until(record.exists)
        assert world.interrupt() == 0
    # Nothing was printed into it.
    assert record.read_bytes().startswith(b'RRF2')


def test_more_connections_than_files_neither_flood_the_log_nor_keep_pages_out(
    outside: Outside,
) -> None:
    script = LIMITED.format(files=64)
    with start_through_shell(outside, script, sketchpad='serve') as world:
        page = world.wait_for('http://').strip()
        address = urlsplit(page)
        world.wait_for('ready')
        with ExitStack() as closing:
            for _ in range(100):
                closing.enter_context(socket.create_connection((address.hostname, address.port)))
        assert answer_of(page) == 200
        assert world.interrupt() == 0
    assert len(world.lines) < 100


def test_time_does_not_hurry_after_the_process_was_stopped(outside: Outside) -> None:
    with outside.start_world() as world:
        world.wait_for('ready')
        seen = outside.run_program('stopper', world.process.pid)
        assert world.interrupt() == 0
    # It is stopped for 5 s, and then read for 1 s or a little more.
    assert 0.0 < seen['passed'] < seen['read'] + 2.0
