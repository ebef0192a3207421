# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Directories and names of files: those that ship with the package, and those of the user."""

from __future__ import annotations

import os
from pathlib import Path
import re
import sys

# Start of a file in which its title is looked for [bytes].
_TITLE_WITHIN = 400
# A comment of YAML, and the first sentence of it.
_COMMENT = re.compile(r'^#(.*?)\.\s', re.DOTALL | re.MULTILINE)


def shipped(folder: str) -> Path:
    """
    Return a directory of files that ship with the package.

    :param folder: name of the directory below `config`
    """
    return _shipped(Path('config') / folder)


def shipped_pictures() -> Path:
    """Return the directory of the pictures of shipped worlds, `<name>.png`."""
    return _shipped(Path('docs') / 'worlds')


def _shipped(folder: Path) -> Path:
    source = Path(__file__).resolve().parents[2] / folder
    if source.is_dir():
        return source
    for prefix in (*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix):
        installed = Path(prefix) / 'share' / 'physsim_ros' / folder
        if prefix and installed.is_dir():
            return installed
    return source


def user_directory(variable: str, *default: str) -> Path:
    """
    Return the package's directory after the XDG Base Directory Specification.

    :param variable: environment variable of the base directory, as `XDG_DATA_HOME`
    :param default: parts of the base directory below the user's home, where that is not set
    """
    base = Path(os.environ.get(variable, ''))
    # A relative path there is invalid, and to be ignored.
    return (base if base.is_absolute() else Path.home().joinpath(*default)) / 'physsim_ros'


def is_plain(name: str) -> bool:
    """Return whether a name has neither directory nor suffix, like the names of shipped files."""
    return Path(name).name == name and not Path(name).suffix


def files_by_name(directory: Path, *suffixes: str) -> dict[str, Path]:
    """
    Return the files of a directory by their plain names, in order; empty where it cannot be read.

    :param suffixes: of the files, with the dot
    """
    try:
        return {
            path.stem: path
            for path in sorted(directory.iterdir())
            if path.suffix in suffixes and not path.name.startswith('.') and path.is_file()
        }
    except OSError:
        return {}


def title_of(path: Path) -> str:
    """Return the first sentence of the comment that a file begins with, else its plain name."""
    try:
        with path.open('rb') as file:
            start = file.read(_TITLE_WITHIN).decode(errors='ignore')
    except OSError:
        return path.stem
    found = _COMMENT.search(start)
    if found is None:
        return path.stem
    return ' '.join(word for word in found[1].split() if word != '#') or path.stem
