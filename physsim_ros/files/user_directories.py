# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
