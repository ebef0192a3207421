# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The files that repeat declarations: tables of the interface, parameters, types, a script.

In documents, types and scripts, such a part stands between two comments, which name it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING
from pathlib import Path
import textwrap
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import physsim_ros
from physsim_ros.appearance.joint_strips import SYMBOLS
from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.actors import ACTORS, Start
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.declarations import Checked, Declaration
from physsim_ros.model.joints import AS_DRAWN, DEFAULTS, JointKind, JointProperties
from physsim_ros.model.media import Medium
from physsim_ros.model.requests import Request
from physsim_ros.model.robots import Battery, DRIVES, Link, LinkJoint, Odometry, Robot, Towed
from physsim_ros.model.robots.sensors import SENSORS
from physsim_ros.model.settings import WorldSettings
from physsim_ros.ros.parameters import NodeSettings, Spec, SPECS
from physsim_ros.sketchpad.message import KINDS, Optional
from physsim_ros.sketchpad.rights import Right
from tools.tables import cheat_sheet

ROOT = Path(__file__).parents[2]
# Columns of a comment in YAML.
_WIDTH = 100
_YAML_HEAD = """\
# Every parameter with its default; `make tables` writes this file.
#
#   physsim --ros-args --params-file config/physsim.yaml -p speed:=0.5
#
# All but those marked read-only take effect at once when they are set on the running node.
/**:
  ros__parameters:
"""
_COLUMNS = ('key', 'default', 'range', 'meaning')
# Keys that the text above the table of sensors explains.
_OF_EVERY_SENSOR = {'name', 'rate', 'at', 'link', 'latency'}
# The parts of the file of parameters.
_GROUPS: Mapping[str, type[Checked]] = {
    'The node': NodeSettings,
    'The world': WorldSettings,
    'Drawing': DrawingSettings,
}


def files() -> dict[Path, str]:
    """Return the text that each file must have, by its path."""
    tables = {
        'interface/properties': {
            'properties of a body': _table(Properties.FIELDS.values()),
            'keys of a force': _rows(_COLUMNS, *_fields_of(AppliedForce)),
            'keys of a medium': _rows(_COLUMNS, *_fields_of(Medium)),
            'kinds of joints': _joint_kinds(),
            'properties of a joint': _table(JointProperties.FIELDS.values(), _joint_default),
            'keys of a robot': _robot_keys(),
            'keys of parts': _part_keys(),
            'keys of a sensor': _sensor_keys(),
            'keys of an actor': _actor_keys(),
        },
        'interface/parameters': {'parameters': _parameters()},
        'python': {'fields of requests': _request_fields()},
        'page_protocol': {'messages of a page': _page_messages()},
        'cheat_sheet': {'keys of the page': cheat_sheet.tables()},
    }
    pages = {ROOT / 'docs' / f'{name}.md': parts for name, parts in tables.items()}
    package = ROOT / 'physsim_ros'
    types, messages = (package / 'testing' / f'{name}.py' for name in ('parameters', 'messages'))
    page = package / 'sketchpad' / 'page'
    scripts = {
        page / 'view' / 'joint_view.js': {'symbols': _symbols()},
        page / 'joint_kinds.js': {'kinds': _kinds_of_joints()},
    }
    return {
        **{
            page: with_parts(page, parts, '<!-- {}: made by `make tables` -->')
            for page, parts in pages.items()
        },
        types: with_parts(types, _types(), '# {}: made by `make tables`'),
        messages: with_parts(
            messages, {'properties': _property_types()}, '# {}: made by `make tables`'
        ),
        **{
            script: with_parts(script, parts, '// {}: made by `make tables`')
            for script, parts in scripts.items()
        },
        ROOT / 'config' / 'physsim.yaml': _YAML_HEAD + '\n'.join(_yaml()),
    }


def with_parts(path: Path, parts: Mapping[str, str], comment: str) -> str:
    """
    Return the text of a file with its parts made anew.

    :param comment: before each part, with braces for its name; the one after it says `end`
    :raises ValueError: a part is not there
    """
    text = path.read_text(encoding='utf-8')
    for name, part in parts.items():
        begin, end = comment.format(name), comment.format('end')
        before, found, rest = text.partition(begin)
        if not found:
            raise ValueError(f'{path} has no part {begin!r}')
        text = f'{before}{begin}\n{part}{end}{rest.partition(end)[2]}'
    return text


def _rows(*rows: tuple[str, ...]) -> str:
    text = [''.join(f'| {cell} ' if cell else '| ' for cell in row) + '|\n' for row in rows]
    text.insert(1, '|---' * len(rows[0]) + '|\n')
    return '\n' + ''.join(text) + '\n'


def _table(declarations: Any, default: Any = None) -> str:
    """Return a table of fields; with `default`, a function of a field, a column of that."""
    columns = ('key', *(('default',) if default else ()), 'range', 'meaning')
    rows = [
        (f'`{each.name}`', *((default(each),) if default else ()), each.span, each.sentence)
        for each in declarations
    ]
    return _rows(columns, *rows)


def _joint_kinds() -> str:
    return _rows(
        ('kind', 'points', 'properties', 'meaning'),
        *(
            (
                f'`{kind}`',
                str(kind.points),
                ', '.join(f'`{name}`' for name in kind.schema.own),
                kind.schema.sentence,
            )
            for kind in JointKind
        ),
    )


def _joint_default(each: Declaration) -> str:
    if AS_DRAWN in each.notes:
        return 'as drawn'
    return _value(DEFAULTS[each.name]) if each.name in DEFAULTS else 'none'


def _robot_keys() -> str:
    drive = [('`kind`', 'required', '', f'one of {_list(DRIVES)}')]
    for each, kinds in _by_kinds(DRIVES):
        key, default, span, meaning = _row(each)
        of = f'of {_list(kinds)}: ' if len(kinds) < len(DRIVES) else ''
        drive.append((key, default, span, of + meaning))
    parts = [
        _titled('**`robot`**', _COLUMNS, _fields_of(Robot)),
        _titled('**`drive`**', _COLUMNS, drive),
        _titled('**`odometry`**', _COLUMNS, _fields_of(Odometry)),
        _titled('**`battery`**', _COLUMNS, _fields_of(Battery)),
    ]
    return ''.join(parts) + '\n'


def _part_keys() -> str:
    joint = [_row(each) for each in LinkJoint.FIELDS.values() if each.name != 'properties']
    parts = [
        _titled('**a link**', _COLUMNS, _fields_of(Link)),
        _titled('**a joint**', _COLUMNS, joint),
        _titled('**`towed`**', _COLUMNS, _fields_of(Towed)),
    ]
    return ''.join(parts) + '\n'


def _sensor_keys() -> str:
    """Return for each kind its sentence with the default topic and rate, and its own keys."""
    parts = []
    for kind, sensor in SENSORS.items():
        sentence = (sensor.__doc__ or '').strip().partition('\n')[0].rstrip('.')
        name, rate = sensor.FIELDS['name'].default, _value(sensor.FIELDS['rate'].default)
        rows = [_row(each) for each in sensor.FIELDS.values() if each.name not in _OF_EVERY_SENSOR]
        parts.append(_titled(f'**`{kind}`** on `{name}`, {rate} Hz. {sentence}.', _COLUMNS, rows))
    return ''.join(parts) + '\n'


def _actor_keys() -> str:
    """Return a table for each set of kinds that share keys, and one of `start`."""
    groups: dict[tuple[str, ...], list[tuple[str, ...]]] = {}
    for each, kinds in _by_kinds(ACTORS):
        groups.setdefault(kinds, []).append(_row(each))
    parts = []
    for kinds, rows in groups.items():
        title = _list(kinds) if len(kinds) < len(ACTORS) else 'every kind'
        parts.append(_titled(f'**{title}**', _COLUMNS, rows))
    parts.append(_titled('**`start`**', _COLUMNS, _fields_of(Start)))
    return ''.join(parts) + '\n'


def _request_fields() -> str:
    """Return a table for each request of the front, in the order of the alphabet."""
    kinds = (getattr(physsim_ros, name) for name in sorted(physsim_ros.__all__))
    requests = [each for each in kinds if isinstance(each, type) and issubclass(each, Request)]
    parts = []
    for kind in requests:
        if kind is not Request:
            sentence = (kind.__doc__ or '').strip().partition('\n')[0].rstrip('.')
            rows = [_row_of_python(each) for each in kind.FIELDS.values()]
            columns = ('field', 'default', 'meaning')
            parts.append(_titled(f'**`{kind.__name__}`**: {sentence}.', columns, rows))
    return ''.join(parts) + '\n'


def _row_of_python(each: Declaration) -> tuple[str, str, str]:
    """Return a row with the default as a program has it."""
    is_plain = isinstance(each.default, str | int | float | tuple | None)
    default = f'`{each.default!r}`' if is_plain else ''
    return f'`{each.name}`', 'required' if each.default is MISSING else default, each.sentence


def _by_kinds(
    kinds: Mapping[str, type[Checked]],
) -> Iterator[tuple[Declaration, tuple[str, ...]]]:
    """Yield each different declaration of some kinds of value, with the words for those kinds."""
    found: dict[tuple[str, str], tuple[Declaration, tuple[str, ...]]] = {}
    for word, kind in kinds.items():
        for name, each in kind.FIELDS.items():
            key = name, each.sentence
            first, words = found.get(key, (each, ()))
            found[key] = first, (*words, word)
    yield from found.values()


def _page_messages() -> str:
    groups: dict[str, list[tuple[str, ...]]] = {right.name.lower(): [] for right in Right}
    for type_, kind in sorted(KINDS.items()):
        meaning = (kind.handle.__doc__ or '').strip().partition('\n')[0].rstrip('.')
        fields = [
            f'`{name}`' + '?' * isinstance(read, Optional) for name, read in kind.fields.items()
        ]
        groups[kind.right.name.lower()].append((f'`{type_}`', ', '.join(fields), meaning))
    columns = ('type', 'fields', 'meaning')
    parts = (_titled(f'**Right `{right}`**', columns, rows) for right, rows in groups.items())
    return ''.join(parts) + '\n'


def _titled(title: str, columns: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    """Return a line and below it a table, if there are rows."""
    table = _rows(columns, *rows).rstrip('\n') + '\n' if rows else ''
    return f'\n{title}\n{table}'


def _list(words: Iterable[str]) -> str:
    return ', '.join(f'`{word}`' for word in words)


def _fields_of(kind: type[Checked]) -> list[tuple[str, ...]]:
    """Return the rows of all fields of a kind of value."""
    return [_row(each) for each in kind.FIELDS.values()]


def _row(each: Declaration) -> tuple[str, str, str, str]:
    return f'`{each.name}`', _value(each.default), each.span, each.sentence


def _value(value: object) -> str:
    """Return a default as people write it in YAML; '' for none, or for a mapping."""
    if value is MISSING:
        return 'required'
    if isinstance(value, Checked) or value in (None, (), ''):
        return ''
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return f'[{", ".join(map(_value, value))}]'
    return f'{value:.5g}' if isinstance(value, float) else str(value)


def _parameters() -> str:
    rows = []
    for name, spec in SPECS.items():
        words = ', '.join(f'`{each}`' for each in spec.choices)
        notes = (words or spec.declaration.span, 'read-only' * spec.read_only)
        default = '' if spec.default == '' else f'`{_yaml_value(spec.default)}`'
        rows.append(
            (f'`{name}`', default, '; '.join(filter(None, notes)), spec.declaration.sentence)
        )
    return _rows(('name', 'default', 'range', 'meaning'), *rows)


def _yaml() -> Iterator[str]:
    """Yield the lines of the file of parameters below its head."""
    for title, group in _GROUPS.items():
        yield f'    # --- {title} ---'
        for name in group.FIELDS:
            spec = SPECS[name]
            said = spec.declaration.text + '; read-only' * spec.read_only
            # A word of the interface stays as it is.
            begin = '' if said.startswith('`') else said[0].upper()
            yield from textwrap.wrap(
                f'{begin}{said[len(begin) :]}.'.replace('`', ''),
                _WIDTH,
                initial_indent='    # ',
                subsequent_indent='    # ',
                break_long_words=False,
                break_on_hyphens=False,
            )
            yield f'    {name}: {_yaml_value(spec.default)}'
        yield ''


def _yaml_value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "''" if value == '' else str(value)


def _property_types() -> str:
    """Return the annotations of the properties of a body, as a marker has them."""
    hints = get_type_hints(Properties)
    lines = [f'    {name}: {_property_type(hints[name])} | None\n' for name in Properties.FIELDS]
    return ''.join(lines) + '\n\n'


def _property_type(hint: Any) -> str:
    """Return the annotation of a property: that of its field, as YAML can write it."""
    (kind,) = (each for each in get_args(hint) if each is not NoneType)
    if get_origin(kind) is tuple:
        is_vector = get_args(kind)[0] is float
        return 'Numbers' if is_vector else 'Sequence[Mapping[str, Any]]'
    if kind in (bool, float, int, str):
        return str(kind.__name__)
    # A shipped robot is named.
    return 'str | Mapping[str, Any]' if kind is Robot else 'Mapping[str, Any]'


def _symbols() -> str:
    """Return the counts of the symbols of joints, for the script that draws them on the page."""
    return f'const {", ".join(f"{name} = {number}" for name, number in SYMBOLS.items())};\n'


def _kinds_of_joints() -> str:
    """Return lists of kinds of joints, for the scripts of the page that treat each alike."""
    lists = {
        # A gear couples rotations, wherever its point is.
        'AT_POINT': lambda schema: schema.points == 1 and 'ratio' not in schema.own,
        'ALONG_LINE': lambda schema: schema.along_line,
        'ALONG_AXIS': lambda schema: schema.has_axis,
    }
    return ''.join(
        f'export const {name} = {[str(kind) for kind in JointKind if is_in(kind.schema)]};\n'
        for name, is_in in lists.items()
    )


def _types() -> dict[str, str]:
    tools = ''.join(f'    {str(each)!r},\n' for each in SPECS['tool'].choices)
    lines = [f'    {name}: {_type(name, spec)}\n' for name, spec in SPECS.items()]
    return {'tools': f'Tool = Literal[\n{tools}]\n', 'parameters': ''.join(lines) + '\n\n'}


def _type(name: str, spec: Spec) -> str:
    """Return the annotation of a parameter."""
    if name == 'tool':
        return 'Tool'
    if spec.choices:
        return f'Literal[{", ".join(repr(str(each)) for each in spec.choices)}]'
    return 'Sequence[float]' if isinstance(spec.default, list) else type(spec.default).__name__
