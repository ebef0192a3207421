# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Texts in English that keep the template and the values that they are made of."""

from __future__ import annotations

from copy import deepcopy

from physsim_ros.model.errors import BadProperty
from physsim_ros.model.translation import counted, Text
from physsim_ros.sketchpad.message import text_content


def test_a_text_is_its_english_also_where_it_is_a_value() -> None:
    inner = Text('move {bodies}', bodies=counted(2, 'body'))
    text = Text('undid {gesture}, back at {time:.1f} s', gesture=inner, time=1)
    assert text == 'undid move 2 bodies, back at 1.0 s'
    bodies = ['{count} bodies', {'count': '2'}]
    values = {'gesture': ['move {bodies}', {'bodies': bodies}], 'time': '1.0'}
    assert text_content(text) == [text.template, values]
    assert text_content('plain {text}') == ['plain {text}', {}]


def test_a_copy_of_a_text_has_its_template_and_values() -> None:
    text = Text('{a} and {b!r}', a='{b}', b='{')
    other = deepcopy(text)
    assert other == text == "{b} and '{'"
    assert text_content(other) == text_content(text)


def test_a_refusal_shortens_its_english_and_what_pages_get() -> None:
    refusal = BadProperty(Text('there is no {name}', name='x' * 1000))
    assert len(str(refusal)) < 100
    template, values = text_content(refusal.text)
    assert (template, len(values['name'])) == ('there is no {name}', 79)
