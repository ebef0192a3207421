# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Documents tell what to install, name files that exist, and list what the code has."""

import ast
from pathlib import Path
import re

from physsim_ros.files import world_schema
from physsim_ros.model import checks
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JOINT_KEYS, JointKind, JointProperties
from physsim_ros.model.names import LONGEST_NAME
from physsim_ros.model.robots.drives import DRIVES
from physsim_ros.model.robots.robot import Odometry, Robot
from physsim_ros.model.robots.sensors import SENSORS
from physsim_ros.model.shapes import LARGEST, MOST_POINTS
import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / 'docs'


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
    text = (DOCS / 'installation.md').read_text(encoding='utf-8')
    (line,) = re.findall(r"^pip install ('numpy.*)$", text, re.MULTILINE)

    # rosdep's is recent enough.
    known = {'PyYAML'}
    assert {word.strip("'") for word in line.split()} == set(asked) - known


DOCUMENTS = [
    path
    for path in (ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted(DOCS.rglob('*.md')))
    if '_build' not in path.parts
]
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
def test_every_link_of_a_document_to_a_file_leads_somewhere(document):
    targets = re.findall(r'\]\((?!https?://)([^)#\s]+)', document.read_text(encoding='utf-8'))

    assert [each for each in targets if not (document.parent / each).exists()] == []


@pytest.mark.linter
def test_the_architecture_names_every_folder_of_the_package():
    named = _named_paths((DOCS / 'architecture.md').read_text(encoding='utf-8'))
    package = ROOT / 'physsim_ros'
    folders = {f'{path.parent.relative_to(package)}/' for path in package.rglob('*/__init__.py')}

    assert sorted(folders - named) == []


@pytest.mark.linter
def test_the_readme_is_read_in_five_minutes():
    assert len((ROOT / 'README.md').read_text(encoding='utf-8').splitlines()) <= 120


@pytest.mark.linter
def test_the_changelog_begins_with_the_version_of_the_package():
    titles = re.findall(r'^(.*)\n-+$', (ROOT / 'CHANGELOG.rst').read_text('utf-8'), re.MULTILINE)
    (version,) = re.findall('<version>(.*)</version>', (ROOT / 'package.xml').read_text('utf-8'))

    newest = next(title for title in titles if title != 'Forthcoming')
    assert newest.split()[0] == version
    assert f"version='{version}'" in (ROOT / 'setup.py').read_text('utf-8')


@pytest.mark.linter
def test_every_page_is_in_a_table_of_contents():
    listed = set()
    for index in DOCS.rglob('index.md'):
        for block in re.findall(r'```{toctree}\n(.*?)```', index.read_text('utf-8'), re.DOTALL):
            words = [word for word in block.splitlines() if word and not word.startswith(':')]
            listed |= {path for word in words for path in index.parent.glob(f'{word}.md')}

    pages = {path for path in DOCUMENTS if path.is_relative_to(DOCS)}
    assert pages - listed == {DOCS / 'index.md'}


def _section(heading):
    """Return the text of the interface below a heading, to the next one."""
    _, _, text = (DOCS / 'interface.md').read_text(encoding='utf-8').partition(heading)
    return text.partition('\n#')[0]


@pytest.mark.linter
def test_the_table_of_parameters_is_that_of_the_node():
    parameters = pytest.importorskip('physsim_ros.ros.parameters', reason='there is no ROS')

    def row(name, spec):
        default = str(spec.default).lower() if isinstance(spec.default, bool) else spec.default
        span = '' if spec.low is None else f'{spec.low:g} .. {spec.high:g}'
        choices = ', '.join(f'`{each}`' for each in spec.choices)
        known = '; '.join(filter(None, (span, choices, 'read-only' * spec.read_only)))
        return f'| `{name}` | {"" if default == "" else f"`{default}`"} | {known} |'

    table = _section('\n## Parameters\n')
    rows = [re.sub(r'[^|]*\|$', '', line) for line in table.splitlines() if line[:3] == '| `']
    assert sorted(rows) == sorted(row(*each) for each in parameters.SPECS.items())


@pytest.mark.linter
def test_the_table_of_codes_has_every_refusal():
    def codes(kind):
        return {kind.code}.union(*(codes(each) for each in kind.__subclasses__()))

    answers = _section('\n### Answers\n')
    missing = {code for code in codes(Refusal) if f'`{code}`' not in answers}
    assert missing <= {Refusal.code}


@pytest.mark.linter
def test_the_table_of_world_files_has_every_key():
    joint = {*world_schema.OWN_JOINT_KEYS, *JOINT_KEYS} - {*JointProperties.__slots__}
    rows = re.findall(r'^\| (\w+) \| (`.*?) \|', _section('\n## World files\n'), re.MULTILINE)

    for of, keys in {
        'world': world_schema.WORLD_KEYS,
        'body': world_schema.BODY_KEYS,
        'joint': joint,
    }.items():
        told = [key for each, said in rows if each == of for key in said.split(', ')]
        assert sorted(told) == sorted(f'`{key}`' for key in keys)


@pytest.mark.linter
def test_the_table_of_joints_has_every_kind_with_its_points_and_properties():
    table = _section('\n### A joint from a marker\n')
    rows = re.findall(r'^\| `(\w+)` \| (\d) \| (.*) \|$', table, re.MULTILINE)

    told = {kind: (int(points), {*re.findall('`([a-z_]+)`', text)}) for kind, points, text in rows}
    assert told.keys() == {*JointKind}
    for kind in JointKind:
        points, words = told[kind]
        assert points == kind.points
        assert words - {'a', 'b'} == {*kind.schema.own}


@pytest.mark.linter
def test_the_tables_of_robots_have_every_key_of_drives_odometry_and_sensors():
    def keys_of(heading):
        rows = re.findall(
            r'^\| `?(\w+)`? \| ((?:`\w+`(?:, )?)+) \|', _section(heading), re.MULTILINE
        )
        told = {}
        for of, keys in rows:
            told.setdefault(of, []).extend(re.findall(r'\w+', keys))
        return told

    drives = {key for each in DRIVES.values() for key in each.CHECKS}
    assert {of: sorted(keys) for of, keys in keys_of('\n### Robots\n').items()} == {
        'robot': sorted(Robot.CHECKS),
        'drive': sorted({'kind', *drives}),
        'odometry': sorted(Odometry.CHECKS),
    }
    # The key of the mount, `at`, is in the text, for all kinds.
    assert {of: sorted(keys) for of, keys in keys_of('\n### Sensors of a robot\n').items()} == {
        kind: sorted({*each.CHECKS} - {'at'}) for kind, each in SENSORS.items()
    }


@pytest.mark.linter
def test_the_limits_of_values_are_those_of_the_code():
    def exponent(value):
        return re.sub(r'e(-?)\+?0*', r'e\1', f'{value:.0e}')

    rows = dict(
        re.findall(r'^\| (.*?) \| (.*) \|$', _section('\n### Limits of values\n'), re.MULTILINE)
    )
    for what, numbers in {
        'points of a shape, centres of a compound': [f'{MOST_POINTS:,}'],
        'position, yaw': [f'{exponent(checks.FARTHEST)} m', f'{exponent(checks.FARTHEST)} rad'],
        'mass, density': [f'{exponent(checks.LIGHTEST)} .. {exponent(checks.HEAVIEST)} kg'],
        'velocity, spin': [f'{exponent(checks.FASTEST)} m/s', f'{exponent(checks.FASTEST)} rad/s'],
        'force, torque; of a joint also stiffness, damping': [exponent(checks.HEAVIEST)],
        '`lifetime`': [f'{exponent(checks.LONGEST)} s'],
        '`lower`, `upper`; `length`, `rest_length`': [exponent(LARGEST)],
        'a name': [f'{LONGEST_NAME:,} printable'],
    }.items():
        assert [number for number in numbers if number not in rows[what]] == []
