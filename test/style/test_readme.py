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

"""The README tells what to install, and documents name files that exist."""

import ast
from pathlib import Path
import re

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / 'README.md').read_text(encoding='utf-8')


@pytest.mark.linter
def test_what_pip_is_to_bring_is_what_the_package_asks_for():
    tree = ast.parse((ROOT / 'setup.py').read_text(encoding='utf-8'))
    (asked,) = (
        ast.literal_eval(keyword.value)
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        for keyword in call.keywords
        if keyword.arg == 'install_requires'
    )
    (line,) = re.findall(r'^pip install (.*)$', README, re.MULTILINE)

    # rosdep knows these two.
    known = {'PyYAML', 'tornado>=6.4,<7'}
    assert {word.strip("'") for word in line.split()} == set(asked) - known


DOCUMENTS = [ROOT / 'README.md', *sorted((ROOT / 'docs').rglob('*.md'))]
# Paths in documents begin at the repository or at the package.
BASES = [ROOT, ROOT / 'physsim_ros']


def _named_paths(text):
    """Return the paths in backticks that begin with a known folder; fenced blocks do not count."""
    inline = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    words = {word for span in re.findall(r'`([^`\n]+)`', inline) for word in span.split()}
    folders = {path.name for base in BASES for path in base.iterdir() if path.is_dir()}
    paths = {word for word in words if re.fullmatch(r'[\w.-]+(/[\w.-]*)+', word)}
    return {path for path in paths if path.endswith('.py') or path.split('/')[0] in folders}


@pytest.mark.linter
@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_every_path_in_a_document_exists(document):
    named = _named_paths(document.read_text(encoding='utf-8'))

    assert [path for path in sorted(named) if not any((it / path).exists() for it in BASES)] == []


@pytest.mark.linter
@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_every_link_of_a_document_to_a_file_leads_somewhere(document):
    targets = re.findall(r'\]\((?!https?://)([^)#\s]+)', document.read_text(encoding='utf-8'))

    assert [each for each in targets if not (document.parent / each).exists()] == []


@pytest.mark.linter
def test_the_architecture_names_every_folder_of_the_package():
    named = _named_paths((ROOT / 'docs' / 'architecture.md').read_text(encoding='utf-8'))
    package = ROOT / 'physsim_ros'
    folders = {f'{path.parent.relative_to(package)}/' for path in package.rglob('*/__init__.py')}

    assert sorted(folders - named) == []
