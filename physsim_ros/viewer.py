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
Frames to Rerun: the viewer's thread, its queue and its sinks.

Law: a viewer that is absent, late, restarted or frozen never slows or stops the world. Frames are
handed over without waiting; what the thread cannot draw in time is dropped, save for its answers.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from enum import Enum
import os
from pathlib import Path
import shutil
import socket
import subprocess
import sys
import threading
from typing import Any, TYPE_CHECKING
from urllib.parse import urlsplit

from physsim_ros.core.snapshot import Answer, Frame

if TYPE_CHECKING:
    from physsim_ros.picture import Picture

# Frames that may wait, four seconds at 60 Hz: the time Rerun takes to start.
CAPACITY = 240
# How often what has gathered is drawn: ten times a second looks alive, and a batch costs little
# more than a frame [s].
TICK = 0.1
# How long the thread waits for a viewer before it calls it lost, or for the file at the end [s].
PATIENCE = 2.0
# What a served stream may keep for viewers that come late.
MEMORY = '256MiB'


class ViewerMode(Enum):
    """Where frames go."""

    NONE = 'none'
    SPAWN = 'spawn'
    WEB = 'web'
    CONNECT = 'connect'
    AUTO = 'auto'

    def chosen(self) -> ViewerMode:
        """Return what is meant: `auto` is a window where there is a display, else a page."""
        if self is not ViewerMode.AUTO:
            return self
        display = os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')
        return ViewerMode.SPAWN if display else ViewerMode.WEB


class Viewer:
    """
    Shows frames in Rerun, from a thread of its own.

    :param mode: where to
    :param url: of the Rerun server, for `connect`
    :param record_file: `.rrd` file written beside any viewer, '' for none
    """

    def __init__(self, *, mode: ViewerMode, url: str = '', record_file: str = '') -> None:
        self._mode = mode.chosen()
        self._url = url
        self._record_file = record_file
        self._frames: deque[Frame] = deque()
        self._factor = 0.0
        self._dropped = 0
        self._shown = 0
        self._where = 'starting'
        self._news: deque[Answer] = deque()
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._child: subprocess.Popen[bytes] | None = None
        self._thread = threading.Thread(target=self._run, name='viewer', daemon=True)
        self._thread.start()

    @property
    def state(self) -> str:
        """Where the frames go and how many went there, in a sentence."""
        return f'{self._where}; {self._shown} frames, {self._dropped} dropped'

    def show(self, frame: Frame, *, real_time_factor: float) -> None:
        """
        Hand over a frame, without waiting.

        :param real_time_factor: simulated seconds a second
        """
        with self._lock:
            self._factor = real_time_factor
            self._frames.append(frame)
            if len(self._frames) > CAPACITY:
                # The oldest goes; what it answered is kept with the next.
                oldest = self._frames.popleft()
                following = self._frames.popleft()
                answers = (*oldest.answers, *following.answers)[-CAPACITY:]
                self._frames.appendleft(replace(following, answers=answers))
                self._dropped += 1

    def poll(self) -> tuple[Answer, ...]:
        """Return what has happened to the viewer since the last call."""
        news = []
        while self._news:
            news.append(self._news.popleft())
        return tuple(news)

    def close(self) -> None:
        """Draw what waits, end the file and the viewer's processes; gives up after a while."""
        self._closing.set()
        self._thread.join(PATIENCE)
        if self._child is not None:
            self._child.terminate()

    # In the thread

    def _run(self) -> None:
        while not self._closing.is_set():
            try:
                recording = self._open()
            except OSError as error:
                self._tell(f'waiting for {self._url}: {error}', code='viewer_lost')
                self._closing.wait(1.0)
                continue
            self._draw(recording)

    def _draw(self, recording: Any) -> None:
        from physsim_ros.picture import Picture  # noqa: PLC0415 - Rerun takes a second to import

        picture = Picture(recording)
        while True:
            closing = self._closing.wait(TICK)
            self._draw_waiting(picture)
            if closing:
                recording.flush(timeout_sec=PATIENCE)
                recording.disconnect()
                return
            if self._mode is ViewerMode.CONNECT and not self._lives(recording):
                self._tell(f'lost {self._url}', code='viewer_lost')
                return

    def _draw_waiting(self, picture: Picture) -> None:
        with self._lock:
            frames, factor = list(self._frames), self._factor
            self._frames.clear()
        if frames:
            picture.draw(frames, real_time_factor=factor)
            self._shown += len(frames)

    def _open(self) -> Any:
        """
        Open a recording with its sinks.

        :raises OSError: there is no server to connect to
        """
        if self._mode is ViewerMode.CONNECT:
            _probe(self._url)
        import rerun as rr  # noqa: PLC0415 - it takes a second

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        recording = rr.RecordingStream('physsim', batcher_config=batching)
        sinks: list[Any] = []
        if self._record_file:
            try:
                Path(self._record_file).open('wb').close()
                sinks.append(rr.FileSink(self._record_file))
            except OSError as error:
                self._tell(f'cannot record: {error}', code='record_failed')
        if self._mode is ViewerMode.CONNECT:
            sinks.append(rr.GrpcSink(self._url))
            self._tell(f'connected to {self._url}')
        elif self._mode is not ViewerMode.NONE:
            server = rr.GrpcServerSink('127.0.0.1', _free_port(), server_memory_limit=MEMORY)
            sinks.append(server)
            self._show_served(server.uri)
        else:
            self._where = f'recording to {self._record_file}'
        if sinks:
            recording.set_sinks(*sinks)
        return recording

    def _show_served(self, uri: str) -> None:
        """Start the program that shows a served stream, in a window or as a page."""
        program = Path(sys.executable).with_name('rerun')
        command = [str(program) if program.exists() else shutil.which('rerun') or 'rerun']
        if self._mode is ViewerMode.SPAWN:
            command += ['--port', 'auto', '--connect', uri]
            where = f'native viewer of {uri}'
        else:
            port = _free_port()
            command += ['--serve-web', '--bind', '127.0.0.1', '--web-viewer-port', str(port), uri]
            where = f'web viewer: http://127.0.0.1:{port}?url={uri}'
        try:
            self._child = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=os.environ | {'CI': '1', 'RERUN_APP_ONLY': 'true'},
            )
        except OSError as error:
            where = f'no viewer program ({error}); serving {uri}'
        self._tell(where)

    def _lives(self, recording: Any) -> bool:
        try:
            _probe(self._url)
            recording.flush(timeout_sec=PATIENCE)
        except (OSError, RuntimeError):
            return False
        return True

    def _tell(self, where: str, *, code: str = '') -> None:
        if where != self._where:
            self._where = where
            self._news.append(Answer(topic='viewer', message=where, code=code))


def _probe(url: str) -> None:
    """
    Find out whether somebody listens: Rerun itself would block for seconds.

    :raises OSError: nobody does
    """
    parts = urlsplit(url.removeprefix('rerun+'))
    socket.create_connection((parts.hostname or '127.0.0.1', parts.port or 9876), 0.5).close()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        port: int = probe.getsockname()[1]
        return port
