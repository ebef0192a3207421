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

"""The page, drawn on: an animation of a car that a pen draws, that rolls, and that goes back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
import io
import itertools
import math
from pathlib import Path
import tempfile

from PIL import Image
from playwright.sync_api import sync_playwright

from ..outside import Outside, own_domain
from ..sketchpad.chromium import launched_chromium, Sheet, started_world

Stroke = list[tuple[float, float]]
WORLD = """
format: 1
bounds: [-8, 0, 8, 9]
bodies: []
"""
# Rate of the animation [Hz], frames of the world in each of its pictures, and its width [pixels].
RATE, FRAMES, NARROW = 12, 5, 800
# Simulation time at which the slider is dragged back, and to which [s].
END, BACK = 4.0, 0.2
# How long the first and the last picture stay [ms].
REST = 900


def line(*corners: tuple[float, float]) -> Stroke:
    """Return a stroke from corner to corner, a sample every 20 cm [m]."""
    points: Stroke = []
    for (x, y), (u, v) in itertools.pairwise(corners):
        count = max(2, round(math.dist((x, y), (u, v)) / 0.2))
        points += [(x + (u - x) * i / count, y + (v - y) * i / count) for i in range(count + 1)]
    return points


def circle(x: float, y: float, radius: float) -> Stroke:
    """Return a round stroke."""
    angles = [math.tau * each / 24 for each in range(25)]
    return [(x + radius * math.cos(each), y + radius * math.sin(each)) for each in angles]


def car() -> list[Stroke]:
    """Return the strokes of a road and a car above it."""
    wheels = [(-6.0, 5.9), (-4.2, 5.9)]
    return [
        line((-7.6, 4.6), (1.0, 1.4), (7.6, 1.4)),
        line((-6.6, 6.0), (-3.6, 6.0), (-3.6, 6.9), (-6.6, 6.9), (-6.6, 6.0)),
        *(circle(x, y, 0.5) for x, y in wheels),
        *(circle(x, y, 0.14) for x, y in wheels),
    ]


def pictures(sheet: Sheet) -> Iterator[Image.Image]:
    """Yield the pictures: strokes, the way down, and the way back by the slider."""

    def shot() -> Image.Image:
        return Image.open(io.BytesIO(sheet.page.screenshot())).convert('RGB')

    sheet.press('Pen')
    mouse = sheet.page.mouse
    for stroke in car():
        mouse.move(*sheet.place(*stroke[0]))
        mouse.down()
        for number, point in enumerate(stroke[1:]):
            mouse.move(*sheet.place(*point))
            if number % 8 == 7:
                yield shot()
        mouse.up()
        # Strokes that follow each other at once would be read as one figure.
        sheet.page.wait_for_timeout(1000)
        yield shot()
    while (now := sheet.page.evaluate('physsim.time')) < END:
        for _ in range(FRAMES):
            sheet.press('Step')
        sheet.wait('time => physsim.time > time', now + (FRAMES - 0.5) / 60)
        yield shot()
    slider = sheet.page.get_by_role('slider', name='Time')
    while now > BACK:
        now -= 2 * FRAMES / 60
        slider.fill(str(now))
        slider.blur()
        sheet.wait('time => Math.abs(physsim.time - time) < 0.02', now)
        yield shot()


def draw_page(path: Path) -> None:
    """Write the animation of the page."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        file = directory / 'empty.yaml'
        file.write_text(WORLD)
        _, address = started_world(outside, world_file=file, speed=0.0)
        browser = launched_chromium(closing.enter_context(sync_playwright()))
        sheet = Sheet(browser, address)
        drawn = list(pictures(sheet))
        sheet.close()
        browser.close()
    size = (NARROW, round(NARROW * drawn[0].height / drawn[0].width))
    small = [each.resize(size, Image.Resampling.LANCZOS) for each in drawn]
    times = [1000 // RATE] * len(small)
    times[0] = times[-1] = REST
    first, *others = small
    first.save(
        path, save_all=True, append_images=others, duration=times, loop=0, quality=60, method=6
    )
