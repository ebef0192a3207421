# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The hash by which a compiled core is compared with its sources; `setup.py` compiles it in."""

from __future__ import annotations

import hashlib
from importlib.resources.abc import Traversable


def hash_of_sources(folder: Traversable) -> str:
    """Return a hash of the C sources in a folder; '' if it has none, as in an installed wheel."""
    sources = [path for path in folder.iterdir() if path.name.endswith(('.c', '.h'))]
    if not any(path.name.endswith('.c') for path in sources):
        return ''
    digest = hashlib.sha256()
    for path in sorted(sources, key=lambda path: path.name):
        digest.update(f'{path.name}\n'.encode() + path.read_bytes())
    return digest.hexdigest()[:16]
