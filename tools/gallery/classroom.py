# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The page of a teacher: an animation in which pupils draw, then get a lesson.

At its end one world runs, one pupil has a question, and one answer is right.
"""

from __future__ import annotations

from contextlib import ExitStack
import itertools
from pathlib import Path
import re
import tempfile
from test.outside import Outside
from test.sketchpad.chromium import circle, launched_chromium, Sheet

from physsim_ros.testing.domain import own_domain
from playwright.sync_api import sync_playwright

from .page import car, Film, line, Stroke, WORLD

LESSON = 'pendulum'
# Simulation time up to which each pupil plays the lesson [s].
PUPILS = {'Anna': 2.5, 'Ben': 1.2, 'Cleo': 0.0, 'Dev': 3.1, 'Emma': 0.7, 'Finn': 1.9}
# Answers: one is right, one is not yet.
ANSWERS = {'Dev': '1.6', 'Anna': '3.17'}
HAND, RUNNING = 'Cleo', 'Emma'
# Size of the page, whose cards are in two rows of three [px].
SIZE = 900, 660
# Size of the page of a pupil [px].
PAGE = 800, 600
# Rate of the animation [Hz]: a page that watches gets four frames a second.
RATE = 4
# Pictures of worlds that play, and of one that is to be looked at.
PLAYING, LOOKING = 14, 4
# Time in which all cards show what has changed in their worlds [ms].
SHOWN = 1500


def box(x: float, y: float, width: float, height: float) -> Stroke:
    """Return a stroke around a rectangle, from its lower left corner [m]."""
    right, top = x + width, y + height
    return line((x, y), (right, y), (right, top), (x, top), (x, y))


def drawings() -> dict[str, list[Stroke]]:
    """Return the strokes of each pupil."""
    zigzag = [(3.0 + 0.35 * (-1) ** each, 5.4 + 0.25 * each) for each in range(10)]
    star = line((3, 5.6), (2.2, 3.4), (4.2, 4.8), (1.8, 4.8), (3.8, 3.4), (3, 5.6))
    return {
        'Anna': car(),
        'Ben': [box(-1.2 + 0.1 * each, 1.3 * each, 2.4, 1.3) for each in range(5)],
        'Cleo': [circle(-4.5, 6.5, 0.9), line((-4.5, 6.5), (0.0, 8.0)), box(1.8, 0, 1.4, 4)],
        'Dev': [
            line((-7.4, 6.6), (0.4, 1.6)),
            *(box(1.5 + 1.4 * each, 0.0, 0.5, 2.2) for each in range(4)),
            circle(-6.0, 6.8, 0.8),
        ],
        'Emma': [circle(3.0 * each - 6.0, 5.0 + each % 2, 0.5 + 0.15 * each) for each in range(5)],
        'Finn': [box(-5.0, 1.0, 3.0, 2.0), star, zigzag],
    }


def come(browser: object, address: str, name: str) -> Sheet:
    """Return the page of a pupil of a name, who has come to a world."""
    sheet = Sheet(browser, address, size=PAGE)
    sheet.page.get_by_role('textbox', name='Your name').fill(name)
    sheet.press('Go to my world')
    sheet.page.locator('#world').wait_for(state='attached')
    sheet.wait('"physsim" in window && heard.people')
    return sheet


def draw(sheet: Sheet, stroke: Stroke) -> None:
    """Draw a stroke by the pen, a sample at each of its points [m]."""
    places = sheet.page.evaluate(
        'points => points.map((point) => physsim.toPage(...point))', stroke
    )
    mouse = sheet.page.mouse
    mouse.move(*places[0])
    mouse.down()
    for place in places[1:]:
        mouse.move(*place)
    mouse.up()


def draw_together(film: Film, sheets: dict[str, Sheet]) -> None:
    """Have each pupil draw a stroke after the other, and play what is drawn."""
    drawn = drawings()
    for sheet in sheets.values():
        sheet.press('Pen')
        # The card of strokes lies over the right half of a page of this size.
        sheet.press('Close')
    for strokes in itertools.zip_longest(*drawn.values()):
        for name, stroke in zip(drawn, strokes, strict=True):
            if stroke:
                draw(sheets[name], stroke)
        # Strokes that follow each other at once would be read as one figure.
        film.sheet.page.wait_for_timeout(SHOWN)
        film.shoot(2)
    for sheet in sheets.values():
        sheet.press('Play')
    for _ in range(PLAYING):
        film.shoot()
        film.sheet.page.wait_for_timeout(1000 // RATE)


def work_on_lesson(film: Film, sheets: dict[str, Sheet]) -> None:
    """Open a lesson for all pupils, who play it, ask and answer."""
    teacher = film.sheet
    teacher.page.get_by_role('combobox', name='Lesson').select_option(LESSON)
    film.shoot(LOOKING)
    teacher.press('Open the lesson for all')
    for sheet in sheets.values():
        sheet.page.get_by_role('textbox', name='Your answer').wait_for()
    teacher.page.wait_for_timeout(SHOWN)
    film.shoot(LOOKING)
    sheets[HAND].press('Raise your hand')
    teacher.page.wait_for_timeout(SHOWN)
    film.shoot(LOOKING)
    for name, end in PUPILS.items():
        if end:
            sheets[name].play_until(end)
            film.shoot()
    sheets[RUNNING].press('Play')
    for name, answer in ANSWERS.items():
        sheets[name].page.get_by_role('textbox', name='Your answer').fill(answer)
        sheets[name].press('Check')
        for _ in range(LOOKING):
            film.shoot()
            teacher.page.wait_for_timeout(1000 // RATE)


def draw_class(path: Path, last: Path) -> None:
    """Write the animation of the teacher's page, and its last picture."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        outside.environment['XDG_DATA_HOME'] = str(directory)
        file = directory / 'room.yaml'
        file.write_text(WORLD)
        program = outside.start_installed(
            'physsim_class', '--pupils', len(PUPILS), '--port', 0, '--seats', 0,
            '--ros-args', '-p', f'world_file:={file}', '-p', 'speed:=0.0',
        )  # fmt: skip
        found = [re.search(r'http\S+', program.wait_for('/login?token=', 300)) for _ in range(2)]
        pupils, teacher = (match[0] for match in found if match)
        browser = launched_chromium(closing.enter_context(sync_playwright()))
        # While a teacher watches, pupils can raise a hand.
        film = Film(Sheet(browser, teacher, size=SIZE))
        sheets = {}
        for name in PUPILS:
            film.sheet.page.wait_for_timeout(SHOWN)
            film.shoot()
            sheets[name] = come(browser, pupils, name)
        film.sheet.page.get_by_text(f'{len(PUPILS)} of {len(PUPILS)} here').wait_for()
        draw_together(film, sheets)
        work_on_lesson(film, sheets)
        browser.close()
    film.pictures[-1].save(last, optimize=True)
    film.save(path, rate=RATE)
