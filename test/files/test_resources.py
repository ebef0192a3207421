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

"""Files have a title for the help: their first sentence, or their name."""

from pathlib import Path

from physsim_ros.files import title_of
import pytest

from .world_files import write


@pytest.mark.parametrize(
    ('text', 'title'),
    [
        ('# A pendulum,\n# swung. And more.\nformat: 1', 'A pendulum, swung'),
        ('<!-- A car. -->', 'A car'),
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
