# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Documents tell what to install, name files that exist, and list what the code has."""

import ast
import importlib
import re

from physsim_ros.files import world_schema
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JOINT_KEYS, JointProperties
from physsim_ros.model.robots.sensors import SENSORS
import pytest
from tools.tables import cheat_sheet, search_words

from .sources import DOCS, DOCUMENTS, PACKAGE, ROOT, spans

pytestmark = pytest.mark.linter


def test_what_pip_is_to_bring_is_what_the_package_asks_for():
    tree = ast.parse((ROOT / 'setup.py').read_text(encoding='utf-8'))
    (always,) = (
        ast.literal_eval(keyword.value)
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        for keyword in call.keywords
        if keyword.arg == 'install_requires'
    )
    (viewer,) = (
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == 'VIEWER'
    )
    text = (DOCS / 'installation.md').read_text(encoding='utf-8')
    (line,) = re.findall(r"^pip install ('numpy.*)$", text, re.MULTILINE)

    # rosdep's is recent enough.
    known = {'PyYAML'}
    assert {word.strip("'") for word in line.split()} == {*always, *viewer} - known


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_every_link_of_a_document_leads_to_a_file_and_a_heading(document):
    links = re.findall(
        r'\]\((?!https?://)([^)#\s]*)(?:#([\w-]+))?\)', document.read_text(encoding='utf-8')
    )

    for target, anchor in links:
        path = document.parent / target if target else document
        assert path.exists(), target
        assert not anchor or anchor in _anchors(path), f'{target}#{anchor}'


def _anchors(document):
    """Return the names by which links lead to the headings of a document, as GitHub makes them."""
    headings = re.findall(r'^#+ (.*)$', document.read_text(encoding='utf-8'), re.MULTILINE)
    return {re.sub(r'[^\w -]', '', heading.lower()).replace(' ', '-') for heading in headings}


def test_the_architecture_names_every_folder_of_the_package():
    named = set(' '.join(spans((DOCS / 'architecture.md').read_text(encoding='utf-8'))).split())
    folders = {f'{path.parent.relative_to(PACKAGE)}/' for path in PACKAGE.rglob('*/__init__.py')}

    assert sorted(folders - named) == []


def test_the_readme_is_read_in_five_minutes():
    assert len((ROOT / 'README.md').read_text(encoding='utf-8').splitlines()) <= 120


def test_the_changelog_begins_with_the_version_of_the_package():
    titles = re.findall(r'^(.*)\n-+$', (ROOT / 'CHANGELOG.rst').read_text('utf-8'), re.MULTILINE)
    (version,) = re.findall('<version>(.*)</version>', (ROOT / 'package.xml').read_text('utf-8'))

    newest = next(title for title in titles if title != 'Forthcoming')
    assert newest.split()[0] == version
    assert f"version='{version}'" in (ROOT / 'setup.py').read_text('utf-8')


def test_every_page_is_in_a_table_of_contents():
    listed = set()
    for index in DOCS.rglob('index.md'):
        for block in re.findall(r'```{toctree}\n(.*?)```', index.read_text('utf-8'), re.DOTALL):
            words = [word for word in block.splitlines() if word and not word.startswith(':')]
            listed |= {path for word in words for path in index.parent.glob(f'{word}.md')}

    pages = {path for path in DOCUMENTS if path.is_relative_to(DOCS)}
    assert pages - listed == {DOCS / 'index.md'}


def _section(page, heading):
    """Return the text of a page of the interface below a heading, to the next one."""
    text = (DOCS / 'interface' / f'{page}.md').read_text(encoding='utf-8')
    return text.partition(f'{heading}\n')[2].partition('\n#')[0]


def test_what_repeats_declarations_is_as_they_are():
    pytest.importorskip('physsim_ros.ros.parameters', reason='there is no ROS')
    documents = importlib.import_module('tools.tables.documents')

    # `make tables` writes them.
    for path, text in documents.files().items():
        assert path.read_text(encoding='utf-8') == text, path


def test_the_cheat_sheet_has_every_stroke_and_tool_of_the_page():
    strokes, tools = (
        (cheat_sheet.PAGE / name).read_text('utf-8')
        for name in ('ui/strokes.js', 'tools/tools.js')
    )

    assert len(cheat_sheet.strokes()) == strokes.count('\n  [t(')
    assert len(cheat_sheet.keys()['Tools']) == tools.count('\n  tool(')
    assert all(cheat_sheet.keys().values())


def test_a_key_of_the_page_does_one_thing():
    groups = cheat_sheet.keys().values()
    rows = [shown for group in groups for shown, _ in group if not shown.startswith('Ctrl+')]
    keys = [key for shown in rows for key in re.split(r', (?=.)', shown)]
    single = [key for key in keys if re.fullmatch(r'(Shift\+)?.', key)]

    assert len(single) == len(set(single)), single


def test_words_of_the_search_lead_to_pages_and_headings_that_are_there():
    for page, heading in search_words.WORDS:
        text = (DOCS / f'{page}.md').read_text('utf-8')

        assert not heading or f'\n## {heading}\n' in text
        assert search_words.with_entries(page, text).count('```{index}') >= 1


def test_the_table_of_codes_has_every_refusal():
    def codes(kind):
        return {kind.code}.union(*(codes(each) for each in kind.__subclasses__()))

    answers = _section('codes', '## Codes')
    missing = {code for code in codes(Refusal) if f'`{code}`' not in answers}
    assert missing <= {Refusal.code}


def test_the_table_of_world_files_has_every_key():
    joint = {*world_schema.OWN_JOINT_KEYS, *JOINT_KEYS} - {*JointProperties.__slots__}
    rows = re.findall(
        r'^\| (\w+) \| (`.*?) \|', _section('world_files', '# World files'), re.MULTILINE
    )

    for of, keys in {
        'world': world_schema.WORLD_KEYS,
        'body': world_schema.BODY_KEYS,
        'joint': joint,
    }.items():
        told = [key for each, said in rows if each == of for key in said.split(', ')]
        assert sorted(told) == sorted(f'`{key}`' for key in keys)


def test_the_table_of_topics_of_robots_has_the_message_of_every_sensor():
    messages = pytest.importorskip('physsim_ros.ros.robots.messages', reason='there is no ROS')
    text = (DOCS / 'robots.md').read_text('utf-8')

    assert messages.SENSOR_MESSAGES.keys() == {*SENSORS.values()}
    for reading in messages.SENSOR_MESSAGES.values():
        package, name = reading.kind.__module__.partition('.')[0], reading.kind.__name__
        assert re.search(rf'^\| .* \| `{package}/{name}` \|', text, re.MULTILINE), name


def test_the_address_of_the_project_is_written_in_its_manifest_alone():
    manifest = (ROOT / 'package.xml').read_text('utf-8')
    hosts = re.findall('(?:<url type="repository">https://|email="[^@]*@)([^/"]+)', manifest)
    texts = [ROOT / 'setup.py', ROOT / 'CITATION.cff', ROOT / 'SECURITY.md', *DOCUMENTS]
    texts += [*(ROOT / '.github').rglob('*.y*ml')]

    assert hosts
    assert [path for path in texts for host in hosts if host in path.read_text('utf-8')] == []


def test_the_topics_and_services_that_documents_name_are_those_of_the_node():
    # test/ros/test_security.py compares the policy with the node.
    policy = (ROOT / 'config' / 'sros2' / 'policy.xml').read_text('utf-8')
    known = set(re.findall(r'<(?:topic|service)>~/(.*?)<', policy))
    named = {
        name
        for path in DOCUMENTS
        for name in re.findall(r'`~/([\w/]+\w)`', path.read_text('utf-8'))
    }

    assert {name for name in named - known if not name.startswith('simulation/')} == set()
