# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The package as others get it: packed, installed by pip, and built, run and tested by colcon.

Everything happens in a copy of the source tree below pytest's temporary directory.
"""

from importlib.metadata import Distribution, version
from importlib.util import find_spec
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tarfile
from xml.etree import ElementTree as ET
from zipfile import ZipFile

from packaging.requirements import Requirement
from packaging.tags import sys_tags
from packaging.utils import parse_wheel_filename
from packaging.version import Version
import pytest

from .outside import Program
from .source_tree import copy_source, ROOT, zig_cache
from .worlds.digests import digest_at, scene

pytestmark = pytest.mark.slow

SHIPPED = [
    path.relative_to(ROOT)
    for pattern in ('config/**/*.*', 'examples/*.py')
    for path in sorted(ROOT.glob(pattern))
]

# Many times what each takes here, on a machine that is busy with other tests, in seconds.
BUILD = 300
TEST = 200
READY = 100

PIP = [sys.executable, '-m', 'pip', '--disable-pip-version-check']
OFFLINE = ['--no-index', '--no-deps', '--no-build-isolation']


def _skip_without_wheel():
    if find_spec('wheel') is None and Version(version('setuptools')) < Version('70.1'):
        pytest.skip('pip cannot build a wheel: it takes setuptools 70.1, or wheel')


def _run(*command, **options):
    """Run a command to its end; its output is the message of a failure."""
    done = subprocess.run(  # noqa: PLW1510  the assertion below says more than check would
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    assert done.returncode == 0, f'{command}\n{done.stdout}'
    return done.stdout


@pytest.fixture(scope='module')
def workspace(tmp_path_factory):
    """Lay out a colcon workspace with this package in it as source."""
    workspace = tmp_path_factory.mktemp('workspace')
    copy_source(workspace / 'src' / 'physsim_ros')
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
    """Build the workspace, and return the environment that its local_setup makes."""
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


def _assert_runs_until_interrupted(executable, environment, folder):
    """Start a world by an executable, elsewhere than in the source tree, and interrupt it."""
    alone = {
        # A domain of its own below 102, where the ports of DDS stay clear of ephemeral ones.
        'ROS_DOMAIN_ID': str(1 + os.getpid() % 101),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_LOG_DIR': str(folder),
    }
    words = ['--ros-args', '-p', 'viewer:=none', '-p', 'world_file:=demo']
    with Program(executable, *words, env=environment | alone, cwd=folder) as program:
        program.wait_for('ready', READY)
        assert program.interrupt() == 0, ''.join(program.lines)


def _manifest():
    return ET.parse(ROOT / 'package.xml').getroot()  # noqa: S314  our own file


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """Let pip install a copy into a tree of its own, and no dependencies."""
    _skip_without_wheel()
    source = copy_source(tmp_path_factory.mktemp('source') / 'physsim_ros')
    prefix = tmp_path_factory.mktemp('prefix')
    options = [*OFFLINE, '--ignore-installed', '--prefix', prefix]
    _run(*PIP, 'install', *options, source, timeout=BUILD)
    return prefix


@pytest.fixture(scope='module')
def distribution(installed):
    (info,) = installed.glob('**/*.dist-info')
    return Distribution.at(info)


def test_pip_is_told_what_rosdep_cannot_bring(distribution):
    requirements = [Requirement(text) for text in distribution.requires]
    always = {each.name.lower(): each.specifier for each in requirements if each.marker is None}
    extras = {str(each.marker) for each in requirements if each.marker is not None}

    named = {
        'cffi',
        'numpy',
        'pillow',
        'pymunk',
        'pyyaml',
        'tornado',
    }
    assert set(always) == named
    assert '1.26.4' not in always['numpy']
    assert '8.0.0' not in always['pymunk']
    names = ('class', 'docs', 'gym', 'jazzy', 'test', 'viewer')
    assert extras == {f'extra == "{name}"' for name in names}


def test_pip_and_ros_are_told_the_same_version_and_licence(distribution):
    manifest = _manifest()

    assert distribution.version == manifest.findtext('version')
    assert manifest.findtext('license') == 'Apache-2.0'
    assert 'Apache-2.0' in distribution.metadata.get_all('License-Expression', []) + (
        distribution.metadata.get_all('License', [])
    )


def test_pip_installs_every_world_and_example_the_manifest_and_the_marker(installed):
    share = installed / 'share'

    missing = [str(path) for path in SHIPPED if not (share / 'physsim_ros' / path).is_file()]

    assert missing == []
    assert (share / 'physsim_ros' / 'package.xml').is_file()
    assert (share / 'ament_index/resource_index/packages/physsim_ros').is_file()


# The packed distributions


@pytest.fixture(scope='module')
def packed(tmp_path_factory):
    """Let setuptools make a source distribution, and pip a wheel of it."""
    _skip_without_wheel()
    source = copy_source(tmp_path_factory.mktemp('packed') / 'physsim_ros')
    dist = source / 'dist'
    _run(sys.executable, 'setup.py', '--quiet', 'sdist', cwd=source, timeout=BUILD)
    (archive,) = dist.glob('*.tar.gz')
    _run(*PIP, 'wheel', *OFFLINE, '--wheel-dir', dist, archive, timeout=BUILD)
    (wheel,) = dist.glob('*.whl')
    return archive, wheel


def _sources_of_the_core():
    return {path.name for path in ROOT.glob('physsim_ros/engine/core/*.[ch]')}


def test_the_source_distribution_has_what_builds_the_package_and_no_tests(packed):
    with tarfile.open(packed[0]) as archive:
        names = {name.partition('/')[2] for name in archive.getnames()}

    assert {'README.md', 'LICENSE', 'NOTICE', 'package.xml', 'pyproject.toml', 'setup.py'} <= names
    assert {path.relative_to(ROOT).as_posix() for path in ROOT.glob('tools/build/*.py')} <= names
    assert _sources_of_the_core() <= {Path(name).name for name in names}
    assert not [name for name in names if name.startswith('test/') or name.endswith('.so')]
    assert not [name for name in names if Path(name).name == '_declarations.py']


def test_the_wheel_of_the_source_distribution_has_the_core_and_its_declarations(packed):
    with ZipFile(packed[1]) as wheel:
        names = {Path(name) for name in wheel.namelist()}

    core = {path.name for path in names if path.match('physsim_ros/engine/core/*')}
    assert core == {'__init__.py', '_core.abi3.so', '_declarations.py', 'sources.py'}
    assert not [path for path in names if path.suffix == '.c']


def test_the_wheel_serves_this_python_and_all_later_ones_on_this_machine(packed):
    *_, tags = parse_wheel_filename(packed[1].name)

    (tag,) = tags
    assert (tag.interpreter, tag.abi) == ('cp311', 'abi3')
    assert tag.platform.startswith('linux_')
    assert tag in set(sys_tags())


@pytest.fixture(scope='module')
def released(tmp_path_factory):
    """Let the script of the workflow build the wheel that is released."""
    if find_spec('ziglang') is None:
        pytest.skip('ziglang is not installed')
    source = copy_source(tmp_path_factory.mktemp('released') / 'physsim_ros')
    script = source / 'tools/build/released_wheel.py'
    _run(sys.executable, script, env=os.environ | zig_cache(tmp_path_factory), timeout=BUILD)
    (wheel,) = source.glob('dist/*.whl')
    return wheel


def test_the_released_wheel_asks_for_no_newer_c_library_than_its_tag_says(released, tmp_path):
    *_, tags = parse_wheel_filename(released.name)
    (platform,) = {tag.platform for tag in tags}
    with ZipFile(released) as wheel:
        core = Path(wheel.extract('physsim_ros/engine/core/_core.abi3.so', tmp_path))

    wanted = {int(minor) for minor in re.findall(rb'GLIBC_2\.(\d+)', core.read_bytes())}

    promised = int(re.match(r'manylinux_2_(\d+)_', platform)[1])
    assert 0 < max(wanted) <= promised


# Prints where the package is, and the digest of a shipped world after a second.
STEPPED = """
from physsim_ros.files import find_world, load_world
from physsim_ros.simulation.simulation import Simulation
import physsim_ros

simulation = Simulation(physics_rate=240.0, publish_rate=60.0)
simulation.begin(load_world(find_world('dominoes')))
while simulation.step < 240:
    simulation.advance_frame()
print(physsim_ros.__file__, simulation.world.digest())
"""


def _assert_steps(folder, home, env):
    """Step a world, not in the source tree: the package is in its home, the digest as here."""
    place = folder / 'elsewhere'
    place.mkdir()
    printed = _run(sys.executable, '-c', STEPPED, cwd=place, timeout=READY, env=env)
    file, stepped = printed.split()
    assert Path(file).is_relative_to(home)
    assert stepped == digest_at(scene('worlds/dominoes'), 1)


def _with_prefix(prefix):
    """Return the environment in which a package and its files are found below a prefix."""
    (site,) = prefix.glob('lib/*/site-packages')
    return os.environ | {'PYTHONPATH': str(site), 'AMENT_PREFIX_PATH': str(prefix)}


def test_the_released_wheel_steps_a_world(released, tmp_path):
    prefix = tmp_path / 'prefix'
    options = [*OFFLINE, '--ignore-installed', '--prefix', prefix]
    _run(*PIP, 'install', *options, released, timeout=BUILD)

    _assert_steps(tmp_path, prefix, _with_prefix(prefix))


def test_what_pip_installs_steps_a_world(installed, tmp_path):
    _assert_steps(tmp_path, installed, _with_prefix(installed))


def test_what_colcon_installs_steps_a_world(workspace, overlay, tmp_path):
    _assert_steps(tmp_path, workspace / 'install', overlay)


def test_colcon_compiles_the_core_beside_the_sources_that_it_links(colcon, tmp_path):
    source = copy_source(tmp_path / 'src' / 'physsim_ros')

    _run(colcon, 'build', '--symlink-install', cwd=tmp_path, timeout=BUILD)

    assert [*source.glob('physsim_ros/engine/core/_core.*')]
    _assert_steps(tmp_path, source, os.environ | {'PYTHONPATH': str(source)})


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
    """Build the wheel, and let pip install it with ROS into an empty environment."""
    dist, environment = tmp_path_factory.mktemp('dist'), tmp_path_factory.mktemp('environment')
    source = workspace / 'src' / 'physsim_ros'
    _run(*PIP, 'wheel', *OFFLINE, '--wheel-dir', dist, source, timeout=BUILD)
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
    executable = empty_environment / 'bin' / 'physsim'
    _assert_runs_until_interrupted(executable, _without_ros(), tmp_path)


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


def test_colcon_installs_every_world(workspace, overlay):
    share = Path(overlay['AMENT_PREFIX_PATH'].split(os.pathsep)[0]) / 'share' / 'physsim_ros'

    missing = [str(path) for path in SHIPPED if not (share / path).is_file()]

    assert share.is_relative_to(workspace)
    assert missing == []


def test_the_executable_that_colcon_installs_runs_until_interrupted(workspace, overlay, tmp_path):
    executable = workspace / 'install/physsim_ros/lib/physsim_ros/physsim'
    _assert_runs_until_interrupted(executable, overlay, tmp_path)


# Of each kind one: alone, with the programs in other processes, with the plugin in another pytest.
# None of those here, which would start over.
SUBSET = (
    'test/style/test_ament.py::test_the_manifest_keeps_the_rules_of_rep_149',
    'test/ros/test_draw_example.py::test_strokes_build_a_car_that_rolls',
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
