# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A cache of forms: equal shapes share one.

Law: the cache takes no memory of its own but for a few forms: a form lives as long as a shape of
it does, in the world or in the past, whose budget has it. The last few outlive their shapes, since
a body that is spawned, deleted and spawned again has the same.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable
from functools import wraps
from typing import Any, cast, TypeVar
from weakref import WeakValueDictionary

# Forms that outlive their shapes [1]: at most 6 MB, if each has 1,000 pieces.
MOST_KEPT = 16

_Make = TypeVar('_Make', bound=Callable[..., Any])


def share_forms(make: _Make) -> _Make:
    """Cache the forms that a function makes, by its positional arguments, which are hashable."""
    forms: WeakValueDictionary[Hashable, Any] = WeakValueDictionary()
    kept: deque[Any] = deque(maxlen=MOST_KEPT)

    @wraps(make)
    def form_of(*arguments: Hashable) -> Any:
        form = forms.get(arguments)
        if form is None:
            form = forms[arguments] = make(*arguments)
            kept.append(form)
        return form

    return cast('_Make', form_of)
