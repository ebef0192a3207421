# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The source tree: its pages, and copies in which the core is compiled otherwise than here."""

from __future__ import annotations

import os
from pathlib import Path
import re
import runpy
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory

import pytest

ROOT = Path(__file__).resolve().parents[1]
# Left out of a copy: what was built, and what a clone does not have.
_BUILT = ('*.so', '_declarations.py', '__pycache__', '*.egg-info', '_build')
_ANYWHERE = shutil.ignore_patterns('.*', *_BUILT)
_AT_THE_TOP = {'build', 'install', 'log', 'dist'}
# Many times what a compiler takes, on a machine that is busy with other tests [s].
_COMPILING = 300


def blocks_of(page: str, language: str) -> list[str]:
    """Return the blocks of a language in a page below the root."""
    text = (ROOT / page).read_text(encoding='utf-8')
    return re.findall(rf'^```{language}\n(.*?)^```', text, re.MULTILINE | re.DOTALL)


def _not_source(folder: str, names: list[str]) -> set[str]:
    top = _AT_THE_TOP.intersection(names) if Path(folder) == ROOT else set()
    return {*_ANYWHERE(folder, names), *top}


def copy_source(place: Path) -> Path:
    """Copy the files of a clone, without hidden ones, to a new folder."""
    return Path(shutil.copytree(ROOT, place, ignore=_not_source))


def compile_core(tree: Path, objects: Path | None = None, **variables: str) -> None:
    """
    Compile the core of a source tree within it.

    :param objects: folder of the object files; by default they are deleted
    :param variables: CC, CFLAGS and so on
    :raises AssertionError: with what was printed
    """
    with TemporaryDirectory(prefix='core_') as place:
        command = [sys.executable, 'setup.py', '--quiet', 'build_ext', '--inplace']
        done = subprocess.run(
            [*command, f'--build-temp={objects or place}', f'--build-lib={place}/lib'],
            cwd=tree,
            env=os.environ | variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=_COMPILING,
        )
    assert done.returncode == 0, done.stdout


def is_compiled() -> bool:
    """Return whether the core is compiled in this source tree, from the sources as they are."""
    folder = ROOT / 'physsim_ros/engine/core'
    sources = runpy.run_path(str(folder / 'sources.py'))['hash_of_sources'](folder)
    return any(sources.encode() in path.read_bytes() for path in folder.glob('_core.*'))


def zig_cache(places: pytest.TempPathFactory) -> dict[str, str]:
    """Return the variable by which all workers share the C library that ziglang builds, 60 MB."""
    return {'ZIG_GLOBAL_CACHE_DIR': str(places.getbasetemp().parent / 'zig')}
