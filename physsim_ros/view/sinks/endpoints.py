# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The Rerun servers that frames are sent to: one elsewhere, and one here with its viewer program.

Law: whatever is opened or started here is closed and ended here.
"""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
import shutil
import socket
import subprocess
import threading
import time
from urllib.parse import quote, urlsplit

from physsim_ros.view.sinks.child_process import end_child, start_child
from physsim_ros.view.sinks.sink import Endpoint, Report, Sink
from physsim_ros.view.sinks.sink_worker import FLUSH_TIMEOUT

DEFAULT_URL = 'rerun+http://127.0.0.1:9876/proxy'
# Memory of a server for late viewers.
SERVER_MEMORY = '256MiB'
# Time after its start within which a program that ends was never up [s].
SETTLING = 10.0


class ClientEndpoint(Endpoint):
    """A Rerun server started elsewhere, which may start later than the world and end before it."""

    kind = 'connect'

    def __init__(self, url: str) -> None:
        self.where = url

    def open_sink(self) -> Sink | None:
        """Return a recording to the server, if there is one by now."""
        import rerun as rr

        try:
            sink = rr.GrpcSink(self.where)
            address = urlsplit(self.where)
            host, port = address.hostname or '127.0.0.1', address.port or 9876
        except (RuntimeError, ValueError) as error:
            raise ConnectionError(error) from error
        # Without a server, GrpcSink (Rerun 0.41) waits 5 s and then keeps all data in memory.
        return Sink(sink) if _is_open(host, port) else None


class ServerEndpoint(Endpoint):
    """
    A Rerun server in this process, on loopback only, and a viewer program connected to it.

    :param native: whether the program is a window, where there is a display; else a web page
    :param report: takes answers about the program
    """

    def __init__(self, *, native: bool, report: Report) -> None:
        self._report = report
        self.kind = 'spawn' if native else 'web'
        self._uri = ''
        self._program: subprocess.Popen[bytes] | None = None
        self._started = 0.0
        # Guards start and end of the program, so that none is started after `close`.
        self._lock = threading.Lock()
        self._closed = False

    def open_sink(self) -> Sink:
        """Start a server and the program, and return a recording to it."""
        import rerun as rr

        with self._lock:
            self._end_program()
        server = rr.GrpcServerSink('127.0.0.1', _free_port(), server_memory_limit=SERVER_MEMORY)
        sink = Sink(server)
        self._uri = server.uri
        if self.kind == 'spawn' and not has_display():
            self._fall_back('there is no display')
        else:
            self._start_program()
        return sink

    def check(self) -> None:
        """Restart or report a program that has ended."""
        program = self._program
        if program is None or (code := program.poll()) is None:
            return
        self._program = None
        settling = time.monotonic() - self._started < SETTLING
        if self.kind == 'web' and settling:
            self.where = f'any Rerun viewer at {self._uri}'
            self._report(self.lost_answer(f'no page could be served ({code})'))
        elif self.kind == 'web':
            self._report(self.lost_answer(f'the page server ended ({code}); it is started again'))
            self._start_program()
        elif code and settling:
            self._fall_back(f'no window could be opened ({code})')
        else:
            self._report(
                self.lost_answer(f'the window was closed; another one: rerun {self._uri}')
            )

    def close(self) -> None:
        """End the program and start none any more."""
        with self._lock:
            self._closed = True
            self._end_program()

    def _end_program(self) -> None:
        """End the program, if there is one; the caller holds the lock."""
        program, self._program = self._program, None
        if program is not None:
            end_child(program, timeout=FLUSH_TIMEOUT)

    def _fall_back(self, reason: str) -> None:
        self.kind = 'web'
        self._start_program()
        self._report(self.lost_answer(f'{reason}, so this page instead'))

    def _start_program(self) -> None:
        if self.kind == 'spawn':
            self.where = f'window on {self._uri}'
            arguments = [f'--connect={self._uri}', '--port=auto', '--hide-welcome-screen']
        else:
            port = _free_port(9090)
            self.where = f'http://127.0.0.1:{port}/?url={quote(self._uri, safe="")}'
            arguments = ['--serve-web', f'--web-viewer-port={port}', self._uri]
        # On loopback; `rerun.serve_web_viewer` (0.41) listens on all interfaces.
        command = [_program(), '--bind=127.0.0.1', *arguments]
        # Both variables keep the program from asking about analytics.
        environment = {**os.environ, 'CI': '1', 'RERUN_APP_ONLY': 'true'}
        try:
            with self._lock:
                if not self._closed:
                    self._program = start_child(command, environment=environment)
        except OSError as error:
            self.where = f'any Rerun viewer at {self._uri}'
            self._report(self.lost_answer(f'{command[0]} cannot be run: {error}'))
        self._started = time.monotonic()


def has_display() -> bool:
    """Return whether a window can be opened."""
    return bool(os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY'))


def _is_open(host: str, port: int) -> bool:
    try:
        socket.create_connection((host, port), timeout=FLUSH_TIMEOUT).close()
    except OSError:
        return False
    return True


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


def _program() -> str:
    """Return the path of the viewer program of the rerun-sdk wheel, or of that on PATH."""
    spec = importlib.util.find_spec('rerun_cli')
    if spec is not None and spec.origin is not None:
        program = Path(spec.origin).with_name('rerun')
        if program.exists():
            return str(program)
    return shutil.which('rerun') or 'rerun'
