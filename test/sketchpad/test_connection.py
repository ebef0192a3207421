# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages whose server goes and comes back, and pages without the right to be there."""

from __future__ import annotations

from collections.abc import Callable
import json
import re
from typing import Any

import pytest

from .chromium import circle, OpenSheet, Sheet, started_world
from ..outside import Outside

# Notes what the line of answers says from now on.
STATUSES = """() => {
    const status = document.querySelector('[role=status]');
    window.statuses = [];
    new MutationObserver(() => statuses.push(status.textContent))
        .observe(status, {childList: true});
}"""


Message = str | bytes
# Of a message by the number of its socket: the message that arrives, None if it is lost.
Way = Callable[[int, Message], Message | None]


def unchanged(_: int, message: Message) -> Message:
    return message


class Cable:
    """
    The way of all messages between a page and its server.

    :param sheet: the page, before it is opened
    :param out: the way of its own messages
    :param back: the way of those to it

    :ivar sockets: that the page has opened, also those in vain
    """

    def __init__(self, sheet: Sheet, *, out: Way = unchanged, back: Way = unchanged) -> None:
        self.sockets: list[Any] = []
        self._is_cut = False
        self._out, self._back = out, back
        sheet.page.route_web_socket('**/ws*', self._connect)

    def cut(self) -> None:
        """Close all sockets, and those that are opened from now on."""
        self._is_cut = True
        for socket in self.sockets:
            socket.close()

    def mend(self) -> None:
        """Connect the sockets that are opened from now on."""
        self._is_cut = False

    def _connect(self, socket: Any) -> None:
        number = len(self.sockets)
        self.sockets.append(socket)
        if self._is_cut:
            socket.close()
            return
        server = socket.connect_to_server()
        for begin, end, way in ((socket, server, self._out), (server, socket, self._back)):

            def pass_on(message: Message, *, end: Any = end, way: Way = way) -> None:
                if (arrived := way(number, message)) is not None:
                    end.send(arrived)

            begin.on_message(pass_on)


def test_the_page_comes_back_when_its_socket_was_cut(open_sheet: OpenSheet, address: str) -> None:
    sheet = open_sheet('about:blank')
    cable = Cable(sheet)
    sheet.page.goto(address)
    sheet.begin()
    people = sheet.page.evaluate('heard.people')
    cable.cut()
    sheet.page.get_by_role('alert').wait_for(state='visible')
    cable.mend()
    sheet.page.get_by_role('alert').wait_for(state='hidden')
    sheet.told('Connected again', exact=True)
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((1.0, 6.0), (1.5, 6.0))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('heard.people') == people
    sheet.page.reload()
    sheet.wait('heard.people')
    assert sheet.page.evaluate('heard.people') == people


def test_a_page_without_a_server_tells_what_was_done_alone_and_its_slider_comes_back(
    open_sheet: OpenSheet, address: str
) -> None:
    open_sheet()
    sheet = open_sheet('about:blank')
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


def test_an_answer_is_told_once_though_its_body_never_comes(
    open_sheet: OpenSheet, address: str
) -> None:
    sheet = open_sheet('about:blank')
    is_told = False

    def back(_: int, message: Message) -> Message | None:
        is_lost = is_told and isinstance(message, str) and '"type":"answer"' in message
        return None if is_lost else message

    cable = Cable(sheet, back=back)
    sheet.page.goto(address)
    sheet.begin()
    answer = {'request': '0', 'ok': True, 'code': '', 'topic': '~/spawn', 'values': {}}
    text = ['deleted {bodies}', {'bodies': 'drawn/99'}]
    told = {'message': 'deleted drawn/99', 'subject': 'drawn/99', 'text': text}
    cable.sockets[0].send(json.dumps({'type': 'answer'} | answer | told))
    sheet.told('Body deleted')
    sheet.page.evaluate(STATUSES)
    # The next scene comes without an answer.
    is_told = True
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((1.0, 6.0), (1.5, 6.0))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('statuses') == []


@pytest.mark.parametrize('lost', ['requests', 'answers'])
def test_a_socket_that_is_silent_is_told_and_what_was_drawn_meanwhile_is_there_once(
    open_sheet: OpenSheet, address: str, lost: str
) -> None:
    sheet = open_sheet('about:blank')
    # Three times as fast. An alert may be shown for less time than a busy machine takes to look.
    sheet.page.add_init_script(
        """const waits = setInterval;
        window.setInterval = (call, pause) => waits(call, pause / 3);
        window.alerts = '';
        const look = () => { alerts += document.querySelector('[role=alert]')?.textContent; };
        new MutationObserver(look).observe(document, {childList: true, subtree: true});"""
    )
    is_dead, drawn = False, []

    def out(number: int, text: str) -> str | None:
        if not is_dead or number:
            return text
        drawn.extend([text] if '"stroke"' in text else [])
        return None if lost == 'requests' or 'ping' in text else text

    def back(number: int, message: Message) -> Message | None:
        return None if is_dead and number == 0 else message

    cable = Cable(sheet, out=out, back=back)
    sheet.page.goto(address)
    sheet.begin()
    before = sheet.names()
    with sheet.dragging(*circle(1.0, 5.0, 0.8)):
        is_dead = True
    sheet.wait_for_new(before)
    assert drawn
    assert len(cable.sockets) == 2
    assert 'does not answer' in sheet.page.evaluate('alerts')
    assert 'refused' not in sheet.page.evaluate('alerts')
    assert sheet.page.get_by_role('alert').is_hidden()
    # After its answer no other one would come.
    sheet.press('Play')
    sheet.wait('physsim.speed === 1')
    assert len(sheet.names()) == len(before) + 1


def test_what_is_drawn_without_a_socket_waits_for_one_and_is_there_once(
    open_sheet: OpenSheet, address: str
) -> None:
    sheet = open_sheet('about:blank')
    cable = Cable(sheet)
    sheet.page.goto(address)
    sheet.begin()
    before = sheet.names()
    cable.cut()
    sheet.page.get_by_role('alert').wait_for(state='visible')
    sheet.press('Inclined plane')
    sheet.drag((1.0, 5.0), (3.0, 6.0))
    # Its meaning depends on the moment.
    sheet.press('Undo')
    sheet.told('Not done')
    cable.mend()
    plane = sheet.wait_for_new(before)
    first, *others = ('again' in each.url for each in cable.sockets)
    assert not first
    assert others
    assert all(others)
    # After its answer no other one would come.
    sheet.press('Play')
    sheet.wait('physsim.speed === 1')
    assert sheet.names() == before | {plane}
    sheet.page.get_by_label('Angle of the slope [°]').wait_for()


def test_what_is_drawn_without_a_socket_is_there_though_the_next_one_is_cut_too(
    open_sheet: OpenSheet, address: str
) -> None:
    sheet = open_sheet('about:blank')
    received, cut = [], set()

    def out(number: int, text: str) -> str | None:
        message = json.loads(text)
        if message['type'] == 'stroke' and not cut:
            cut.add(number)
            cable.cut()
        if number in cut:
            return None
        received.append(int(message['id']))
        return text

    cable = Cable(sheet, out=out)
    sheet.page.goto(address)
    sheet.begin()
    before = sheet.names()
    cable.cut()
    sheet.page.get_by_role('alert').wait_for(state='visible')
    sheet.drag(*circle(1.0, 5.0, 0.8))
    cable.mend()
    sheet.until(lambda: cut, 'a stroke that is lost')
    cable.mend()
    sheet.wait_for_new(before)
    assert received == sorted(received)


def test_a_dead_socket_is_told_within_three_seconds_and_then_what_may_be_lost(
    open_sheet: OpenSheet, address: str
) -> None:
    sheet = open_sheet('about:blank')
    # The looks whether something has come, each half a second.
    sheet.page.add_init_script(
        """const waits = setInterval;
        window.looks = [];
        window.setInterval = (call, pause) =>
            pause === 500 ? looks.push(call) : waits(call, pause);"""
    )
    is_dead = False

    def way(number: int, message: Message) -> Message | None:
        return None if is_dead and number == 0 else message

    Cable(sheet, out=way, back=way)
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
    open_sheet: OpenSheet, address: str
) -> None:
    sheet = open_sheet('about:blank')

    def back(number: int, message: Message) -> Message:
        is_other = number > 0 and isinstance(message, str)
        return message.replace('"version":2', '"version":3') if is_other else message

    cable = Cable(sheet, back=back)
    sheet.page.goto(address)
    sheet.begin()
    with sheet.page.expect_navigation():
        cable.sockets[0].close()
    sheet.wait('Object.keys(physsim.bodies).length === 3')


def test_the_page_says_that_the_server_is_gone_and_comes_back_with_it(
    chromium: Any, outside: Outside
) -> None:
    world, first = started_world(outside, sketchpad_port=8790)
    sheet = Sheet(chromium, first)
    sheet.begin()
    world.interrupt()
    alert = sheet.page.get_by_role('alert')
    alert.get_by_text('does not answer').wait_for()
    requests: list[str] = []
    sockets: list[str] = []
    sheet.page.on('requestfailed', lambda request: requests.append(request.url))
    sheet.page.on('websocket', lambda socket: sockets.append(socket.url))
    # Browsers delay the sockets of a page that tried many in vain.
    sheet.until(lambda: len(requests) > 2, 'requests to a server that is gone')
    assert not sockets
    # A stroke is drawn for the world that comes; what means another thing later is not kept.
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.press('Undo')
    sheet.told('Not done')
    port = re.search(r':(\d+)/', first)[1]
    world, _ = started_world(outside, sketchpad_port=port)
    alert.wait_for(state='hidden')
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    assert not sheet.page.locator('#dock').get_by_text('may be lost').is_visible()
    before = sheet.names()
    sheet.drag(*circle(1.0, 2.0, 0.8))
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


def test_a_page_that_only_shows_has_no_tools(open_sheet: OpenSheet, address: str) -> None:
    sheet = open_sheet(f'{address}&view')
    sheet.wait('Object.keys(physsim.bodies).length > 0')
    assert sheet.page.get_by_role('button').count() == 0


def test_the_world_is_framed_alike_whatever_message_comes_last(
    open_sheet: OpenSheet, address: str
) -> None:
    # With two people the bars of a phone have a button more, and need another line.
    open_sheet()
    places = []
    for late in ('"type":"worlds"', '"type":"class"'):
        sheet = open_sheet('about:blank', size=(390, 844))
        held: list[Message] = []

        def back(_: int, message: Message, late=late, held=held) -> Message | None:
            is_late = isinstance(message, str) and late in message
            return held.append(message) if is_late else message

        cable = Cable(sheet, back=back)
        sheet.page.goto(address)
        sheet.wait('Object.keys(physsim.bodies).length > 0')
        sheet.until(lambda held=held: held, late)
        cable.sockets[0].send(held[0])
        sheet.page.get_by_role('button', name='People').wait_for()
        sheet.wait('true')
        places.append(sheet.place(0.0, 0.0))
        sheet.close()
    assert places[0] == places[1]
