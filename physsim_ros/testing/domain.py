# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""ROS domains that tests on one machine do not share with each other."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import fcntl
import itertools
import os
from pathlib import Path
import tempfile

# Domains whose ports lie below the ephemeral range of Linux:
# https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html
DOMAINS = range(1, 102)
# Each process begins at another domain, so that it seldom has to try a second; and each test, so
# that remains of one do not reach the next. Every participant takes ports of its domain, of which
# discovery on one machine tries the first 32 only.
_BEGINNINGS = itertools.count(os.getpid())


@contextmanager
def own_domain() -> Iterator[int]:
    """
    Yield a domain ID that no other test on this machine is given at the same time.

    :raises RuntimeError: all are taken
    """
    directory = Path(tempfile.gettempdir()) / f'physsim_ros_domains_{os.getuid()}'
    directory.mkdir(exist_ok=True)
    begin = next(_BEGINNINGS) % len(DOMAINS)
    for domain in (*DOMAINS[begin:], *DOMAINS[:begin]):
        with (directory / str(domain)).open('w') as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield domain
            return
    raise RuntimeError('all ROS domains of this machine are taken by tests')
