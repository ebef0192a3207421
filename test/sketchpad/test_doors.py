# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An error that nobody expected, at each door of the pages: it is told, and the world goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import json
from pathlib import Path
from typing import Any

from physsim_ros.files import OwnWorlds
from physsim_ros.ros import world_files
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import (
    autosave,
    gallery,
    message,
    Role,
    sketchpad,
    world_handlers,
)
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.frame_feed import FrameFeed
from physsim_ros.sketchpad.message import KINDS
from physsim_ros.sketchpad.open_pages import OpenPages
from physsim_ros.sketchpad.page_handlers import CookieCheck
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.past import BodyPasts, TimelineReport
from physsim_ros.sketchpad.server import Server
import pytest

from .browser import Browser

WORLD = 'format: 1\nbodies: [{name: a/0, circle: {radius: 1}}]\n'


def fail(*_: object, **__: object) -> Any:
    raise ZeroDivisionError('by zero')


@pytest.fixture
def goes_on(
    browser: Browser, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[[], None]]:
    """Give a test a check that an error was told, and that world and pages go on without it."""
    errors: list[BaseException] = []
    browser.physsim.node.boundary.on_error = errors.append

    def check() -> None:
        browser.until(lambda: errors)
        assert {type(each) for each in errors} == {ZeroDivisionError}
        monkeypatch.undo()
        log = capfd.readouterr().err
        assert 'failure 1, ' in log
        assert 'ZeroDivisionError: by zero' in log
        page, before, count = browser.open_page(), browser.physsim.time, len(errors)
        assert page.ask('drop')['ok']
        browser.physsim.run(0.1)
        assert browser.physsim.time == pytest.approx(before + 0.1)
        page.until(lambda: page.frames and page.frames[-1].time == pytest.approx(before + 0.1))
        assert len(errors) == count

    yield check
    # Each of these tests makes sure that its error came about.
    assert errors


def assert_failed(answer: dict[str, Any]) -> None:
    assert (answer['ok'], answer['code']) == (False, 'failed')
    assert 'failure 1 in the log' in answer['message']


@pytest.mark.parametrize('kind', sorted(KINDS.keys() - {'show', 'here'}))
def test_a_message_on_the_thread_of_the_world(
    browser: Browser,
    goes_on: Callable[[], None],
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
) -> None:
    server = browser.physsim.node.outputs.sketchpad
    assert server is not None
    # A teacher's page may send all kinds.
    page = browser.open_page(cookie=browser.login_cookie(server.url(Role.TEACH)))
    monkeypatch.setitem(KINDS, kind, KINDS[kind]._replace(handle=fail, fields={}))
    assert_failed(page.ask(kind))
    goes_on()


def test_a_message_that_is_read(
    browser: Browser, goes_on: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    page = browser.open_page()
    monkeypatch.setattr(message, 'check_right', fail)
    assert_failed(page.ask('drop'))
    goes_on()


@pytest.mark.parametrize(
    ('kind', 'fields', 'where', 'name'),
    [
        ('open', {'name': 'demo'}, world_files, 'find_world'),
        ('save', {'name': 'mine'}, OwnWorlds, 'keep'),
        ('rename', {'name': 'mine', 'to': 'his'}, OwnWorlds, 'rename'),
        ('remove', {'name': 'mine'}, OwnWorlds, 'delete'),
        ('put_back', {'name': 'mine'}, OwnWorlds, 'put_back'),
        ('forget', {}, Autosave, 'forget_unsaved'),
        ('share', {}, Simulation, 'save'),
        ('take_back', {}, Simulation, 'take_back'),
        ('course', {'course': 7}, Simulation, 'return_to_course'),
    ],
)
def test_an_action(
    browser: Browser,
    goes_on: Callable[[], None],
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
    fields: dict[str, Any],
    where: object,
    name: str,
) -> None:
    page = browser.open_page()
    monkeypatch.setattr(where, name, fail)
    assert_failed(page.ask(kind, **fields))
    goes_on()


def test_an_upload(
    browser: Browser, goes_on: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sketchpad, 'state_from', fail)
    upload = browser.fetch('/world', method='POST', body=WORLD, headers={'Origin': browser.base})
    assert_failed(json.loads(upload.body))
    goes_on()


REQUESTS: dict[str, tuple[object, str]] = {
    '/session': (CookieCheck, 'get'),
    '/world/demo.yaml': (world_handlers, 'find_world'),
    '/picture/demo': (OwnWorlds, 'picture'),
    '/unsaved': (Autosave, 'unsaved_content'),
}


@pytest.mark.parametrize('path', REQUESTS)
def test_a_request(
    browser: Browser, goes_on: Callable[[], None], monkeypatch: pytest.MonkeyPatch, path: str
) -> None:
    monkeypatch.setattr(*REQUESTS[path], fail)
    response = browser.fetch(path)
    assert response.code == 500
    assert b'failure 1 in the log' in response.body
    goes_on()


def test_a_file_of_the_list_of_worlds(
    browser: Browser, goes_on: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A lesson that nobody can read is in the list by its name, and so are all others."""
    load, bad = gallery.load_world, browser.physsim.node.world_files.directory / 'lessons'
    bad.mkdir()
    (bad / 'bad.yaml').write_text(WORLD)

    def load_unless_bad(path: Path) -> Any:
        return fail() if path.stem == 'bad' else load(path)

    monkeypatch.setattr(gallery, 'load_world', load_unless_bad)
    page = browser.open_page()
    page.until(lambda: page.of_type('worlds'))
    (content,) = page.of_type('worlds')
    assert {'name': 'bad', 'number': 0, 'title': 'bad', 'question': ''} in content['lessons']
    assert len(content['lessons']) > 1
    goes_on()


@pytest.mark.parametrize(
    ('where', 'name'),
    [
        (PageSession, 'tell_touches'),
        (TimelineReport, 'take_status'),
        (BodyPasts, 'send_due'),
        (sketchpad.Sketchpad, '_open'),
        (sketchpad.Sketchpad, '_send_class'),
        (Server, '_show'),
        (FrameFeed, 'send_frame'),
        (OpenPages, 'move_cursor'),
    ],
    ids=lambda value: value if isinstance(value, str) else '',
)
def test_what_goes_to_a_page(
    browser: Browser,
    goes_on: Callable[[], None],
    monkeypatch: pytest.MonkeyPatch,
    where: object,
    name: str,
) -> None:
    page = browser.open_page()
    assert page.ask('drop')['ok']
    monkeypatch.setattr(where, name, fail)
    browser.open_page()
    page.send('here', point=[0, 0])
    browser.physsim.step()
    goes_on()


def test_an_autosave(
    browser: Browser, goes_on: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    page = browser.open_page()
    monkeypatch.setattr(autosave, 'write_file', fail)
    assert page.ask('spawn', body={'name': 'a/0', 'circle': {'radius': 1}})['ok']
    browser.physsim.step(2)
    goes_on()
