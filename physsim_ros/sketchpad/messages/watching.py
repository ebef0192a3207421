# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages that change nothing: which parts of frames a page gets, and the past of a body."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.checks import flag
from physsim_ros.sketchpad.frame_codec import Show
from physsim_ros.sketchpad.messages.fields import Fields, Readers, text_of

_PARTS = {'velocities': Show.VELOCITIES, 'contacts': Show.CONTACTS, 'forces': Show.FORCES}


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """
    Ask for the past of a body, as far as it was shown.

    :param name: of the body; '' is none
    """

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowParts:
    """Choose the parts of a frame that this page gets."""

    show: Show


def _watch(fields: Fields) -> Watch:
    return Watch(name=text_of(fields.get('name'), 'name'))


def _show(fields: Fields) -> ShowParts:
    show = Show.POSES
    for name, part in _PARTS.items():
        if flag(fields.get(name, False), name):
            show |= part
    return ShowParts(show=show)


READERS: Readers = {
    'watch': (['name'], _watch),
    'show': (list(_PARTS), _show),
}
