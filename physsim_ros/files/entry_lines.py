# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The text of a world file as a mapping: lines of bodies and joints in JSON, all else in YAML.

Law: a line is read as JSON only where YAML reads the same from it. The node writes such lines,
which are read in a fiftieth of the time that YAML takes, and with little memory.
"""

from __future__ import annotations

import errno
import functools
import json
from typing import Any

from physsim_ros.files.yaml12 import load_mapping, Loader, Located
import yaml

_DASH, _TAG = '  - ', '!lines-of-json'
# Greatest size of what is not JSON [characters]: YAML takes two seconds for each million.
MOST_YAML = 4 * 2**20


class _Run(list[Located]):
    """Entries of lines that follow each other."""


class _RunLoader(Loader):
    """
    A loader of texts in which each run of JSON lines is a tag.

    :param runs: of the text
    """

    def __init__(self, stream: str, runs: list[_Run]) -> None:
        super().__init__(stream)
        self.runs = runs


def _construct_run(loader: _RunLoader, node: yaml.ScalarNode) -> _Run:
    return loader.runs[int(node.value)]


_RunLoader.add_constructor(_TAG, _construct_run)


def load_entries(text: str, *, field: str) -> dict[Any, Any]:
    """
    Return the mapping of a world file's text.

    :param field: name of the text, for the refusal
    :raises NotYaml: the text is not YAML
    :raises Malformed: it is no mapping
    :raises OSError: it is too large
    """
    lines, runs = text.split('\n'), list[_Run]()
    last = -1
    # A file that has the tag itself is read as it is.
    for number, line in enumerate(lines if _TAG not in text else (), 1):
        mapping = _from_json(line.removeprefix(_DASH)) if line.startswith(f'{_DASH}{{"') else None
        if mapping is None:
            continue
        entry = Located(number)
        entry.update(mapping)
        if last == number - 1:
            lines[number - 1] = ''
        else:
            lines[number - 1] = f'{_DASH}{_TAG} {len(runs)}'
            runs.append(_Run())
        runs[-1].append(entry)
        last = number
    rest = '\n'.join(lines)
    if len(rest) > MOST_YAML:
        raise OSError(errno.EFBIG, f'more than {MOST_YAML / 2**20:g} MiB of it is not JSON')
    content = load_mapping(rest, field=field, loader=functools.partial(_RunLoader, runs=runs))
    for key in ('bodies', 'joints'):
        if isinstance(content.get(key), list):
            content[key] = [
                entry
                for item in content[key]
                for entry in (item if isinstance(item, _Run) else [item])
            ]
    return content


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
        raise ValueError('a key comes twice')
    return mapping


def _refuse(name: str) -> None:
    raise ValueError(f'{name} is no JSON')
