# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An error that nobody expected, at each door of the pages: it is told, and the world goes on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from physsim_ros.files import OwnWorlds
from physsim_ros.ros import world_files
from physsim_ros.simulation import applier
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import autosave, message, Role, sketchpad, world_control
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.body_pasts import BodyPasts
from physsim_ros.sketchpad.message import KINDS
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.people import People
from physsim_ros.sketchpad.server import gallery, world_handlers
from physsim_ros.sketchpad.server.frame_feed import FrameFeed
from physsim_ros.sketchpad.server.open_pages import OpenPages
from physsim_ros.sketchpad.server.page_handlers import CookieCheck
from physsim_ros.sketchpad.server.server import Server
from physsim_ros.sketchpad.timeline import TimelineReport
import pytest

from .browser import Browser
from ..client import parameter
from ..doors import Doors, fail

WORLD = 'format: 1\nbodies: [{name: a/0, circle: {radius: 1}}]\n'


class PageDoors(Doors):
    """The pages of a world of which a part fails from some moment on."""

    def __init__(self, browser: Browser, *fixtures: Any) -> None:
        super().__init__(browser.physsim, *fixtures)
        self.browser = browser

    def go_on(self) -> None:
        """Check that errors were told, and that world and pages go on without them."""
        self.browser.until(lambda: self.errors)
        self.repair()
        page, count = self.browser.open_page(), len(self.errors)
        assert page.ask('drop')['ok']
        self.run_on()
        page.until_frame(lambda frame: frame.time == self.physsim.time)
        assert len(self.errors) == count


@pytest.fixture
def doors(
    browser: Browser, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> PageDoors:
    """Give a test pages and what makes their parts fail."""
    return PageDoors(browser, monkeypatch, capfd)


def assert_failed(answer: dict[str, Any]) -> None:
    assert (answer['ok'], answer['code']) == (False, 'failed')
    assert 'failure 1 in the log' in answer['message']


def test_messages_on_the_thread_of_the_world(doors: PageDoors) -> None:
    # A teacher's page may send all kinds.
    page = doors.browser.open_page(cookie=doors.browser.cookie_of(Role.TEACH))
    kinds = sorted(name for name in KINDS if KINDS[name].for_world)
    for kind in kinds:
        doors.monkeypatch.setitem(KINDS, kind, KINDS[kind]._replace(handle=fail, fields={}))
        assert_failed(page.ask(kind))
    assert len(doors.errors) == len(kinds)
    doors.go_on()


def test_a_message_that_is_read(doors: PageDoors) -> None:
    page = doors.browser.open_page()
    doors.fail(message, 'check_right')
    assert_failed(page.ask('drop'))
    doors.go_on()


@pytest.mark.parametrize(
    ('kind', 'fields', 'where', 'name'),
    [
        ('open', {'name': 'demo'}, world_files, 'find_world'),
        ('save', {'name': 'mine'}, OwnWorlds, 'check_free'),
        ('rename', {'name': 'mine', 'to': 'his'}, OwnWorlds, 'rename'),
        ('remove', {'name': 'mine'}, OwnWorlds, 'delete'),
        ('put_back', {'name': 'mine'}, OwnWorlds, 'put_back'),
        ('forget', {}, Autosave, 'forget_unsaved'),
        ('share', {}, Simulation, 'saver'),
        ('take_back', {}, applier, 'take_back'),
        ('course', {'course': 7}, Simulation, 'return_to_course'),
    ],
)
def test_an_action(
    doors: PageDoors, kind: str, fields: dict[str, Any], where: object, name: str
) -> None:
    page = doors.browser.open_page()
    world_file = parameter(doors.physsim, 'world_file')
    doors.fail(where, name)
    assert_failed(page.ask(kind, **fields))
    assert parameter(doors.physsim, 'world_file') == world_file
    doors.go_on()


@pytest.mark.parametrize('part', ['state_from', 'check_moment'])
def test_an_upload(doors: PageDoors, part: str) -> None:
    doors.fail(world_control if part == 'state_from' else sketchpad, part)
    assert_failed(doors.browser.open_world(WORLD))
    doors.go_on()


REQUESTS: dict[str, tuple[object, str]] = {
    '/session': (CookieCheck, 'get'),
    '/world/demo.yaml': (world_handlers, 'find_world'),
    '/picture/demo': (OwnWorlds, 'picture'),
    '/unsaved': (Autosave, 'unsaved_content'),
}


@pytest.mark.parametrize('path', REQUESTS)
def test_a_request(doors: PageDoors, path: str) -> None:
    doors.fail(*REQUESTS[path])
    response = doors.browser.fetch(path)
    assert response.code == 500
    assert b'failure 1 in the log' in response.body
    doors.go_on()


def test_a_file_of_the_list_of_worlds(doors: PageDoors) -> None:
    """A lesson that nobody can read is in the list by its name, and so are all others."""
    load, bad = gallery.load_world, doors.node.world_files.directory / 'lessons'
    bad.mkdir()
    (bad / 'bad.yaml').write_text(WORLD)

    def load_unless_bad(path: Path) -> Any:
        return fail() if path.stem == 'bad' else load(path)

    doors.monkeypatch.setattr(gallery, 'load_world', load_unless_bad)
    page = doors.browser.open_page()
    page.until(lambda: page.of_type('worlds'))
    (content,) = page.of_type('worlds')
    assert {'name': 'bad', 'number': 0, 'title': 'bad', 'question': ''} in content['lessons']
    assert len(content['lessons']) > 1
    doors.go_on()


@pytest.mark.parametrize(
    ('where', 'name'),
    [
        (PageSession, 'tell_touches'),
        (TimelineReport, 'take_status'),
        (BodyPasts, 'send_due'),
        (sketchpad.Sketchpad, '_open'),
        (People, 'take_list'),
        (Server, '_show'),
        (FrameFeed, 'send_frame'),
        (OpenPages, 'move_cursor'),
    ],
    ids=lambda value: value if isinstance(value, str) else '',
)
def test_what_goes_to_a_page(doors: PageDoors, where: object, name: str) -> None:
    page = doors.browser.open_page()
    assert page.ask('drop')['ok']
    doors.fail(where, name)
    doors.browser.open_page()
    page.send('here', point=[0, 0])
    doors.physsim.step()
    doors.go_on()


def test_an_autosave(doors: PageDoors) -> None:
    page = doors.browser.open_page()
    doors.fail(autosave, 'write_file')
    assert page.spawn('a/0')['ok']
    # A frame begins the save, and one after its end, whenever that is, finds that it has failed.
    doors.browser.until(lambda: doors.physsim.step() or doors.errors)
    doors.go_on()
