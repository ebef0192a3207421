# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The user's own worlds: nothing is lost that was deleted or written over last."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.files import check_world_name, own_worlds, OwnWorlds
from physsim_ros.model.errors import BadWorldFile, Exists
import pytest


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    """Return a directory with one world."""
    (tmp_path / 'mine.yaml').write_text('first')
    return tmp_path


def test_a_deleted_world_comes_back(directory: Path) -> None:
    own = OwnWorlds(directory)
    own.delete('mine')
    assert not (directory / 'mine.yaml').exists()
    own.put_back('mine')
    assert (directory / 'mine.yaml').read_text() == 'first'
    with pytest.raises(BadWorldFile):
        own.put_back('mine')


def test_a_world_that_was_written_over_comes_back(directory: Path) -> None:
    own = OwnWorlds(directory)
    own.keep('mine')
    new = directory / 'new'
    new.write_text('second')
    new.replace(directory / 'mine.yaml')
    own.put_back('mine')
    assert (directory / 'mine.yaml').read_text() == 'first'


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
    'name', ['', ' ', 'a/b', '..', '.hidden', 'a.yaml', 'a\\b', 'a\0', 'a' * 65]
)
def test_what_is_no_plain_name_is_refused(directory: Path, name: str) -> None:
    own = OwnWorlds(directory)
    with pytest.raises(BadWorldFile):
        check_world_name(name)
    for act in (own.delete, own.put_back, own.picture, own.keep):
        with pytest.raises(BadWorldFile):
            act(name)
    with pytest.raises(BadWorldFile):
        own.rename('mine', name)


@pytest.mark.parametrize('name', ['\U0001f600' * 64, '\U0001f600' * 61])
def test_a_name_that_no_file_can_have_is_refused(directory: Path, name: str) -> None:
    own = OwnWorlds(directory)

    for act in (own.check_free, own.delete, own.put_back, own.keep):
        with pytest.raises(BadWorldFile):
            act(name)


def without_links(*_: object) -> None:
    raise PermissionError('this file system has no hard links')


def test_a_world_is_kept_where_a_file_has_one_name(
    directory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Path, 'hardlink_to', without_links)
    own = OwnWorlds(directory)
    own.keep('mine')
    (directory / 'mine.yaml').write_text('second')
    for text in ('first', 'second', 'first'):
        own.put_back('mine')
        assert (directory / 'mine.yaml').read_text() == text


def test_a_kept_world_stays_where_another_cannot_be_kept(
    directory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = OwnWorlds(directory)
    own.delete('mine')
    (directory / 'mine.yaml').write_text('second')
    monkeypatch.setattr(Path, 'hardlink_to', without_links)
    monkeypatch.setattr(own_worlds, 'write_file', without_links)
    for act in (own.keep, own.put_back):
        with pytest.raises(OSError, match='hard links'):
            act('mine')
    monkeypatch.undo()

    own.put_back('mine')

    assert (directory / 'mine.yaml').read_text() == 'first'


def test_a_renamed_world_has_its_own_picture_or_none(directory: Path) -> None:
    own = OwnWorlds(directory)
    own.picture('ours').parent.mkdir()
    own.picture('ours').write_bytes(b'of a world that is gone')

    own.rename('mine', 'ours')

    assert not own.picture('ours').exists()
    own.picture('ours').write_bytes(b'its own')
    own.rename('ours', 'mine')
    assert own.picture('mine').read_bytes() == b'its own'
