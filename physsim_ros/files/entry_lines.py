# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The mapping of a world file: lines of bodies and joints in JSON, all other text in YAML.

Law: a line is read as JSON only where YAML reads the same from it: as an entry of a list, and not
as a part of a text. The node writes such lines.

JSON is read in a thirtieth of the time that YAML takes, and with a tenth of the memory: PyYAML
keeps an object for each number until the end of the text.
"""

from __future__ import annotations

from collections.abc import Mapping
import errno
from itertools import count
import json
import secrets
from typing import Any

from physsim_ros.files.yaml12 import load_mapping, Loader, Located
import yaml

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
    # No text has this tag, since nobody knows it beforehand.
    tag = f'!entry-{secrets.token_hex(8)}'
    for number, line in enumerate(lines, 1):
        is_json = line.startswith(f'{_DASH}{{"')
        entry = _from_json(line.removeprefix(_DASH)) if is_json else None
        if entry is not None:
            entries[number] = Located(number, entry)
            size -= len(line)
            lines[number - 1] = f'{_DASH}{tag} {number}'
    if entries:
        taken = count()
        loader = _loader_of(tag, entries, taken)
        content = _load('\n'.join(lines), size, field, loader)
        if next(taken) == len(entries):
            return content
    # Without such lines, or with one that is a part of a text, it is YAML throughout.
    return _load(text, len(text), field, Loader)


def _load(text: str, size: int, field: str, loader: type[Loader]) -> dict[Any, Any]:
    """
    Return the mapping of a text in YAML.

    :param size: of what is read as YAML [characters]
    :raises OSError: it is too large
    """
    if size > MOST_YAML:
        raise OSError(errno.EFBIG, f'more than {MOST_YAML / 2**20:g} MiB of it is not JSON')
    return load_mapping(text, field=field, loader=loader)


def _loader_of(tag: str, entries: Mapping[int, Located], taken: count[int]) -> type[Loader]:
    """
    Return a loader to which a scalar with the tag is the entry of that line.

    :param taken: is advanced with each entry
    """

    class LineLoader(Loader):
        pass

    def entry(_: Loader, node: yaml.ScalarNode) -> Located:
        next(taken)
        return entries[int(node.value)]

    LineLoader.add_constructor(tag, entry)
    return LineLoader


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
