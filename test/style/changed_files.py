# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The Python files that a checker of single files has not passed yet, as pytest remembers them."""

from hashlib import sha256
from importlib.metadata import distributions
from pathlib import Path

ROOT = Path(__file__).parents[2]
CHECKED = ('physsim_ros', 'test', 'tools', 'setup.py')
# cffi writes it when the core is built.
GENERATED = ROOT / 'physsim_ros/engine/core/_declarations.py'
# Prefixes of the names of the checkers; another version of one looks at all files again.
CHECKERS = ('ament', 'flake8', 'pep8', 'pycodestyle', 'pydocstyle', 'pyflakes', 'ros-jazzy-ament')


def _digest(path, versions):
    return sha256(versions + path.read_bytes()).hexdigest()


def digests():
    """Return a digest of each file, and of the versions that look at it, by path."""
    found = sorted(
        f'{each.name} {each.version}'
        for each in distributions()
        if each.name.lower().startswith(CHECKERS)
    )
    versions = '\n'.join(found).encode()
    tops = [ROOT / top for top in CHECKED]
    paths = [path for top in tops for path in ([top] if top.is_file() else top.rglob('*.py'))]
    own = sorted(path for path in paths if path != GENERATED)
    return {str(path.relative_to(ROOT)): _digest(path, versions) for path in own}


def changed(cache, checker):
    """
    Return the paths that a checker has not passed, and the digests of all files.

    :param cache: of pytest, where the digests go when they have passed
    """
    now, passed = digests(), cache.get(checker, {})
    return [path for path, digest in now.items() if passed.get(path) != digest], now
