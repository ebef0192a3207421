# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A YAML loader with the numbers of YAML 1.2 (1e5 is one), no dates and no custom tags.

Lines of bodies and joints in world files may be JSON, and the node writes them so: JSON takes a
thirtieth of the time of YAML, and a tenth of the memory, since PyYAML keeps an object for each
number until the end of the text.

Laws: keys are texts, since hashes of numbers can be made to collide; values that aliases repeat
are counted while the text is read, and more than `MOST_REPEATED` are an error; a line is read as
JSON only where YAML reads the same from it: as an entry of a list, and not as a part of a text.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
import errno
import json
import re
from types import MappingProxyType
from typing import Any, ClassVar

from physsim_ros.model.errors import Malformed
from physsim_ros.runtime.garbage_collection import suspended_collection
import yaml
from yaml.composer import Composer

_TAG = 'tag:yaml.org,2002:'
# Tag of the scalar that stands for a line of JSON, whose number it has; files do not use it.
_JSON_LINE = '!line'
# Greatest number of scalars, lists and mappings that aliases repeat: 300 outlines of 100 points.
MOST_REPEATED = 100_000


class NotYaml(Malformed):
    """
    A text that is not YAML.

    :param line: of the text, from 1; None if it is unknown
    """

    def __init__(self, template: str, /, *, line: int | None = None, **values: Any) -> None:
        super().__init__(template, line=line, **values)
        self.line = line


class Located(dict[Any, Any]):
    """
    A mapping of a text.

    :param line: of the text where it begins, from 1
    :param entries: that it has
    """

    def __init__(self, line: int, entries: Mapping[Any, Any] = MappingProxyType({})) -> None:
        super().__init__(entries)
        self.line = line


def _construct_located(loader: yaml.SafeLoader, node: yaml.MappingNode) -> Iterator[Located]:
    """Construct a mapping in two steps, as PyYAML does: its depth costs no stack."""
    mapping = Located(node.start_mark.line + 1)
    yield mapping
    mapping.update(loader.construct_mapping(node))


class Loader(Composer, yaml.CSafeLoader):
    """
    PyYAML's safe loader with the types of the YAML 1.2 core schema; duplicate keys are refused.

    libyaml scans the text, in a quarter of the time of Python. Nodes are composed in Python, since
    the composer in C (PyYAML 6.0) overflows the stack at tens of thousands of nested brackets.

    A scalar that does not fit its tag, as in `!!bool maybe`, is a ConstructorError; PyYAML's own
    constructors raise ValueError and others.

    :param text: YAML
    :param entries: values of the scalars with the tag `_JSON_LINE`, by number
    """

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}  # noqa: RUF012
    yaml_constructors: ClassVar[dict[Any, Callable[..., Any]]] = {
        None: yaml.SafeLoader.construct_undefined,
        _TAG + 'map': _construct_located,
        _TAG + 'seq': yaml.SafeLoader.construct_yaml_seq,
    }

    def __init__(self, text: str, entries: dict[int, Located]) -> None:
        yaml.CSafeLoader.__init__(self, text)
        Composer.__init__(self)
        self.entries = entries
        # Number of nodes up to now, with those that aliases repeat; and of these alone.
        self._nodes = self._repeated = 0
        # Number of nodes of each anchor, with those below it.
        self._sizes: dict[str, int] = {}

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """Return the next node; what aliases repeat is bounded."""
        event: Any = self.peek_event()
        before = self._nodes
        anchor = getattr(event, 'anchor', None)
        node = super().compose_node(parent, index)
        if isinstance(event, yaml.AliasEvent):
            # An alias within its own anchor, whose size is not known yet, repeats without end.
            self._repeated += self._sizes.get(str(anchor), MOST_REPEATED + 1)
            self._nodes += self._sizes.get(str(anchor), 0)
        else:
            self._nodes += 1
        if anchor is not None:
            self._sizes[anchor] = self._nodes - before
        if self._repeated > MOST_REPEATED:
            problem = f'aliases repeat more than {MOST_REPEATED} values'
            raise yaml.composer.ComposerError(problem=problem, problem_mark=event.start_mark)
        return node

    def construct_mapping(
        self,
        node: yaml.MappingNode,
        deep: bool = False,  # noqa: FBT001, FBT002 - PyYAML's own
    ) -> dict[Any, Any]:
        """
        Return the mapping of a node; a duplicate key, or one that is no scalar, is an error.

        A merge key is one like others: YAML 1.2 has none, and nested merges exhaust the memory.
        """
        mapping: dict[Any, Any] = {}
        if not isinstance(node, yaml.MappingNode):
            raise _refused('this is no mapping', node)
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.tag not in self.yaml_constructors:
                raise _refused('a key is no text', key)
            if key.value in mapping:
                raise _refused(f'{key.value} appears twice', key)
            mapping[key.value] = self.construct_object(value, deep=deep)
        return mapping


def _refused(problem: str, node: yaml.Node) -> yaml.constructor.ConstructorError:
    return yaml.constructor.ConstructorError(None, None, problem, node.start_mark)


def _bool(text: str) -> bool:
    if text.lower() not in ('true', 'false'):
        raise ValueError(f'{text} is not true or false')
    return text.lower() == 'true'


def _float(text: str) -> float:
    return float(text.replace('.', '') if text.lower().endswith(('.inf', '.nan')) else text)


def _scalar(make: Callable[[str], object]) -> Callable[[Loader, yaml.ScalarNode], object]:
    def construct(loader: Loader, node: yaml.ScalarNode) -> object:
        try:
            return make(str(loader.construct_scalar(node)))
        except ValueError as error:
            raise _refused(str(error), node) from error

    return construct


def _construct_entry(loader: Loader, node: yaml.ScalarNode) -> Located:
    try:
        return loader.entries.pop(int(node.value))
    except (KeyError, ValueError) as error:
        raise _refused(f'there is no tag {_JSON_LINE}', node) from error


Loader.add_constructor(_JSON_LINE, _construct_entry)
for _name, _make in (
    ('bool', _bool),
    ('null', lambda _: None),
    ('int', int),
    ('float', _float),
    ('str', str),
):
    Loader.add_constructor(_TAG + _name, _scalar(_make))

_NUMBER = list('-+0123456789.')
for _tag, _pattern, _first in (
    ('bool', r'true|True|TRUE|false|False|FALSE', list('tTfF')),
    ('null', r'null|Null|NULL|~|', ['n', 'N', '~', '']),
    ('int', r'[-+]?[0-9]+', list('-+0123456789')),
    ('float', r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?', _NUMBER),
    ('float', r'[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)', _NUMBER),
):
    Loader.add_implicit_resolver(_TAG + _tag, re.compile(f'^(?:{_pattern})$'), _first)


@suspended_collection()
def load_mapping(
    text: str, *, field: str, entries: dict[int, Located] | None = None
) -> dict[Any, Any]:
    """
    Return the mapping of a YAML text; of an empty text an empty one.

    :param text: YAML
    :param field: name of the text, for the refusal
    :param entries: values of the scalars with the tag `_JSON_LINE`, by number; each that is used
        is removed
    :raises NotYaml: the text is not YAML
    :raises Malformed: it is no mapping
    """
    try:
        loader = Loader(text, entries or {})
        try:
            value = loader.get_single_data()
        finally:
            loader.dispose()
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # The text of PyYAML's errors spans lines and quotes the input; their `problem` does not.
        said = getattr(error, 'problem', None) or str(error) or type(error).__name__
        line = _line(error, text)
        reason = said.partition('\n')[0][:200]
        template = '{field} is not YAML: {reason}'
        if line is not None:
            template = '{field} is not YAML: {reason}, line {line}'
        raise NotYaml(template, field=field, reason=reason, line=line) from error
    if value is None:
        return {}
    if not isinstance(value, dict):
        raise Malformed('{field} must be a YAML mapping as {{friction: 0.3}}', field=field)
    return value


def _line(error: Exception, text: str) -> int | None:
    """Return the line of an error; None if it is unknown, or the text has one line only."""
    lines = text.rstrip('\n').count('\n') + 1
    mark = getattr(error, 'problem_mark', None)
    if lines == 1:
        return None
    if mark is not None:
        # At the end of the text libyaml counts one line more.
        return min(int(mark.line) + 1, lines)
    if isinstance(error, yaml.reader.ReaderError):
        # ReaderError.position counts bytes.
        return text.encode()[: error.position].count(b'\n') + 1
    return None


_DASH = '  - '
# Greatest size of what is not JSON [characters]: YAML takes two seconds for each million.
MOST_YAML = 4 * 2**20


def load_entries(text: str, *, field: str) -> dict[Any, Any]:
    """
    Return the mapping of a world file's text.

    :param field: name of the text, for the refusal
    :raises NotYaml: the text is not YAML
    :raises Malformed: it is no mapping
    :raises OSError: it is too large
    """
    lines, entries, size = text.split('\n'), dict[int, Located](), len(text)
    for number, line in enumerate(lines, 1):
        is_json = line.startswith(f'{_DASH}{{"')
        entry = _from_json(line.removeprefix(_DASH)) if is_json else None
        if entry is not None:
            entries[number] = Located(number, entry)
            size -= len(line)
            lines[number - 1] = f'{_DASH}{_JSON_LINE} {number}'
    _check_size(size)
    content = load_mapping('\n'.join(lines), field=field, entries=entries)
    if not entries:
        return content
    # A line that is left was a part of a text: the whole is read as YAML.
    _check_size(len(text))
    return load_mapping(text, field=field)


def _check_size(size: int) -> None:
    if size > MOST_YAML:
        raise OSError(errno.EFBIG, f'more than {MOST_YAML / 2**20:g} MiB of it is not JSON')


def _from_json(text: str) -> dict[str, Any] | None:
    """Return the mapping of a line; None if it is not JSON that is YAML too."""
    try:
        value: dict[str, Any] = json.loads(
            text, object_pairs_hook=_without_doubles, parse_constant=_refuse
        )
    except (ValueError, RecursionError):
        return None
    return value


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    mapping = dict(pairs)
    if len(mapping) < len(pairs):
        raise ValueError('a key appears twice')
    return mapping


def _refuse(name: str) -> None:
    raise ValueError(f'{name} is not JSON')
