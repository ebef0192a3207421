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
The viewer: frames are shown in a window, on a web page or by another server, and recorded.

Law: neither a viewer nor a disk that fails or is slow delays the world.
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
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.sink_worker import (
    ANSWERS,
    Endpoint,
    FLUSH_TIMEOUT,
    Report,
    Sink,
    SinkWorker,
)

if TYPE_CHECKING:
    import rerun as rr

# Application id of the recordings in Rerun.
NAME = 'physsim'
DEFAULT_URL = 'rerun+http://127.0.0.1:9876/proxy'
# Memory of a server for late viewers.
SERVER_MEMORY = '256MiB'
# Period of Rerun's batcher [s]: at its default of 8 ms a software-rendered web viewer falls 18 s
# behind within 30 s.
TICK = 0.1
# Time after its start within which a program that ends was never up [s].
SETTLING = 10.0


class ViewerMode(Enum):
    """The kinds of viewer: the values of parameter `viewer`."""

    NONE = 'none'
    SPAWN = 'spawn'
    WEB = 'web'
    CONNECT = 'connect'
    AUTO = 'auto'


class Viewer:
    """Shows frames in at most one viewer, and records them in at most one file."""

    def __init__(self) -> None:
        self._events: deque[Answer] = deque(maxlen=ANSWERS)
        self._file: SinkWorker | None = None
        self._window: SinkWorker | None = None
        # The viewer before, which may still be closing.
        self._closing: SinkWorker | None = None
        self._shown: tuple[Frame, float] | None = None

    @property
    def state(self) -> str:
        """Return the states of viewer and file, as a sentence."""
        return '; '.join(worker.state for worker in self._workers) or 'none'

    @property
    def is_open(self) -> bool:
        """Whether there is a viewer or a file."""
        return any(worker.is_open for worker in self._workers)

    @property
    def _workers(self) -> list[SinkWorker]:
        return [worker for worker in (self._file, self._window) if worker is not None]

    def open_viewer(self, mode: ViewerMode, url: str = '') -> None:
        """
        Open another viewer, which shows the last frame too; the file is not affected.

        :param mode: kind of viewer
        :param url: of the Rerun server for CONNECT; '' is the default one of this machine
        """
        if self._window is not None:
            self._window.end()
            self._closing, self._window = self._window, None
        if mode is ViewerMode.AUTO:
            mode = ViewerMode.SPAWN if _has_display() else ViewerMode.WEB
        if mode is ViewerMode.NONE:
            return
        endpoint = (
            _ClientEndpoint(url or DEFAULT_URL)
            if mode is ViewerMode.CONNECT
            else _ServerEndpoint(native=mode is ViewerMode.SPAWN, report=self._events.append)
        )
        self._window = SinkWorker(endpoint, report=self._events.append, after=self._closing)
        if self._shown is not None:
            frame, factor = self._shown
            self._window.put_frame(frame, real_time_factor=factor)

    def record(self, path: str) -> None:
        """Record the frames from now on in another `.rrd` file."""
        if self._file is not None:
            self._file.end()
        self._file = SinkWorker(_FileEndpoint(path), report=self._events.append, after=self._file)

    def show(self, frame: Frame, *, real_time_factor: float) -> None:
        """
        Queue a frame for viewer and file; never blocks.

        :param frame: its arrays are not changed any more
        :param real_time_factor: simulation seconds a second
        """
        self._shown = frame, real_time_factor
        for worker in self._workers:
            worker.put_frame(frame, real_time_factor=real_time_factor)

    def poll(self) -> tuple[Answer, ...]:
        """Return the answers about viewers and files since the last call."""
        return tuple(self._events.popleft() for _ in range(len(self._events)))

    def close(self) -> None:
        """Log the queued frames, as far as the time for closing allows, and end."""
        workers = [*self._workers]
        if self._closing is not None:
            workers.append(self._closing)
        for worker in workers:
            worker.end()
        ended = [worker.join() for worker in workers]
        if not all(ended) and 'rerun' in sys.modules:
            # At exit Rerun (0.41) waits for its recordings, without end where a viewer is frozen.
            sys.modules['rerun'].unregister_shutdown()


class _RerunSink:
    """A recording stream of Rerun, and the recorder of frames on it."""

    def __init__(self, *sinks: rr.GrpcSink | rr.GrpcServerSink | rr.FileSink) -> None:
        # The first import takes a second, so it happens in the thread of the worker.
        from physsim_ros.view.recording import FrameRecorder
        import rerun as rr

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        self._recording = rr.RecordingStream(NAME, batcher_config=batching)
        try:
            self._recording.set_sinks(*sinks)
        except RuntimeError as error:
            raise ConnectionError(error) from error
        self._recorder = FrameRecorder(self._recording)

    def draw(self, frames: Sequence[Frame], *, real_time_factor: float) -> None:
        self._recorder.draw(frames, context=FrameContext(real_time_factor=real_time_factor))

    def flush(self, timeout: float) -> None:
        try:
            self._recording.flush(timeout_sec=timeout)
        except RuntimeError as error:
            # Rerun (0.41) raises RuntimeError for both.
            if 'timed out' in str(error):
                raise TimeoutError(error) from error
            raise ConnectionError(error) from error

    def close(self) -> None:
        self._recording.disconnect()


class _FileEndpoint(Endpoint):
    """A `.rrd` file, for which no frame is dropped."""

    kind = 'record'
    code = 'record_failed'
    period, capacity, closing, reopens = 0.5, sys.maxsize, 10.0, False

    def __init__(self, path: str) -> None:
        self.where = path

    def open_sink(self) -> Sink:
        import rerun as rr

        return _RerunSink(rr.FileSink(self.where))


class _ClientEndpoint(Endpoint):
    """A Rerun server started elsewhere, which may start later than the world and end before it."""

    kind = 'connect'

    def __init__(self, url: str) -> None:
        self.where = url

    def open_sink(self) -> Sink | None:
        import rerun as rr

        try:
            sink = rr.GrpcSink(self.where)
            address = urlsplit(self.where)
            host, port = address.hostname or '127.0.0.1', address.port or 9876
        except (RuntimeError, ValueError) as error:
            raise ConnectionError(error) from error
        # Without a server, GrpcSink (Rerun 0.41) waits 5 s and then keeps all data in memory.
        return _RerunSink(sink) if _is_open(host, port) else None


class _ServerEndpoint(Endpoint):
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
        import rerun as rr

        with self._lock:
            self._end_program()
        sink = rr.GrpcServerSink('127.0.0.1', _free_port(), server_memory_limit=SERVER_MEMORY)
        rerun_sink = _RerunSink(sink)
        self._uri = sink.uri
        if self.kind == 'spawn' and not _has_display():
            self._fall_back('there is no display')
        else:
            self._start_program()
        return rerun_sink

    def check_program(self) -> None:
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
        with self._lock:
            self._closed = True
            self._end_program()

    def _end_program(self) -> None:
        """End the program, if there is one; the caller holds the lock."""
        program, self._program = self._program, None
        if program is not None:
            program.terminate()
            try:
                program.wait(FLUSH_TIMEOUT)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()

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
                    self._program = subprocess.Popen(  # noqa: S603  the command is ours
                        command,
                        env=environment,
                        stdin=subprocess.DEVNULL,
                        stdout=subprocess.DEVNULL,
                        stderr=subprocess.DEVNULL,
                    )
        except OSError as error:
            self.where = f'any Rerun viewer at {self._uri}'
            self._report(self.lost_answer(f'{command[0]} cannot be run: {error}'))
        self._started = time.monotonic()


def _has_display() -> bool:
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
