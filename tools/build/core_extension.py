# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The core of the engine as an extension for `setup.py`: its compilation and declarations."""

from importlib.util import find_spec
import os
from pathlib import Path
import runpy
import shlex
import sys

from cffi import FFI
from setuptools import Extension
from setuptools.command.build_ext import build_ext

PACKAGE = 'physsim_ros'
SOURCE = Path(__file__).resolve().parents[2]

# The core of the engine: a plain shared library, without any Python in it.
CORE = f'{PACKAGE}/engine/core'
DECLARATIONS = '_declarations.py'
HASH = runpy.run_path(str(SOURCE / CORE / 'sources.py'))['hash_of_sources'](SOURCE / CORE)
COMPILER = runpy.run_path(str(SOURCE / 'tools/build/compiler.py'))
FLAGS = [
    '-std=c11',
    # The monotonic clock.
    '-D_POSIX_C_SOURCE=200809L',
    # The same bits by every compiler: no sum in another order, no fused multiply-add.
    '-O2',
    '-ffp-contract=off',
    # GCC 12 fuses even so where it joins two sums into a vector, if CFLAGS allow it (PR 106902).
    '-fno-tree-vectorize',
    '-fno-math-errno',
    '-fvisibility=hidden',
]


class BuildCore(build_ext):
    """
    Compile the core; where the machine has no C compiler, by that of the package ziglang.

    CC, CPPFLAGS, CFLAGS and LDFLAGS of the environment are obeyed, and come after what is here.
    The compiler and the flags of which Python was made are not: there is no Python in it.
    """

    def finalize_options(self) -> None:
        """Note whether the core is for the source tree: setuptools forgets it as it compiles."""
        super().finalize_options()
        self.is_for_source_tree = bool(self.inplace)

    def build_extensions(self) -> None:
        """Choose the compiler, and compile."""
        compiler = COMPILER['machine_compiler']()
        if not compiler:
            if find_spec('ziglang') is None:
                sys.exit(
                    f'{PACKAGE} is compiled in part, and this machine has no C compiler: '
                    f'`apt-get install gcc`, or `{sys.executable} -m pip install ziglang`'
                )
            compiler = COMPILER['zig_compiler']()
        # The C library that zig builds for itself, 60 MB: elsewhere it would be in the home.
        os.environ.setdefault('ZIG_GLOBAL_CACHE_DIR', str(Path(self.build_temp, 'zig').resolve()))
        # A core for the source tree, with which the tests run, checks its promises by `assert`.
        checks = [] if self.is_for_source_tree or self.editable_mode else ['-DNDEBUG']
        flags = [*FLAGS, *checks, *_environment('CPPFLAGS'), *_environment('CFLAGS')]
        self.compiler.set_executables(
            compiler_so=[*compiler, '-fPIC', *flags],
            linker_so=[*compiler, '-shared', *_environment('LDFLAGS')],
        )
        super().build_extensions()

    def build_extension(self, ext: Extension) -> None:
        """Compile also where a source was renamed or is no more, which no time of a file tells."""
        built = Path(self.get_ext_fullpath(ext.name))
        self.force = self.force or (built.is_file() and HASH.encode() not in built.read_bytes())
        super().build_extension(ext)
        write_declarations(built.with_name(DECLARATIONS))

    def copy_extensions_to_source(self) -> None:
        """Write the declarations also beside the core that runs from the source tree."""
        super().copy_extensions_to_source()
        write_declarations(SOURCE / CORE / DECLARATIONS)

    def get_outputs(self) -> list[str]:
        """Return the files that are built: the core, and its declarations."""
        core = super().get_outputs()
        return [*core, *(str(Path(each).with_name(DECLARATIONS)) for each in core)]


def write_declarations(path: Path) -> None:
    """
    Write the declarations of the headers as a module of Python that cffi makes of them.

    It has the hash of all sources, as the core has it, by which both are compared. Read from the
    headers at each start, the declarations take a tenth of a second.
    """
    texts = [(SOURCE / CORE / name).read_text('utf-8') for name in ('chipmunk.h', 'core.h')]
    lines = ''.join(texts).splitlines(keepends=True)
    ffi = FFI()
    ffi.cdef(''.join(line for line in lines if not line.startswith('#')))
    ffi.set_source(f'{PACKAGE}.engine.core.{path.stem}', None, compiler_verbose=0)
    ffi.emit_python_code(str(path))
    with path.open('a', encoding='utf-8') as file:
        file.write(f'SOURCES = {HASH!r}\n')


def core_extension() -> Extension:
    """Return the core; its sources have names relative to `setup.py`, as setuptools wants them."""
    return Extension(
        f'{PACKAGE}.engine.core._core',
        _sources('*.c'),
        depends=_sources('*.h'),
        define_macros=[('CORE_SOURCES', f'"{HASH}"')],
        libraries=['m'],
        # One binary for every Python, since it calls none.
        py_limited_api=True,
    )


def _sources(pattern: str) -> list[str]:
    return sorted(str(path.relative_to(SOURCE)) for path in (SOURCE / CORE).glob(pattern))


def _environment(name: str) -> list[str]:
    return shlex.split(os.environ.get(name, ''))
