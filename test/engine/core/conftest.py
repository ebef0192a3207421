# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The core as one translation unit, of which tests call what the library does not export."""

from __future__ import annotations

from pathlib import Path
import runpy
import subprocess
from typing import Any

from cffi import FFI
import pytest

from ...source_tree import ROOT

HERE = Path(__file__).parent
CORE = ROOT / 'physsim_ros/engine/core'
STANDARD = ['-std=c11', '-D_POSIX_C_SOURCE=200809L']
FLAGS = [*STANDARD, '-O0', '-g', '-Wall', '-Wextra', '-Werror', '-shared', '-fPIC']


@pytest.fixture(scope='session')
def parts(tmp_path_factory: pytest.TempPathFactory) -> tuple[FFI, Any]:
    """Return the calls of `calls.h`; a name with two meanings in the core does not compile."""
    place = tmp_path_factory.mktemp('one_unit')
    sources = [*sorted(CORE.glob('*.c')), HERE / 'calls.c']
    (place / 'unit.c').write_text(''.join(f'#include "{path}"\n' for path in sources), 'utf-8')
    compiler = runpy.run_path(str(ROOT / 'tools/build/compiler.py'))
    done = subprocess.run(
        [
            *(compiler['machine_compiler']() or compiler['zig_compiler']()),
            *FLAGS,
            '-DCORE_SOURCES=""',
            *(f'-I{folder}' for folder in (CORE, HERE)),
            *('-o', 'unit.so', 'unit.c', '-lm'),
        ],
        cwd=place,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    ffi = FFI()
    ffi.cdef((HERE / 'calls.h').read_text('utf-8'))
    return ffi, ffi.dlopen(str(place / 'unit.so'))
