# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lessons in world files: how they are found, and how bad ones are refused."""

from contextlib import suppress
from pathlib import Path

from hypothesis import example, given
from hypothesis import strategies as st
from physsim_ros.files import (
    find_world,
    load_mapping,
    load_world,
    shipped_lessons,
    state_from,
    text_of,
    user_lessons,
)
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadProperty, BadWorldFile
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.settings import WorldSettings
import pytest

from .world_files import write

GOOD = {
    'number': '11',
    'title': 'Mine',
    'question': 'How far?',
    'hint': 'Look.',
    'measure': 'The way',
    'unit': 'm',
    'figure': '2',
    'within': '0.1',
    'answer': 'Two metres.',
}


def text(**changes: str) -> str:
    """Return the text of a lesson; a value of '' leaves a key out."""
    entry = {key: value for key, value in (GOOD | changes).items() if value}
    lines = ''.join(f'  {key}: {value}\n' for key, value in entry.items())
    return f'format: 1\nlesson:\n{lines}bodies: []\n'


def test_a_teacher_writes_a_lesson_in_a_file_and_finds_it_by_its_name(folder: Path) -> None:
    directory = user_lessons(folder)
    directory.mkdir()
    write(directory, text(), 'mine.yaml')

    path = find_world('mine', world_dir=folder, confined=True)
    lesson = load_world(path).lesson

    assert path == directory / 'mine.yaml'
    assert lesson is not None
    assert (lesson.title, lesson.figure, lesson.unit) == ('Mine', 2.0, 'm')


def test_shipped_lessons_are_found_by_their_names(folder: Path) -> None:
    found = find_world('free_fall', world_dir=folder, confined=True)

    assert found == shipped_lessons() / 'free_fall.yaml'


@pytest.mark.parametrize(
    ('changes', 'brief', 'reason'),
    [
        ({'figure': 'two'}, 'w.yaml, line 9, figure: bad_property', "a number, not 'two'"),
        ({'figure': '.nan'}, 'w.yaml, line 9, figure: malformed', 'finite'),
        ({'within': '-1'}, 'w.yaml, line 10, within: bad_property', 'between 0 and'),
        ({'title': '7'}, 'w.yaml, line 4, title: bad_property', 'must be text, not 7'),
        ({'title': '"  "'}, 'w.yaml, line 4, title: bad_property', '1 to 80 characters'),
        ({'hint': 'x' * 2001}, 'w.yaml, line 6, hint: bad_property', '1 to 2000 characters'),
        ({'number': '0'}, 'w.yaml, line 3, number: bad_property', 'whole number'),
        ({'answer': ''}, 'w.yaml, line 2, lesson: bad_property', 'answer is missing'),
        ({'questoin': 'Why?'}, 'w.yaml, line 12: unknown_property', 'question'),
    ],
)
def test_a_bad_lesson_is_refused_with_its_place_and_a_reason(
    folder: Path, changes: dict[str, str], brief: str, reason: str
) -> None:
    with pytest.raises(BadWorldFile) as refused:
        load_world(write(folder, text(**changes)))

    assert refused.value.brief == brief
    assert reason in str(refused.value)


@given(words=st.text(st.characters(), min_size=1))
@example(words='\ud800')
@example(words='one\ntwo')
def test_any_lesson_that_there_is_is_read_as_it_was_written(words: str) -> None:
    numbers = {'number': 1, 'figure': 1.0, 'within': 0.1}
    texts = {key: words for key in GOOD if key not in numbers and key != 'unit'}
    with suppress(BadProperty):
        lesson = Lesson(**numbers, **texts, unit='m')
        state = WorldState(settings=WorldSettings(), lesson=lesson)
        content = load_mapping(text_of(state, 240.0), field='text')
        assert state_from(content, state.settings, 240.0).lesson == lesson
