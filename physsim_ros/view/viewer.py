# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The viewer: where frames are shown and recorded.

Law: nothing that happens to a viewer or a disk slows or stops the world.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from enum import Enum
import importlib.util
import os
from pathlib import Path
import shutil
import socket
import subprocess
import sys
import threading
import time
from typing import TYPE_CHECKING
from urllib.parse import quote, urlsplit

from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.sink_worker import ANSWERS, Canvas, Outlet, PATIENCE, Tell, Way

if TYPE_CHECKING:
    import rerun as rr

# Under which Rerun lists what it is shown.
NAME = 'physsim'
USUAL_URL = 'rerun+http://127.0.0.1:9876/proxy'
# What is served to browsers that come late.
SERVED = '256MiB'
# A batch is sent on after so long [s]: with Rerun's own 8 ms a software-rendered web viewer falls
# 18 s behind in 30.
TICK = 0.1
# A window that ends with an error before that was never one; nor was a page server that ends [s].
SETTLING = 10.0


class ViewerMode(Enum):
    """Where frames are shown."""

    NONE = 'none'
    SPAWN = 'spawn'
    WEB = 'web'
    CONNECT = 'connect'
    AUTO = 'auto'


class Viewer:
    """Shows frames, and records them: nowhere at first."""

    def __init__(self) -> None:
        self._events: deque[Answer] = deque(maxlen=ANSWERS)
        self._file: Outlet | None = None
        self._window: Outlet | None = None
        # The window before, which may still be closing.
        self._closing: Outlet | None = None
        self._shown: tuple[Frame, float] | None = None

    @property
    def state(self) -> str:
        """Tell what is shown where, in a sentence."""
        return '; '.join(outlet.state for outlet in self._outlets) or 'none'

    @property
    def is_open(self) -> bool:
        """Whether frames go anywhere."""
        return any(outlet.is_open for outlet in self._outlets)

    @property
    def _outlets(self) -> list[Outlet]:
        return [outlet for outlet in (self._file, self._window) if outlet is not None]

    def turn_to(self, mode: ViewerMode, url: str = '') -> None:
        """
        Show frames elsewhere from now on, the last one too; what is recorded goes on.

        :param mode: where
        :param url: of the Rerun server for CONNECT; '' is the usual one of this machine
        """
        if self._window is not None:
            self._window.end()
            self._closing, self._window = self._window, None
        if mode is ViewerMode.AUTO:
            mode = ViewerMode.SPAWN if _has_display() else ViewerMode.WEB
        if mode is ViewerMode.NONE:
            return
        way = (
            _Client(url or USUAL_URL)
            if mode is ViewerMode.CONNECT
            else _Server(native=mode is ViewerMode.SPAWN, tell=self._events.append)
        )
        self._window = Outlet(way, tell=self._events.append, after=self._closing)
        if self._shown is not None:
            frame, factor = self._shown
            self._window.put(frame, real_time_factor=factor)

    def record(self, path: str) -> None:
        """Write what is shown from now on to a `.rrd` file, and no more to the one before."""
        if self._file is not None:
            self._file.end()
        self._file = Outlet(_File(path), tell=self._events.append, after=self._file)

    def show(self, frame: Frame, *, real_time_factor: float) -> None:
        """
        Show a frame soon; this never blocks.

        :param frame: its arrays are never written again
        :param real_time_factor: simulated seconds a second
        """
        self._shown = frame, real_time_factor
        for outlet in self._outlets:
            outlet.put(frame, real_time_factor=real_time_factor)

    def poll(self) -> tuple[Answer, ...]:
        """Return what has happened to viewers and files since the last call."""
        return tuple(self._events.popleft() for _ in range(len(self._events)))

    def close(self) -> None:
        """Show and write what waits as far as that goes at once, and end."""
        outlets = [*self._outlets] if self._closing is None else [*self._outlets, self._closing]
        for outlet in outlets:
            outlet.end()
        ended = [outlet.join() for outlet in outlets]
        if not all(ended) and 'rerun' in sys.modules:
            # At exit Rerun waits for every viewer, for a frozen one without end.
            sys.modules['rerun'].unregister_shutdown()


class _RerunCanvas:
    """A stream of Rerun's and the picture on it."""

    def __init__(self, *sinks: rr.GrpcSink | rr.GrpcServerSink | rr.FileSink) -> None:
        # Takes a second the first time, so this runs in the outlet's thread.
        from physsim_ros.view.recording import Picture
        import rerun as rr

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        self._recording = rr.RecordingStream(NAME, batcher_config=batching)
        try:
            self._recording.set_sinks(*sinks)
        except RuntimeError as error:
            raise ConnectionError(error) from error
        self._picture = Picture(self._recording)

    def draw(self, frames: Sequence[Frame], *, real_time_factor: float) -> None:
        self._picture.draw(frames, real_time_factor=real_time_factor)

    def flush(self, patience: float) -> None:
        try:
            self._recording.flush(timeout_sec=patience)
        except RuntimeError as error:
            # Rerun has one class of error for both.
            if 'timed out' in str(error):
                raise TimeoutError(error) from error
            raise ConnectionError(error) from error

    def close(self) -> None:
        self._recording.disconnect()


class _File(Way):
    """A file, which is to hold every frame, and takes them as fast as they come."""

    kind = 'record'
    code = 'record_failed'
    period, waiting, closing, again = 0.5, sys.maxsize, 10.0, False

    def __init__(self, path: str) -> None:
        self.where = path

    def begin(self) -> Canvas:
        import rerun as rr

        return _RerunCanvas(rr.FileSink(self.where))


class _Client(Way):
    """Somebody else's Rerun server, which may come late and go again."""

    kind = 'connect'

    def __init__(self, url: str) -> None:
        self.where = url

    def begin(self) -> Canvas | None:
        import rerun as rr

        try:
            sink = rr.GrpcSink(self.where)
            address = urlsplit(self.where)
            host, port = address.hostname or '127.0.0.1', address.port or 9876
        except (RuntimeError, ValueError) as error:
            raise ConnectionError(error) from error
        # Rerun would wait 5 s for nobody, and then keep all that it is given.
        return _RerunCanvas(sink) if _is_open(host, port) else None


class _Server(Way):
    """
    A server of our own on this machine alone, and a program that shows what it serves.

    :param native: in a window, where one can be had; else on a page
    :param tell: takes what happens
    """

    def __init__(self, *, native: bool, tell: Tell) -> None:
        self._tell = tell
        self.kind = 'spawn' if native else 'web'
        self._uri = ''
        self._program: subprocess.Popen[bytes] | None = None
        self._started = 0.0
        # Held while a program is started or ended, so that none is started behind `close`.
        self._lock = threading.Lock()
        self._closed = False

    def begin(self) -> Canvas:
        import rerun as rr

        with self._lock:
            self._end()
        sink = rr.GrpcServerSink('127.0.0.1', _free_port(), server_memory_limit=SERVED)
        stream = _RerunCanvas(sink)
        self._uri = sink.uri
        if self.kind == 'spawn' and not _has_display():
            self._fall_back('there is no display')
        else:
            self._start()
        return stream

    def look(self) -> None:
        program = self._program
        if program is None or (code := program.poll()) is None:
            return
        self._program = None
        settling = time.monotonic() - self._started < SETTLING
        if self.kind == 'web' and settling:
            self.where = f'any Rerun viewer at {self._uri}'
            self._tell(self.lost(f'no page could be served ({code})'))
        elif self.kind == 'web':
            self._tell(self.lost(f'the page server ended ({code}); it is started again'))
            self._start()
        elif code and settling:
            self._fall_back(f'no window could be opened ({code})')
        else:
            self._tell(self.lost(f'the window was closed; another one: rerun {self._uri}'))

    def close(self) -> None:
        with self._lock:
            self._closed = True
            self._end()

    def _end(self) -> None:
        """End the program, if there is one; with the lock held."""
        program, self._program = self._program, None
        if program is not None:
            program.terminate()
            try:
                program.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()

    def _fall_back(self, why: str) -> None:
        self.kind = 'web'
        self._start()
        self._tell(self.lost(f'{why}, so this page instead'))

    def _start(self) -> None:
        if self.kind == 'spawn':
            self.where = f'window on {self._uri}'
            arguments = [f'--connect={self._uri}', '--port=auto', '--hide-welcome-screen']
        else:
            port = _free_port(9090)
            self.where = f'http://127.0.0.1:{port}/?url={quote(self._uri, safe="")}'
            arguments = ['--serve-web', f'--web-viewer-port={port}', self._uri]
        # On loopback; `rerun.serve_web_viewer` would be open to all the network.
        command = [_program(), '--bind=127.0.0.1', *arguments]
        # These two keep it from asking for analytics.
        environment = {**os.environ, 'CI': '1', 'RERUN_APP_ONLY': 'true'}
        try:
            with self._lock:
                if not self._closed:
                    self._program = subprocess.Popen(  # noqa: S603  the command is ours
                        command,
                        env=environment,
                        stdin=subprocess.DEVNULL,
                        stdout=subprocess.DEVNULL,
                        stderr=subprocess.DEVNULL,
                    )
        except OSError as error:
            self.where = f'any Rerun viewer at {self._uri}'
            self._tell(self.lost(f'{command[0]} cannot be run: {error}'))
        self._started = time.monotonic()


def _has_display() -> bool:
    return bool(os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY'))


def _is_open(host: str, port: int) -> bool:
    try:
        socket.create_connection((host, port), timeout=PATIENCE).close()
    except OSError:
        return False
    return True


def _free_port(wanted: int = 0) -> int:
    """Return a port of this machine that nobody listens on: the one wanted, or any other."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(('127.0.0.1', wanted))
        except OSError:
            return _free_port()
        port: int = probe.getsockname()[1]
        return port


def _program() -> str:
    """Return the Rerun viewer of the wheel, or what the path has."""
    spec = importlib.util.find_spec('rerun_cli')
    if spec is not None and spec.origin is not None:
        program = Path(spec.origin).with_name('rerun')
        if program.exists():
            return str(program)
    return shutil.which('rerun') or 'rerun'
