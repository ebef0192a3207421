# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make gallery`; `make gallery ARGS='car demo'` chooses the pictures by their names."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
import sys
import tempfile
from test.pictures import headless_viewer, HeadlessViewer
from test.view.picture_file import Recording
from test.worlds.digests import scene, SCENES

from physsim_ros.drawing import DrawingSession, DrawingSettings, Tool
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.robot import Robot
from physsim_ros.simulation.simulation import Simulation

from .classroom import draw_class
from .page import draw_crash, draw_page
from .stories import car_story

DOCS = Path(__file__).parents[2] / 'docs'
# Window of the pictures [pixels]: the world in it is 16 : 9.
WIDTH, HEIGHT = 1400, 920
# Simulation time of the picture of a scene [s], at the moment of most motion.
TIMES = {
    'drawings/catapult': 0.5,
    'drawings/clock': 2.0,
    'drawings/cradle': 0.5,
    'drawings/double_pendulum': 0.4,
    'drawings/marble_run': 6.0,
    'drawings/seesaw': 1.0,
    'drawings/windmill': 0.5,
    'worlds/boxes': 10.0,
    'worlds/bridge': 4.0,
    'worlds/car': 5.5,
    'worlds/catapult': 1.6,
    'worlds/demo': 2.2,
    'worlds/dominoes': 3.5,
    'worlds/galton': 14.0,
    'worlds/incline': 1.6,
    'worlds/newtons_cradle': 1.1,
    'worlds/pendulums': 6.0,
    'worlds/sorting': 7.5,
    'worlds/warehouse': 8.0,
}
USUAL = 3.0
# Command of every robot of a scene: forward [m/s], turn [rad/s].
COMMANDS = {
    'worlds/boxes': (0.22, 0.0),
    'worlds/burger': (0.2, 0.3),
    'worlds/maze': (0.15, 0.0),
    'worlds/people': (0.22, 0.1),
    'worlds/soccer': (0.4, 0.4),
    'worlds/swarm': (0.2, 0.5),
}
# Height of the title bar of the window [pixels].
TITLE = 36
# Frames in a batch of the recorder.
BATCH = 60
# Pictures of pages, which a browser draws.
PAGES: dict[str, Callable[[], None]] = {
    'page': lambda: draw_page(DOCS / 'page.webp', DOCS / 'time.png'),
    'class': lambda: draw_class(DOCS / 'class.webp', DOCS / 'class.png'),
    'crash': lambda: draw_crash(DOCS / 'crash.webp'),
}


def record(recording: Recording, frames: list[Frame]) -> int:
    """Draw frames batch by batch; return the time of the last on the picture's timeline [ns]."""
    for first in range(0, len(frames), BATCH):
        end = first + BATCH
        now = recording.draw(*frames[first:end], real_time_factor=frames[-1].speed)
    return now


def frames_until(simulation: Simulation, seconds: float) -> Iterator[Frame]:
    """Yield the frames of a simulation up to a time [s]."""
    simulation.reports_contacts = True
    simulation.speed = 1.0
    while simulation.step < seconds * simulation.physics_rate:
        yield simulation.advance_frame()


def draw_scene(viewer: HeadlessViewer, directory: Path, name: str) -> None:
    """Draw the picture of a world or a drawing."""
    recording = Recording(directory / f'{Path(name).name}.rrd')
    simulation = scene(name)
    if name in COMMANDS:
        described = simulation.sensed.snapshot.scene
        for row in described.robot_rows:
            Robot(simulation, described.names[row]).drive(*COMMANDS[name])
    now = record(recording, list(frames_until(simulation, TIMES.get(name, USUAL))))
    recording.close()
    viewer.open_recording(recording.path)
    path = DOCS / f'{name}.png'
    path.parent.mkdir(exist_ok=True)
    viewer.picture(now).save(path, optimize=True)


def draw_drawing(viewer: HeadlessViewer, directory: Path) -> None:
    """Draw a car of strokes, and beside it a polygon that clicks have half drawn."""
    *_, frame = frames_until(scene('drawings/car'), 1.5)
    session = DrawingSession(DrawingSettings(), Tool.POLYGON)
    for point in ((10.0, 4.6), (12.0, 4.4), (12.8, 5.6), (11.4, 6.6)):
        session.click(point, '', frame.snapshot)
    recording = Recording(directory / 'drawing.rrd')
    now = record(recording, [replace(frame, preview=session.preview)])
    recording.close()
    viewer.open_recording(recording.path)
    viewer.picture(now).save(DOCS / 'drawing.png', optimize=True)


def draw_window(viewer: HeadlessViewer, directory: Path) -> None:
    """Draw the whole window, in which time has gone back."""
    times = show_story(viewer, directory, car_story())
    window = viewer.picture(times[-1], view='')
    window.crop((0, TITLE, *window.size)).save(DOCS / 'demo.png', optimize=True)


def show_story(viewer: HeadlessViewer, directory: Path, frames: list[Frame]) -> list[int]:
    """Show frames; return the time of each on the timeline of the picture [ns]."""
    recording = Recording(directory / 'story.rrd')
    times = [record(recording, [frame]) for frame in frames]
    recording.close()
    viewer.open_recording(recording.path)
    return times


def main(chosen: list[str]) -> None:
    """Draw the chosen pictures, or all."""
    pictures: dict[str, Callable[[HeadlessViewer, Path], None]] = {
        'drawing': draw_drawing,
        'window': draw_window,
    }
    if unknown := {*chosen} - {Path(name).name for name in (*SCENES, *pictures, *PAGES)}:
        sys.exit(f'no picture {", ".join(sorted(unknown))}')
    for name, draw in PAGES.items():
        if not chosen or name in chosen:
            draw()
            print(name, flush=True)
    names = [name for name in (*SCENES, *pictures) if not chosen or Path(name).name in chosen]
    if not names:
        return
    with (
        tempfile.TemporaryDirectory() as directory,
        headless_viewer(WIDTH, HEIGHT) as viewer,
    ):
        for name in names:
            if name in pictures:
                pictures[name](viewer, Path(directory))
            else:
                draw_scene(viewer, Path(directory), name)
            print(name, *(f'{view}: {error}' for view, error in viewer.errors()), flush=True)


if __name__ == '__main__':
    main(sys.argv[1:])
