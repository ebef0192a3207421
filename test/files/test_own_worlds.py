# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The user's own worlds: nothing is lost that was deleted or written over last."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import errno
from functools import partial
import itertools
import os
from pathlib import Path
from typing import Any

from physsim_ros.files import check_world_name, OwnWorlds, save_world, write_file
from physsim_ros.model.errors import BadWorldFile, Exists
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import BOX, spawning


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    """Return a directory with one world."""
    (tmp_path / 'mine.yaml').write_text('first')
    return tmp_path


def save_over(directory: Path) -> None:
    """Save a world with one body over the world of the directory."""
    simulation = Simulation()
    simulation.perform(spawning('ball/0', BOX))
    save_world(simulation.save(), 'mine', world_dir=directory, physics_rate=240.0)


def files_of(directory: Path) -> dict[str, bytes]:
    """Return the content of each file below a directory, by its path."""
    files = (path for path in directory.rglob('*') if path.is_file())
    return {str(path.relative_to(directory)): path.read_bytes() for path in files}


def test_a_deleted_world_comes_back(directory: Path) -> None:
    own = OwnWorlds(directory)
    own.delete('mine')
    assert not (directory / 'mine.yaml').exists()
    own.put_back('mine')
    assert (directory / 'mine.yaml').read_text() == 'first'
    with pytest.raises(BadWorldFile):
        own.put_back('mine')


def test_a_world_that_was_written_over_comes_back(directory: Path) -> None:
    write_file(directory / 'mine.yaml', b'format: 1')
    save_over(directory)
    own = OwnWorlds(directory)
    saved = (directory / 'mine.yaml').read_bytes()
    assert b'ball/0' in saved
    for content in (b'format: 1', saved, b'format: 1'):
        own.put_back('mine')
        assert (directory / 'mine.yaml').read_bytes() == content


def test_a_world_that_has_the_name_of_a_deleted_one_is_kept_when_that_comes_back(
    directory: Path,
) -> None:
    own = OwnWorlds(directory)
    own.delete('mine')
    (directory / 'mine.yaml').write_text('second')
    for text in ('first', 'second', 'first'):
        own.put_back('mine')
        assert (directory / 'mine.yaml').read_text() == text


def test_a_taken_name_is_refused(directory: Path) -> None:
    own = OwnWorlds(directory)
    (directory / 'yours.yaml').write_text('second')
    for name in ('mine', 'incline'):
        with pytest.raises(Exists):
            own.check_free(name)
    own.check_free('mine', replace=True)
    with pytest.raises(Exists):
        own.check_free('incline', replace=True)
    with pytest.raises(Exists):
        own.rename('mine', 'yours')
    own.rename('mine', 'ours')
    assert (directory / 'ours.yaml').read_text() == 'first'
    assert (directory / 'yours.yaml').read_text() == 'second'


@pytest.mark.parametrize(
    'change',
    [
        save_over,
        lambda directory: OwnWorlds(directory).put_back('mine'),
        lambda directory: OwnWorlds(directory).delete('mine'),
        lambda directory: OwnWorlds(directory).rename('mine', 'ours'),
    ],
    ids=['save', 'put back', 'delete', 'rename'],
)
def test_a_refused_change_has_changed_nothing_whichever_call_the_system_refuses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]
) -> None:
    for number in itertools.count(1):
        # A world that is there, and an older one of its name that is kept.
        directory = tmp_path / str(number)
        directory.mkdir()
        for text in (b'format: 1', b'format: 1  # newer'):
            write_file(directory / 'mine.yaml', text, kept=directory / '.kept' / 'mine.yaml')
        before = files_of(directory)
        with monkeypatch.context() as patches:
            calls = refusing(patches, number)
            try:
                change(directory)
            except (OSError, BadWorldFile):
                assert files_of(directory) == before, number
            if next(calls) <= number:
                break
    assert number > 1
    assert b'format: 1  # newer' in files_of(directory).values()


def refusing(patches: pytest.MonkeyPatch, number: int) -> Iterator[int]:
    """
    Have the system refuse one of the calls that change files, as a full disk does.

    :param number: of the call, from 1
    :return: the numbers of the next calls
    """
    numbers = itertools.count(1)

    def call(real: Callable[..., Any], *words: Any, **options: Any) -> Any:
        if next(numbers) == number:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return real(*words, **options)

    for name in ('open', 'mkdir', 'fchmod', 'fsync', 'link', 'rename', 'replace'):
        patches.setattr(os, name, partial(call, getattr(os, name)))
    return numbers


@pytest.mark.parametrize(
    'name', ['', ' ', 'a/b', '..', '.hidden', 'a.yaml', 'a\\b', 'a\0', 'a' * 65]
)
def test_what_is_no_plain_name_is_refused(directory: Path, name: str) -> None:
    own = OwnWorlds(directory)
    with pytest.raises(BadWorldFile):
        check_world_name(name)
    for act in (own.delete, own.put_back, own.picture):
        with pytest.raises(BadWorldFile):
            act(name)
    with pytest.raises(BadWorldFile):
        own.rename('mine', name)


@pytest.mark.parametrize('name', ['\U0001f600' * 64, '\U0001f600' * 61])
def test_a_name_that_no_file_can_have_is_refused(directory: Path, name: str) -> None:
    own = OwnWorlds(directory)

    for act in (own.check_free, own.delete, own.put_back, own.picture):
        with pytest.raises(BadWorldFile):
            act(name)


def test_a_renamed_world_has_its_own_picture_or_none(directory: Path) -> None:
    own = OwnWorlds(directory)
    own.picture('ours').parent.mkdir()
    own.picture('ours').write_bytes(b'of a world that is gone')

    own.rename('mine', 'ours')

    assert not own.picture('ours').exists()
    own.picture('ours').write_bytes(b'its own')
    own.rename('ours', 'mine')
    assert own.picture('mine').read_bytes() == b'its own'
