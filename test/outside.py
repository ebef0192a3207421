# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Processes beside the test's own: the world as people start it, and programs that talk to it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
import json
import os
from pathlib import Path
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
from typing import Any, Self
import uuid

import pytest

# For what a test waits for, many times what it takes, on a machine that is busy with other tests
# [s]. It costs nothing where nothing is wrong; `LONGEST` of `conftest.py` is longer.
PATIENCE = 100.0
# A program of util-linux, by which another one ends with the process that has started it: a test
# run that is killed leaves no world behind.
ENDS_WITH_US = ('setpriv', '--pdeathsig', 'KILL')
ROOT = Path(__file__).resolve().parents[1]


def until(predicate: Callable[[], Any], timeout: float = PATIENCE) -> Any:
    """Wait until something holds; return it."""
    deadline = time.monotonic() + timeout
    pause = threading.Event()
    while not (result := predicate()):
        assert time.monotonic() < deadline, 'it did not come to hold'
        pause.wait(0.01)
    return result


def write_profiles(path: Path, partition: str) -> None:
    """
    Write the profiles of Fast DDS that the program uses, with a partition.

    Nodes of another partition are on the same domain and neither hear nor are heard.
    """
    shipped = ROOT / 'physsim_ros' / 'ros' / 'programs' / 'fastdds_profiles.xml'
    qos = f'<qos><partition><names><name>{partition}</name></names></partition></qos>'
    subscriber = f'<subscriber profile_name="s" is_default_profile="true">{qos}</subscriber>'
    text = shipped.read_text()
    assert '<times>' in text
    text = text.replace('<times>', f'{qos}<times>')
    path.write_text(text.replace('</profiles>', f'{subscriber}</profiles>'))


def installed_program(name: str) -> str | None:
    """Return the path of one of the package's own programs, as colcon or pip installs it."""
    prefixes = filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep))
    directories = [Path(prefix) / 'lib' / 'physsim_ros' for prefix in prefixes]
    directories.append(Path(sys.executable).parent)
    path = os.pathsep.join([*map(str, directories), os.environ['PATH']])
    return shutil.which(name, path=path)


def run_python(
    *words: object, cwd: Path = ROOT, timeout: float = 3 * PATIENCE, **variables: str
) -> str:
    """Run Python with arguments and environment variables to its end; return what it prints."""
    done = subprocess.run(
        [sys.executable, *map(str, words)],
        cwd=cwd,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Program:
    """A process and the lines that it prints."""

    def __init__(self, *command: object, env: dict[str, str], cwd: Path) -> None:
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [*ENDS_WITH_US, *(str(word) for word in command)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=env,
            cwd=cwd,
        )
        self.lines: list[str] = []
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._queue.put(line)
        self._queue.put(None)

    def wait_for(self, word: str, timeout: float = PATIENCE) -> str:
        """Return the next line with that word."""
        deadline = time.monotonic() + timeout
        while True:
            try:
                line = self._queue.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                pytest.fail(f'no {word!r} within {timeout} s of:\n{"".join(self.lines)}')
            if line is None:
                pytest.fail(f'ended without {word!r}:\n{"".join(self.lines)}')
            self.lines.append(line)
            if word in line:
                return line

    def finish(self, timeout: float = PATIENCE) -> int:
        """Wait for the end, read the remaining lines, and return the exit code."""
        code = self.process.wait(timeout)
        self._reader.join(timeout)
        while not self._queue.empty():
            line = self._queue.get()
            if line is not None:
                self.lines.append(line)
        return code

    def interrupt(self, number: int = signal.SIGINT) -> int:
        """Send a signal, and return the exit code."""
        self.process.send_signal(number)
        return self.finish()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process, whatever it does."""
        self.process.kill()
        self.finish()


class Outside:
    """
    Processes beside this one that share a ROS domain and a DDS partition of their own.

    :param directory: where they work and log

    :ivar environment: variables of the processes
    """

    def __init__(self, directory: Path, domain: int, closing: ExitStack) -> None:
        self.directory = directory
        self.partition = uuid.uuid4().hex
        self._closing = closing
        profiles = directory / 'profiles.xml'
        write_profiles(profiles, self.partition)
        self.environment = os.environ | {
            'ROS_DOMAIN_ID': str(domain),
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
            'FASTRTPS_DEFAULT_PROFILES_FILE': str(profiles),
            'ROS_LOG_DIR': str(directory),
            'XDG_STATE_HOME': str(directory),
            'PYTHONUNBUFFERED': '1',
        }

    def start(self, *command: object) -> Program:
        """Start a program."""
        program = Program(*command, env=self.environment, cwd=self.directory)
        self._closing.callback(program.close)
        return program

    def start_world(self, *arguments: str, **parameters: object) -> Program:
        """Start the world as people do, by its installed executable."""
        given = {'viewer': 'none'} | parameters
        words = [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]
        return self.start_installed('physsim', '--ros-args', *words, *arguments)

    def start_installed(self, name: str, *words: object) -> Program:
        """Start one of the package's own programs, as it is installed."""
        executable = installed_program(name)
        assert executable, 'the package is not installed: make test, or colcon build'
        return self.start(executable, *words)

    def start_elsewhere(self, name: str, *arguments: object) -> Program:
        """Start one of the programs that know the world by its topics alone."""
        return self.start(sys.executable, ROOT / 'test' / 'elsewhere' / f'{name}.py', *arguments)

    def run_program(self, name: str, *arguments: object) -> dict[str, Any]:
        """Run one of the programs that know the world by its topics alone; return what it saw."""
        with self.start_elsewhere(name, *arguments) as program:
            line = program.wait_for('RESULT', 2.5 * PATIENCE)
            assert program.finish() == 0, ''.join(program.lines)
        result: dict[str, Any] = json.loads(line.partition(' ')[2])
        return result
