# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page of a teacher whose pupils work on a lesson: one runs, one has asked, one was right."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
import re
import tempfile
from test.outside import Outside
from test.sketchpad.chromium import launched_chromium, Sheet

from physsim_ros.testing.domain import own_domain
from playwright.sync_api import sync_playwright

LESSON = 'pendulum'
# Names of pupils, and the simulation time up to which each has played [s].
PUPILS = {'Anna': 2.5, 'Ben': 1.2, 'Cleo': 0.0, 'Dev': 3.1, 'Emma': 0.7, 'Finn': 1.9}
# Answers: one is right, one is not yet.
ANSWERS = {'Anna': '3.17', 'Dev': '1.6'}
HAND, RUNNING = 'Cleo', 'Emma'
# Part of the page with all cards [px].
SIZE = {'width': 1200, 'height': 775}


def come(browser: object, address: str, name: str) -> Sheet:
    """Return the page of a pupil of a name, who has come to a world."""
    sheet = Sheet(browser, address)
    sheet.page.get_by_role('textbox', name='Your name').fill(name)
    sheet.press('Go to my world')
    sheet.page.locator('#world').wait_for(state='attached')
    sheet.wait('"physsim" in window && Object.keys(physsim.bodies).length > 0')
    return sheet


def draw_class(path: Path) -> None:
    """Write the picture of the teacher's page."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        outside.environment['XDG_DATA_HOME'] = str(directory)
        program = outside.start_installed(
            'physsim_class', '--pupils', len(PUPILS), '--port', 0, '--seats', 0,
            '--ros-args', '-p', f'world_file:={LESSON}', '-p', 'speed:=0.0',
        )  # fmt: skip
        found = [re.search(r'http\S+', program.wait_for('/login?token=', 300)) for _ in range(2)]
        pupils, teacher = (match[0] for match in found if match)
        browser = launched_chromium(closing.enter_context(sync_playwright()))
        # While a teacher watches, pupils can raise a hand.
        overview = Sheet(browser, teacher)
        sheets = {name: come(browser, pupils, name) for name in PUPILS}
        for name, sheet in sheets.items():
            if name in ANSWERS:
                sheet.page.get_by_role('textbox', name='Your answer').fill(ANSWERS[name])
                sheet.press('Check')
            if name == HAND:
                sheet.press('Raise your hand')
            if PUPILS[name]:
                sheet.play_until(PUPILS[name])
            if name == RUNNING:
                sheet.press('Play')
        overview.page.get_by_text(f'{len(PUPILS)} of {len(PUPILS)} here').wait_for()
        # The pictures of worlds come one after the other.
        overview.page.wait_for_timeout(5000)
        overview.page.screenshot(path=path, clip={'x': 0, 'y': 0, **SIZE})
        browser.close()
