# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The page as a person meets it: the installed node, and Chromium without a graphics card.

Times are from the event of mouse or pen to the frame of the page that draws its effect; frames of
the page are those that show another time of the simulation than the one before.
"""

from __future__ import annotations

from contextlib import ExitStack
import math
from pathlib import Path
import random
import re
import statistics
import tempfile
from test.building import spawn
from test.outside import Outside
from test.sketchpad.chromium import circle, launched_chromium, Sheet

from physsim_ros.files import save_world
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Configure
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
from physsim_ros.testing.domain import own_domain
from playwright.sync_api import sync_playwright

# Bodies, and pixels of the screen to one of the page.
CASES = ((100, 1), (1000, 1), (1000, 2), (3000, 1), (3000, 2))
SIZE = 1280, 720
ASPECT = SIZE[0] / SIZE[1]
# From one body to the next, and the height of the free strip above them [m].
APART, FREE = 0.8, 4.0
# Frames of the page are counted for so long [ms].
COUNTED = 4000
REPEATS = 9
FRAMES = """duration => new Promise((resolve) => {
    let frames = 0, time = physsim.time;
    const begun = performance.now(), count = () => {
        if (physsim.time !== time) frames++;
        time = physsim.time;
        const passed = performance.now() - begun;
        if (passed < duration) requestAnimationFrame(count);
        else resolve(1000 * frames / passed);
    };
    requestAnimationFrame(count);
})"""
# Time from the last event of a type to the frame in which a number on the page has changed.
WATCH = """([type, number, change]) => {
    const read = {
        bodies: () => Object.keys(physsim.bodies).length,
        x: () => physsim.bodies['hand/0'][0],
    }[number];
    const before = read();
    let since = 0;
    addEventListener(type, (event) => { since = event.timeStamp; }, {capture: true, once: true});
    window.measured = new Promise((resolve) => {
        const check = () => {
            if (since && Math.abs(read() - before) >= change) resolve(performance.now() - since);
            else requestAnimationFrame(check);
        };
        requestAnimationFrame(check);
    });
}"""


def spinning(count: int) -> WorldState:
    """Return bodies that spin in rows, without gravity, below a free strip with one more body."""
    world, rng = World(), random.Random(count)
    across = math.ceil(math.sqrt(count * ASPECT))
    right, top = across * APART, -(-count // across) * APART + FREE
    bounds = (-APART, -APART, right, top)
    world.apply(Configure(changes={'gravity': (0.0, 0.0), 'bounds': bounds}))
    for number in range(count):
        level, column = divmod(number, across)
        shape = Disc(radius=0.25) if (level + column) % 2 else Box(width=0.5, height=0.5)
        pose = (column * APART, level * APART, 0.0)
        spawn(world, f'body/{number}', shape, pose, spin=rng.uniform(-1.0, 1.0))
    spawn(world, 'hand/0', Disc(radius=0.5), (right / 2, top - FREE / 2, 0.0))
    return world.save()


def stroke_times(sheet: Sheet) -> list[float]:
    """Return the times from a pen that is lifted to the body that it has drawn [ms]."""
    x, y, _ = sheet.pose('hand/0')
    times = []
    for number in range(REPEATS):
        before = len(sheet.names())
        # Strokes beside each other are no parts of one drawing.
        points = circle(x + (3.0 if number % 2 else -3.0), y, 0.8)
        sheet.page.evaluate(WATCH, ['pointerup', 'bodies', 1])
        sheet.drag(*points)
        times.append(sheet.page.evaluate('window.measured'))
        sheet.press('Undo')
        sheet.wait('count => Object.keys(physsim.bodies).length === count', before)
    return times


def hand_times(sheet: Sheet) -> list[float]:
    """Return the times from a hand that moves to its body that has moved by a centimetre [ms]."""
    x, y, _ = sheet.pose('hand/0')
    mouse = sheet.page.mouse
    sheet.press('Hand')
    times = []
    with sheet.dragging((x, y), (x + 0.3, y)):
        for number in range(REPEATS):
            # The body rests at the last place of the hand.
            sheet.page.wait_for_timeout(700)
            sheet.page.evaluate(WATCH, ['pointermove', 'x', 0.01])
            mouse.move(*sheet.place(x + (0.3 if number % 2 else -0.3), y))
            times.append(sheet.page.evaluate('window.measured'))
    return times


def measure(bodies: int, ratio: int) -> None:
    """Print the row of a count of bodies and a density of pixels."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        path = save_world(spinning(bodies), 'spinning', world_dir=directory, physics_rate=240.0)
        given = {'world_file': path, 'world_dir': directory, 'sketchpad': 'serve'}
        program = outside.start_world(**given)
        found = re.search(r'http\S+', program.wait_for('/login?token='))
        assert found
        program.wait_for('ready')
        playwright = closing.enter_context(sync_playwright())
        browser = launched_chromium(playwright)
        sheet = Sheet(browser, found[0], size=SIZE, device_scale_factor=ratio)
        sheet.wait('count => Object.keys(physsim.bodies).length > count', bodies)
        frames = sheet.page.evaluate(FRAMES, COUNTED)
        strokes, hands = stroke_times(sheet), hand_times(sheet)
        sheet.close()
        browser.close()
    stroke, hand = statistics.median(strokes), statistics.median(hands)
    print(
        f'{bodies:6} {ratio:6} {frames:9.1f} {stroke:20.0f} {max(strokes):9.0f}'
        f' {hand:19.0f} {max(hands):9.0f}',
        flush=True,
    )


def table() -> None:
    """Print a row for each count of bodies and density of pixels."""
    width, height = SIZE
    print(f'\nThe page in Chromium, {width} x {height}, no graphics card, a world at 60 Hz')
    print('bodies  ratio  frames/s  stroke to body [ms]  greatest  hand to body [ms]  greatest')
    for bodies, ratio in CASES:
        measure(bodies, ratio)
