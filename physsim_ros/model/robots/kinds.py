# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values of several kinds, whose mapping says by the key `kind` which one it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from physsim_ros.model.checks import Checked, shown
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.texts import nearest_name

Value = TypeVar('Value', bound=Checked)


def value_of_kind(value: object, name: str, noun: str, kinds: Mapping[str, type[Value]]) -> Value:
    """
    Return the value that a mapping with the key `kind` is.

    :param name: of the field, for the refusal
    :param noun: for such a value, for the refusal
    :param kinds: classes by the words for them
    :raises UnknownProperty: a key is not a property of that kind; the nearest one is named
    :raises Malformed: a number is not finite, or a list has the wrong length
    :raises BadProperty: there is no such kind, or a value is null, of the wrong kind or out of
        range
    """
    if not isinstance(value, dict):
        raise BadProperty(f'a {noun} must be a mapping, not {shown(value)}', field=name)
    kind, words = value.get('kind'), ', '.join(kinds)
    if kind is None:
        raise BadProperty(f'a {noun} needs a kind: {words}', field='kind')
    if not isinstance(kind, str) or kind not in kinds:
        raise BadProperty(
            f'there is no kind of {noun} {shown(kind)}{nearest_name(str(kind), kinds)}; there are '
            f'{words}',
            field='kind',
        )
    return kinds[kind].from_mapping({key: each for key, each in value.items() if key != 'kind'})
