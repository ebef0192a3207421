# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The core is compiled by the compiler that there is, and by ziglang's where there is none."""

from importlib.util import find_spec
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys

import pytest

from ..source_tree import compile_core, copy_source, ROOT

CORE = Path('physsim_ros/engine/core')
# `setup.py` where ziglang is not installed; what was None in `sys.modules` is not found.
WITHOUT_ZIGLANG = """
import runpy
import sys
sys.modules['ziglang'] = None
sys.argv = ['setup.py', 'build_ext', '--inplace']
runpy.run_path('setup.py', run_name='__main__')
"""

machine_has_a_compiler = pytest.mark.skipif(
    shutil.which('cc') is None, reason='this machine has no C compiler'
)
ziglang_is_installed = pytest.mark.skipif(
    find_spec('ziglang') is None, reason='ziglang is not installed'
)


@pytest.fixture
def tree(tmp_path):
    """Copy the source tree, in which nothing is compiled."""
    return copy_source(tmp_path / 'source')


@pytest.fixture
def no_compiler(tmp_path, monkeypatch):
    """Leave nothing on the path, and no compiler that is named."""
    place = tmp_path / 'bin'
    place.mkdir()
    monkeypatch.setenv('PATH', str(place))
    monkeypatch.delenv('CC', raising=False)
    return place


@pytest.fixture
def backend(monkeypatch):
    """Import the build backend as pip does."""
    monkeypatch.syspath_prepend(ROOT / 'tools/build')
    return pytest.importorskip('backend')


def test_pip_is_asked_for_a_compiler_where_there_is_none(backend, no_compiler):
    assert backend.get_requires_for_build_wheel() == ['ziglang']
    assert backend.get_requires_for_build_editable() == ['ziglang']


@pytest.mark.parametrize('name', ['cc', 'gcc', 'clang'])
def test_pip_is_not_asked_for_a_compiler_where_there_is_one(backend, no_compiler, name):
    (no_compiler / name).symlink_to(sys.executable)

    assert backend.get_requires_for_build_wheel() == []
    assert backend.get_requires_for_build_editable() == []


def test_pip_is_not_asked_for_a_compiler_where_one_is_named(backend, no_compiler, monkeypatch):
    monkeypatch.setenv('CC', 'icx -static-intel')

    assert backend.get_requires_for_build_wheel() == []


@pytest.mark.slow
def test_without_any_compiler_a_sentence_names_two(tree, no_compiler):
    done = subprocess.run(
        [sys.executable, '-c', WITHOUT_ZIGLANG],
        cwd=tree,
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == (
        'physsim_ros is compiled in part, and this machine has no C compiler: '
        f'`apt-get install gcc`, or `{sys.executable} -m pip install ziglang`'
    )
    assert not [*tree.glob(f'{CORE}/*.so')]


@pytest.mark.slow
@ziglang_is_installed
def test_ziglang_compiles_for_the_c_library_of_old_systems_and_leaves_the_home(
    tree, no_compiler, monkeypatch, tmp_path
):
    monkeypatch.setenv('HOME', str(tmp_path / 'nobody'))
    monkeypatch.delenv('XDG_CACHE_HOME', raising=False)

    compile_core(tree)

    (library,) = tree.glob(f'{CORE}/_core.*')
    wanted = {int(minor) for minor in re.findall(rb'GLIBC_2\.(\d+)', library.read_bytes())}
    assert wanted
    assert max(wanted) <= 28
    assert not (tmp_path / 'nobody').exists()


@pytest.mark.slow
@machine_has_a_compiler
def test_a_compiler_is_called_by_the_name_that_it_has(tree, no_compiler):
    real = shutil.which('cc', path=os.defpath) or '/usr/bin/cc'
    script = no_compiler / 'clang'
    script.write_text(f'#!/bin/sh\nPATH={os.defpath} exec {real} "$@"\n')
    script.chmod(0o755)

    compile_core(tree)

    assert [*tree.glob(f'{CORE}/_core.*')]


@pytest.mark.slow
@machine_has_a_compiler
def test_the_core_is_compiled_again_where_a_source_has_another_name(tree):
    command = [sys.executable, 'setup.py', '--quiet', 'build_ext', '--inplace']
    subprocess.run(command, cwd=tree, check=True)
    (tree / CORE / 'sleeping.c').rename(tree / CORE / 'asleep.c')

    subprocess.run(command, cwd=tree, check=True)

    program = 'import physsim_ros.engine.core as core; print(core.__file__)'
    printed = subprocess.run(
        [sys.executable, '-c', program],
        cwd=tree,
        env=os.environ | {'PYTHONPATH': str(tree)},
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    assert Path(printed.strip()).parent == tree / CORE


def test_the_core_of_the_source_tree_checks_its_promises():
    (library,) = (ROOT / CORE).glob('_core.*')
    assert b'place < world->body_count' in library.read_bytes()


@pytest.mark.slow
@machine_has_a_compiler
def test_a_core_that_is_shipped_does_not(tree, tmp_path):
    command = [sys.executable, 'setup.py', '--quiet', 'build_ext', '--build-lib', tmp_path]
    subprocess.run(command, cwd=tree, check=True)

    (library,) = tmp_path.glob(f'{CORE}/_core.*')
    assert b'place < world->body_count' not in library.read_bytes()
