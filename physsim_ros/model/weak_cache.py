# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A cache of what follows from a value, as from a form or a scene, for as long as that lives."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

_Key = TypeVar('_Key')
_Value = TypeVar('_Value')


def cached_weakly(function: Callable[[_Key], _Value]) -> Callable[[_Key], _Value]:
    """Cache what a function returns for each argument, which is compared by identity."""
    values: WeakKeyDictionary[_Key, _Value] = WeakKeyDictionary()

    @wraps(function)
    def value_of(key: _Key) -> _Value:
        try:
            return values[key]
        except KeyError:
            value = values[key] = function(key)
            return value

    return value_of
