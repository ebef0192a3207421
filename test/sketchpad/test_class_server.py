# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A class with a world for each pupil: its program, its page, and who gets which world."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from http.client import HTTPConnection, HTTPResponse
import json
from pathlib import Path
import re
import socket
import threading
from typing import Any
from urllib.parse import quote, urlsplit

from physsim_ros.model.errors import WorldFull
from physsim_ros.ros.programs.physsim_class import shares
from physsim_ros.sketchpad import ClassServer, Role
from physsim_ros.sketchpad.server import seats as seats_module
from physsim_ros.sketchpad.server import website
from physsim_ros.sketchpad.server.seats import machine_of, Seats, WorldAddresses
import pytest

from .chromium import circle, Sheet
from ..outside import Outside, PATIENCE, Program

# Colours of a picture.
# The states of all seats, as their cards tell them one after the other.
STATES = """window.states = '';
new MutationObserver(() => {
    for (const each of document.querySelectorAll('.state')) states += `${each.textContent}; `;
}).observe(document, {childList: true, subtree: true});"""
# Counts the pictures that are drawn of seats, and of all together.
COUNT_PICTURES = """() => {
    window.pictures = {together: 0, seats: 0};
    const fill = CanvasRenderingContext2D.prototype.fillRect;
    CanvasRenderingContext2D.prototype.fillRect = function (...box) {
        pictures[this.canvas.className || 'seats'] += 1;
        fill.apply(this, box);
    };
}"""
COLORS = """selector => {
    const canvas = document.querySelector(selector);
    const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) seen.add([...data.slice(i, i + 3)].join());
    return [...seen].map((each) => each.split(',').map(Number));
}"""
RESULT = ('answer', 'right', 'tries')
WORLDS = [
    WorldAddresses(pupil=f'http://p/{each}', teacher=f'http://t/{each}') for each in range(2)
]


def test_a_browser_comes_back_to_its_world_and_gets_no_other_one() -> None:
    seats = Seats(WORLDS)
    anna, key = seats.join('Anna', '')
    ben, other = seats.join('Ben', 'a key of another class')
    assert (anna, ben) == (0, 1)
    assert key != other
    assert seats.join('Anna B.', key) == (anna, key)
    assert seats.names == ['Anna B.', 'Ben']
    # A name alone opens nobody's world.
    with pytest.raises(WorldFull):
        seats.join('Anna', '')


def test_a_machine_has_few_seats_however_often_it_asks() -> None:
    seats = Seats([*WORLDS, *WORLDS], most_of_machine=2)
    keys = [seats.join(f'Pupil {each}', '', address='192.168.0.7')[1] for each in range(2)]
    with pytest.raises(WorldFull, match='this machine'):
        seats.join('Pupil 3', '', 'forged', address='192.168.0.7')
    # With a key it comes back, and others come.
    assert seats.join('Anna', '', keys[1], address='192.168.0.7') == (1, keys[1])
    assert seats.join('Ben', '', address='192.168.0.8')[0] == 2
    seats.free(0)
    assert seats.names == ['', 'Anna', 'Ben', '']
    number, key = seats.join('Pupil 1', keys[0], address='192.168.0.7')
    assert (number, key == keys[0]) == (0, False)
    many = Seats([*WORLDS, *WORLDS], most_of_machine=0)
    assert [many.join('A', '', address='10.0.0.1')[0] for _ in range(4)] == [0, 1, 2, 3]


def test_a_machine_has_a_network_of_ipv6() -> None:
    assert machine_of('2001:db8::1') == machine_of('2001:db8::ffff:2') != machine_of('2001:db9::1')
    assert machine_of('::ffff:10.0.0.1') == machine_of('10.0.0.1') == '10.0.0.1'
    assert machine_of('fe80::1%eth0') == machine_of('fe80::2')


def test_seats_outlive_a_restart_and_a_newcomer_gets_an_empty_one_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / 'physsim_ros' / 'class_8800.json'
    seats = Seats([*WORLDS, *WORLDS], path)
    keys = [seats.join(name, '', address=f'10.0.0.{name}')[1] for name in 'ABC']
    seats.free(0)
    assert path.stat().st_mode & 0o777 == 0o600

    again = Seats([*WORLDS, *WORLDS], path)
    assert again.names == ['', 'B', 'C', '']
    assert again.join('C', keys[2]) == (2, keys[2])
    assert [again.join(name, '')[0] for name in 'XY'] == [0, 3]
    # The seat of who has not come back is the last one.
    assert again.join('Z', '')[0] == 1
    with pytest.raises(WorldFull):
        again.join('B', keys[1])
    # Of a smaller class, of another day, and of a file that somebody has spoilt.
    assert Seats(WORLDS, path).names == ['X', 'Z']
    monkeypatch.setattr(seats_module, 'SEAT_AGE', -1)
    assert Seats(WORLDS, path).names == ['', '']
    spoilt = '[{"name": 3}]', '[{"other": ""}]', '[{"at": "a"}]', '[' * 100_000
    for content in ('', '[', '{}', '[1]', *spoilt):
        path.write_text(content)
        assert Seats(WORLDS, path).names == ['', '']


@pytest.mark.parametrize(('pupils', 'processes'), [(1, 2), (5, 2), (20, 2), (30, 4), (3, 8)])
def test_worlds_are_shared_out_evenly_from_one(pupils: int, processes: int) -> None:
    parts = shares(pupils, processes)
    assert [number for part in parts for number in part] == list(range(1, pupils + 1))
    sizes = [len(part) for part in parts]
    assert max(sizes) - min(sizes) <= 1
    assert len(parts) == min(pupils, processes)


@pytest.fixture
def class_server(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[ClassServer]:
    """Give a test the server of a class, on a thread."""
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    monkeypatch.setitem(website.LIMITS, 'body_timeout', 0.2)
    is_over = threading.Event()
    server = ClassServer(WORLDS, address='127.0.0.1', port=0)
    thread = threading.Thread(target=server.run, args=(is_over.is_set,))
    thread.start()
    yield server
    is_over.set()
    thread.join()


@pytest.fixture
def class_address(class_server: ClassServer) -> str:
    """Give a test the address of pupils of a class."""
    return class_server.url(Role.DRAW)


def fetch(url: str, method: str = 'GET', body: str = '', **headers: str) -> HTTPResponse:
    """Return the response to a request, whatever its status."""
    parts = urlsplit(url)
    connection = HTTPConnection(parts.netloc, timeout=PATIENCE)
    connection.request(method, f'{parts.path}?{parts.query}', body, headers)
    return connection.getresponse()


def post_without_body(address: str) -> socket.socket:
    """Return a connection with a request whose body does not come, as anybody can open it."""
    parts = urlsplit(address)
    connection = socket.create_connection((parts.hostname, parts.port))
    connection.sendall(
        f'POST /join HTTP/1.1\r\nHost: {parts.netloc}\r\nContent-Length: 100\r\n\r\n'.encode()
    )
    connection.settimeout(PATIENCE)
    return connection


def test_requests_without_a_body_do_not_shut_the_class_page(
    class_address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(website, 'MOST_CONNECTIONS', 3)
    with ExitStack() as closing:
        held = [closing.enter_context(post_without_body(class_address)) for _ in range(3)]
        # They are closed after a time, and others have their places.
        assert [connection.recv(1) for connection in held] == [b''] * 3
        assert fetch(class_address).status == 302


def test_an_error_that_nobody_expected_is_answered(
    class_address: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError('by zero')

    monkeypatch.setattr(Seats, 'join', fail)
    base = class_address.partition('/login')[0]
    cookie = fetch(class_address).headers['Set-Cookie'].partition(';')[0]
    failed = fetch(f'{base}/join', 'POST', '{"name": "Anna"}', Origin=base, Cookie=cookie)
    assert failed.status == 500
    assert b'failure 1 in the log' in failed.read()
    assert 'ZeroDivisionError: by zero' in capsys.readouterr().err
    assert json.load(fetch(f'{base}/seats', Cookie=cookie))['seats'] == []


def test_a_browser_without_its_key_has_its_seat_by_a_cookie_and_a_teacher_frees_it(
    class_server: ClassServer,
) -> None:
    address = class_server.url(Role.DRAW)
    base = address.partition('/login')[0]
    cookies = {
        role: fetch(class_server.url(role)).headers['Set-Cookie'].partition(';')[0]
        for role in (Role.DRAW, Role.TEACH)
    }

    def post(path: str, body: dict[str, object], cookie: str) -> HTTPResponse:
        return fetch(f'{base}{path}', 'POST', json.dumps(body), Origin=base, Cookie=cookie)

    first = post('/join', {'name': 'Anna'}, cookies[Role.DRAW])
    seat = first.headers['Set-Cookie'].partition(';')[0]
    assert 'HttpOnly' in first.headers['Set-Cookie']
    key = json.load(first)['key']
    for _ in range(3):
        again = post('/join', {'name': 'Anna'}, f'{cookies[Role.DRAW]}; {seat}')
        assert json.load(again)['key'] == key
    assert post('/join', {'name': 'Ben'}, cookies[Role.DRAW]).status == 200
    assert post('/join', {'name': 'Cleo'}, cookies[Role.DRAW]).status == 409

    assert post('/free', {'seat': 0}, cookies[Role.DRAW]).status == 403
    for wrong in ({}, {'seat': 2}, {'seat': -1}, {'seat': '0'}, {'seat': True}):
        assert post('/free', wrong, cookies[Role.TEACH]).status == 400
    assert json.load(post('/free', {'seat': 0}, cookies[Role.TEACH])) == {'seats': ['', 'Ben']}
    assert post('/join', {'name': 'Cleo'}, cookies[Role.DRAW]).status == 200


@pytest.mark.parametrize('number', ['9' * 5000, '9999', '-1', '٣', '0x1', '1' + '0' * 300])
def test_a_socket_to_no_seat_is_refused_and_no_error(
    class_server: ClassServer, number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    address = class_server.url(Role.TEACH)
    base = address.partition('/login')[0]
    cookie = fetch(address).headers['Set-Cookie'].partition(';')[0]
    upgrade = {
        'Upgrade': 'websocket',
        'Connection': 'Upgrade',
        'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==',
        'Sec-WebSocket-Version': '13',
    }
    answer = fetch(f'{base}/ws/{quote(number)}', Origin=base, Cookie=cookie, **upgrade)
    assert answer.status in (101, 404)
    assert 'failure' not in capsys.readouterr().err


def names_on(sheet: Sheet) -> list[str]:
    """Return the names on the cards of a teacher's page, in the order in which Tab comes there."""
    names: list[str] = sheet.page.locator('#seats li a').all_inner_texts()
    return names


class RunningClass:
    """
    A class of two worlds.

    :ivar program: of the class
    :ivar sheets: pages that were opened in it
    :ivar pupils: address of pupils
    :ivar teacher: address of a teacher
    """

    def __init__(self, chromium: Any, program: Program) -> None:
        self.program = program
        lines = [program.wait_for('/login?token=') for _ in range(2)]
        self.pupils, self.teacher = (re.search(r'http\S+', line)[0] for line in lines)
        self._chromium = chromium
        self.sheets: list[Sheet] = []

    def open(self, address: str, **options: Any) -> Sheet:  # noqa: A003 - of a page
        """Open a page."""
        self.sheets.append(Sheet(self._chromium, address, **options))
        return self.sheets[-1]

    def come(self, name: str) -> Sheet:
        """Come to the class as a pupil, and wait for the world."""
        sheet = self.open(self.pupils)
        sheet.page.get_by_role('textbox', name='Your name').fill(name)
        sheet.press('Go to my world')
        # Of the page that it is sent to: a script on the one before would end with it.
        sheet.page.locator('#world').wait_for(state='attached')
        sheet.wait('"physsim" in window && "heavy/0" in physsim.bodies')
        return sheet

    def end(self) -> None:
        """End the class."""
        assert self.program.interrupt() == 0


@pytest.fixture
def run_class(chromium: Any, outside: Outside) -> Iterator[RunningClass]:
    """Give a test a class of two worlds."""
    outside.environment['XDG_DATA_HOME'] = str(outside.directory)
    arguments = ['--pupils', 2, '--port', 0, '--ros-args', '-p', 'world_file:=free_fall']
    running = RunningClass(chromium, outside.start_installed('physsim_class', *arguments))
    yield running
    for sheet in running.sheets:
        sheet.close()
    if running.program.process.poll() is None:
        running.end()


def test_pupils_come_by_one_address_each_to_a_world_and_a_teacher_sees_them(
    run_class: RunningClass,
) -> None:
    anna, ben = run_class.come('Anna'), run_class.come('Ben')
    before = anna.names()
    # A lesson begins with the hand, and without the pen.
    anna.press('All tools')
    anna.press('Pen')
    anna.drag(*circle(0.0, 3.0, 0.6))
    drawn = anna.wait_for_new(before)
    assert drawn not in ben.names()
    late = run_class.open(run_class.pupils)
    late.page.get_by_role('textbox', name='Your name').fill('Cleo')
    late.press('Go to my world')
    late.page.get_by_role('alert').get_by_text('every world').wait_for()
    # The browser tells of the refusal, too.
    assert all('409' in each for each in late.errors)
    late.errors.clear()

    sheet = run_class.open(run_class.teacher)
    links = sheet.page.get_by_role('listitem').get_by_role('link')
    links.nth(1).wait_for()
    sheet.until(lambda: links.all_inner_texts() == ['Anna', 'Ben'], 'who is where')
    sheet.press('Pupils come here')
    assert sheet.page.locator('#pupils').inner_text() == run_class.pupils
    sheet.press('Close')
    # A lesson for all.
    sheet.page.get_by_label('Lesson').select_option('slope')
    sheet.press('Open the lesson for all')
    anna.page.locator('#lesson').get_by_text('4. Down a slope').wait_for()
    card = sheet.page.locator('#seats li').first
    card.get_by_text('4. Down a slope').wait_for()
    sheet.press('Play all')
    for pupil in (anna, ben):
        pupil.wait('physsim.speed === 1')
    sheet.press('Pause all')
    for pupil in (anna, ben):
        pupil.wait('physsim.speed === 0')
    sheet.page.get_by_label('Message to all').fill('Five minutes left')
    sheet.press('Send')
    ben.page.get_by_text('Teacher: Five minutes left').wait_for()
    # The picture shows the block of ice.
    sheet.until(
        lambda: [118, 183, 178] in sheet.page.evaluate(COLORS, '#seats canvas'), 'a picture'
    )
    with sheet.context.expect_page() as opened:
        links.first.click()
    opened.value.locator('.whose').get_by_text('World of Anna').wait_for()
    opened.value.get_by_role('button', name='People').click()
    opened.value.get_by_role('listitem').get_by_text('Anna').wait_for()
    # That code would lead to this world, and not to the class.
    assert not opened.value.get_by_role('img', name='QR code').count()
    opened.value.get_by_role('button', name='Freeze all pupils').click()
    anna.page.get_by_text('Your teacher has frozen this world.').wait_for()
    card.get_by_text('frozen').wait_for()
    # One undo takes the lesson back.
    ben.press('Undo')
    ben.page.locator('#lesson').get_by_text('1. Free fall').wait_for()


def test_a_pupil_who_gets_no_world_is_told_why_in_the_language_of_the_page(
    run_class: RunningClass,
) -> None:
    for name in ('Anna', 'Ben'):
        run_class.come(name)
    late = run_class.open(run_class.pupils, locale='de-DE')
    late.page.get_by_role('textbox', name='Dein Name').fill('Dora')
    late.press('Zu meiner Welt')
    told = late.page.get_by_role('alert')
    told.get_by_text('Alle Welten der Klasse sind besetzt').wait_for()
    for sheet in run_class.sheets[:2]:
        sheet.close()
    run_class.end()
    late.press('Zu meiner Welt')
    told.get_by_text('Die Klasse ist nicht erreichbar').wait_for()
    # The browser tells of both, too.
    assert all('Failed to load' in each for each in late.errors)
    late.errors.clear()


def test_a_body_that_leaves_what_its_lesson_shows_stays_in_its_picture(
    run_class: RunningClass,
) -> None:
    anna, boss = run_class.come('Anna'), run_class.open(run_class.teacher)
    boss.page.get_by_text('1 of 2 here').wait_for()
    boss.page.get_by_label('Lesson').select_option('horizontal_throw')
    boss.press('Open the lesson for all')
    anna.wait('"dropped/0" in physsim.bodies')
    seen = partial(boss.page.evaluate, COLORS, '#seats canvas')
    # It rolls to the wall, beyond the view of the lesson.
    anna.play_until(4.0)
    assert anna.pose('dropped/0')[0] > 7.0
    boss.until(lambda: [228, 87, 86] in seen(), 'the red ball')


def test_a_teacher_sees_hands_and_results_and_who_is_not_here(
    run_class: RunningClass,
) -> None:
    anna, ben = run_class.come('Anna'), run_class.come('Ben')
    sheet = run_class.open(run_class.teacher)
    sheet.page.get_by_text('2 of 2 here').wait_for()
    anna.page.get_by_role('textbox', name='Your answer').fill('1.01')
    anna.press('Check')
    card = sheet.page.locator('#seats li').filter(has_text='Anna')
    card.get_by_text('1.01 s ✓ right').wait_for()
    more = card.get_by_role('button', name='More')
    more.focus()
    ben.press('Raise your hand')
    sheet.page.get_by_text('2 of 2 here · hands raised: 1').wait_for()
    # Hands come first, the earliest before others; then people by their names.
    sheet.until(lambda: names_on(sheet) == ['Ben', 'Anna'], 'an order')
    # Who works by keys stays where they are.
    assert more.evaluate('each => each === document.activeElement')
    anna.press('Raise your hand')
    sheet.page.get_by_text('hands raised: 2').wait_for()
    assert names_on(sheet) == ['Ben', 'Anna']
    sheet.page.locator('#seats li').filter(has_text='Ben').get_by_role(
        'button', name='Lower the hand'
    ).click()
    ben.page.get_by_role('button', name='Raise your hand', pressed=False).wait_for()
    sheet.until(lambda: names_on(sheet) == ['Anna', 'Ben'], 'an order')
    more.click()
    sheet.page.get_by_label('Message to Anna').fill('Well done')
    sheet.page.get_by_role('dialog').get_by_role('button', name='Send').click()
    anna.page.get_by_text('Teacher: Well done').wait_for()
    assert not ben.page.get_by_text('Well done').count()
    # Without their page a pupil is not here; the result stays.
    anna.page.reload()
    card.get_by_text('1.01 s ✓ right').wait_for()
    anna.close()
    card.get_by_text('not here').wait_for()
    sheet.press('Results')
    sheet.page.get_by_role('row', name='Anna').get_by_text('1.01 ✓').wait_for()
    sheet.page.locator('.histogram').get_by_text('1 … 2').wait_for()
    assert sheet.page.locator('.histogram .right').evaluate('bar => bar.style.width') == '100%'
    with sheet.page.expect_download() as table:
        sheet.press('Save table (CSV)')
    head, row = Path(table.value.path()).read_text('utf-8-sig').splitlines()
    assert head.split(',')[:4] == ['Name', *(f'1. Free fall: {each}' for each in RESULT)]
    assert row.startswith('Anna,1.01,1,1,')
    sheet.press('Close')
    ben.close()
    assert sheet.errors == []
    run_class.end()
    sheet.page.get_by_text('The class is not reachable').wait_for()
    sheet.errors.clear()


def test_a_pupil_whose_seat_is_freed_is_told_and_leaves_the_world_to_the_next_one(
    run_class: RunningClass,
) -> None:
    anna = run_class.come('Anna')
    run_class.come('Ben')
    boss = run_class.open(run_class.teacher)
    boss.page.get_by_text('2 of 2 here').wait_for()
    boss.page.locator('#seats li').first.get_by_role('button', name='More').click()
    boss.press('Free this seat')
    told = anna.page.get_by_role('alert').get_by_text('Your teacher has freed this seat')
    told.wait_for()
    left = anna.page.evaluate('physsim.time')
    boss.page.get_by_text('1 of 2 here').wait_for()
    # It is alone there, and the page before does not come back.
    cleo = run_class.come('Cleo')
    assert urlsplit(cleo.page.url).port == urlsplit(anna.page.url).port
    boss.page.get_by_text('2 of 2 here').wait_for()
    cleo.wait(f'physsim.time > {left}')
    assert anna.page.evaluate('physsim.time') == left
    assert cleo.page.get_by_role('button', name='People').is_hidden()
    assert told.is_visible()


def test_a_teacher_sees_all_runs_in_one_picture_and_shows_one_to_all(
    run_class: RunningClass,
) -> None:
    anna, ben = run_class.come('Anna'), run_class.come('Ben')
    for sheet in (anna, ben):
        sheet.begin(2)
    anna.tap(*anna.pose('heavy/0')[:2])
    anna.page.get_by_text('Enter numbers').click()
    anna.enter('vx [m/s]', '-2')
    anna.told('changed')
    for sheet in (anna, ben):
        sheet.play_until(0.9)

    boss = run_class.open('about:blank')
    boss.page.add_init_script(STATES)
    boss.page.goto(run_class.teacher)
    boss.page.get_by_text('2 of 2 here').wait_for()
    # Nobody is said to be away, and no world to be silent, before anybody has looked.
    assert not re.search('not here|not answer', boss.page.evaluate('states'))
    boss.press('All runs in one picture')
    boss.page.locator('.together').wait_for()
    for color in ([30, 87, 143], [143, 30, 54]):
        seen = partial(boss.page.evaluate, COLORS, '.together')
        boss.until(lambda color=color, seen=seen: color in seen(), f'a way in {color}')
    boss.press('Close')
    # On dark paper the colours are light ones.
    boss.page.emulate_media(color_scheme='dark')
    boss.press('All runs in one picture')
    name = boss.page.get_by_role('dialog').get_by_role('button', name='Anna')
    color = name.evaluate('each => getComputedStyle(each).color')
    assert min(int(each) for each in re.findall(r'\d+', color)) > 128, color
    boss.press('Close')
    boss.page.emulate_media(color_scheme='light')
    # In the frame after it is closed, it learns that it has no size.
    for _ in range(2):
        boss.page.evaluate('new Promise(requestAnimationFrame)')
    boss.page.evaluate(COUNT_PICTURES)
    boss.page.locator('#seats li').first.get_by_role('button', name='More').click()
    boss.press('Show this run to all')
    # Its beginning is that of Anna's run, and so it goes as that went.
    ben.wait('Math.abs(physsim.time) < 0.9 && physsim.speed === 1')
    ben.wait('physsim.time > 0.9')
    ben.press('Pause')
    for time in (0.5, 0.9):
        for sheet in (anna, ben):
            sheet.seek(time)
        assert ben.pose('heavy/0') == anna.pose('heavy/0')
    assert ben.pose('heavy/0')[0] < 1.0
    # A picture that is closed is drawn no more.
    boss.wait('pictures.seats > 0')
    assert boss.page.evaluate('pictures.together') == 0
