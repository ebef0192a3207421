# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The style of ROS, as ament's checkers see it: flake8 with its plugins, PEP 257, the manifest."""

from hashlib import sha256
from importlib.metadata import distributions
import shutil
import subprocess
import sys

from ament_xmllint.main import main
from catkin_pkg.package import parse_package
import pytest

from .sources import ROOT, sources

# Prefixes of the names of the checkers; another version of one looks at all files again.
CHECKERS = ('ament', 'flake8', 'pep8', 'pycodestyle', 'pydocstyle', 'pyflakes', 'ros-jazzy-ament')

pytestmark = pytest.mark.linter


def digests():
    """Return a digest of each file, and of the versions that look at it, by path."""
    found = sorted(
        f'{each.name} {each.version}'
        for each in distributions()
        if each.name.lower().startswith(CHECKERS)
    )
    versions = '\n'.join(found).encode()
    return {
        str(path.relative_to(ROOT)): sha256(versions + path.read_bytes()).hexdigest()
        for path in sources()
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    'checker',
    [
        pytest.param('ament_flake8', marks=pytest.mark.flake8),
        pytest.param('ament_pep257', marks=pytest.mark.pep257),
    ],
)
def test_a_checker_of_ament_finds_no_errors_in_files_that_have_changed(checker, cache):
    now, passed = digests(), cache.get(checker, {})
    if paths := [path for path, digest in now.items() if passed.get(path) != digest]:
        # In a process of its own: flake8 forks others, which may hang where other tests have
        # started threads. ament's own configuration is the default; ours is not looked at.
        program = f'import sys; from {checker}.main import main; sys.exit(main(sys.argv[1:]))'
        command = [sys.executable, '-c', program, *paths]
        seen = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        assert seen.returncode == 0, seen.stdout + seen.stderr
    cache.set(checker, now)


@pytest.mark.xmllint
def test_the_manifest_keeps_the_rules_of_rep_149():
    warnings = []

    # Raises where the file is not XML, or not a manifest.
    parse_package(ROOT / 'package.xml', warnings=warnings)

    assert warnings == []


@pytest.mark.xmllint
@pytest.mark.skipif(shutil.which('xmllint') is None, reason='xmllint is not installed')
def test_ament_xmllint_finds_no_errors(monkeypatch):
    monkeypatch.chdir(ROOT)

    assert main(argv=['package.xml']) == 0
