# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The wheel that is released: for Linux with the C library of `compiler.GLIBC`, or a newer one.

    python tools/build/released_wheel.py    # into dist/

It takes pip, setuptools, cffi and ziglang, and downloads nothing.
"""

from __future__ import annotations

import os
from pathlib import Path
import platform
import shlex
import subprocess
import sys

from compiler import GLIBC, zig_compiler

ROOT = Path(__file__).resolve().parents[2]
TAG = f'manylinux_{GLIBC.replace(".", "_")}_{platform.machine()}'


def main() -> int:
    """Build the wheel, and return the exit code of pip."""
    pip = [sys.executable, '-m', 'pip', '--disable-pip-version-check', 'wheel', '--no-deps']
    tag = f'--config-settings=--build-option=--plat-name={TAG}'
    command = [*pip, '--no-build-isolation', tag, '--wheel-dir=dist', '.']
    environment = os.environ | {'CC': shlex.join(zig_compiler())}
    return subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode


if __name__ == '__main__':
    sys.exit(main())
