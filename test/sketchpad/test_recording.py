# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The recording beside the page: one origin, one batch at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
import io
from itertools import chain, repeat
import json
from pathlib import Path
import re
from socket import socket as tcp_socket
import threading
import time
from typing import Any

import numpy as np
from physsim_ros.sketchpad import recording_handlers
from physsim_ros.sketchpad.recording_handlers import MOST_RECORDINGS
from physsim_ros.view import Viewer
import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import (
    websocket_connect,
    WebSocketClientConnection,
    WebSocketClosedError,
)

from .browser import Browser
from .chromium import launched_chromium, MILLISECONDS, SOFTWARE_GL, started_world
from ..outside import Outside, PATIENCE

pytest.importorskip('rerun')
Image = pytest.importorskip('PIL.Image')

# Of two bodies of `started_world`; the tolerance is of levels 0 .. 255.
COLORS, COLOR_TOLERANCE = ((0xD0, 0x20, 0x20), (0x20, 0xA0, 0x40)), 3
# Fewer than a body of 1 m has in a small picture.
SOME_PIXELS = 20
SCRIPT = 'let wasm_bindgen;\n' * 20_000

# A viewer in place of Rerun's that takes 0.7 s for each batch, as one without a graphics card.
SLOW_VIEWER = """let wasm_bindgen = Object.assign(async () => {}, {WebHandle: class {
    constructor(options) { this.options = options; }
    start() {}
    open_channel() {}
    send_rrd_to_channel() {
        for (const end = performance.now() + 700; performance.now() < end;);
        this.options.on_viewer_event('{"type": "time_update", "time": 1e18}');
    }
}})"""


@pytest.fixture
def viewer_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Serve a directory as Rerun's own server would."""
    (tmp_path / 're_viewer.js').write_text(SCRIPT)
    (tmp_path / 'secret.txt').write_text('secret')
    handler = partial(SimpleHTTPRequestHandler, directory=str(tmp_path))
    server = ThreadingHTTPServer(('127.0.0.1', 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f'http://127.0.0.1:{server.server_port}/?url=x'
    monkeypatch.setattr(Viewer, 'page_address', address)
    yield
    server.shutdown()
    server.server_close()


def opened(browser: Browser, **changed: str) -> WebSocketClientConnection:
    """Open the socket of a recording as its page does."""
    headers = {'Cookie': browser.cookie, 'Origin': browser.base} | changed

    async def connect() -> WebSocketClientConnection:
        url = browser.base.replace('http', 'ws') + '/rerun/ws'
        return await websocket_connect(HTTPRequest(url, headers=headers))

    socket: WebSocketClientConnection = browser.run(connect())
    return socket


def read(browser: Browser, socket: WebSocketClientConnection) -> Any:
    """Return the next message; None where the socket is closed."""

    async def message() -> str | bytes | None:
        return await socket.read_message()

    return browser.run(message())


def write(browser: Browser, socket: WebSocketClientConnection, text: str) -> None:
    async def message() -> None:
        await socket.write_message(text)

    browser.run(message())


def test_pages_are_told_when_there_is_a_recording_and_before_there_is_none(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert browser.fetch('/rerun/').code == 404
    with pytest.raises(HTTPClientError, match='404'):
        opened(browser)
    page = browser.open_page()
    page.until(lambda: page.of_type('welcome'))
    assert page.of_type('welcome')[0]['rerun'] == ''
    monkeypatch.setattr(Viewer, 'page_address', 'http://127.0.0.1:9090/')
    browser.physsim.run(0.1)
    page.until(lambda: page.of_type('recording'))
    assert page.of_type('recording')[0]['rerun'] == '/rerun/'


def test_a_recording_that_is_opened_while_the_viewer_starts_comes_when_it_has(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    starting = [True, True, True]
    monkeypatch.setattr(
        Viewer, 'is_opening', property(lambda _: bool(starting and starting.pop()))
    )
    address = property(lambda _: '' if starting else 'http://127.0.0.1:9090/')
    monkeypatch.setattr(Viewer, 'page_address', address)
    assert browser.fetch('/rerun/').code == 200


@pytest.mark.usefixtures('viewer_files')
def test_the_files_of_the_viewer_come_through_this_server_and_none_else(browser: Browser) -> None:
    page = browser.open_page()
    page.until(lambda: page.of_type('welcome'))
    assert page.of_type('welcome')[0]['rerun'] == '/rerun/'

    script = browser.fetch('/rerun/re_viewer.js')
    assert (script.code, script.body.decode()) == (200, SCRIPT)
    assert script.headers['Content-Type'].startswith('text/javascript')
    known = {'If-None-Match': script.headers['Etag']}
    assert browser.fetch('/rerun/re_viewer.js', headers=known).code == 304
    assert browser.fetch('/rerun/re_viewer_bg.wasm').code == 502
    for path in ('/rerun/secret.txt', '/rerun/..%2fsecret.txt', '/rerun/re_viewer.js/'):
        assert browser.fetch(path).code == 404


@pytest.mark.usefixtures('viewer_files')
def test_a_file_is_waited_for_while_the_viewer_starts(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    with tcp_socket() as starting:
        # Bound, but nothing listens.
        starting.bind(('127.0.0.1', 0))
        silent = f'http://127.0.0.1:{starting.getsockname()[1]}/'
        addresses = chain([silent] * 5, repeat(Viewer.page_address))
        monkeypatch.setattr(Viewer, 'page_address', property(lambda _: next(addresses)))
        assert browser.fetch('/rerun/re_viewer.js').body.decode() == SCRIPT
        assert next(addresses) != silent

        monkeypatch.setattr(Viewer, 'page_address', silent)
        monkeypatch.setattr(recording_handlers, '_START_TIMEOUT', 0.2)
        assert browser.fetch('/rerun/re_viewer.js').code == 502


@pytest.mark.usefixtures('viewer_files')
def test_the_page_of_the_recording_may_call_this_server_only(browser: Browser) -> None:
    host = browser.base.removeprefix('http://')
    response = browser.fetch('/rerun/')
    policy = dict(
        each.split(' ', 1) for each in response.headers['Content-Security-Policy'].split('; ')
    )
    assert response.code == 200
    assert policy['default-src'] == "'none'"
    assert policy['connect-src'] == f"'self' ws://{host} wss://{host}"
    assert policy['script-src'] == "'self' 'wasm-unsafe-eval'"
    assert 'wasm' not in browser.fetch('/').headers['Content-Security-Policy']


@pytest.mark.usefixtures('viewer_files')
def test_a_recording_is_for_those_who_have_the_token(browser: Browser) -> None:
    for path in ('/rerun/', '/rerun/re_viewer.js'):
        assert browser.fetch(path, cookie='').code == 403
        assert browser.fetch(path, headers={'Host': 'evil.example'}).code == 403
    for changed in ({'Cookie': ''}, {'Origin': 'http://evil.example'}):
        with pytest.raises(HTTPClientError, match='403'):
            opened(browser, **changed)
    watcher = browser.login_cookie(browser.view_login)
    assert browser.fetch('/rerun/', cookie=watcher).code == 200
    opened(browser, Cookie=watcher).close()


@pytest.mark.usefixtures('viewer_files')
def test_a_page_gets_a_recording_of_its_own_batch_by_batch(browser: Browser) -> None:
    page = browser.open_page()
    page.ask('spawn', body={'circle': {'radius': 0.5}, 'at': [0, 100]})
    sockets = [opened(browser) for _ in range(2)]
    times: list[list[int]] = [[], []]
    for _ in range(3):
        browser.physsim.run(0.5)
        for socket, known in zip(sockets, times, strict=True):
            known.append(json.loads(read(browser, socket))['recorded'])
            # An `.rrd` file, or a part of one.
            assert len(read(browser, socket)) > 100
            write(browser, socket, str(known[-1]))
    for known in times:
        assert known == sorted(set(known))
    for socket in sockets:
        socket.close()


@pytest.mark.usefixtures('viewer_files')
def test_recordings_are_few_and_a_page_that_writes_nonsense_is_closed(browser: Browser) -> None:
    browser.physsim.run(0.1)
    sockets = [opened(browser) for _ in range(MOST_RECORDINGS)]
    with pytest.raises(HTTPClientError, match='503'):
        opened(browser)

    write(browser, sockets[0], 'nonsense')
    while read(browser, sockets[0]) is not None:
        # The batch that was on its way.
        pass
    assert sockets[0].close_code == 1008
    sockets[0] = opened(browser)

    for socket in sockets:
        socket.close()


@pytest.mark.usefixtures('viewer_files')
def test_a_flood_closes_the_socket_of_a_recording(browser: Browser) -> None:
    browser.physsim.run(0.1)
    socket = opened(browser)

    async def flood() -> None:
        with suppress(WebSocketClosedError):
            while True:
                await socket.write_message('0')

    browser.run(flood())
    while read(browser, socket) is not None:
        # The batch that was on its way.
        pass
    assert (socket.close_code, socket.close_reason) == (1008, 'too many messages')


@pytest.fixture(scope='module')
def chromium() -> Iterator[Any]:
    """Give a browser that draws without a graphics card."""
    sync_api = pytest.importorskip('playwright.sync_api', reason='playwright is not installed')
    with sync_api.sync_playwright() as playwright:
        browser = launched_chromium(playwright, SOFTWARE_GL)
        yield browser
        browser.close()


def screenshot(page: Any) -> bytes | None:
    """Return the picture of a page; None where Chromium could not capture it under load."""
    sync_api = pytest.importorskip('playwright.sync_api')
    try:
        png: bytes = page.screenshot(timeout=MILLISECONDS)
    except sync_api.Error as error:
        # `Page.captureScreenshot` of Chromium, where a frame is not drawn in time.
        if 'Unable to capture screenshot' not in error.message:
            raise
        return None
    return png


def shows_bodies(page: Any) -> bool:
    """Return whether the colours of the world's bodies are on a page."""
    png = screenshot(page)
    if png is None:
        return False
    picture = np.asarray(Image.open(io.BytesIO(png)).convert('RGB')).astype(int)
    return all(
        (np.abs(picture - color).max(axis=2) <= COLOR_TOLERANCE).sum() > SOME_PIXELS
        for color in COLORS
    )


def test_chromium_shows_the_recording_and_calls_no_other_origin(
    chromium: Any, outside: Outside
) -> None:
    _, address = started_world(outside, viewer='web')
    origin = address.partition('/login')[0]
    # Few pixels: without a graphics card, they are what takes the time.
    context = chromium.new_context(viewport={'width': 480, 'height': 360})
    called: set[str] = set()
    context.on('request', lambda request: called.add(request.url))
    sketch = context.new_page()
    sketch.goto(address)
    link = sketch.get_by_role('link', name='Rerun')
    with context.expect_page() as opening:
        link.click(timeout=MILLISECONDS)
    recording = opening.value

    # 43 MB are compiled, and each frame is drawn by the processor.
    deadline = time.monotonic() + 2.0 * PATIENCE
    while not shows_bodies(recording):
        assert time.monotonic() < deadline, recording.locator('#recording').text_content()
    # All but what data and blobs hold is asked of this server.
    foreign = {url for url in called if not url.startswith((origin, 'data:', 'blob:'))}
    assert foreign == set()
    context.close()


def test_a_browser_that_draws_slowly_says_how_far_it_is_behind(
    chromium: Any, outside: Outside
) -> None:
    _, address = started_world(outside, viewer='web')
    context = chromium.new_context()
    context.route(
        '**/re_viewer.js',
        lambda route: route.fulfill(body=SLOW_VIEWER, content_type='text/javascript'),
    )
    page = context.new_page()
    page.goto(address)
    page.goto(f'{address.partition("/login")[0]}/rerun/')
    told = page.get_by_role('status').get_by_text(re.compile(r'\d\.\d s behind'))
    # 43 MB are read first.
    told.wait_for(timeout=2.0 * MILLISECONDS)
    context.close()
