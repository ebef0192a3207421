# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Threads, connections and participants of DDS that this process has."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
import threading
from typing import TypeVar

from .outside import PATIENCE, until

OWN = Path('/proc/self')
_Read = TypeVar('_Read')


class Open:
    """The threads, participants and connections that this process has at a moment."""

    def __init__(self) -> None:
        self.threads = {*threading.enumerate()}
        self.participants = participants()
        self.connections = connections()

    def check_same(self) -> None:
        """Check that nothing more is open soon: a thread that is about to end may do so."""
        for thread in {*threading.enumerate()} - self.threads:
            thread.join(PATIENCE)
            assert not thread.is_alive(), thread.name
        until(lambda: participants() <= self.participants)
        until(lambda: connections() <= self.connections)


def participants() -> set[str]:
    """Return the threads that receive for participants, which end with these."""
    names = known(Path.read_text, (OWN / 'task').glob('*/comm'))
    return {path.parent.name for path, name in names if name.startswith('dds.udp')}


def connections() -> set[str]:
    """Return the sockets of TCP that are open in this process."""
    tables = known(Path.read_text, (OWN / 'net' / name for name in ('tcp', 'tcp6')))
    lines = [line for _, table in tables for line in table.splitlines()[1:]]
    inodes = {f'socket:[{line.split()[9]}]' for line in lines}
    return inodes & {str(target) for _, target in known(Path.readlink, (OWN / 'fd').iterdir())}


def known(read: Callable[[Path], _Read], paths: Iterable[Path]) -> Iterator[tuple[Path, _Read]]:
    """Yield what is read of each path; a thread or a file may have ended since it was listed."""
    for path in paths:
        with suppress(OSError):
            yield path, read(path)
