# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cases of a parametrised test that `make test` leaves out."""

from typing import Any

import pytest


def slow(*values: Any) -> Any:
    """Return a case of `pytest.mark.parametrize` that is marked as slow."""
    return pytest.param(*values, marks=pytest.mark.slow)
