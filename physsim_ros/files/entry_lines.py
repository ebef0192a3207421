# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The mapping of a world file: lines of bodies and joints in JSON, all other text in YAML.

Law: a line is read as JSON only where YAML reads the same from it. The node writes such lines.
JSON is read in a thirtieth of the time that YAML takes, and with a tenth of the memory: PyYAML
keeps an object for each number until the end of the text.
"""

from __future__ import annotations

from collections.abc import Mapping
import errno
import json
from typing import Any

from physsim_ros.files.yaml12 import load_mapping, Loader, Located

_DASH, _TAG = '  - ', '!line-of-json'
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
    lines, entries, rest = text.split('\n'), dict[int, Located](), 0
    # A text that has the tag itself is YAML throughout.
    has_tag = _TAG in text
    for number, line in enumerate(lines, 1):
        is_json = not has_tag and line.startswith(f'{_DASH}{{"')
        entry = _from_json(line.removeprefix(_DASH)) if is_json else None
        if entry is None:
            rest += len(line) + 1
        else:
            entries[number] = Located(number, entry)
            lines[number - 1] = f'{_DASH}{_TAG} {number}'
    if rest > MOST_YAML:
        raise OSError(errno.EFBIG, f'more than {MOST_YAML / 2**20:g} MiB of it is not JSON')
    loader = _loader_of(entries) if entries else Loader
    return load_mapping('\n'.join(lines), field=field, loader=loader)


def _loader_of(entries: Mapping[int, Located]) -> type[Loader]:
    """Return a loader to which a scalar with the tag is the entry of that line."""

    class LineLoader(Loader):
        pass

    LineLoader.add_constructor(_TAG, lambda _, node: entries[int(node.value)])
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
