# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The package's directories among those of the user."""

from __future__ import annotations

import os
from pathlib import Path


def user_directory(variable: str, *default: str) -> Path:
    """
    Return the package's directory after the XDG Base Directory Specification.

    :param variable: environment variable of the base directory, as `XDG_DATA_HOME`
    :param default: parts of the base directory below the user's home, where that is not set
    """
    base = Path(os.environ.get(variable, ''))
    # A relative path there is invalid, and to be ignored.
    return (base if base.is_absolute() else Path.home().joinpath(*default)) / 'physsim_ros'
