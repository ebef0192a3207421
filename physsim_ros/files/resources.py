# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files that ship with the package, and those of the user: where they are, and their names."""

from __future__ import annotations

from itertools import takewhile
import os
from pathlib import Path
import sys

# Start of a file in which its title is looked for [bytes].
_TITLE_WITHIN = 400


def shipped(folder: str) -> Path:
    """
    Return a directory of files that ship with the package.

    :param folder: name of the directory below `config`
    """
    source = Path(__file__).resolve().parents[2] / 'config' / folder
    if source.is_dir():
        return source
    for prefix in (*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix):
        installed = Path(prefix) / 'share' / 'physsim_ros' / 'config' / folder
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

    Files whose names are not printable, or not UTF-8, are left out: no message can name them.

    :param suffixes: of the files, with the dot
    """
    try:
        return {
            path.stem: path
            for path in sorted(directory.iterdir())
            if path.suffix in suffixes
            and path.name.isprintable()
            and not path.name.startswith('.')
            and path.is_file()
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
    comment = takewhile(lambda line: line.startswith('#'), start.splitlines())
    words = ' '.join(' '.join(line.lstrip('#') for line in comment).split())
    sentence, stop, _ = f'{words} '.partition('. ')
    # A sentence that goes on after the start is none.
    is_whole = stop or len(start) < _TITLE_WITHIN
    return sentence.strip() or path.stem if is_whole else path.stem
