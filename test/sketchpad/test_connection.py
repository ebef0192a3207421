# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages whose server goes and comes back, and pages without the right to be there."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from .chromium import circle, Sheet, started_world
from ..outside import Outside

# Notes what the line of answers says from now on.
STATUSES = """() => {
    const status = document.querySelector('[role=status]');
    window.statuses = [];
    new MutationObserver(() => statuses.push(status.textContent))
        .observe(status, {childList: true});
}"""


class Cable:
    """
    What a page's sockets pass through.

    :param sheet: the page, before it is opened

    :ivar sockets: that the page has opened, also those in vain
    """

    def __init__(self, sheet: Sheet) -> None:
        self.sockets: list[Any] = []
        self._is_cut = False
        sheet.page.route_web_socket('**/ws*', self._pass_on)

    def cut(self) -> None:
        """Close all sockets, and those that are opened from now on."""
        self._is_cut = True
        for socket in self.sockets:
            socket.close()

    def mend(self) -> None:
        """Connect the sockets that are opened from now on."""
        self._is_cut = False

    def _pass_on(self, socket: Any) -> None:
        self.sockets.append(socket)
        if self._is_cut:
            socket.close()
        else:
            socket.connect_to_server()


def test_the_page_comes_back_when_its_socket_was_cut(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, 'about:blank')
    cable = Cable(sheet)
    sheet.page.goto(address)
    sheet.begin()
    people = sheet.page.evaluate('heard.people')
    cable.cut()
    sheet.page.get_by_role('alert').wait_for(state='visible')
    cable.mend()
    sheet.page.get_by_role('alert').wait_for(state='hidden')
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((1.0, 6.0), (1.5, 6.0))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('heard.people') == people
    sheet.page.reload()
    sheet.wait('heard.people')
    assert sheet.page.evaluate('heard.people') == people
    sheet.close()


def test_a_page_without_a_server_tells_what_was_done_alone_and_its_slider_comes_back(
    chromium: Any, address: str
) -> None:
    other, sheet = Sheet(chromium, address), Sheet(chromium, 'about:blank')
    cable = Cable(sheet)
    sheet.page.goto(address)
    sheet.begin()
    sheet.play_until(0.3)
    sheet.wait('heard.people.length > 1')
    status = sheet.page.get_by_role('status')
    told = status.inner_text()
    cable.cut()
    alert = sheet.page.get_by_role('alert')
    alert.wait_for(state='visible')
    # Others would see where the pointer is; nobody has asked for that.
    seen = len(cable.sockets)
    while len(cable.sockets) < seen + 2:
        for x in range(8):
            sheet.page.mouse.move(*sheet.place(x / 4, 5.0))
    assert status.inner_text() == told
    for time in ('0.1', '0.2'):
        sheet.page.get_by_role('slider', name='Time', exact=True).fill(time)
    assert 'Not done' in status.inner_text()
    cable.mend()
    alert.wait_for(state='hidden')
    sheet.play_until(0.5)
    sheet.wait("document.querySelector('#slider').value > 0.5")
    for each in (other, sheet):
        each.close()


def test_an_answer_is_told_once_though_its_body_never_comes(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, 'about:blank')
    sockets: list[Any] = []
    is_told = False

    def pass_on(socket: Any) -> None:
        def take(text: str | bytes) -> None:
            if not (is_told and isinstance(text, str) and '"type":"answer"' in text):
                socket.send(text)

        sockets.append(socket)
        socket.connect_to_server().on_message(take)

    sheet.page.route_web_socket('**/ws*', pass_on)
    sheet.page.goto(address)
    sheet.begin()
    answer = {'request': '0', 'ok': True, 'code': '', 'topic': '~/spawn', 'values': {}}
    told = {'message': 'deleted drawn/99', 'subject': 'drawn/99'}
    sockets[0].send(json.dumps({'type': 'answer'} | answer | told))
    sheet.page.get_by_role('status').get_by_text('Body deleted').wait_for()
    sheet.page.evaluate(STATUSES)
    # The next scene comes without an answer.
    is_told = True
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((1.0, 6.0), (1.5, 6.0))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('statuses') == []
    sheet.close()


@pytest.mark.parametrize('lost', ['requests', 'answers'])
def test_a_socket_that_is_silent_is_told_and_what_was_drawn_meanwhile_is_there_once(
    chromium: Any, address: str, lost: str
) -> None:
    sheet = Sheet(chromium, 'about:blank')
    # Three times as fast. An alert may be shown for less time than a busy machine takes to look.
    sheet.page.add_init_script(
        """const waits = setInterval;
        window.setInterval = (call, pause) => waits(call, pause / 3);
        window.alerts = '';
        const look = () => { alerts += document.querySelector('[role=alert]')?.textContent; };
        new MutationObserver(look).observe(document, {childList: true, subtree: true});"""
    )
    is_dead, sockets, drawn = False, [], []

    def pass_on(socket: Any) -> None:
        number, server = len(sockets), socket.connect_to_server()
        sockets.append(socket)

        def send_out(text: str) -> None:
            if is_dead and number == 0:
                drawn.extend([text] if '"stroke"' in text else [])
                if lost == 'requests' or 'ping' in text:
                    return
            server.send(text)

        socket.on_message(send_out)
        server.on_message(lambda text: (is_dead and number == 0) or socket.send(text))

    sheet.page.route_web_socket('**/ws*', pass_on)
    sheet.page.goto(address)
    sheet.begin()
    before = sheet.names()
    with sheet.dragging(*circle(1.0, 5.0, 0.8)):
        is_dead = True
    sheet.wait_for_new(before)
    assert drawn
    assert len(sockets) == 2
    assert 'does not answer' in sheet.page.evaluate('alerts')
    assert 'refused' not in sheet.page.evaluate('alerts')
    assert sheet.page.get_by_role('alert').is_hidden()
    # After its answer no other one would come.
    sheet.press('Play')
    sheet.wait('physsim.speed === 1')
    assert len(sheet.names()) == len(before) + 1
    sheet.close()


def test_a_dead_socket_is_told_within_three_seconds_and_then_what_may_be_lost(
    chromium: Any, address: str
) -> None:
    sheet = Sheet(chromium, 'about:blank')
    # The looks whether something has come, each half a second.
    sheet.page.add_init_script(
        """const waits = setInterval;
        window.looks = [];
        window.setInterval = (call, pause) =>
            pause === 500 ? looks.push(call) : waits(call, pause);"""
    )
    is_dead, sockets = False, []

    def pass_on(socket: Any) -> None:
        number, server = len(sockets), socket.connect_to_server()
        sockets.append(socket)
        socket.on_message(lambda text: (is_dead and number == 0) or server.send(text))
        server.on_message(lambda text: (is_dead and number == 0) or socket.send(text))

    sheet.page.route_web_socket('**/ws*', pass_on)
    sheet.page.goto(address)
    sheet.begin()
    is_dead = True
    sheet.press('Play')
    sheet.drag(*circle(1.0, 5.0, 0.8))
    alert = sheet.page.get_by_role('alert')
    assert alert.is_hidden()
    sheet.page.evaluate('() => { for (let i = 0; i < 6; i++) looks[0](); }')
    alert.get_by_text('does not answer').wait_for()
    sheet.page.evaluate('() => { for (let i = 0; i < 9; i++) looks[0](); }')
    note = sheet.page.locator('#dock .note')
    note.get_by_text('Of what you did meanwhile, 1 may be lost').wait_for()
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    sheet.close()


def test_a_server_that_closes_each_socket_is_asked_ever_less_often(
    chromium: Any, address: str
) -> None:
    sheet = Sheet(chromium, 'about:blank')
    sheet.page.add_init_script(
        """window.pauses = [];
        const original = setTimeout;
        window.setTimeout = (call, pause) => {
            if (String(call).includes('connect')) pauses.push(pause);
            return original(call, pause);
        };"""
    )

    def close(socket: Any) -> None:
        # Opened, but without a frame.
        socket.connect_to_server().on_message(lambda _: socket.close())

    sheet.page.route_web_socket('**/ws*', close)
    sheet.page.goto(address)
    sheet.wait('pauses.length >= 4')
    assert sheet.page.evaluate('pauses.slice(0, 4)') == [250, 500, 1000, 2000]
    sheet.context.close()


def test_the_page_is_loaded_again_where_another_version_of_the_server_comes_back(
    chromium: Any, address: str
) -> None:
    sheet = Sheet(chromium, 'about:blank')
    sockets: list[Any] = []

    def pass_on(socket: Any) -> None:
        sockets.append(socket)
        server = socket.connect_to_server()
        if len(sockets) > 1:
            version = '"version":2', '"version":3'
            server.on_message(
                lambda text: socket.send(text.replace(*version) if isinstance(text, str) else text)
            )

    sheet.page.route_web_socket('**/ws*', pass_on)
    sheet.page.goto(address)
    sheet.begin()
    with sheet.page.expect_navigation():
        sockets[0].close()
    sheet.wait('Object.keys(physsim.bodies).length === 3')
    sheet.close()


def test_the_page_says_that_the_server_is_gone_and_comes_back_with_it(
    chromium: Any, outside: Outside
) -> None:
    world, first = started_world(outside, sketchpad_port=8790)
    sheet = Sheet(chromium, first)
    sheet.begin()
    world.interrupt()
    alert = sheet.page.get_by_role('alert')
    alert.get_by_text('gone').wait_for()
    requests: list[str] = []
    sockets: list[str] = []
    sheet.page.on('requestfailed', lambda request: requests.append(request.url))
    sheet.page.on('websocket', lambda socket: sockets.append(socket.url))
    # Browsers delay the sockets of a page that tried many in vain.
    sheet.until(lambda: len(requests) > 2, 'requests to a server that is gone')
    assert not sockets
    # A stroke drawn meanwhile is not lost in silence.
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.page.locator('.note.refusal').get_by_text('Not done').wait_for()
    port = re.search(r':(\d+)/', first)[1]
    world, _ = started_world(outside, sketchpad_port=port)
    alert.wait_for(state='hidden')
    assert sheet.page.get_by_role('status').inner_text() == 'Connected again'
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.wait_for_new(before)
    world.interrupt()
    # Of another user, or a year ago.
    (outside.directory / 'physsim_ros' / 'cookie_key').unlink()
    started_world(outside, sketchpad_port=port)
    alert.get_by_text('Wrong token').wait_for()
    sheet.context.close()


def test_a_wrong_token_opens_nothing_and_says_so(chromium: Any, address: str) -> None:
    context = chromium.new_context()
    page = context.new_page()
    response = page.goto(re.sub('token=.*', 'token=wrong', address))
    assert response.status == 403
    assert 'token' in page.inner_text('body')
    assert page.goto(address.partition('/login')[0]).status == 403
    context.close()


def test_a_page_that_only_shows_has_no_tools(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, f'{address}&view')
    sheet.wait('Object.keys(physsim.bodies).length > 0')
    assert sheet.page.get_by_role('button').count() == 0
    sheet.close()


def test_the_world_is_framed_alike_whatever_message_comes_last(
    chromium: Any, address: str
) -> None:
    # With two people the bars of a phone have a button more, and need another line.
    other = Sheet(chromium, address)
    places = []
    for late in ('"type":"worlds"', '"type":"class"'):
        sheet = Sheet(chromium, 'about:blank', viewport={'width': 390, 'height': 844})
        sockets: list[Any] = []
        held: list[str] = []

        def pass_on(socket: Any, *, late=late, sockets=sockets, held=held) -> None:
            def take(text: str | bytes) -> None:
                is_late = isinstance(text, str) and late in text
                held.append(text) if is_late else socket.send(text)

            sockets.append(socket)
            socket.connect_to_server().on_message(take)

        sheet.page.route_web_socket('**/ws*', pass_on)
        sheet.page.goto(address)
        sheet.wait('Object.keys(physsim.bodies).length > 0')
        sheet.until(lambda held=held: held, late)
        sockets[0].send(held[0])
        sheet.page.get_by_role('button', name='People').wait_for()
        sheet.wait('true')
        places.append(sheet.place(0.0, 0.0))
        sheet.close()
    assert places[0] == places[1]
    other.close()
