# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The C compiler: that of the machine, or where there is none, that of the package ziglang."""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import sys

NAMES = ('cc', 'gcc', 'clang')
# The C library that ziglang's compiler links for: that of Debian 10 and RHEL 8 (PEP 600).
GLIBC = '2.28'


def machine_compiler() -> list[str]:
    """Return the command of the compiler that CC names or that is on the path; [] without one."""
    named = shlex.split(os.environ.get('CC', ''))
    return named or [name for name in NAMES if shutil.which(name)][:1]


def zig_compiler() -> list[str]:
    """Return the command of ziglang's compiler."""
    target = f'{platform.machine()}-linux-gnu.{GLIBC}'
    return [sys.executable, '-m', 'ziglang', 'cc', '-target', target]
