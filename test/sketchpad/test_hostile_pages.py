# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strangers get nothing; hostile pages change nothing, and delay neither the world nor others."""

import asyncio
from contextlib import ExitStack, suppress
from itertools import chain, repeat
import json
from pathlib import Path
import socket
from threading import Event
from typing import Any

from physsim_ros.sketchpad import Role
from physsim_ros.sketchpad.inbox import CAPACITY
from physsim_ros.sketchpad.server import guarded, website, world_handlers
from physsim_ros.sketchpad.server.access import Access
from physsim_ros.sketchpad.server.open_pages import MOST_PAGES
from physsim_ros.sketchpad.server.server import MOST_BYTES
import pytest
from tornado.httpclient import HTTPClientError
from tornado.httputil import HTTPHeaders
from tornado.iostream import StreamClosedError
from tornado.websocket import WebSocketClosedError

from .browser import Browser

# Of an answer, wherever it comes from.
FIELDS = {
    'type', 'request', 'ok', 'code', 'message', 'text', 'subject', 'topic', 'field', 'values',
}  # fmt: skip
# A request whose body does not come.
BODILESS = 'POST /login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n'
# Of the second byte of a frame, which also has its length (RFC 6455, section 5.2).
MASKED = 0x80
CLICK = '{"id": "x", "type": "click", "tool": "anchor", "point": [0, 0]}'


def status_of_socket(browser: Browser, **options: object) -> int:
    with pytest.raises(HTTPClientError) as refused:
        browser.open_page(**options)
    return refused.value.code


def test_a_wrong_token_opens_nothing(browser: Browser) -> None:
    refused = browser.fetch('/login?token=guess', cookie='')
    assert (refused.code, b'token is wrong' in refused.body) == (403, True)
    for cookie in ('', browser.cookie.partition('=')[0] + '=guess'):
        for path in ('/', '/session', '/page/app.js', '/gallery/car.svg', '/world/car.yaml'):
            assert browser.fetch(path, cookie=cookie).code == 403
        assert status_of_socket(browser, cookie=cookie) == 403


def test_the_cookie_is_kept_from_scripts_and_other_sites(browser: Browser) -> None:
    response = browser.fetch(browser.login.removeprefix(browser.base), cookie='')
    assert response.code == 302
    assert response.headers['Location'] == '/'
    assert {'HttpOnly', 'SameSite=Strict'} <= set(response.headers['Set-Cookie'].split('; '))


def test_every_answer_forbids_foreign_and_inline_scripts(browser: Browser) -> None:
    for path, code in (('/', 200), ('/page/style.css', 200), ('/nothing', 404)):
        response = browser.fetch(path)
        assert response.code == code
        policy = response.headers['Content-Security-Policy']
        assert "default-src 'none'" in policy
        assert 'unsafe' not in policy
        assert response.headers['X-Content-Type-Options'] == 'nosniff'


@pytest.mark.parametrize(
    'path',
    ['/', '/session', '/page/app.js', '/gallery/car.svg', '/world/own.yaml', '/results', '/none'],
)
def test_head_is_answered_as_get_without_the_content(
    browser: Browser, tmp_path: Path, path: str
) -> None:
    (tmp_path / 'own.yaml').write_text('format: 1')
    head, get = (browser.fetch(path, method=method) for method in ('HEAD', 'GET'))
    assert (head.code, head.body) == (get.code, b'')
    for name in ('Content-Type', 'Content-Security-Policy'):
        assert head.headers[name] == get.headers[name]


def test_a_socket_is_opened_by_get_alone(browser: Browser) -> None:
    headers = {'Origin': browser.base, 'Upgrade': 'websocket', 'Connection': 'Upgrade'}
    headers |= {'Sec-WebSocket-Key': 'AAAAAAAAAAAAAAAAAAAAAA==', 'Sec-WebSocket-Version': '13'}
    assert browser.fetch('/ws', method='HEAD', headers=headers).code == 405


@pytest.mark.parametrize(
    'path',
    [
        '/page/../server.py',
        '/page/%2e%2e/server.py',
        '/gallery//etc/passwd',
        '/gallery/..%2f..%2fcar.svg',
        '/gallery/nowhere.svg',
        '/page/tools',
        '/page/app.js%00.png',
        '/world/..%2f..%2fcar.yaml',
    ],
)
def test_no_path_leads_out_of_the_page(browser: Browser, path: str) -> None:
    assert browser.fetch(path).code in (403, 404)


def test_an_error_says_nothing_of_the_request(browser: Browser) -> None:
    response = browser.fetch('/gallery/evil%ff.svg')
    assert response.code == 400
    assert response.body == b'Bad Request\n'


def test_a_foreign_name_of_this_machine_is_refused(browser: Browser) -> None:
    # As after DNS rebinding: the cookie would not be sent, but nothing depends on that.
    headers = {'Host': 'evil.example'}
    assert browser.fetch('/', headers=headers).code == 403
    assert browser.fetch('/login?token=x', headers=headers).code == 403


@pytest.mark.parametrize(
    ('host', 'allowed'),
    [
        ('127.0.0.1:8765', True),
        ('127.0.0.1:8765.evil.example', False),
        ('localhost:8765', True),
        ('[::1]:8765', True),
        ('192.168.0.7', True),
        (socket.gethostname(), True),
        ('evil.example', False),
        ('127.0.0.1.evil.example', False),
        ('localhost.evil.example', False),
        ('', False),
        ('[', False),
    ],
)
def test_only_addresses_and_names_of_this_machine_are_hosts(host: str, *, allowed: bool) -> None:
    assert Access('127.0.0.1', 8765).allows_host(host) is allowed


def test_a_foreign_origin_opens_no_socket_and_uploads_nothing(browser: Browser) -> None:
    before = browser.physsim.digest()
    for origin in ('http://evil.example', 'null', 'http://127.0.0.1:1'):
        assert status_of_socket(browser, origin=origin) == 403
        assert browser.upload('format: 1\n', headers={'Origin': origin}).code == 403
    assert status_of_socket(browser, origin='') == 403
    assert browser.physsim.digest() == before


def test_a_page_behind_a_proxy_with_tls_opens_a_socket(browser: Browser) -> None:
    page = browser.open_page(origin=browser.base.replace('http', 'https'))
    page.until(lambda: page.of_type('scene'))


def test_a_page_that_only_shows_changes_nothing(browser: Browser) -> None:
    cookie = browser.cookie_of(Role.VIEW)
    pages = [browser.open_page('/ws?view'), browser.open_page('/ws', cookie=cookie)]
    before = browser.physsim.digest()
    for page in pages:
        page.until(lambda page=page: page.of_type('welcome') and page.frames)
        assert page.last('welcome')['view_only']
        body = {'name': 'box/0', 'box': {'width': 1, 'height': 1}}
        for kind, fields in (
            ('spawn', {'body': body}),
            ('service', {'name': 'pause'}),
            ('speed', {'speed': 2}),
            ('grab', {'point': [0, 0]}),
            ('share', {}),
        ):
            answer = page.ask(kind, **fields)
            assert (answer['code'], set(answer)) == ('view_only', FIELDS)
    assert browser.upload('format: 1\n', cookie=cookie).code == 403
    assert browser.physsim.digest() == before


# By the code of the refusal.
WRONG: dict[str, list[str | bytes]] = {
    'malformed': [
        '',
        'no json',
        '[]',
        '"text"',
        '{}',
        bytes(range(256)),
        '{"type": 3}',
        '{"type": "nonsense"}',
        '{"type": "constructor"}',
        '{"type": "undo"}',
        '{"type": "speed", "speed": NaN}',
        '{"type": "speed", "speed": 1e999}',
        '{"type": "speed", "speed": ' + '9' * 5000 + '}',
        '{"type": "grab", "point": [1]}',
        '{"type": "stroke", "points": [[0, 0, 0], [1, 1]]}',
        '{"type": "stroke", "points": [[0, 0, 1e400], [1, 1, 1]]}',
        '{"type": "stroke", "points": []}',
        '{"type": "delete", "names": ["a/1", "a/1"]}',
        '{"type": "spawn", "body": {"name": "\\ud800/1", "circle": {"radius": 1}}}',
        '{"type": "spawn", "body": ' + '[' * 20 + ']' * 20 + '}',
        '{"type": "save", "name": "\\ud800"}',
        '{"id": "' + 'i' * 100 + '", "type": "share"}',
        '{"id": {}, "type": "share"}',
        '[' * 100_000,
        '{"a":' * 50_000,
    ],
    'bad_property': [
        '{"type": "speed", "speed": "1"}',
        '{"type": "speed", "speed": true}',
        '{"type": "speed", "speed": 1e4}',
        '{"type": "seek", "time": -1}',
        '{"type": "seek", "time": 1e300}',
        '{"type": "grab", "point": [1, null]}',
        '{"type": "click", "tool": "hammer", "point": [0, 0]}',
        '{"type": "click", "tool": ["wall"], "point": [0, 0]}',
        '{"type": "stroke", "points": [[0, 0, 0], ["1", 1, 1]]}',
        '{"type": "delete", "names": []}',
        '{"type": "delete", "names": "a/1"}',
        '{"type": "spawn", "body": {"circle": {"radius": 1}}}',
        '{"type": "change", "name": "a/1", "properties": []}',
        '{"type": "gravity", "gravity": [0, 1e9]}',
        '{"type": "service", "name": "quit"}',
        '{"type": "draw_with", "color": "red; }"}',
        '{"type": "show", "velocities": 1}',
        '{"type": "place", "names": ["a/1"], "poses": []}',
        '{"type": "follow", "names": false}',
        '{"type": "stroke", "points": [[0, 0, -1e308], [1, 1, 1e308], [2, 0, 0]]}',
        '{"type": "answered", "lesson": "' + 'l' * 81 + '", "answer": "1", "right": true}',
    ],
    'bad_size': ['{"type": "spawn", "body": {"name": "a/1", "circle": {"radius": -1}}}'],
    'bad_world_file': [
        '{"type": "service", "name": "undo", "world": "x"}',
        '{"type": "open", "name": "/etc/passwd"}',
        '{"type": "save", "name": "../x"}',
    ],
}


def test_a_wrong_message_is_refused_and_changes_nothing(browser: Browser) -> None:
    page = browser.open_page()
    before = browser.physsim.digest()
    for code, texts in WRONG.items():
        for text in texts:
            count = len(page.answers(''))
            page.send_raw(text)
            page.until(lambda count=count: len(page.answers('')) > count)
            (answer,) = page.answers('')[count:]
            assert (answer['ok'], answer['code'], set(answer)) == (False, code, FIELDS), text[:48]
            assert len(answer['message']) < 1000
            assert browser.physsim.digest() == before
    assert page.ask('drop')['ok']


def test_a_refusal_names_the_field_and_why(browser: Browser) -> None:
    page = browser.open_page()
    refused = page.ask('seek', time='soon')
    assert (refused['field'], refused['topic']) == ('time', '')
    assert refused['message'] == "time must be a number, not 'soon'"
    too_long = page.ask('watch', name='a' * 1001)
    assert too_long['message'] == 'name has more than 1000 characters'


def test_a_message_beyond_a_mebibyte_closes_the_page_alone(browser: Browser) -> None:
    page, other = browser.open_page(), browser.open_page()
    page.send_raw('x' * (MOST_BYTES + 1))
    page.until(lambda: page.closed)
    assert other.ask('drop')['ok']


@pytest.mark.parametrize('way', ['length', 'chunks', 'announced'])
def test_a_file_that_is_too_large_is_refused_with_a_code(browser: Browser, way: str) -> None:
    """It is read to its end: who is refused before has nothing but a broken pipe."""
    before, is_chunked = browser.physsim.digest(), way == 'chunks'
    size = 100 * MOST_BYTES if way == 'announced' else 20 * MOST_BYTES
    fields = {'Host': browser.base[7:], 'Cookie': browser.cookie, 'Origin': browser.base}
    length = {'Transfer-Encoding': 'chunked'} if is_chunked else {'Content-Length': str(size)}
    head = ''.join(f'{name}: {value}\r\n' for name, value in (fields | length).items())

    def answer() -> bytes:
        with socket.create_connection(('127.0.0.1', int(browser.base.rpartition(':')[2]))) as link:
            link.settimeout(30.0)
            link.sendall(f'POST /world HTTP/1.1\r\n{head}\r\n'.encode())
            part = b'#' * 2**16
            # Programs wait for the answer before they send so much.
            for _ in range(0 if way == 'announced' else size // len(part)):
                link.sendall(b'%x\r\n%b\r\n' % (len(part), part) if is_chunked else part)
            link.sendall(b'0\r\n\r\n' * is_chunked)
            told = b''
            while b'}' not in told:
                told += link.recv(2**16)
            return told

    status, _, body = browser.run(asyncio.to_thread(answer)).partition(b'\r\n\r\n')
    assert status.startswith(b'HTTP/1.1 413 ')
    assert json.JSONDecoder().raw_decode(body.decode())[0]['code'] == 'malformed'
    assert browser.physsim.digest() == before


def test_one_upload_too_many_is_refused_with_a_code(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    goes_on, read = Event(), world_handlers.load_mapping

    def read_later(text: str, *, field: str) -> dict[str, Any]:
        goes_on.wait()
        return read(text, field=field)

    monkeypatch.setattr(world_handlers, 'load_mapping', read_later)
    post = {'method': 'POST', 'body': 'format: 1', 'headers': {'Origin': browser.base}}
    sent = [
        browser.loop.create_task(browser.begin_fetch('/world', **post))
        for _ in range(world_handlers.MOST_UPLOADS + 1)
    ]
    browser.until(lambda: any(each.done() for each in sent))
    (refused,) = (each.result() for each in sent if each.done())
    assert refused.code == 503
    assert json.loads(refused.body)['code'] == 'busy'
    goes_on.set()
    browser.until(lambda: all(each.done() for each in sent))
    assert sorted(each.result().code for each in sent) == [200] * world_handlers.MOST_UPLOADS + [
        503
    ]


@pytest.mark.parametrize('kind', ['message', 'ping', 'empty part'])
def test_a_flood_closes_the_page_and_delays_no_other(
    browser: Browser, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    # On a busy machine, the turns of a page may read fewer messages than the rate allows.
    monkeypatch.setattr(guarded, 'RATE', 0.0)
    page, other = browser.open_page(), browser.open_page()
    opcodes = chain([1], repeat(0))

    async def flood() -> None:
        with suppress(WebSocketClosedError, StreamClosedError):
            while not page.closed:
                if kind == 'message':
                    await page.socket.write_message(CLICK)
                elif kind == 'ping':
                    page.socket.ping(b'x' * 125)
                else:
                    # The first part is of a text, those after it continue it.
                    part = bytes([next(opcodes), MASKED]) + bytes(4)
                    await page.socket.protocol.stream.write(part)
                await asyncio.sleep(0.0)

    task = browser.loop.create_task(flood())
    assert other.ask('drop')['ok']
    page.until(lambda: page.closed and task.done())
    assert other.ask('speed', speed=1.0)['ok']


def test_messages_that_wait_are_bounded_and_the_rest_is_told(browser: Browser) -> None:
    page = browser.open_page()

    async def burst() -> None:
        for _ in range(2 * CAPACITY):
            await page.socket.write_message(CLICK)

    browser.loop.run_until_complete(burst())
    browser.until(lambda: page.answers('x'), settling=False)
    assert page.answers('x')[0]['code'] == 'busy'
    assert all(set(each) == FIELDS for each in page.answers('x'))
    page.until(lambda: len(page.answers('x')) == 2 * CAPACITY)
    codes = [each['code'] for each in page.answers('x')]
    assert set(codes) == {'busy', 'nothing_there'}
    assert codes.count('nothing_there') >= CAPACITY - 1


def test_a_page_that_does_not_read_is_skipped(browser: Browser) -> None:
    """Its frames are dropped, and the world goes on for all others."""
    page = browser.open_page()
    host, port = browser.base.removeprefix('http://').split(':')
    with socket.create_connection((host, int(port))) as sleeper:
        request = HTTPHeaders(
            {
                'Host': f'{host}:{port}',
                'Upgrade': 'websocket',
                'Connection': 'Upgrade',
                'Sec-WebSocket-Key': 'AAAAAAAAAAAAAAAAAAAAAA==',
                'Sec-WebSocket-Version': '13',
                'Cookie': browser.cookie,
                'Origin': browser.base,
            }
        )
        lines = ''.join(f'{name}: {value}\r\n' for name, value in request.get_all())
        sleeper.sendall(f'GET /ws HTTP/1.1\r\n{lines}\r\n'.encode())
        sleeper.settimeout(20.0)
        assert b'101' in sleeper.recv(12)
        # The frames of these bodies are more than the buffers of any socket.
        boxes = '\n'.join(
            f'  - {{name: box/{each}, box: {{width: 1, height: 1}}, at: [{2 * each}, 0]}}'
            for each in range(500)
        )
        assert browser.open_world(f'format: 1\nbodies:\n{boxes}\n')['ok']
        for number in range(1, 121):
            browser.physsim.step()
            page.until_frame(lambda frame, number=number: frame.time * 60 > number - 0.5)
    assert page.frames[-1].count == 500


def test_one_page_too_many_is_refused(browser: Browser) -> None:
    pages = [browser.open_page('/ws?view') for _ in range(MOST_PAGES)]
    assert status_of_socket(browser) == 503
    pages[0].close()
    pages[0] = browser.open_page()
    assert pages[0].ask('drop')['ok']


# The last ones wait for their turn, or for a client that does not read.
@pytest.mark.parametrize(
    'part',
    ['', 'GET / HTTP/1.1\r\nHost:', BODILESS, 2000 * 'GET / HTTP/1.1\r\nHost: localhost\r\n\r\n'],
    ids=['nothing', 'a part', 'no body', 'very much'],
)
def test_connections_give_way_to_others(
    browser: Browser, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    page = browser.open_page()
    monkeypatch.setattr(website, 'MOST_CONNECTIONS', 4)
    with ExitStack() as closing:
        for _ in range(20):
            connection = closing.enter_context(socket.create_connection(address_of(browser)))
            connection.setblocking(False)
            with suppress(BlockingIOError):
                connection.sendall(part.encode())
            assert browser.fetch('/session').code == 200
    assert page.ask('drop')['ok']


def address_of(browser: Browser) -> tuple[str, int]:
    """Return the host and the port of the page."""
    host, port = browser.base.removeprefix('http://').split(':')
    return host, int(port)


def test_roles_have_tokens_of_their_own() -> None:
    access = Access('127.0.0.1', 8765)
    assert [access.role_of(access.tokens[role]) for role in Role] == list(Role)
    assert access.role_of('') is None
    assert access.role_of('ü\ud800') is None
