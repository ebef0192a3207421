# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Errors of the files that messages write."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from physsim_ros.model.errors import BadWorldFile


@contextmanager
def reaching(name: str) -> Iterator[None]:
    """
    Refuse a file that cannot be reached.

    :param name: of what is in the file
    :raises BadWorldFile: the system has refused it, as a name that is too long or a full disk
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise BadWorldFile('{name}: {reason}', field='name', name=name, reason=reason) from error
