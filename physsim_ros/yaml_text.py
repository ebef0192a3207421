# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""YAML as other people write it: numbers as in YAML 1.2 (1e5 is one), no dates, no tags."""

from __future__ import annotations

import re
from typing import Any

from physsim_ros.core.errors import Malformed
import yaml


class _Loader(yaml.SafeLoader):
    """The safe loader with the plain scalars of the YAML 1.2 core schema."""

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}  # noqa: RUF012


_NUMBER = list('-+0123456789.')
for _tag, _pattern, _first in (
    ('bool', r'true|True|TRUE|false|False|FALSE', list('tTfF')),
    ('null', r'null|Null|NULL|~|', ['n', 'N', '~', '']),
    ('int', r'[-+]?[0-9]+', list('-+0123456789')),
    ('float', r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?', _NUMBER),
    ('float', r'[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)', _NUMBER),
):
    _Loader.add_implicit_resolver(
        f'tag:yaml.org,2002:{_tag}', re.compile(f'^(?:{_pattern})$'), _first
    )


def load_mapping(text: str, *, field: str) -> dict[Any, Any]:
    """
    Return a YAML mapping; empty text is an empty one.

    :param text: YAML
    :param field: what the text is, for the refusal
    :raises Malformed: the text is not YAML, or not a mapping
    """
    try:
        value = yaml.load(text, Loader=_Loader)  # noqa: S506 - a subclass of SafeLoader
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # What PyYAML says may span lines and repeat the text; its first line says what is wrong.
        reason = str(error).partition('\n')[0] or type(error).__name__
        raise Malformed(f'{field} is not YAML: {reason[:200]}', field=field) from error
    if value is None:
        return {}
    if not isinstance(value, dict):
        raise Malformed(f'{field} must be a YAML mapping as {{friction: 0.3}}', field=field)
    return value
