# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A plugin of pytest, by which tests run without the stage that a variable names."""

from __future__ import annotations

from contextlib import ExitStack
import os

import pytest

from .stages import STAGES, switched_off

# The environment variable.
LEFT_OUT = 'PHYSSIM_LEFT_OUT'


def pytest_configure(config: pytest.Config) -> None:
    closing = ExitStack()
    config.add_cleanup(closing.close)
    (stage,) = (each for each in STAGES if each.name == os.environ[LEFT_OUT])
    closing.enter_context(switched_off(stage))
