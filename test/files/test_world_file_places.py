# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""World files are found by name, and written whole, below the world directory only."""

import json
import os
from pathlib import Path
from typing import Any

from physsim_ros.files import hides_shipped, shipped_worlds, user_worlds
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.simulation.world import World
import pytest

from .world_files import assert_round_trip, find, load, save, write
from ..building import DISC, G, spawn

# Places of files


def test_a_plain_name_is_a_file_of_the_world_directory_before_a_shipped_one(folder: Path) -> None:
    shipped = find('demo', folder)
    assert find('demo.yaml', folder) == shipped
    own = write(folder, 'format: 1', 'demo.yaml')

    assert shipped == shipped_worlds() / 'demo.yaml'
    assert find('demo', folder) == own


@pytest.mark.parametrize(
    ('name', 'hides'),
    [('demo', True), ('demo.yaml', True), ('sub/demo.yaml', False), ('own', False)],
)
def test_only_what_the_name_of_a_shipped_world_now_means_hides_that(
    folder: Path, name: str, hides: bool
) -> None:
    (folder / 'sub').mkdir()
    saved = save(World(), folder, name)

    assert hides_shipped(saved, world_dir=folder) is hides
    meant = find('demo', folder)
    assert (meant.resolve() == saved) is hides


def test_saving_over_a_shipped_world_hides_none() -> None:
    worlds = shipped_worlds()

    assert not hides_shipped(worlds / 'demo.yaml', world_dir=worlds)


def test_a_path_is_below_the_world_directory(folder: Path) -> None:
    (folder / 'sub').mkdir()
    path = write(folder / 'sub', 'format: 1', 'x.yaml')

    for name in ('sub/x.yaml', 'sub/../sub/x.yaml', './sub/x.yaml', str(path)):
        assert find(name, folder).resolve() == path.resolve()


@pytest.mark.parametrize('path', sorted(shipped_worlds().glob('*.yaml')),
                         ids=lambda path: path.stem)  # fmt: skip
def test_every_shipped_world_loads_by_its_name(path: Path, folder: Path) -> None:
    assert find(path.stem, folder) == path
    assert load(path).bodies


def test_a_file_outside_is_read_where_nobody_confines(folder: Path) -> None:
    outside = write(folder.parent, 'format: 1', 'outside.yaml')

    for name in ('../outside.yaml', str(outside)):
        assert find(name, folder, confined=False).resolve() == outside.resolve()
        with pytest.raises(BadWorldFile, match='outside'):
            find(name, folder)


def test_a_link_that_leads_outside_is_not_followed_where_confined(folder: Path) -> None:
    outside = write(folder.parent, 'format: 1', 'outside.yaml')
    (folder / 'link.yaml').symlink_to(outside)
    (folder / 'sub').symlink_to(folder.parent, target_is_directory=True)

    for name in ('link', 'link.yaml', 'sub/outside.yaml'):
        assert find(name, folder, confined=False).is_file()
        with pytest.raises(BadWorldFile):
            find(name, folder)
        with pytest.raises(BadWorldFile):
            save(World(), folder, name)
    assert outside.read_text() == 'format: 1'


def test_a_link_within_the_directory_is_followed(folder: Path) -> None:
    path = write(folder, 'format: 1', 'real.yaml')
    (folder / 'link.yaml').symlink_to(path)

    assert find('link', folder).read_text() == 'format: 1'
    save(World(), folder, 'link')
    assert path.read_text().startswith('format: 1\ngravity')


def test_links_in_a_circle_are_refused(folder: Path) -> None:
    (folder / 'a.yaml').symlink_to(folder / 'b.yaml')
    (folder / 'b.yaml').symlink_to(folder / 'a.yaml')

    with pytest.raises(BadWorldFile):
        find('a', folder)
    with pytest.raises(BadWorldFile):
        save(World(), folder, 'a')


# Saving


def test_a_world_is_saved_under_a_name_or_a_path(folder: Path) -> None:
    (folder / 'sub').mkdir()

    assert save(World(), folder, 'mine') == (folder / 'mine.yaml').resolve()
    assert save(World(), folder, 'sub/x.yaml') == (folder / 'sub' / 'x.yaml').resolve()
    assert save(World(), folder, str(folder / 'abs.yaml')) == (folder / 'abs.yaml').resolve()
    assert sorted(path.name for path in folder.rglob('*')) == [
        'abs.yaml', 'mine.yaml', 'sub', 'x.yaml'
    ]  # fmt: skip


def test_the_directory_of_worlds_is_made_when_a_world_is_saved(tmp_path: Path) -> None:
    folder = tmp_path / 'data' / 'worlds'

    with pytest.raises(BadWorldFile):
        save(World(), folder, '../outside')
    assert list(tmp_path.iterdir()) == []

    assert save(World(), folder, 'mine').is_file()


def test_the_worlds_of_a_user_are_in_the_data_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('HOME', str(tmp_path))
    for data, base in (
        (str(tmp_path / 'data'), tmp_path / 'data'),
        ('', tmp_path / '.local/share'),
        ('relative', tmp_path / '.local/share'),
    ):
        monkeypatch.setenv('XDG_DATA_HOME', data)
        assert user_worlds() == base / 'physsim_ros' / 'worlds'


@pytest.mark.parametrize(
    'name',
    ['.bashrc', '.w.yaml', '.ssh/w.yaml', 'sub/.w.yaml', 'w.yml', 'w.world', 'w.YAML', 'w.yaml.sh',
     'hidden.yaml', 'hiding/w.yaml', 'w\n.yaml', 'w\x1b[2J.yaml'],
)  # fmt: skip
def test_only_visible_yaml_files_are_read_and_written(name: str, folder: Path) -> None:
    for directory in ('sub', '.ssh'):
        (folder / directory).mkdir()
    (folder / 'hidden.yaml').symlink_to('.secret.yaml')
    (folder / 'hiding').symlink_to('.ssh')
    hidden = '.bashrc', '.w.yaml', '.ssh/w.yaml', 'sub/.w.yaml', 'w.yml', '.secret.yaml'
    for place in (*hidden, 'w\n.yaml'):
        write(folder, 'format: 1', place)
    before = {path: path.is_file() and path.read_text() for path in folder.rglob('*')}

    with pytest.raises(BadWorldFile):
        save(World(), folder, name)
    with pytest.raises(BadWorldFile):
        find(name, folder)

    assert {path: path.is_file() and path.read_text() for path in folder.rglob('*')} == before


@pytest.mark.parametrize(
    'text',
    ['', 'format: 2', 'services: {}', '[format, 1]', 'name: format\nbodies: 1', '{format: [1]}',
     '- format: 1', 'inner: {format: 1}', 'alias ll=ls', '\x00', '{' * 10_000, '[' * 10**6,
     # A mistake of who edits it.
     'format: 1\nbodies: [', 'format: true'],
)  # fmt: skip
def test_what_is_no_world_file_is_not_written_over(text: str, folder: Path) -> None:
    path = write(folder, text, 'compose.yaml')

    with pytest.raises(BadWorldFile, match='not a world file'):
        save(World(), folder, 'compose')

    assert path.read_text() == text


@pytest.mark.parametrize('text', ['format: 1', '# My world\n{bodies: [], format: 1}'])
def test_a_world_file_that_is_written_over_keeps_its_mode(text: str, folder: Path) -> None:
    path = write(folder, text)
    for mode in (0o600, 0o664):
        path.chmod(mode)
        save(World(), folder)
        assert path.stat().st_mode & 0o777 == mode


@pytest.mark.parametrize('kind', ['FIFO', 'device', 'directory', 'of the kernel', 'huge'])
def test_what_is_no_plain_file_is_refused_at_once(kind: str, folder: Path) -> None:
    path = folder / 'w.yaml'
    if kind == 'FIFO':
        os.mkfifo(path)
    elif kind == 'directory':
        path.mkdir()
    elif kind == 'huge':
        with path.open('w') as file:
            file.truncate(2**40)
    else:
        path.symlink_to('/dev/zero' if kind == 'device' else '/proc/self/environ')

    with pytest.raises(BadWorldFile) as refused:
        load(path)
    assert len(str(refused.value)) < 400
    if kind not in {'of the kernel', 'huge'}:
        with pytest.raises(BadWorldFile):
            find(str(path), folder, confined=False)
    with pytest.raises(BadWorldFile):
        save(World(), folder)


def test_a_world_file_of_the_working_directory_is_read_at_start(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(folder.parent, 'format: 1', 'mine.yaml')
    monkeypatch.chdir(folder.parent)

    for name in ('mine.yaml', './mine.yaml'):
        assert find(name, folder, confined=False).resolve() == path.resolve()
        with pytest.raises(BadWorldFile):
            find(name, folder)


@pytest.mark.parametrize(
    'name', ['$(touch x)/0', 'a: b/0', '`id`/0', '\uffff/0', '😀/0', 'a\\"b/0']
)
def test_names_are_quoted(name: str, folder: Path) -> None:
    world = World()
    spawn(world, name, DISC)
    assert_round_trip(world, folder)

    text = save(world, folder).read_text()

    # YAML cannot have a noncharacter as it is.
    quoted = json.dumps(name, ensure_ascii=name == '\uffff/0')
    assert f'"name": {quoted}' in text


@pytest.mark.parametrize(
    'name', ['../w.yaml', '/w.yaml', 'sub/../../w.yaml', '.', './', '../worlds', 'none/w.yaml']
)
def test_nothing_is_written_outside_the_directory_or_into_one_that_is_not_there(
    name: str, folder: Path
) -> None:
    (folder / 'sub').mkdir()
    before = sorted(folder.parent.rglob('*'))

    with pytest.raises(BadWorldFile):
        save(World(), folder, name)

    assert sorted(folder.parent.rglob('*')) == before
    assert not Path('/w.yaml').exists()


@pytest.mark.parametrize(
    ('module', 'function'), [(os, 'fsync'), (Path, 'replace'), (os, 'fchmod')]
)
def test_a_failing_write_leaves_the_old_file_and_nothing_else(
    module: Any, function: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World()
    path = save(world, folder)
    old = path.read_text()
    spawn(world, 'a/0', DISC)

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, 'No space left on device')

    with monkeypatch.context() as broken:
        broken.setattr(module, function, fail)
        with pytest.raises(BadWorldFile, match='No space left'):
            save(world, folder)

    assert [each for each in folder.rglob('*') if each.is_file()] == [path]
    assert path.read_text() == old


def test_saving_replaces_what_was_there(folder: Path) -> None:
    world = World()
    save(world, folder)
    spawn(world, 'a/0', DISC, (0.0, -G, 0.0))

    path = save(world, folder)

    assert load(path) == world.save()
    # The file before is kept, and nothing else is there.
    assert {each.name for each in folder.iterdir()} == {path.name, '.kept'}
    assert len(load(folder / '.kept' / path.name).bodies) == 0
