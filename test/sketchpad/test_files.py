# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of own worlds as pages reach them: names, sizes, directories that take nothing."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
import errno
import io
from pathlib import Path
import shutil
import stat
import sys
from urllib.parse import quote
from xml.etree import ElementTree as ET

from physsim_ros.files import MOST_BYTES
import pytest
from rclpy.parameter import Parameter

from .browser import Browser

# Shorter than 64 characters, but of more bytes than the name of a file may have.
EMOJI = '😀' * 63


class Full(io.StringIO):
    """A standard output onto a full disk."""

    def flush(self) -> None:
        raise OSError(errno.ENOSPC, 'No space left on device')


def worlds_of(browser: Browser) -> Path:
    return browser.physsim.node.world_files.directory


@pytest.mark.parametrize('kind', ['save', 'open', 'rename', 'remove', 'put_back'])
def test_a_name_of_too_many_bytes_is_refused(browser: Browser, kind: str) -> None:
    page = browser.open_page()
    assert page.ask('save', name='mine')['ok']
    fields = {'name': 'mine', 'to': EMOJI} if kind == 'rename' else {'name': EMOJI}
    answer = page.ask(kind, **fields)
    reason = 'too long' if kind == 'open' else 'bytes in UTF-8'
    assert (answer['code'], reason in answer['message']) == ('bad_world_file', True)
    browser.physsim.step()
    assert page.ask('save', name=EMOJI[:20])['ok']


def as_file(kept: Path) -> None:
    kept.write_text('')


def as_directory(kept: Path) -> None:
    (kept / 'mine.yaml').mkdir(parents=True)


@pytest.mark.parametrize('occupy', [as_file, as_directory])
def test_a_world_that_cannot_be_kept_is_not_written_over(
    browser: Browser, occupy: Callable[[Path], None]
) -> None:
    page, worlds = browser.open_page(), worlds_of(browser)
    assert page.ask('save', name='mine')['ok']
    before = (worlds / 'mine.yaml').read_text()
    occupy(worlds / '.kept')
    assert page.spawn('a/0')['ok']
    for kind in ('save', 'remove'):
        answer = page.ask(kind, name='mine', **({'replace': True} if kind == 'save' else {}))
        assert answer['code'] == 'bad_world_file'
    assert (worlds / 'mine.yaml').read_text() == before
    browser.physsim.step()


def test_an_unsaved_world_that_cannot_be_deleted_is_named(browser: Browser) -> None:
    (worlds_of(browser) / '.unsaved.yaml').mkdir()
    answer = browser.open_page().ask('forget')
    assert answer['code'] == 'bad_world_file'
    assert answer['message'].startswith('the unsaved world: ')


@pytest.mark.parametrize('name', ['mine', '名前', '😀', 'a "quoted" one', 'ü; filename=x'])
def test_a_world_of_any_name_can_be_downloaded(browser: Browser, name: str) -> None:
    assert browser.open_page().ask('save', name=name)['ok']
    response = browser.fetch(f'/world/{quote(name, safe="")}.yaml')
    assert response.code == 200
    assert response.body.startswith(b'format: 1\n')
    disposition = f"attachment; filename*=UTF-8''{quote(name, safe='')}.yaml"
    assert response.headers['Content-Disposition'] == disposition


def test_a_file_that_is_no_world_is_not_read_to_be_downloaded(browser: Browser) -> None:
    with (worlds_of(browser) / 'huge.yaml').open('w') as file:
        file.truncate(2**34)
    assert browser.fetch('/world/huge.yaml').code == 404
    with (worlds_of(browser) / 'large.yaml').open('w') as file:
        file.truncate(MOST_BYTES)
    assert len(browser.fetch('/world/large.yaml').body) == MOST_BYTES


def test_a_picture_or_an_unsaved_world_that_somebody_has_swapped_is_not_read(
    browser: Browser,
) -> None:
    worlds = worlds_of(browser)
    assert browser.open_page().ask('save', name='mine')['ok']
    (worlds / '.pictures').mkdir()
    for path in (worlds / '.pictures' / 'mine.png', worlds / '.unsaved.yaml'):
        with path.open('w') as file:
            file.truncate(2**34)
    assert browser.fetch('/picture/mine').code == 404
    assert browser.fetch('/unsaved').code == 404


def test_worlds_and_lessons_have_pictures_of_their_bodies(browser: Browser) -> None:
    page, worlds = browser.open_page(), worlds_of(browser)
    (worlds / 'lessons').mkdir()
    (worlds / 'lessons' / 'mine.yaml').write_text(
        'format: 1\nbodies: [{name: a/0, circle: {radius: 1.5}}]\njoints: [{name: b/0, '
        'kind: rope, a: a/0, b: world, points: [[0, 0], [3, 4], [5, 0]], over: [world]}]'
    )
    listed = page.last('worlds')
    names = [each['name'] for each in listed['worlds'] + listed['lessons']]
    for name in (*names, 'mine'):
        response = browser.fetch(f'/gallery/{name}.svg')
        assert response.headers['Content-Type'] == 'image/svg+xml', name
        picture = ET.fromstring(response.body)  # noqa: S314 - of this server
        assert picture.attrib['viewBox'].count(' ') == 3
        assert len(picture[0]) > 0, name
    disc, rope = picture[0][0][0], picture[0][-3]
    assert float(disc.attrib['r']) == 1.5
    # A rope goes to what it passes.
    assert 'L3 4L' in rope.attrib['d']
    (worlds / 'bad.yaml').write_text('format: 1\nbodies: [{name: "<script>"}]')
    assert browser.fetch('/gallery/bad.svg').code == 404


def test_files_and_directories_are_for_this_user_alone(browser: Browser) -> None:
    page, worlds = browser.open_page(), worlds_of(browser)
    shutil.rmtree(worlds)
    png = b'\x89PNG\r\n\x1a\n'
    assert page.ask('save', name='mine')['ok']
    assert page.ask('save', name='mine', replace=True)['ok']
    assert browser.upload(png, '/picture/mine').code == 200
    assert page.spawn('a/0')['ok']
    # The save begins with a frame, and is made on a thread.
    browser.until(lambda: browser.physsim.step() or (worlds / '.autosave.yaml').exists())
    made = {path.relative_to(worlds): path.stat().st_mode for path in worlds.rglob('*')}
    assert {stat.S_IMODE(mode) for mode in made.values() if stat.S_ISREG(mode)} == {0o600}
    assert {stat.S_IMODE(mode) for mode in made.values() if stat.S_ISDIR(mode)} == {0o700}
    assert stat.S_IMODE(worlds.stat().st_mode) == 0o700
    assert len(made) == 7


def test_a_page_is_served_though_its_address_cannot_be_printed(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim, errors = browser.physsim, list[BaseException]()
    physsim.node.boundary.on_error = errors.append
    physsim.node.set_parameters([Parameter('sketchpad', value='none')])
    physsim.node.start()
    monkeypatch.setattr(sys, 'stdout', Full())
    (result,) = physsim.node.set_parameters([Parameter('sketchpad', value='serve')])
    assert result.successful
    assert [type(each) for each in errors] == [OSError]
    with closing(Browser(physsim)) as again:
        assert again.fetch('/session').code == 200
