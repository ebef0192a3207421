# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Autosave: one file, within a budget, offered at the next start."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import wait
import errno
import os
from pathlib import Path
import signal
from threading import Event
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from physsim_ros.files import DirectoryLock, finish_files, load_mapping
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import WorldFull
from physsim_ros.model.requests import Restore
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import autosave as module
from physsim_ros.sketchpad.autosave import Autosave, PERIOD, SHARE, STILL_PERIOD
from physsim_ros.sketchpad.file_work import FileWork
import pytest

from .browser import Browser, Page
from ..building import BOX, spawning
from ..client import Client
from ..outside import Outside
from ..worlds.film import state_of


@pytest.fixture
def lock(tmp_path: Path) -> DirectoryLock:
    return DirectoryLock(tmp_path)


def autosave_in(
    directory: Path,
    lock: DirectoryLock,
    text: Callable[[], Callable[[int], str]],
    people: Callable[[], list[str]] = list,
) -> Autosave:
    return Autosave(directory, lock, FileWork(lambda: None), text, people)


def empty() -> Callable[[int], str]:
    """Return a function that returns an empty text."""
    return lambda _: ''


def names_in(simulation: Simulation) -> Callable[[], Callable[[int], str]]:
    """Return a function that begins a text: the names of the bodies of a world."""

    def text() -> Callable[[int], str]:
        scene = simulation.world.scene
        return lambda _: ' '.join(scene.names)

    return text


def drawn(simulation: Simulation, autosave: Autosave, name: str) -> None:
    """Add a body by a page, and note the frame that shows it."""
    simulation.perform(spawning(name, BOX))
    autosave.note_frame(simulation.advance_frame(), drawn=True)


def end_save(autosave: Autosave) -> Answer | None:
    """Save the world, wait for the end, and return the event."""
    wait((autosave.save(),))
    return autosave.note_end()


def test_what_was_drawn_is_kept_and_what_was_saved_is_not(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, names_in(simulation))
    autosave.note_frame(simulation.advance_frame(), drawn=False)
    assert not autosave.is_due(time.monotonic())
    drawn(simulation, autosave, 'a/0')
    assert autosave.is_due(time.monotonic())
    end_save(autosave)
    assert (tmp_path / '.autosave.yaml').read_text() == 'a/0'
    # Within the period nothing is saved, and without a change nothing later.
    assert not autosave.is_due(time.monotonic() + 2 * PERIOD)
    drawn(simulation, autosave, 'a/1')
    assert not autosave.is_due(time.monotonic())
    assert autosave.is_due(time.monotonic() + 2 * PERIOD)

    again = autosave_in(tmp_path, lock, empty)
    assert abs(again.unsaved_at - time.time()) < 3600.0
    assert again.unsaved_content() == b'a/0'
    again.forget_unsaved()
    assert again.unsaved_at == 0.0
    end_save(autosave)
    autosave.note_saved(simulation.world.scene)
    finish_files()
    assert [each.name for each in tmp_path.iterdir()] == ['.lock']


def test_while_nothing_moves_a_change_is_kept_a_second_after_the_one_before(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    simulation.speed = 0.0
    begun = -STILL_PERIOD
    for name in ('a/0', 'a/1'):
        simulation.requests.submit(spawning(name, BOX), topic='~/spawn')
        frame = simulation.apply_requests()
        assert frame is not None
        autosave.note_frame(frame, drawn=True)
        assert not autosave.is_due(begun + 0.9 * STILL_PERIOD)
        begun = time.monotonic()
        assert autosave.is_due(begun + STILL_PERIOD)
        end_save(autosave)


def test_a_world_that_was_opened_and_not_changed_is_not_kept(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    drawn(simulation, autosave, 'a/0')
    simulation.requests.submit(Restore(state=Simulation().save()), topic='~/load_world')
    autosave.note_frame(simulation.advance_frame(), drawn=True)
    assert not autosave.is_due(time.monotonic())
    drawn(simulation, autosave, 'a/0')
    assert autosave.is_due(time.monotonic())


def test_a_lesson_that_a_page_opened_is_kept_for_the_next_start(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    simulation.requests.submit(Restore(state=state_of('lever')), topic='~/load_world')
    autosave.note_frame(simulation.advance_frame(), drawn=True)
    assert autosave.is_due(time.monotonic())


def test_it_takes_a_hundredth_of_the_time(
    tmp_path: Path, lock: DirectoryLock, monkeypatch: pytest.MonkeyPatch
) -> None:
    times = iter((0.0, 2.0))
    monkeypatch.setattr(time, 'thread_time', lambda: next(times))
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    drawn(simulation, autosave, 'a/0')
    end_save(autosave)
    drawn(simulation, autosave, 'a/1')
    now = time.monotonic()
    assert not autosave.is_due(now + 0.9 * SHARE * 2.0)
    assert autosave.is_due(now + 1.1 * SHARE * 2.0)


def test_the_unsaved_world_has_the_names_of_those_who_drew_it(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    names = ['Mia', 'Jürgen "J" Groß']
    autosave = autosave_in(tmp_path, lock, lambda: lambda _: 'format: 1', lambda: names)
    drawn(Simulation(), autosave, 'a/0')
    end_save(autosave)
    again = autosave_in(tmp_path, lock, empty)
    assert again.unsaved_by == names
    assert load_mapping(again.unsaved_content().decode(), field='file') == {'format': 1}
    for line in ('# drawn by: [', f'# drawn by: {"[" * 5000}', '# drawn by: {}', '# a comment'):
        (tmp_path / '.unsaved.yaml').write_text(f'{line}\nformat: 1')
        assert again.unsaved_by == []
    again.forget_unsaved()
    assert again.unsaved_by == []
    # A reader of a pipe waits for a writer.
    os.mkfifo(tmp_path / '.unsaved.yaml')
    assert again.unsaved_by == []
    with pytest.raises(OSError, match='not a regular file'):
        again.unsaved_content()


def test_a_world_that_is_too_large_and_a_full_disk_stop_nothing(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()

    def refuse(_: int) -> str:
        raise WorldFull('too large', field='world')

    end_save(autosave_in(tmp_path, lock, lambda: refuse))
    finish_files()
    assert [each.name for each in tmp_path.iterdir()] == ['.lock']
    nowhere = tmp_path / 'file'
    nowhere.write_text('')
    autosave = autosave_in(nowhere, DirectoryLock(nowhere), empty)
    drawn(simulation, autosave, 'a/0')
    end_save(autosave)
    assert autosave.unsaved_at == 0.0


def test_what_a_full_disk_did_not_take_is_written_when_there_is_room(tmp_path: Path) -> None:
    simulation = Simulation()
    directory = tmp_path / 'worlds'
    directory.write_text('')
    autosave = autosave_in(directory, DirectoryLock(directory), names_in(simulation))
    drawn(simulation, autosave, 'a/0')
    event = end_save(autosave)
    assert event is not None
    assert (event.topic, event.code) == ('autosave', 'autosave_failed')
    # Not for each time that it is tried.
    assert end_save(autosave) is None
    assert not autosave.is_due(time.monotonic())
    directory.unlink()
    assert autosave.is_due(time.monotonic() + 2 * PERIOD)
    event = end_save(autosave)
    assert event is not None
    assert (event.topic, event.code) == ('autosave', '')
    assert end_save(autosave) is None
    assert (directory / '.autosave.yaml').read_text() == 'a/0'
    assert not autosave.is_due(time.monotonic() + 2 * PERIOD)


def test_a_world_that_is_too_large_is_tried_again_when_it_changes(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()

    def refuse(_: int) -> str:
        raise WorldFull('too large', field='world')

    autosave = autosave_in(tmp_path, lock, lambda: refuse)
    for name in ('a/0', 'a/1'):
        drawn(simulation, autosave, name)
        assert autosave.is_due(time.monotonic() + 2 * PERIOD)
        end_save(autosave)
        assert not autosave.is_due(time.monotonic() + 2 * PERIOD)
    assert autosave.failure is not None
    assert autosave.failure.message.endswith(': too large')
    # A world that somebody has saved, or that is that of a file, lacks nothing.
    autosave.note_saved(simulation.world.scene)
    assert autosave.failure is None


def test_a_failure_is_told_on_all_pages_also_later_ones_in_events_and_diagnostics(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    node, client, page = browser.physsim.node, Client(browser.physsim), browser.open_page()
    page.last('welcome')
    told = client.listen(DiagnosticArray, '/diagnostics')

    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(module, 'write_file', refuse)
    node.start()

    def event_on(page: Page) -> dict[str, Any] | None:
        found = [each for each in page.of_type('answer') if each['topic'] == 'autosave']
        return found[0] if found else None

    def of(array: DiagnosticArray) -> str:
        return str(array.status[0].message)

    def tick() -> None:
        node.tick(time.monotonic_ns())

    node.simulation.perform(spawning('a/0', BOX))
    browser.until(lambda: tick() or event_on(page))
    (event,) = filter(None, [event_on(page)])
    assert event['code'] == 'autosave_failed'
    assert event['message'] == f'what was drawn is not autosaved: {os.strerror(errno.ENOSPC)}'
    browser.until(lambda: any(each.name == 'autosave' for each in client.events))
    browser.until(lambda: tick() or any(event['message'] in of(each) for each in told))
    later = browser.open_page()
    browser.until(lambda: tick() or event_on(later))


def test_what_is_drawn_during_a_save_by_name_is_autosaved(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, names_in(simulation))
    drawn(simulation, autosave, 'a/0')
    saved = simulation.world.scene
    drawn(simulation, autosave, 'a/1')
    autosave.note_saved(saved)
    assert autosave.is_due(time.monotonic())
    # The frame of a save that ends at once is shown after it.
    simulation.perform(spawning('a/2', BOX))
    autosave.note_saved(simulation.world.scene)
    autosave.note_frame(simulation.advance_frame(), drawn=True)
    assert not autosave.is_due(time.monotonic() + 2 * PERIOD)


def test_a_directory_that_cannot_be_written_is_no_hindrance(
    tmp_path: Path, lock: DirectoryLock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    simulation = Simulation()
    with monkeypatch.context() as patches:
        patches.setattr(os, 'open', refuse)
        autosave = autosave_in(tmp_path, lock, names_in(simulation))
    assert autosave.failure is None
    drawn(simulation, autosave, 'a/0')
    end_save(autosave)
    assert (tmp_path / '.autosave.yaml').read_text() == 'a/0'


def test_of_two_nodes_on_a_directory_one_autosaves_until_it_ends(
    browse: Callable[..., Browser],
    outside: Outside,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ('PERIOD', 'STILL_PERIOD', 'SHARE'):
        monkeypatch.setattr(module, name, 0.0)
    first = outside.start_world(sketchpad='serve', sketchpad_port=0, world_dir=tmp_path)
    first.wait_for('ready')
    kept = tmp_path / '.autosave.yaml'
    kept.write_text('drawn in the first')
    browser = browse(world_dir=str(tmp_path))
    page = browser.open_page()
    browser.until(lambda: 'in_use' in {each['code'] for each in page.of_type('answer')})
    lesson = {'lesson': 'Lever', 'answer': '2', 'right': True}
    assert page.ask('answered', **lesson)['code'] == 'in_use'
    assert page.ask('forget')['code'] == 'in_use'
    assert page.spawn('a/0')['ok']
    assert page.ask('save', name='mine')['ok']
    assert page.spawn('a/1')['ok']
    browser.physsim.run(0.1)
    finish_files()
    assert kept.read_text() == 'drawn in the first'
    assert not (tmp_path / '.unsaved.yaml').exists()

    first.interrupt(signal.SIGKILL)
    assert page.ask('answered', **lesson)['ok']
    assert page.spawn('a/2')['ok']
    unsaved = tmp_path / '.unsaved.yaml'
    # Between the move of the file and the first save there is none.
    browser.until(lambda: browser.physsim.step() or (unsaved.exists() and kept.exists()))
    browser.until(lambda: browser.physsim.step() or 'a/2' in kept.read_text())
    assert unsaved.read_text() == 'drawn in the first'


def test_no_file_is_left_of_a_save_in_which_a_person_saved_the_world(
    tmp_path: Path, lock: DirectoryLock, monkeypatch: pytest.MonkeyPatch
) -> None:
    held, write = Event(), module.write_file

    def write_later(path: Path, content: bytes) -> None:
        held.wait()
        write(path, content)

    monkeypatch.setattr(module, 'write_file', write_later)
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    drawn(simulation, autosave, 'a/0')
    autosave.save()
    autosave.note_saved(simulation.world.scene)
    held.set()
    finish_files()
    assert [each.name for each in tmp_path.iterdir()] == ['.lock']


def test_a_save_by_name_leaves_what_another_start_has_not_saved(
    tmp_path: Path, lock: DirectoryLock
) -> None:
    other = DirectoryLock(tmp_path)
    other.acquire()
    (tmp_path / '.autosave.yaml').write_text('drawn before')
    simulation = Simulation()
    autosave = autosave_in(tmp_path, lock, empty)
    other.release()
    # As answers to lessons do.
    lock.acquire()
    drawn(simulation, autosave, 'a/0')
    autosave.note_saved(simulation.world.scene)
    finish_files()
    assert (tmp_path / '.autosave.yaml').read_text() == 'drawn before'


def test_no_request_waits_for_a_save_and_one_is_under_way(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Behind the autosave of 9,000 bodies, requests waited for two to three seconds.
    node, held, written = browser.physsim.node, Event(), list[Path]()

    def write_later(path: Path, _: bytes) -> None:
        written.append(path)
        held.wait()

    monkeypatch.setattr(module, 'write_file', write_later)
    for name in ('PERIOD', 'STILL_PERIOD', 'SHARE'):
        monkeypatch.setattr(module, name, 0.0)
    browser.open_page().last('welcome')
    node.start()

    def tick(count: int) -> int:
        for _ in range(count):
            node.tick(time.monotonic_ns())
        return len(written)

    node.simulation.perform(spawning('a/0', BOX))
    browser.until(lambda: tick(1) == 1, settling=False)
    node.simulation.requests.submit(spawning('a/1', BOX), topic='~/spawn')
    assert tick(20) == 1
    assert 'a/1' in node.simulation.world
    held.set()
    # The next change has its save too.
    browser.until(lambda: tick(1) == 2, settling=False)
    assert tick(20) == 2
