# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The package as others get it: installed by pip, and built, run and tested by colcon.

Everything happens in a copy of the source tree below pytest's temporary directory.
"""

import ast
from contextlib import contextmanager
from importlib.metadata import Distribution, version
from importlib.util import find_spec
import os
from pathlib import Path
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
from xml.etree import ElementTree as ET

from packaging.requirements import Requirement
from packaging.version import Version
import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
CONFIG = sorted(path.relative_to(ROOT) for path in ROOT.glob('config/**/*.*'))

# Left out of the copy: what was built, and what a clone does not have.
NOT_SOURCE = shutil.ignore_patterns(
    '.*', '__pycache__', '*.egg-info', 'build', 'install', 'log', 'dist'
)

# Many times what each takes here, on a machine that is busy with other tests, in seconds.
BUILD = 200
TEST = 200
READY = 100
EXIT = 60


def _run(*command, **options):
    """Run a command to its end; what it printed is the message where it fails."""
    done = subprocess.run(  # noqa: PLW1510  the assertion below says more than check would
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    assert done.returncode == 0, f'{command}\n{done.stdout}'
    return done.stdout


@pytest.fixture(scope='module')
def workspace(tmp_path_factory):
    """Lay out a colcon workspace with this package in it as source."""
    workspace = tmp_path_factory.mktemp('workspace')
    shutil.copytree(ROOT, workspace / 'src' / 'physsim_ros', ignore=NOT_SOURCE)
    return workspace


@pytest.fixture(scope='module')
def colcon():
    """Find the colcon of this interpreter's environment, else the one on the path."""
    beside = Path(sys.executable).parent
    found = shutil.which('colcon', path=f'{beside}{os.pathsep}{os.environ["PATH"]}')
    assert found is not None, 'colcon is not installed'
    return found


@pytest.fixture(scope='module')
def overlay(workspace, colcon):
    """Build the workspace; give the environment that its local_setup leaves."""
    _run(colcon, 'build', cwd=workspace, timeout=BUILD)
    # The plain sh file cannot find out where it lies.
    printed = _run(
        'sh',
        '-c',
        '. "$COLCON_CURRENT_PREFIX/local_setup.sh" && env -0',
        env={**os.environ, 'COLCON_CURRENT_PREFIX': str(workspace / 'install')},
        timeout=BUILD,
    )
    return dict(line.split('=', 1) for line in printed.split('\0') if line)


@contextmanager
def _running(*command, **options):
    """Start a program; its lines come through the queue, then None. Killed if still there."""
    lines = queue.SimpleQueue()

    def read():
        for line in process.stdout:
            lines.put(line)
        lines.put(None)

    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    ) as process:
        reader = threading.Thread(target=read, daemon=True)
        reader.start()
        try:
            yield process, lines
        finally:
            process.kill()
            reader.join()


def _wait_for(word, lines, timeout):
    """Return the first line with that word; fail with all lines until then."""
    seen = []
    deadline = time.monotonic() + timeout
    while not seen or word not in seen[-1]:
        try:
            line = lines.get(timeout=max(deadline - time.monotonic(), 0))
        except queue.Empty:
            pytest.fail(f'no {word!r} within {timeout} s of:\n{"".join(seen)}')
        if line is None:
            pytest.fail(f'ended without {word!r}:\n{"".join(seen)}')
        seen.append(line)
    return seen[-1]


def _manifest():
    return ET.parse(ROOT / 'package.xml').getroot()  # noqa: S314  our own file


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """Let pip install a copy into a tree of its own, and no dependencies."""
    if find_spec('wheel') is None and Version(version('setuptools')) < Version('70.1'):
        pytest.skip('pip cannot build a wheel: it takes setuptools 70.1, or wheel')
    source = tmp_path_factory.mktemp('source') / 'physsim_ros'
    shutil.copytree(ROOT, source, ignore=NOT_SOURCE)
    prefix = tmp_path_factory.mktemp('prefix')
    offline = ['--no-index', '--no-deps', '--no-build-isolation']
    pip = [sys.executable, '-m', 'pip', '--disable-pip-version-check', 'install']
    _run(*pip, *offline, '--ignore-installed', '--prefix', prefix, source, timeout=BUILD)
    return prefix


@pytest.fixture(scope='module')
def distribution(installed):
    (info,) = installed.glob('**/*.dist-info')
    return Distribution.at(info)


def test_pip_installs_the_executable_and_the_pytest_plugin(installed, distribution):
    points = {(point.group, point.name, point.value) for point in distribution.entry_points}

    assert points == {
        ('console_scripts', 'physsim', 'physsim_ros.ros.programs.physsim:main'),
        (
            'console_scripts',
            'physsim_class',
            'physsim_ros.ros.programs.physsim_class:main',
        ),
        ('console_scripts', 'physsim_draw', 'physsim_ros.ros.programs.physsim_draw:main'),
        ('pytest11', 'physsim', 'physsim_ros.testing.plugin'),
    }
    for program in ('physsim', 'physsim_draw'):
        assert (installed / 'bin' / program).is_file()


def test_pip_is_told_what_rosdep_cannot_bring(distribution):
    requirements = [Requirement(text) for text in distribution.requires]
    always = {each.name.lower(): each.specifier for each in requirements if each.marker is None}
    extras = {str(each.marker) for each in requirements if each.marker is not None}

    named = {
        'cffi',
        'numpy',
        'pillow',
        'pyarrow',
        'pymunk',
        'pyyaml',
        'rerun-sdk',
        'scipy',
        'svgelements',
        'tornado',
    }
    assert set(always) == named
    assert '1.26.4' not in always['numpy']
    assert '8.0.0' not in always['pymunk']
    assert extras == {'extra == "class"', 'extra == "docs"', 'extra == "jazzy"', 'extra == "test"'}


def test_the_wheels_of_ros_come_with_their_middleware(distribution):
    jazzy = {
        requirement.name: requirement.extras
        for requirement in map(Requirement, distribution.requires)
        if str(requirement.marker) == 'extra == "jazzy"'
    }

    assert jazzy == {'ros-jazzy-common-interfaces': set(), 'ros-jazzy-rclpy': {'fastrtps'}}


def test_pip_and_ros_are_told_the_same_version_and_licence(distribution):
    manifest = _manifest()

    assert distribution.version == manifest.findtext('version')
    assert manifest.findtext('license') == 'Apache-2.0'
    assert 'Apache-2.0' in distribution.metadata.get_all('License-Expression', []) + (
        distribution.metadata.get_all('License', [])
    )


def test_pip_installs_every_world_the_manifest_and_the_marker(installed):
    share = installed / 'share'

    missing = [str(path) for path in CONFIG if not (share / 'physsim_ros' / path).is_file()]

    assert missing == []
    assert (share / 'physsim_ros' / 'package.xml').is_file()
    assert (share / 'ament_index/resource_index/packages/physsim_ros').is_file()


# Of the other project: its test asks for the fixture, and names nothing that finds the plugin.
ELSEWHERE = """
def test_a_ball_of_the_shipped_world_is_there(physsim):
    physsim.load('demo')
    physsim.run(0.1)
    assert 'ball/0' in physsim.names
"""
INSTALL = 500


@pytest.fixture(scope='module')
def empty_environment(workspace, tmp_path_factory):
    """Build the wheel, and let pip install it with ROS into an environment that has nothing."""
    dist, environment = tmp_path_factory.mktemp('dist'), tmp_path_factory.mktemp('environment')
    source = workspace / 'src' / 'physsim_ros'
    build = ['wheel', '--no-deps', '--no-build-isolation', '--wheel-dir', dist, source]
    _run(sys.executable, '-m', 'pip', '--disable-pip-version-check', *build, timeout=BUILD)
    (wheel,) = dist.glob('*.whl')
    _run(sys.executable, '-m', 'venv', environment, timeout=BUILD)
    pip = [environment / 'bin' / 'python', '-m', 'pip', '--disable-pip-version-check']
    # All of ROS is of wheels, as in a shell where none is sourced.
    _run(*pip, 'install', f'{wheel}[jazzy]', 'pytest', env=_without_ros(), timeout=INSTALL)
    yield environment
    # 1 GB, which pytest would keep for three runs.
    shutil.rmtree(environment)


def _without_ros():
    """Return the environment of this process less what leads to its ROS."""
    leads = {
        'LD_LIBRARY_PATH',
        'PYTHONPATH',
        'AMENT_PREFIX_PATH',
        '_ROS_WHEELS_BOOTSTRAP_COMPLETE',
    }
    return {name: value for name, value in os.environ.items() if name not in leads}


def test_the_wheel_runs_in_an_empty_environment(empty_environment, tmp_path):
    alone = {
        'ROS_DOMAIN_ID': str(1 + os.getpid() % 101),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_LOG_DIR': str(tmp_path),
    }
    command = [empty_environment / 'bin' / 'physsim', '--ros-args', '-p', 'world_file:=demo']

    with _running(*command, '-p', 'viewer:=none', cwd=tmp_path, env=_without_ros() | alone) as (
        node,
        lines,
    ):
        _wait_for('ready', lines, READY)
        node.send_signal(signal.SIGINT)

        assert node.wait(EXIT) == 0, ''.join(iter(lines.get, None))


def test_the_wheel_is_a_plugin_of_pytest_in_an_empty_environment(empty_environment, tmp_path):
    (tmp_path / 'test_elsewhere.py').write_text(ELSEWHERE)
    pytest_there = [empty_environment / 'bin' / 'python', '-m', 'pytest', '-q', tmp_path]

    assert '1 passed' in _run(*pytest_there, cwd=tmp_path, env=_without_ros(), timeout=TEST)


FOREIGN = """
from physsim_ros.testing import Contact, PhysSim, Refused


def test_of_others(physsim: PhysSim) -> None:
    physsim.load('demo')
    heights: list[float] = [physsim.pose(name).y for name in physsim.names]
    contacts: list[Contact] = physsim.contacts('ball/0')
    code: str = Refused('bad_size', 'it is 0', 'scale.x').code
    assert heights and contacts and code and physsim.context.ok()
"""


@pytest.mark.skipif(find_spec('mypy') is None, reason='mypy is not installed')
def test_tests_of_others_are_checked_by_mypy(installed, tmp_path):
    (site,) = installed.glob('lib/*/site-packages')
    test = tmp_path / 'test_of_others.py'
    check = [sys.executable, '-m', 'mypy', '--strict', '--config-file=', test.name]
    options = {'cwd': tmp_path, 'env': {**os.environ, 'PYTHONPATH': str(site)}, 'timeout': BUILD}

    test.write_text(FOREIGN)
    _run(*check, **options)

    test.write_text(FOREIGN.replace('.y for', '.height for'))
    wrong = subprocess.run(check, capture_output=True, text=True, check=False, **options)
    assert '"Pose" has no attribute "height"' in wrong.stdout


def test_pip_installs_no_tests(installed):
    assert list(installed.glob('lib*/**/test')) == []


def test_the_manifest_names_every_ros_package_that_is_imported():
    declared = {element.text for element in _manifest().iter('exec_depend')}
    imported = set()
    for path in (*ROOT.glob('physsim_ros/**/*.py'), *ROOT.glob('launch/*.py')):
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                imported.add(node.module.split('.')[0])
    of_ros = {
        name
        for name in imported
        if name in {'launch', 'launch_ros', 'rclpy', 'std_srvs'}
        or name.endswith(('_msgs', '_interfaces'))
    }

    others = {name for name in declared if name.startswith('python3-')}
    # For transforms of robots, and for the services of simulators.
    optional = {'tf2_msgs', 'simulation_interfaces'}
    assert of_ros - optional == declared - others


def test_colcon_installs_every_world(workspace, overlay):
    share = Path(overlay['AMENT_PREFIX_PATH'].split(os.pathsep)[0]) / 'share' / 'physsim_ros'

    missing = [str(path) for path in CONFIG if not (share / path).is_file()]

    assert share.is_relative_to(workspace)
    assert missing == []


def test_the_executable_that_colcon_installs_runs_until_interrupted(workspace, overlay, tmp_path):
    executable = workspace / 'install/physsim_ros/lib/physsim_ros/physsim'
    # A domain of its own below 102, where the ports of DDS stay clear of ephemeral ones.
    alone = {
        'ROS_DOMAIN_ID': str(1 + os.getpid() % 101),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_LOG_DIR': str(tmp_path),
    }
    parameters = ['viewer:=none', 'world_file:=demo']
    arguments = [word for parameter in parameters for word in ('-p', parameter)]

    # Elsewhere than in the source tree, so that only what is installed is found.
    with _running(
        executable, '--ros-args', *arguments, cwd=tmp_path, env={**overlay, **alone}
    ) as (node, lines):
        _wait_for('ready', lines, READY)
        node.send_signal(signal.SIGINT)

        code = node.wait(EXIT)

        assert code == 0, ''.join(iter(lines.get, None))


def test_the_overlay_hides_the_source_tree(workspace, overlay, tmp_path):
    program = 'import physsim_ros; print(physsim_ros.__file__)'

    printed = _run(sys.executable, '-c', program, env=overlay, cwd=tmp_path, timeout=READY)

    assert Path(printed.strip()).is_relative_to(workspace / 'install')


# Of each kind one: alone, with the programs in other processes, with the plugin in another pytest.
# None of those here, which would start over.
SUBSET = (
    'test/style/test_xmllint.py::test_the_manifest_keeps_the_rules_of_rep_149',
    'test/ros/test_physsim_draw.py::test_every_stroke_is_drawn_and_its_answers_are_told',
    'test/testing/test_plugin.py::test_a_robot_of_others_is_tested_with_the_same_bits_every_time',
)


@pytest.mark.usefixtures('overlay')
def test_colcon_test_runs_the_tests(workspace, colcon):
    # As in a new shell: colcon itself sets the overlay up, of which the programs are.
    stranger = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}
    command = (colcon, 'test', '--return-code-on-test-failure', '--pytest-args', *SUBSET)

    _run(*command, cwd=workspace, env=stranger, timeout=TEST)

    assert f'{len(SUBSET)} tests, 0 errors, 0 failures, 0 skipped' in _run(
        colcon, 'test-result', '--all', cwd=workspace, timeout=READY
    )
