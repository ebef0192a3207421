# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages in Chromium, worked as people work them, by the names of the contract."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
import math
from pathlib import Path
import re
import shutil
import tempfile
import time
from typing import Any, ClassVar, Self

import pytest

from .delays import DELAYS
from ..outside import Outside, PATIENCE, Program

WORLD = """
format: 1
bounds: [-8, 0, 8, 9]
bodies:
  - {name: ball/0, circle: {radius: 0.5}, at: [0, 0.5], color: '#d02020'}
  - {name: box/0, box: {width: 1, height: 1}, at: [4, 0.5], color: '#20a040'}
  - {name: shelf/0, box: {width: 2, height: 0.4}, at: [-4, 3], anchored: true, color: '#2040d0'}
"""
ARGUMENTS = ['--no-sandbox', '--disable-gpu', '--disable-background-networking']
PIXEL = """([x, y]) => [...document.querySelector('canvas').getContext('2d').getImageData(
    x * devicePixelRatio, y * devicePixelRatio, 1, 1).data]"""
# Called by a promise that settles when what was told has been drawn.
DRAWN = '(done) => requestAnimationFrame(() => setTimeout(done))'
# Called with the error of what needs a page that is loaded.
LOADING = '(error) => { if (!(error instanceof ReferenceError)) throw error; }'
MILLISECONDS = 1000.0 * PATIENCE
# Notes what a page is told: people, with the last message of its welcome; topics of its requests
# that are answered, and of those after whose answer a frame has come; speeds of time; texts of
# notes, which go by themselves; and for the report of a failure the last timeline and refusals.
LISTENER = """
const heard = window.heard = {
    people: null, answered: [], shown: [], speeds: [], notes: [], timeline: null, refusals: []};
window.WebSocket = class extends WebSocket {
    constructor(...words) {
        super(...words);
        this.addEventListener('message', ({data}) => {
            if (typeof data !== 'string') {
                const speed = new DataView(data).getFloat32(16, true);
                if (heard.speeds.at(-1) !== speed) heard.speeds.push(speed);
                heard.shown.push(...heard.answered.splice(0));
                return;
            }
            const message = JSON.parse(data), {type, request, ok, topic} = message;
            if (type === 'timeline') heard.timeline = message;
            if (type === 'class') heard.people = message.people.map(({name}) => name);
            if (type !== 'answer') return;
            if (request) heard.answered.push(topic);
            if (!ok) heard.refusals = [...heard.refusals.slice(-4), message.message];
        });
    }
};
new MutationObserver((changes) => {
    for (const {addedNodes} of changes) for (const node of addedNodes) {
        if (node.classList?.contains('note')) heard.notes.push(node.textContent);
    }
}).observe(document, {childList: true, subtree: true});"""
# Adds to what a program sees of a page: forces as they are drawn, lengths of arrows [px] to a
# newton and to a metre a second, numbers of the samples that are recorded and of the course that
# was left, places of handles [px], the wind [m/s].
PARTS = """
document.addEventListener('DOMContentLoaded', async () => {
    if (!document.querySelector('#world')) return;
    // A page that is left meanwhile loads no scripts any more.
    const page = await import('/page/app.js').catch(() => null);
    if (!page) return;
    const {arrows, handles, records, world} = page, {scales} = arrows;
    const counts = ([name, {samples, left}]) => [name, [samples.length, left.length]];
    for (const [name, get] of Object.entries({
        forces: () => arrows.drawn,
        scales: () => ({newton: scales.N.length(1), speed: scales['m/s'].length(1)}),
        records: () => Object.fromEntries([...records.bodies].map(counts)),
        handles: () => handles.places(),
        wind: () => world.scene.wind,
    })) Object.defineProperty(window.physsim, name, {get});
});"""
# The state of a page, for the report of a test that failed.
STATE = """() => ({...window.heard, ...window.physsim && {
    time: physsim.time, speed: physsim.speed, bodies: Object.keys(physsim.bodies),
    status: document.querySelector('[role=status]').textContent}})"""
# Has pointer events come to the canvas that the protocol of the browser's tools cannot make: many
# at once, of the eraser of a stylus, of one finger of two. A browser does not capture such a
# pointer.
POINTER = """([kind, buttons, id, places]) => {
    const canvas = document.querySelector('canvas');
    canvas.setPointerCapture = () => {};
    const button = Math.log2(buttons) | 0;
    for (const [type, x, y] of places) canvas.dispatchEvent(new PointerEvent(`pointer${type}`, {
        pointerId: id, pointerType: kind, clientX: x, clientY: y, bubbles: true,
        button: type === 'move' ? -1 : button, buttons: type === 'up' ? 0 : buttons}));
}"""
SPACE = """() => {
    for (const type of ['keydown', 'keyup']) {
        const event = new KeyboardEvent(type, {key: ' ', bubbles: true, cancelable: true});
        document.activeElement.dispatchEvent(event);
    }
}"""
UNFOLDED = "if (location.protocol !== 'about:') localStorage['physsim-panel'] ??= '1';"
# Notes what is written on canvases, and the boxes of texts in the last picture of the world [px].
NOTE_TEXTS = """() => {
    const {prototype} = CanvasRenderingContext2D, {fillRect, fillText} = prototype;
    window.texts = [];
    window.boxes = [];
    prototype.fillRect = function (x, y, ...size) {
        if (this.canvas.id === 'world' && x === 0 && y === 0) window.boxes = [];
        fillRect.call(this, x, y, ...size);
    };
    prototype.fillText = function (text, x, y) {
        const {actualBoundingBoxLeft: left, actualBoundingBoxRight: right,
            actualBoundingBoxAscent: up, actualBoundingBoxDescent: down} = this.measureText(text);
        texts.push(text);
        if (this.canvas.id === 'world') boxes.push([text, x - left, y - up, x + right, y + down]);
        fillText.call(this, text, x, y);
    };
}"""
# Press Pause at the first frame after a time [s].
PAUSE_AFTER = """seconds => {
    const look = () => {
        if (physsim.time > seconds) document.querySelector('[aria-label=Pause]').click();
        else requestAnimationFrame(look);
    };
    look();
}"""


def launched_chromium(playwright: Any) -> Any:
    """Return a browser; where there is none, the test is skipped with that reason."""
    path = shutil.which('chromium') or shutil.which('chromium-browser')
    if path is None:
        pytest.skip('chromium is not installed')
    return playwright.chromium.launch(executable_path=path, args=ARGUMENTS)


def started_world(
    outside: Outside, *, world: str = WORLD, **parameters: object
) -> tuple[Program, str]:
    """Start a world with a page, and return it with the address that it prints."""
    # Of its own: a world that was not saved is offered to the next one in a directory.
    directory = Path(tempfile.mkdtemp(dir=outside.directory))
    path = directory / 'page.yaml'
    path.write_text(world)
    given = {'world_file': path, 'world_dir': directory, 'sketchpad': 'serve'}
    program = outside.start_world(**given | parameters)
    line = program.wait_for('/login?token=')
    program.wait_for('ready')
    found = re.search(r'http\S+', line)
    assert found
    return program, found[0]


def circle(x: float, y: float, radius: float) -> list[tuple[float, float]]:
    """Return the points of a stroke around a centre [m]."""
    angles = [math.tau * each / 24 for each in range(25)]
    return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]


class Sheet:
    """
    An open page.

    :param browser: that opens it
    :param address: with the token
    :param size: width and height [px]
    :param unfolded: whether panels are shown in full, as somebody has chosen in this browser
    :param options: of its browser context

    :cvar opened: pages of the test that runs
    """

    opened: ClassVar[list[Sheet]] = []

    def __init__(
        self,
        browser: Any,
        address: str,
        *,
        size: tuple[int, int] = (1200, 800),
        unfolded: bool = True,
        **options: Any,
    ) -> None:
        viewport = dict(zip(('width', 'height'), size, strict=True))
        self.context = browser.new_context(viewport=viewport, **options)
        self.context.set_default_timeout(MILLISECONDS)
        self.context.add_init_script(DELAYS + LISTENER + PARTS + (UNFOLDED if unfolded else ''))
        self.page = self.context.new_page()
        self.errors: list[str] = []
        self.page.on('pageerror', lambda error: self.errors.append(str(error)))
        self.page.on(
            'console',
            lambda message: message.type == 'error' and self.errors.append(message.text),
        )
        self.opened.append(self)
        self.page.goto(address)

    def begin(self, bodies: int = 3) -> Self:
        """
        Reset the world, pause it, wait for that to be seen, and return the page.

        :param bodies: number of bodies at the beginning
        """
        # The first messages change its bars, and so the place of the world.
        self.wait('heard.people && Object.keys(physsim.bodies).length > 0')
        before = self.page.evaluate('heard.shown.length')
        self.press('Pause')
        self.press('Reset')
        # The world may have looked like this before.
        self.wait('before => heard.shown.indexOf("~/reset", before) >= 0', before)
        self.wait('physsim.time === 0 && physsim.speed === 0')
        self.wait('count => Object.keys(physsim.bodies).length === count', bodies)
        return self

    def wait(self, predicate: str, argument: Any = None) -> None:
        """
        Wait for an expression on the page, or a function of an argument, to become true.

        It is evaluated when a picture has been drawn, so that buttons and fields show what it
        knows; a page that is loading does not have `physsim` yet. The browser's own waiting
        evaluates text in the page, which the page's policy forbids.
        """
        value = predicate if argument is None else f'({predicate})(argument)'
        drawn = f'argument => new Promise({DRAWN}).then(() => {value}).catch({LOADING})'
        self.until(lambda: self.page.evaluate(drawn, argument), predicate)

    def until(self, predicate: Callable[[], object], what: str) -> None:
        """Wait frame by frame until something holds."""
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            assert time.monotonic() < deadline, f'{what} did not come about in time'
            self.page.evaluate('new Promise(requestAnimationFrame)')

    def play_until(self, seconds: float) -> float:
        """
        Play from before a time to just after it, pause, and return the time [s].

        The page itself pauses: time would go on while a busy machine has this process wait.
        """
        self.press('Play')
        self.page.evaluate(PAUSE_AFTER, seconds)
        self.wait('seconds => physsim.time > seconds && physsim.speed === 0', seconds)
        return float(self.page.evaluate('physsim.time'))

    def seek(self, seconds: float) -> None:
        """Go to a time that is kept, by the slider."""
        self.page.get_by_role('slider', name='Time', exact=True).fill(str(seconds))
        self.wait('seconds => Math.abs(physsim.time - seconds) < 0.02', seconds)

    def press(self, name: str) -> None:
        """Press a button."""
        self.page.get_by_role('button', name=name, exact=True).click()

    def tap(self, x: float, y: float) -> None:
        """Click a point of the world [m]."""
        self.page.mouse.click(*self.place(x, y))

    def enter(self, label: str, text: str, *, exact: bool = False) -> None:
        """Type a text into a field, and the key Enter."""
        field = self.page.get_by_label(label, exact=exact)
        field.fill(text)
        field.press('Enter')

    def told(self, text: str, *, exact: bool = False) -> None:
        """Wait for the status line to say something."""
        self.page.get_by_role('status').get_by_text(text, exact=exact).wait_for()

    def tap_space(self) -> None:
        """Tap the space bar: on a busy machine a real key may be held for longer than a tap."""
        self.page.evaluate(SPACE)

    def names(self) -> set[str]:
        """Return the names of the bodies."""
        return set(self.page.evaluate('Object.keys(physsim.bodies)'))

    def pose(self, name: str) -> list[float]:
        """Return x, y [m], yaw [rad] of a body."""
        pose: list[float] = self.page.evaluate('name => physsim.bodies[name]', name)
        return pose

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return the pixels of a point of the world [m]."""
        px, py = self.page.evaluate('([x, y]) => physsim.toPage(x, y)', [x, y])
        return px, py

    def color_at(self, x: float, y: float) -> list[int]:
        """
        Return red, green, blue, each 0 .. 255, at a point of the world [m].

        The page knows the poses of a frame before it draws them.
        """
        color: list[int] = self.page.evaluate(PIXEL, self.place(x, y))
        return color[:3]

    def drag(self, *points: tuple[float, float]) -> None:
        """Draw with the mouse from point to point of the world [m]."""
        with self.dragging(*points):
            pass

    @contextmanager
    def dragging(self, *points: tuple[float, float]) -> Iterator[None]:
        """Draw with the mouse, and let go at the end of the block."""
        mouse = self.page.mouse
        mouse.move(*self.place(*points[0]))
        mouse.down()
        for point in points[1:]:
            mouse.move(*self.place(*point), steps=4)
        yield
        mouse.up()

    def wait_for_new(self, before: set[str]) -> str:
        """Wait for one body more, and return its name."""
        self.wait('count => Object.keys(physsim.bodies).length === count', len(before) + 1)
        (name,) = self.names() - before
        return name

    def state(self) -> str:
        """Return the state of the page, and its latest notes and refusals."""
        sync_api = pytest.importorskip('playwright.sync_api')
        try:
            return f'{self.page.evaluate(STATE)}\n{self.errors}'
        except sync_api.Error as error:
            return str(error)

    def close(self) -> None:
        """Close the page; it has had no errors."""
        self.context.close()
        assert self.errors == [], self.errors


# Opens a page that the test has closed at its end; without an address, of the module's world.
OpenSheet = Callable[..., Sheet]


class Fingers:
    """
    Fingers on a page, by the protocol of the browser's own tools.

    :param sheet: opened with `has_touch`
    """

    def __init__(self, sheet: Sheet) -> None:
        self._session = sheet.context.new_cdp_session(sheet.page)

    def put(self, *places: Sequence[float]) -> None:
        """Put fingers down [px]."""
        self._send('touchStart', places)

    def move(self, *places: Sequence[float]) -> None:
        """Move them."""
        self._send('touchMove', places)

    def lift(self) -> None:
        """Lift all of them."""
        self._send('touchEnd', ())

    def cancel(self) -> None:
        """Have the system take all of them for a palm."""
        self._send('touchCancel', ())

    def _send(self, kind: str, places: Sequence[Sequence[float]]) -> None:
        points = [{'x': x, 'y': y, 'id': number} for number, (x, y) in enumerate(places)]
        self._session.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': points})


class Stylus:
    """
    A stylus on a page.

    :param sheet: that it draws on
    """

    def __init__(self, sheet: Sheet) -> None:
        self._session = sheet.context.new_cdp_session(sheet.page)

    def draw(self, places: Sequence[Sequence[float]]) -> None:
        """Draw a stroke from place to place [px]."""
        self.put(places[0])
        self.move(places[1:])
        self.lift(places[-1])

    def put(self, place: Sequence[float]) -> None:
        """Put it down [px]."""
        self._send('mousePressed', place)

    def move(self, places: Sequence[Sequence[float]]) -> None:
        """Move it from place to place."""
        for place in places:
            self._send('mouseMoved', place)

    def lift(self, place: Sequence[float]) -> None:
        """Lift it."""
        self._send('mouseReleased', place)

    def _send(self, kind: str, place: Sequence[float]) -> None:
        x, y = place
        event = {'type': kind, 'x': x, 'y': y, 'button': 'left', 'buttons': 1, 'clickCount': 1}
        self._session.send('Input.dispatchMouseEvent', event | {'pointerType': 'pen'})
