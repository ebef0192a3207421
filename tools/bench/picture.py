# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The picture: bytes of recordings, and how far a viewer without a graphics card is behind.

A viewer joins a stream of falling bodies that has run for some seconds, and is asked each second
which time it shows.
"""

from __future__ import annotations

from pathlib import Path
import tempfile
from test.pictures import has_vulkan, headless_viewer
from test.rerun_program import free_port
from test.view.picture_file import Recording
from test.worlds.film import simulation
import threading
import time

from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.view import FrameContext
from physsim_ros.view.recording import FrameRecorder
import rerun as rr

from .bodies import fill

BODIES, SECONDS = 1000, 10
# Simulation time before the viewer joins [s].
LATE = 5
FRAMES = 60
# Frames in a batch of a file, and of a viewer.
FILED, SHOWN = 60, 6
CONTEXT = FrameContext(real_time_factor=1.0)


def table() -> None:
    """Print bytes and lag."""
    print('A recording                   [MB a minute]  [bytes a body and frame]')
    falling = _falling()
    pile = falling.simulate(SECONDS)
    print_size(f'{BODIES} bodies falling', pile)
    gears = _Scene(simulation('gear_train')).simulate(6 * SECONDS)
    print_size('gear_train, 7 bodies', gears)
    if has_vulkan():
        pile += falling.simulate(LATE)
        print_lag(pile)


class _Scene:
    """A simulation whose contacts are watched."""

    def __init__(self, sim: Simulation) -> None:
        self._simulation = sim
        sim.reports_contacts = True

    def simulate(self, seconds: int) -> list[Frame]:
        """Return the frames of the next seconds."""
        return [self._simulation.advance_frame() for _ in range(seconds * FRAMES)]


def _falling() -> _Scene:
    sim = Simulation(physics_rate=240, publish_rate=FRAMES)
    fill(sim.world, BODIES, settle=0.0)
    return _Scene(sim)


def print_size(name: str, frames: list[Frame]) -> None:
    """Print what a recording of frames takes."""
    with tempfile.TemporaryDirectory() as directory:
        recording = Recording(Path(directory) / 'it.rrd')
        for first in range(0, len(frames), FILED):
            end = first + FILED
            recording.draw(*frames[first:end], real_time_factor=1.0)
        recording.close()
        size = recording.path.stat().st_size
    minutes = len(frames) / FRAMES / 60
    each = size / len(frames) / len(frames[0].snapshot.poses)
    print(f'{name:28} {size / 1e6 / minutes:14.2f} {each:24.1f}', flush=True)


def print_lag(frames: list[Frame]) -> None:
    """Print how far a viewer is behind that joins a running world."""
    stream = rr.RecordingStream('bench', batcher_config=rr.ChunkBatcherConfig(flush_tick=0.1))
    sink = rr.GrpcServerSink('127.0.0.1', free_port(), server_memory_limit='256MiB')
    stream.set_sinks(sink)
    recorder = FrameRecorder(stream)

    def send() -> None:
        begun = time.monotonic()
        for first in range(0, len(frames), SHOWN):
            time.sleep(max(0.0, begun + first / FRAMES - time.monotonic()))
            end = first + SHOWN
            recorder.log(frames[first:end], context=CONTEXT)

    thread = threading.Thread(target=send)
    thread.start()
    time.sleep(LATE)
    begun = time.monotonic()
    print(f'A viewer that joins {BODIES} falling bodies after {LATE} s')
    with headless_viewer(1200, 800) as viewer:
        viewer.client.open(sink.uri)
        while thread.is_alive():
            (shown,) = viewer.client.get_state().recordings
            behind = (recorder.recorded - (shown.current_time or 0)) * 1e-9
            print(f'{time.monotonic() - begun:6.1f} s: {behind:5.2f} s behind', flush=True)
            time.sleep(1.0)
    thread.join()
    stream.disconnect()
