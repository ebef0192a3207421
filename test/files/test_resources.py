# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files have a title for the help: their first sentence, or their name."""

from pathlib import Path

from physsim_ros.files import title_of
import pytest

from .world_files import write


@pytest.mark.parametrize(
    ('text', 'title'),
    [
        ('# A pendulum,\n# swung. And more.\nformat: 1', 'A pendulum, swung'),
        ('format: 1', 'own'),
        ('# .\n', 'own'),
        ('', 'own'),
    ],
)
def test_a_title_is_the_first_sentence_of_a_file_or_its_name(
    folder: Path, text: str, title: str
) -> None:
    assert title_of(write(folder, text, 'own.yaml')) == title


def test_the_title_of_a_file_that_cannot_be_read_is_its_name(folder: Path) -> None:
    (folder / 'own.yaml').symlink_to('own.yaml')

    assert title_of(folder / 'own.yaml') == 'own'
