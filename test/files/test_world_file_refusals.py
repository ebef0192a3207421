# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world file that cannot be loaded is refused, with its line, field and code."""

import os
from pathlib import Path
import pickle
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files import load_mapping
from physsim_ros.files.yaml12 import load_entries
from physsim_ros.model.errors import BadWorldFile, Malformed, WorldFull
from physsim_ros.simulation.world import World
import pytest
import yaml

from .world_files import find, load, refusal_of, restored, save, write

# Refusals of what files say

HEAD = 'format: 1\nbodies:\n'
# Texts of files, of bodies but for their names, and of discs but for their radius; and the field
# that is named in the refusal.
FILES = [
    ('', 'format'),
    ('gravity: [0, 0]', 'format'),
    ('format: 2', 'format'),
    ('format: true', 'format'),
    ('format:', 'format'),
    ('format: 1\n"\\ud800": 1', 'world_file'),
    ('format: 1\ngravitation: [0, 0]', 'gravitation'),
    ('format: 1\nmax_bodies: 7', 'max_bodies'),
    ('format: 1\n5: 3', '5'),
    ('format: 1\njoints: [{name: joint/0}]', 'points'),
    ('format: 1\ndamping: 2', 'damping'),
    ('format: 1\ngravity:', 'gravity'),
    ('format: 1\nbodies: 3', 'bodies'),
    ('format: 1\nbodies: {a/0: {circle: {radius: 1}}}', 'bodies'),
    ('format: 1\nbodies:\n  - {circle: {radius: 1}}', 'name'),
    ('format: 1\nbodies:\n  - {name: ball, circle: {radius: 1}}', 'name'),
    ('format: 1\nbodies:\n  - {name: [a/0], circle: {radius: 1}}', 'name'),
    (HEAD + '  - {name: a/0, circle: {radius: 1}}\n' * 2, 'name'),
    ('format: 1\nbodies:\n  - {name: a/0}', 'shape'),
]  # fmt: skip
BODIES = [
    ('disc: {radius: 1}', 'disc'),
    ('circle: 3', 'circle'),
    ('circle: {diameter: 1}', 'diameter'),
    ('circle: {radius: .inf}', 'radius'),
    ('box: {width: 1}', 'height'),
    ('polygon: triangle', 'polygon'),
    ('polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]', 'points'),
    ('polygon: [[0, 0], [1], [1, 1]]', 'polygon'),
    ('chain: {thickness: 1}', 'points'),
    ('chain: {points: [[0, 0], [1, 0]]}', 'thickness'),
    ('compound: {centers: [[0, 0]]}', 'shape'),
    ('compound: {polygon: [[0, 0], [1, 0], [0, 1]], centers: [[0, 0]]}', 'polygon'),
]  # fmt: skip
DISCS = [
    ('box: {width: 1, height: 1}', 'shape'),
    ('at: [0]', 'at'),
    ('at: here', 'at'),
    ('at: [0, 1e8]', 'pose'),
    ('color: "#1234567"', 'color'),
    ('color: red', 'color'),
    ('color: [2, 0, 0, 1]', 'color'),
    ('lifetime: long', 'lifetime'),
    ('lifetime: 1e308', 'lifetime'),
    ('weight: 1', 'weight'),
    ('mass: ', 'mass'),
    ('mass: 1, density: 1', 'mass'),
    ('anchored: true, velocity: [1, 0]', 'velocity'),
    ('anchored: true, velocity: [1, 0], motion: [0, 0, 0, 1, 0, 0, true]', 'velocity'),
    ('anchored: true, wrench: {force: [1, 0], torque: 0}', 'joint_names'),
    ('wrench: {force: [1e300, 0], torque: 0}', 'wrench'),
    ('wrench: {force: [1, 0]}', 'torque'),
    ('wrench: {force: [1, 0], torque: 0, steps: -1}', 'steps'),
    ('wrench: {force: [1, 0], torque: 0, seconds: some}', 'seconds'),
    ('wrench: {force: [1, 0], torque: 0, seconds: -1}', 'seconds'),
    ('wrench: {force: [1, 0], torque: 0, steps: 10000000000000000}', 'steps'),
    ('wrench: hard', 'wrench'),
    ('motion: [0, 0, 0, 0, 0, true]', 'motion'),
    ('motion: fast', 'motion'),
    ('motion: [0, 0, 0, 0, 0, 0, no]', 'motion'),
    ('motion: [.nan, 0, 0, 0, 0, 0, true]', 'motion'),
    ('at: [1e300, 0], motion: [1e300, 0, 0, 0, 0, 0, false]', 'motion'),
    ('at: [1e300, 0], motion: [0, 0, 0, 0, 0, 0, true]', 'pose'),
]  # fmt: skip
REFUSED = [
    *FILES,
    *((f'{HEAD}  - {{name: a/0, {text}}}', field) for text, field in BODIES),
    *((f'{HEAD}  - {{name: a/0, circle: {{radius: 1}}, {text}}}', field) for text, field in DISCS),
]


@pytest.mark.parametrize(('text', 'field'), REFUSED)
def test_a_file_that_says_nonsense_is_refused_and_says_where(
    text: str, field: str, folder: Path
) -> None:
    refusal = refusal_of(text, folder)

    assert refusal.code == 'bad_world_file'
    assert refusal.field == field


def test_a_file_with_a_body_too_many_is_a_full_world(folder: Path) -> None:
    path = write(folder, HEAD + '  - {name: a/0, circle: {radius: 1}}\n' * 2)

    with pytest.raises(WorldFull, match='2 bodies; max_bodies is 1'):
        load(path, max_bodies=1)


NO_YAML = [
    '{',
    '\tformat: 1',
    'a: b: c',
    '[format, 1]',
    'format',
    'format: 1\n#\x07',
    'format: 1\n---\nformat: 1',
    'format: *one',
    'format: !!python/object:os.system 1',
    'format: !!timestamp soon',
    'format: !!int ""',
    '{[1, 2]: 3}',
    'format: 1\nformat: 1',
    'format: ' + '9' * 10_000,
    '[' * 20_000,
    '- ' * 20_000,
]


@pytest.mark.parametrize('text', NO_YAML)
def test_what_is_no_yaml_mapping_is_refused(text: str, folder: Path) -> None:
    assert refusal_of(text, folder).field == 'world_file'


@pytest.mark.parametrize(
    ('text', 'line'),
    [
        ('format: 1\nbodies:\n\t- {}', 3),
        ('format: 1\nformat: 1', 2),
        ('format: 1\n# é\x07', 2),
        ('format: 1\ngravity: !!int ""\n\n', 2),
        ('format: 1\ngravity: [0,\n\n', 2),
        ('format: 1\n---\nformat: 1', 2),
    ],
)
def test_what_is_no_yaml_says_in_which_line(text: str, line: int, folder: Path) -> None:
    assert str(refusal_of(text, folder)).endswith(f', line {line}')


def test_what_is_no_yaml_is_told_in_another_process() -> None:
    with pytest.raises(Malformed) as refused:
        load_mapping('a:\nb: [', field='text')

    told = pickle.loads(pickle.dumps(refused.value))  # noqa: S301 - its own

    assert (str(told), vars(told)) == (str(refused.value), vars(refused.value))


def test_a_text_of_one_line_says_no_line() -> None:
    with pytest.raises(Malformed) as refused:
        load_mapping('a: b: c', field='text')
    assert 'line' not in str(refused.value)


DISCS_OF = ''.join(f'  - {{name: a/{k}, circle: {{radius: {3 - k}}}}}\n' for k in range(5))


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('gravty: [0, 0]', ["'gravity'"]),
        ('bodies: [{name: a/0, circle: {radius: 1}, elastic: 1}]', ["'elasticity'", "'a/0'"]),
        ('max_bodies: 2', ['parameter of the node']),
        ('flavour: 2', ["w.yaml: there is no property 'flavour'; there are format, "]),
        ('bodies: [{name: a/0, circle: {radius: 1}}, {circle: {radius: 1}}]', ['body number 2: ']),
        ('joints: [{kind: axle}]', ['joint number 1: ']),
        ('joints: [{name: 7, kind: axle}]', ['joint 7: ']),
        (f'bodies:\n{DISCS_OF}', ["body 'a/3'"]),
    ],
)
def test_a_refusal_says_the_nearest_key_and_of_which_body_or_joint(
    text: str, words: list[str], folder: Path
) -> None:
    told = str(refusal_of(f'format: 1\n{text}', folder))
    assert [word for word in words if word not in told] == []


# Refusals of files


def test_a_file_that_is_not_there_is_refused(folder: Path) -> None:
    with pytest.raises(BadWorldFile):
        load(folder / 'nothing.yaml')
    for name in ('nothing', 'nothing.yaml', 'sub/nothing', '/nothing.yaml', '.', '..', '../..'):
        with pytest.raises(BadWorldFile):
            find(name, folder, confined=False)


def test_where_a_world_is_not_there_the_nearest_is_named_be_it_shipped_or_ones_own(
    folder: Path,
) -> None:
    write(folder, 'format: 1', 'mine.yaml')
    write(folder, 'format: 1', '.hidden.yaml')
    for name, nearest in (('mines', "'mine'"), ('brigde', "'bridge'"), ('hidden', '')):
        with pytest.raises(BadWorldFile, match='physsim --help') as refused:
            find(name, folder)
        _, is_near, told = str(refused.value).partition('nearest is ')
        assert bool(is_near) == bool(nearest)
        assert told.startswith(nearest)


def test_a_directory_is_no_world(folder: Path) -> None:
    (folder / 'sub.yaml').mkdir()

    for act in (lambda: load(folder / 'sub.yaml'), lambda: find('sub', folder),
                lambda: save(World(), folder, 'sub')):  # fmt: skip
        with pytest.raises(BadWorldFile):
            act()


def test_a_file_that_is_no_text_is_refused(folder: Path) -> None:
    path = folder / 'w.yaml'
    path.write_bytes(b'format: 1\n\xff\xfe')

    with pytest.raises(BadWorldFile) as refused:
        load(path)
    assert 'w.yaml' in str(refused.value)


@pytest.mark.skipif(os.geteuid() == 0, reason='root may read everything')
def test_a_file_that_may_not_be_read_is_refused(folder: Path) -> None:
    path = write(folder, 'format: 1')
    path.chmod(0)

    with pytest.raises(BadWorldFile):
        load(path)


@pytest.mark.parametrize('name', ['', 'a' * 5000, 'a\0b', 'a\0b.yaml', '\ud800'])
def test_a_name_that_no_file_can_have_is_refused(name: str, folder: Path) -> None:
    for act in (
        lambda: find(name, folder, confined=False),
        lambda: find(name, folder),
        lambda: save(World(), folder, name),
    ):
        with pytest.raises(BadWorldFile) as refused:
            act()
        assert refused.value.field == 'world_file'
    assert list(folder.iterdir()) == []


# Lines in JSON

LINE = '  - {"name": "a/0", "circle": {"radius": 1}}'


@pytest.mark.parametrize('tag', ['!line', '!lin%65', '!entry'])
def test_no_tag_of_a_text_stands_for_a_line(folder: Path, tag: str) -> None:
    text = f'format: 1\nbodies:\n{LINE}\ndensity: {tag} 3\n'
    assert refusal_of(text, folder).cause == 'malformed'


@pytest.mark.parametrize(
    ('text', 'value'),
    [
        (f'x: |\n{LINE}\n', f'{LINE.strip()}\n'),
        (f'x: >-\n{LINE}\n\n{LINE}\n', f'{LINE.strip()}\n{LINE.strip()}'),
        (f"x: '\n{LINE}\n '", f' {LINE.strip()} '),
        (f'x:\n{LINE}\n', [{'name': 'a/0', 'circle': {'radius': 1}}]),
        (f'x: &x\n{LINE}\ny: *x\n', [{'name': 'a/0', 'circle': {'radius': 1}}]),
    ],
)
def test_a_line_in_a_text_is_text(text: str, value: object) -> None:
    # With another line that is an entry.
    content = load_entries(f'bodies:\n{LINE}\n{text}', field='text')
    assert content['x'] == value == load_mapping(text, field='text')['x']
    assert content['bodies'] == [{'name': 'a/0', 'circle': {'radius': 1}}]


# Text of YAML


@pytest.mark.parametrize(
    ('text', 'value'),
    [('1e5', 1e5), ('1E-3', 1e-3), ('.5', 0.5), ('-1.', -1.0), ('+2', 2), ('010', 10), ('08', 8),
     ('1_000', '1_000'), ('1:30', '1:30'), ('0x10', '0x10'), ('yes', 'yes'), ('on', 'on'),
     ('No', 'No'), ('true', True), ('FALSE', False), ('~', None), ('', None), ('null', None),
     ('2026-01-01', '2026-01-01'), ('=', '='), ('<<', '<<'), ('.inf', float('inf')),
     ('-.INF', float('-inf')), ("'1'", '1'), ('"true"', 'true'), ('1.5.2', '1.5.2'), ('.', '.'),
     ('e5', 'e5'), ('!!float 1', 1.0), ('!!str 1', '1'), ('!!int "7"', 7)],
)  # fmt: skip
def test_plain_words_are_read_as_in_yaml_1_2(text: str, value: object) -> None:
    result = load_mapping(f'key: {text}', field='text')['key']

    assert result == value
    assert type(result) is type(value)


def test_not_a_number_is_read_as_one() -> None:
    assert np.isnan(load_mapping('key: .nan', field='text')['key'])


@pytest.mark.parametrize('text', ['', '   ', '# nothing', '---', '{}', 'null'])
def test_no_text_is_an_empty_mapping(text: str) -> None:
    assert load_mapping(text, field='text') == {}


POINTS = ', '.join(f'[{each}, {each % 2}]' for each in range(1000))
WALL = f'chain: &wall {{points: [{POINTS}], thickness: 0.1}}'


def repeating(count: int) -> str:
    """Return a world with as many walls of 1,000 points, whose text has these once."""
    walls = ''.join(f'  - {{name: a/{each}, chain: *wall}}\n' for each in range(1, count))
    return f'format: 1\nbodies:\n  - {{name: a/0, {WALL}}}\n{walls}'


def test_an_outline_may_be_repeated(folder: Path) -> None:
    assert len(load(write(folder, repeating(20))).bodies) == 20


def unfolding(layer: str, times: int, first: str) -> list[str]:
    """Return entries, each of which has the one before it so many times."""
    entries = [f'a0: &a0 {first}']
    for each in range(1, 30):
        again = ', '.join([f'*a{each - 1}'] * times)
        entries.append(f'a{each}: &a{each} {layer.format(f"[{again}]")}')
    return entries


ENDLESS = {
    'walls': repeating(1500),
    'lists': '\n'.join(unfolding('{}', 10, '[x]')),
    'merges': 'format: 1\n' + '\n'.join(unfolding('{{!!merge x: {}}}', 9, '{mass: 1}')),
    'a name': f'bodies: [{{name: {{{", ".join(unfolding("{}", 9, "[x]"))}}}}}]',
    'a list in itself': '{a: &a [*a]}',
    'a mapping in itself': '{a: &a {b: *a}}',
    'a key': '{? &a b : &c [*c], *a : 1}',
    'a format': 'format: &a [*a]',
    'bodies': 'format: 1\nbodies: &a [*a]',
    'a body': 'format: 1\nbodies: [&a {name: *a, circle: {radius: 1}}]',
}


@pytest.mark.parametrize('text', ENDLESS.values(), ids=ENDLESS)
def test_aliases_end_while_they_are_read(text: str, folder: Path) -> None:
    assert 'aliases repeat more than 100000 values' in str(refusal_of(text, folder))


def test_pieces_are_counted_while_bodies_are_read(folder: Path) -> None:
    # Of three walls of twenty.
    with pytest.raises(WorldFull, match='the world would have 2997 convex pieces'):
        load(write(folder, repeating(20)), max_shapes=2000)


def test_keys_are_texts() -> None:
    text = '{1: 2, true: 3, ~: 4, 1.5: 5, "x": 6, &a y: 7, z: *a}'
    content = load_mapping(text, field='text')
    assert content == {'1': 2, 'true': 3, '~': 4, '1.5': 5, 'x': 6, 'y': 7, 'z': 'y'}


@settings(deadline=None, max_examples=300)
@given(text=st.text(st.sampled_from('{}[]:,-!&*#|>%@`"\'?~ \n\tab01.e<=é'), max_size=40))
def test_any_text_is_a_mapping_or_malformed(text: str) -> None:
    try:
        value = load_mapping(text, field='text')
    except Malformed:
        return

    assert isinstance(value, dict)


@settings(deadline=None, max_examples=150)
@given(
    content=st.recursive(
        st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=3)),
        lambda inner: st.one_of(
            st.lists(inner, max_size=3),
            st.dictionaries(
                st.sampled_from(['name', 'circle', 'radius', 'polygon', 'at', 'motion', 'wrench',
                                 'color', 'mass', 'force', 'torque', 'compound', 'centers']),
                inner, max_size=3,
            ),
        ),
        max_leaves=12,
    )
)  # fmt: skip
def test_any_nested_junk_is_loaded_or_refused(content: object, tmp_path_factory: Any) -> None:
    folder = tmp_path_factory.getbasetemp()
    for text in (
        yaml.safe_dump(content),
        yaml.safe_dump({'format': 1, 'bodies': content}),
        yaml.safe_dump({'format': 1, 'bodies': [content]}),
    ):
        path = write(folder, text, 'junk.yaml')
        try:
            state = load(path)
        except BadWorldFile:
            continue
        restored(state).step(1)
