# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The build backend: that of setuptools, which asks for a C compiler from PyPI where there is none.

`setup.py` has the rest. The package ziglang is a compiler of 101 MB in a wheel. In a build this
folder comes first where modules are looked for: none here may be named as a package is.
"""

from __future__ import annotations

from collections.abc import Mapping

from compiler import machine_compiler
from setuptools import build_meta
from setuptools.build_meta import (
    build_editable,
    build_sdist,
    build_wheel,
    get_requires_for_build_sdist,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

# The hooks of PEP 517 and PEP 660.
__all__ = [
    'build_editable',
    'build_sdist',
    'build_wheel',
    'get_requires_for_build_editable',
    'get_requires_for_build_sdist',
    'get_requires_for_build_wheel',
    'prepare_metadata_for_build_editable',
    'prepare_metadata_for_build_wheel',
]

Settings = Mapping[str, object] | None


def _compiler() -> list[str]:
    return [] if machine_compiler() else ['ziglang']


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    """Return what is needed to build a wheel."""
    return [*build_meta.get_requires_for_build_wheel(config_settings), *_compiler()]


def get_requires_for_build_editable(config_settings: Settings = None) -> list[str]:
    """Return what is needed to install the source tree itself."""
    return [*build_meta.get_requires_for_build_editable(config_settings), *_compiler()]
