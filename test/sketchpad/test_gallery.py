# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The list of worlds and lessons: pages wait for its files, and for nothing else."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

from physsim_ros.files import shipped_lessons
from physsim_ros.sketchpad.server import gallery
import pytest

from .browser import Browser, Page


def titles(page: Page) -> set[str]:
    """Return the titles of lessons in the list that a page got last."""
    return {lesson['title'] for lesson in page.last('worlds')['lessons']}


def test_pages_go_on_while_lessons_are_read_which_is_done_once_for_all_that_ask(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    pages = [browser.open_page() for _ in range(3)]
    for page in pages:
        page.last('worlds')
        page.messages.clear()
    load_world, goes_on, read = gallery.load_world, Event(), list[Path]()

    def load_slowly(path: Path) -> Any:
        read.append(path)
        goes_on.wait(60.0)
        return load_world(path)

    monkeypatch.setattr(gallery, 'load_world', load_slowly)
    lessons = browser.physsim.node.control.files.lessons
    lessons.mkdir()
    lesson = (shipped_lessons() / 'lever.yaml').read_text().replace('title: Lever', 'title: Own')
    for number in range(2):
        (lessons / f'own{number}.yaml').write_text(lesson)
    for number, page in enumerate(pages):
        for _ in range(20):
            page.send('list')
        # Other messages and frames do not wait.
        page.send('ping')
        page.last('pong')
        assert page.spawn(f'a/{number}')['ok']
        page.until_frame(lambda picture: picture.count > 0)
        assert not page.of_type('worlds')
    assert len(read) == 1
    goes_on.set()
    for page in pages:
        assert 'Own' in titles(page)
        # One for those that asked before the files were read, and one for those after.
        assert len(page.of_type('worlds')) <= 2
    assert len(read) == 2


def test_files_that_no_message_can_name_are_left_out(browser: Browser, tmp_path: Path) -> None:
    for name in ('own', 'new\nline', '\udcff'):
        (tmp_path / f'{name}.yaml').write_text('format: 1')
    page = browser.open_page()
    own = [each['name'] for each in page.last('worlds')['worlds'] if not each['shipped']]
    assert own == ['own']
    # The refusal tells the nearest name.
    assert page.ask('open', name='owm')['code'] == 'bad_world_file'
