# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Texts in English that pages show in the language of their reader.

The English template is the key of its translations, as for GNU gettext; these are in
`sketchpad/page/languages/`, below `server`.
"""

from __future__ import annotations

from typing import Any, Self


class Text(str):
    """
    A text in English, and the template and the values that it is made of.

    ROS, logs and files have the English text; a page translates the template, and those values
    that are texts themselves (cf. `Message` of zope.i18nmessageid).

    :param template: for `str.format`, with the names of its values in braces
    :param values: names of bodies, worlds and people, numbers, further texts

    :ivar template: the template
    :ivar values: by their names
    """

    __slots__ = ('template', 'values')

    template: str
    values: dict[str, Any]

    def __new__(cls, template: str, /, **values: Any) -> Self:
        """Return the text of a template and its values."""
        return cls._of(template.format(**values), template, values)

    @classmethod
    def _of(cls, english: str, template: str, values: dict[str, Any]) -> Self:
        text = super().__new__(cls, english)
        text.template, text.values = template, values
        return text

    def with_english(self, english: str) -> Self:
        """Return a text that is translated like this one, but reads otherwise in English."""
        return self._of(english, self.template, self.values)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how it is copied: `str` would take its English for the template."""
        return self._of, (str(self), self.template, self.values)


# The message where there is none.
NOTHING = Text('')


def verbatim(message: str) -> Text:
    """Return a message that pages show as it is: it comes from elsewhere, as from rclpy."""
    return Text('{message}', message=message)


def counted(number: int, noun: str) -> Text:
    """Return a number and its noun: 1 body, 2 bodies."""
    if number == 1:
        return Text(f'1 {noun}')
    return Text(
        f'{{count}} {noun[:-1]}ies' if noun.endswith('y') else f'{{count}} {noun}s', count=number
    )
