# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The compiled core is loaded where it belongs to the sources beside it, else the mend is told."""

import importlib
from pathlib import Path
import shutil
import subprocess
import sys

from physsim_ros.engine import core
import pymunk._chipmunk
import pytest

load = core._load  # noqa: SLF001 - what an import calls
(COMPILED,) = Path(core.__file__).parent.glob('_core.*')


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Have the core looked for in an empty folder."""
    monkeypatch.setattr(core, '_HERE', tmp_path)
    return tmp_path


def test_a_core_that_was_not_compiled_is_told_with_the_command_that_compiles_it(folder):
    (folder / 'step.c').touch()

    with pytest.raises(ImportError) as refused:
        load()

    assert str(refused.value) == (
        'the core of the engine has not been compiled; run `pip install --editable .`'
    )


def test_a_core_without_its_declarations_is_told_with_the_same_command(monkeypatch):
    monkeypatch.setitem(sys.modules, f'{core.__name__}._declarations', None)

    with pytest.raises(ImportError, match='has not been compiled; run `pip install'):
        importlib.reload(core)


def test_a_core_of_other_sources_is_told_with_the_command_that_compiles_it(folder):
    shutil.copy(COMPILED, folder)
    (folder / 'step.c').touch()

    with pytest.raises(ImportError) as refused:
        load()

    assert str(refused.value) == (
        'the core of the engine was compiled from other sources; run `pip install --editable .`'
    )


@pytest.mark.parametrize('header', ['core.h', 'arena.h'])
def test_a_changed_header_makes_other_sources(folder, header):
    for path in (*COMPILED.parent.glob('*.[ch]'), COMPILED):
        shutil.copy(path, folder)
    load()

    with (folder / header).open('a') as file:
        file.write('// Changed.\n')

    with pytest.raises(ImportError, match='from other sources'):
        load()


def test_an_installed_core_without_sources_is_loaded(folder):
    shutil.copy(COMPILED, folder)
    shutil.copy(COMPILED.with_name('core.h'), folder)

    assert load().core_sources() != core.ffi.NULL


def files_that_are_no_core():
    """Return beginnings of the core, other files, and another library."""
    data = COMPILED.read_bytes()
    parts = (data[: int(share * len(data))] for share in (0.0, 1e-4, 0.3, 0.99))
    others = (b'#!/bin/sh\n', b'\x7fELF' + bytes(60), b'MZ' * 500)
    return [*parts, *others, Path(pymunk._chipmunk.__file__).read_bytes()]  # noqa: SLF001


@pytest.mark.parametrize('content', files_that_are_no_core(), ids=lambda data: f'{len(data)} B')
def test_what_is_no_core_is_told_with_the_command_and_ends_no_process(folder, content):
    (folder / COMPILED.name).write_bytes(content)

    with pytest.raises(ImportError, match=r'cannot be loaded, .* run `pip install'):
        load()


def test_declarations_of_other_headers_are_told_with_the_command(monkeypatch):
    monkeypatch.setattr(core, 'SOURCES', '0' * 16)

    with pytest.raises(ImportError, match='from other sources; run `pip install'):
        load()


# The end of the interpreter closes the library, before or after the worlds are freed that it made.
FREED_LAST = """
from physsim_ros.engine.core import ffi, lib
from physsim_ros.simulation.simulation import Simulation

world = Simulation()
ffi.dlclose(lib)
del world
"""


def test_a_world_can_be_freed_after_the_core_was_closed():
    assert subprocess.run([sys.executable, '-c', FREED_LAST], check=False).returncode == 0
