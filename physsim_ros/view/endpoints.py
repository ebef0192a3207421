# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Endpoints of frames: a Rerun server elsewhere, and one here with its viewer program.

Law: whatever is opened or started here is closed and ended here, by the same thread.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
import os
import socket
import subprocess
from typing import ClassVar
from urllib.parse import quote, urlsplit

from physsim_ros.model.answer import Answer
from physsim_ros.model.translation import Text
from physsim_ros.runtime.ending import CLOSING
from physsim_ros.view.child_process import end_child, rerun_program, start_child
from physsim_ros.view.stream import RerunStream

DEFAULT_URL = 'rerun+http://127.0.0.1:9876/proxy'
# Memory of a server for late viewers.
SERVER_MEMORY = '256MiB'
# Timeouts of a connection, and of the end of a program after SIGTERM [s].
CONNECTING, TERMINATING = 0.5, 0.5


class Endpoint(ABC):
    """
    A receiver of frames.

    :cvar where: address, for messages
    :cvar code: of the event that reports a lost receiver
    :cvar period: time between two writes [s]
    :cvar closing: longest time that the end takes where none ends the program [s]
    :cvar reopens: whether a lost receiver is opened again
    """

    where = ''
    code: ClassVar[str] = 'viewer_lost'
    period: ClassVar[float] = 0.1
    closing: ClassVar[float] = CLOSING
    reopens: ClassVar[bool] = True

    @property
    @abstractmethod
    def kind(self) -> str:
        """Return the name of the kind, for messages."""

    @abstractmethod
    def open_stream(self) -> RerunStream:
        """
        Return a new stream to the receiver.

        :raises ConnectionError: it is not there, or cannot be opened
        """

    def check(self) -> None:  # noqa: B027  optional
        """
        Report a program that has ended.

        :raises ConnectionError: the receiver is lost
        """

    def complete(self, end_by: float) -> None:  # noqa: B027  optional
        """Complete a file whose stream was closed, and not lost, until a steady time [s]."""

    def close(self) -> None:  # noqa: B027  optional
        """End the program, if there is one."""

    @property
    def address(self) -> str:
        """Return the kind of the receiver, and its address once that is known."""
        return f'Rerun {self.kind}: {self.where}' if self.where else f'Rerun {self.kind}'

    @property
    def page_address(self) -> str:
        """Return the address where that is a web page; else ''."""
        return ''

    def lost_answer(self, reason: str) -> Answer:
        """Return the answer that reports a lost receiver, or another one than was asked for."""
        message = Text('{receiver}: {reason}', receiver=self.address, reason=reason)
        return Answer(topic='viewer', message=message, code=self.code)


class ClientEndpoint(Endpoint):
    """A Rerun server of another process, which may start after the world and end before it."""

    kind = 'connect'

    def __init__(self, url: str) -> None:
        self.where = url

    def open_stream(self) -> RerunStream:
        """Return a stream to the server."""
        import rerun as rr

        try:
            sink = rr.GrpcSink(self.where)
            address = urlsplit(self.where)
            host, port = address.hostname or '127.0.0.1', address.port or 9876
        except (RuntimeError, ValueError) as error:
            raise ConnectionError(error) from error
        # Without a server, GrpcSink (Rerun 0.41) waits 5 s and then keeps all data in memory.
        try:
            socket.create_connection((host, port), timeout=CONNECTING).close()
        except OSError as error:
            raise ConnectionError('nobody there') from error
        return RerunStream(sink)


class ServerEndpoint(Endpoint):
    """
    A Rerun server in this process, on loopback only, and a viewer program connected to it.

    :param native: whether the program is a window, where there is a display; else a web page
    :param report: takes answers about the program
    """

    def __init__(self, *, native: bool, report: Callable[[Answer], None]) -> None:
        self._report = report
        self._is_native = native
        self._uri = ''
        self._program: subprocess.Popen[bytes] | None = None

    @property
    def kind(self) -> str:
        """Return the kind of the program, which may become another."""
        return 'spawn' if self._is_native else 'web'

    @property
    def page_address(self) -> str:
        """Return the address of the page, once there is one."""
        return self.where if self.where.startswith('http:') else ''

    def open_stream(self) -> RerunStream:
        """Start a server and the program, and return a stream to it."""
        import rerun as rr

        self.close()
        server = rr.GrpcServerSink('127.0.0.1', _free_port(), server_memory_limit=SERVER_MEMORY)
        stream = RerunStream(server)
        self._uri = server.uri
        if self._is_native and not has_display():
            self._fall_back('there is no display')
        else:
            self._start_program()
        return stream

    def check(self) -> None:
        """Report a program that has ended; a window that has failed becomes a page."""
        program = self._program
        if program is None or (code := program.poll()) is None:
            return
        self._program = None
        if self._is_native and code:
            self._fall_back(f'the window has failed ({code})')
        else:
            self._lose_program(f'the viewer was closed ({code})')

    def close(self) -> None:
        """End the program."""
        program, self._program = self._program, None
        if program is not None:
            end_child(program, timeout=TERMINATING)

    def _fall_back(self, reason: str) -> None:
        self._is_native = False
        self._start_program()
        self._report(self.lost_answer(f'{reason}, so this page instead'))

    def _start_program(self) -> None:
        if self._is_native:
            self.where = f'window on {self._uri}'
            arguments = [f'--connect={self._uri}', '--port=auto', '--hide-welcome-screen']
        else:
            port = _free_port(9090)
            self.where = f'http://127.0.0.1:{port}/?url={quote(self._uri, safe="")}'
            arguments = ['--serve-web', f'--web-viewer-port={port}', self._uri]
        # On loopback; `rerun.serve_web_viewer` (0.41) listens on all interfaces.
        command = [rerun_program(), '--bind=127.0.0.1', *arguments]
        # Both variables keep the program from asking about analytics.
        environment = {**os.environ, 'CI': '1', 'RERUN_APP_ONLY': 'true'}
        try:
            self._program = start_child(command, environment=environment)
        except OSError as error:
            self._lose_program(f'{command[0]} cannot be run: {error}')

    def _lose_program(self, reason: str) -> None:
        """Report that there is no program; the server goes on, for another one."""
        self.where = f'any Rerun viewer at {self._uri}'
        self._report(self.lost_answer(f'{reason}; another one: rerun {self._uri}'))


def has_display() -> bool:
    """Return whether a window can be opened."""
    return bool(os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY'))


def _free_port(wanted: int = 0) -> int:
    """Return a free TCP port of this machine: the wanted one, or any other."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(('127.0.0.1', wanted))
        except OSError:
            return _free_port()
        port: int = probe.getsockname()[1]
        return port
