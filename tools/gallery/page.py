# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The page, worked by pen and mouse: animations in which time goes back, and a body is moved there.

A car that a pen draws rolls against a wall; a robot that has hit a crate passes it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
import io
import itertools
import math
from pathlib import Path
import tempfile
from test.outside import Outside
from test.sketchpad.chromium import circle, launched_chromium, Sheet, started_world

from physsim_ros.testing.domain import own_domain
from PIL import Image
from playwright.sync_api import sync_playwright

from .stories import ASIDE, CRASH_BACK, CRASH_END, CRASH_TURN, CRATE, YARD

Stroke = list[tuple[float, float]]
WORLD = """
format: 1
bounds: [-8, 0, 8, 9]
bodies: []
"""
# Rate of the animation [Hz], frames of the world in each of its pictures, and its width [pixels].
RATE, FRAMES, NARROW = 12, 5, 800
# Simulation times at which the slider is dragged back, to which, and at the end [s].
TURN, BACK, END = 3.2, 0.8, 2.8
# A wall that hangs over the road, and the distance by which it is moved down [m].
WALL, DOWN = ((4.6, 6.4), (4.6, 4.4)), 2.8
# Duration of the first and of the last picture [ms].
REST = 900


def line(*corners: tuple[float, float]) -> Stroke:
    """Return a stroke from corner to corner, a sample every 20 cm [m]."""
    points: Stroke = []
    for (x, y), (u, v) in itertools.pairwise(corners):
        count = max(2, round(math.dist((x, y), (u, v)) / 0.2))
        points += [(x + (u - x) * i / count, y + (v - y) * i / count) for i in range(count + 1)]
    return points


def car() -> list[Stroke]:
    """Return the strokes of a road, a wall and a car."""
    wheels = [(-6.0, 5.9), (-4.2, 5.9)]
    return [
        line((-7.6, 4.6), (1.0, 1.4), (7.6, 1.4)),
        line(*WALL),
        line((-6.6, 6.0), (-3.6, 6.0), (-3.6, 6.9), (-6.6, 6.9), (-6.6, 6.0)),
        *(circle(x, y, 0.5) for x, y in wheels),
        *(circle(x, y, 0.14) for x, y in wheels),
    ]


class Film:
    """
    The pictures of a page that is worked.

    :param sheet: the page

    :ivar sheet: the page
    """

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet
        self.pictures: list[Image.Image] = []

    def shoot(self, times: int = 1) -> None:
        """Add a picture, several times if it is to be looked at."""
        picture = Image.open(io.BytesIO(self.sheet.page.screenshot()))
        self.pictures += [picture.convert('RGB')] * times

    def draw(self, strokes: list[Stroke]) -> None:
        """Draw strokes by the pen."""
        self.sheet.press('Pen')
        for stroke in strokes:
            self._drag(stroke, every=8)
            # Strokes that follow each other at once would be read as one figure.
            self.sheet.page.wait_for_timeout(1000)
            self.shoot()
            # The card of the pen is gone, and its room with it.
            self.sheet.press('Frame the world')

    def step_to(self, end: float) -> None:
        """Step to a simulation time [s]."""
        sheet = self.sheet
        while (now := sheet.page.evaluate('physsim.time')) < end:
            for _ in range(FRAMES):
                sheet.press('Step')
            sheet.wait('time => physsim.time > time', now + (FRAMES - 0.5) / 60)
            self.shoot()

    def slide_back(self, now: float, end: float) -> None:
        """Drag the slider of time back, from one simulation time to another [s]."""
        sheet = self.sheet
        slider = sheet.page.get_by_role('slider', name='Time')
        while now > end:
            now -= 2 * FRAMES / 60
            slider.fill(str(now))
            slider.blur()
            sheet.wait('time => Math.abs(physsim.time - time) < 0.02', now)
            self.shoot()

    def carry(
        self, body: tuple[float, float], by: tuple[float, float], beside: tuple[float, float]
    ) -> None:
        """Choose a body by the lasso, carry it by a vector, and tap beside all bodies [m]."""
        sheet = self.sheet
        x, y = body
        sheet.press('Lasso')
        sheet.drag(body)
        # The panel of the body has opened then.
        sheet.page.wait_for_timeout(500)
        self.shoot()
        self._drag(line(body, (x + by[0], y + by[1])), every=2)
        # A tap beside the bodies chooses none, and closes the panel.
        sheet.drag(beside)
        sheet.page.wait_for_timeout(500)
        sheet.press('Frame the world')
        self.shoot()

    def save(self, path: Path, *, rate: int = RATE) -> None:
        """Write the pictures as an animation of a rate [Hz]."""
        size = (NARROW, round(NARROW * self.pictures[0].height / self.pictures[0].width))
        first, *others = (each.resize(size, Image.Resampling.LANCZOS) for each in self.pictures)
        times = [1000 // rate] * len(self.pictures)
        times[0] = times[-1] = REST
        first.save(
            path, save_all=True, append_images=others, duration=times, loop=0, quality=60, method=4
        )

    def _drag(self, stroke: Stroke, *, every: int) -> None:
        """Drag the mouse along a stroke, with a picture after every so many samples."""
        mouse = self.sheet.page.mouse
        mouse.move(*self.sheet.place(*stroke[0]))
        mouse.down()
        for number, point in enumerate(stroke[1:], 1):
            mouse.move(*self.sheet.place(*point))
            if number % every == 0:
                self.shoot()
        mouse.up()


@contextmanager
def film_of(world: str) -> Iterator[Film]:
    """Show a world, which is paused, on a page, and yield the film of it."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        file = directory / 'world.yaml'
        file.write_text(world)
        _, address = started_world(outside, world_file=file, speed=0.0)
        browser = launched_chromium(closing.enter_context(sync_playwright()))
        sheet = Sheet(browser, address)
        yield Film(sheet)
        sheet.close()
        browser.close()


def draw_page(path: Path, last: Path) -> None:
    """Write the animation of the page, and its last picture, beside the course that was left."""
    with film_of(WORLD) as film:
        film.draw(car())
        film.step_to(TURN)
        film.slide_back(TURN, BACK)
        x, (top, bottom) = WALL[0][0], (WALL[0][1], WALL[1][1])
        film.carry((x, (top + bottom) / 2), (0.0, -DOWN), beside=(0.0, 8.0))
        film.step_to(END)
    film.pictures[-1].save(last, optimize=True)
    film.save(path)


def draw_crash(path: Path) -> None:
    """Write the animation of a robot that hits a crate, and passes when that is moved before."""
    with film_of(YARD) as film:
        film.step_to(CRASH_TURN)
        film.slide_back(CRASH_TURN, CRASH_BACK)
        film.carry(CRATE, ASIDE, beside=(-2.0, -0.6))
        film.step_to(CRASH_END)
    film.save(path)
