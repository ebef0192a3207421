# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Message classes of packages that have no wheel, built of the definitions in `interfaces/`.

The generators of rosidl, which come with the wheels of rclpy, write C, C++ and Python of them, and
a compiler makes libraries. These are loaded before ROS asks for them by name, since they lie where
the loader does not look. What was built is kept in pytest's cache, under a name that changes with
definitions, this file and the versions of the generators.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
import ctypes
from fcntl import flock, LOCK_EX
import hashlib
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
import os
from pathlib import Path
import shutil
import subprocess
import sys
import sysconfig
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

INTERFACES = Path(__file__).parent / 'interfaces'
# Fast DDS takes messages by the first, and their descriptions by the second.
TYPE_SUPPORTS = ('rosidl_typesupport_fastrtps_c', 'rosidl_typesupport_introspection_c')
COMPILERS = {'.c': 'cc', '.cpp': 'c++'}
KINDS = ('msg', 'srv', 'action')
# Modules of packages that no test has at the moment.
_LOADED: dict[str, dict[str, ModuleType]] = {}


def _kept(request: pytest.FixtureRequest) -> Path:
    """Return pytest's cache; where there is none, a folder that all workers of a run share."""
    if request.config.pluginmanager.has_plugin('cacheprovider'):
        return request.config.cache.mkdir('interfaces')
    shared = request.getfixturevalue('tmp_path_factory').getbasetemp().parent / 'interfaces'
    shared.mkdir(exist_ok=True)
    return shared


def import_built(package: str, request: pytest.FixtureRequest) -> None:
    """Make a package importable until a fixture ends, or skip the test with the reason."""
    if find_spec(package) is not None:
        return
    if missing := [each for each in COMPILERS.values() if shutil.which(each) is None]:
        pytest.skip(f'{package} is not installed, and there is no {missing[0]} to build it')
    try:
        generators = version('rosidl_generator_py'), version(TYPE_SUPPORTS[0])
    except PackageNotFoundError:
        pytest.skip(f'{package} is not installed, nor are the generators of rosidl')
    if not Path(sysconfig.get_paths()['include'], 'Python.h').exists():
        pytest.skip(f'{package} is not installed, and Python.h is missing to build it')
    found = _definitions(package)
    texts = [path.read_bytes() for path in (Path(__file__), *found)]
    digest = hashlib.sha256(b'\0'.join((repr((generators, sys.version)).encode(), *texts)))
    cache = _kept(request)
    built = cache / f'{package}-{digest.hexdigest()[:16]}'
    with _locked(cache / f'{package}.lock'):
        if not built.exists():
            unfinished = built.with_suffix('.unfinished')
            shutil.rmtree(unfinished, ignore_errors=True)
            _build(package, found, unfinished)
            unfinished.rename(built)
    for kind in TYPE_SUPPORTS:
        ctypes.CDLL(str(built / package / f'lib{package}__{kind}.so'), ctypes.RTLD_GLOBAL)
    sys.modules.update(_LOADED.pop(package, {}))
    sys.path.insert(0, str(built))

    def take_away() -> None:
        # Other worlds find out what is installed. Classes are loaded once in a process.
        sys.path.remove(str(built))
        names = [name for name in sys.modules if name.partition('.')[0] == package]
        _LOADED[package] = {name: sys.modules.pop(name) for name in names}

    request.addfinalizer(take_away)


def _definitions(package: str) -> list[Path]:
    return sorted(path for kind in KINDS for path in INTERFACES.glob(f'{package}/{kind}/*.*'))


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Keep other processes of the same run from building the same package."""
    with path.open('w') as file:
        flock(file, LOCK_EX)
        yield


def _build(package: str, definitions: list[Path], into: Path) -> None:
    # Wheels of ROS lie in the environment of Python, and no variable says so.
    prefixes = os.environ.get('AMENT_PREFIX_PATH', sys.prefix).split(os.pathsep)
    prefix = next(
        Path(each) for each in prefixes if Path(each, 'share/rosidl_generator_c').exists()
    )
    # Only here: it may be missing.
    from rosidl_generator_c import cli as generator_c  # noqa: PLC0415

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
        patch.setattr(generator_c, 'build_type_description_tuples', _with_descriptions)
        _generate(package, definitions, into / package, prefix)
    _compile(package, into / package, into, prefix)


def _generate(package: str, definitions: list[Path], generated: Path, prefix: Path) -> None:
    # Only here: they may be missing.
    from rosidl_cli.command.translate.api import translate  # noqa: PLC0415
    from rosidl_generator_c.cli import GenerateC  # noqa: PLC0415
    from rosidl_generator_py.cli import GeneratePython  # noqa: PLC0415
    from rosidl_typesupport_c.cli import GenerateCTypesupport  # noqa: PLC0415
    from rosidl_typesupport_fastrtps_c import cli as fastrtps  # noqa: PLC0415
    from rosidl_typesupport_introspection_c import cli as introspection  # noqa: PLC0415

    root = INTERFACES / package
    include = [
        str(path)
        for path in (prefix / 'share').iterdir()
        if any((path / kind).is_dir() for kind in KINDS)
    ]
    # The generators look for packages in directories of their own names.
    generated.mkdir(parents=True)
    for kind in {path.parent.name for path in definitions}:
        (generated / kind).mkdir()
    idl = translate(
        package_name=package,
        interface_files=[f'{root}:{path.relative_to(root)}' for path in definitions],
        include_paths=include,
        output_format='idl',
        output_path=generated,
    )
    include.append(str(generated))
    for generator in (
        GenerateC('c'),
        fastrtps.GenerateFastRTPSCTypesupport('fastrtps_c'),
        GenerateCTypesupport('c', typesupport_implementations=TYPE_SUPPORTS),
        GeneratePython('py', typesupport_implementations=['rosidl_typesupport_c']),
    ):
        generator.generate(package, idl, include, generated)
    # Elsewhere: some of its files have the names of others.
    beside = generated.parent / 'introspection' / package
    generator = introspection.GenerateIntrospectionCTypesupport('introspection_c')
    generator.generate(package, idl, include, beside)


def _with_descriptions(interfaces: list[str], descriptions: list[str]) -> list[str]:
    """
    Return each interface file with the file of its type description.

    In place of `build_type_description_tuples` of rosidl_cli 4.6 (Jazzy), which compares the names
    of files without their folders, until it compares both: `simulation_interfaces` has a message
    and a service of the name `SpawnEntity`.
    """
    found = {(Path(each).parent.name, Path(each).stem): each for each in descriptions}
    paths = [Path(each.rpartition(':')[2]) for each in interfaces]
    return [f'{path}:{found[path.parent.name, path.stem]}' for path in paths]


def _compile(package: str, generated: Path, into: Path, prefix: Path) -> None:
    libraries = prefix / 'lib'
    python, all_headers = sysconfig.get_paths()['include'], prefix / 'include'
    headers = [
        into,
        into / 'introspection',
        python,
        np.get_include(),
        all_headers,
        *all_headers.iterdir(),
    ]
    flags = ['-O0', '-fPIC', '-w', *(f'-I{each}' for each in headers)]
    sources = [path for path in sorted(into.rglob('*.c*')) if path.suffix in COMPILERS]

    def compiled(source: Path) -> Path:
        result = source.with_suffix(f'{source.suffix}.o')
        compiler = COMPILERS[source.suffix]
        subprocess.check_call([compiler, *flags, '-c', str(source), '-o', str(result)])
        return result

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compiled, sources))
    needed = [
        *libraries.glob('lib*_msgs__rosidl_generator_[cp]*.so'),
        *(each for kind in TYPE_SUPPORTS for each in libraries.glob(f'lib*_msgs__{kind}.so')),
        *libraries.glob('lib*_msgs__rosidl_typesupport_c.so'),
        *libraries.glob('lib*_interfaces__rosidl_*_c.so'),
        *libraries.glob('librosidl_*_c.so'),
        *libraries.glob('librosidl_*_fastrtps_cpp.so'),
        *libraries.glob('librcutils.so'),
        *libraries.glob('libfastcdr.so'),
    ]

    def link(name: str, *inputs: Path) -> Path:
        library = generated / name
        subprocess.check_call(
            [
                COMPILERS['.cpp'],
                *('-shared', f'-Wl,-soname,{name}', '-Wl,-rpath,$ORIGIN', '-Wl,--no-as-needed'),
                *map(str, inputs),
                *('-o', str(library)),
            ]
        )
        return library

    # All is in the first, and the others lead to it.
    first, second = (f'lib{package}__{kind}.so' for kind in TYPE_SUPPORTS)
    whole = link(first, *objects, *needed)
    link(second, whole)
    link(f'{package}_s__rosidl_typesupport_c.so', whole, *generated.glob('_*.ep.*.o'))
    for each in objects:
        each.unlink()
