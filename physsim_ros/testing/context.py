# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A context of ROS for one test, which no other process can discover."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import itertools
import os

import pytest
import rclpy
from rclpy.context import Context

# Domains whose ports lie below the ephemeral range of Linux:
# https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html
_DOMAINS = range(1, 102)
# Each process begins at another domain: every participant takes ports of its domain, of which
# discovery on one machine tries the first 32 only.
_BEGINNINGS = itertools.count(os.getpid())
# Environment variables that name peers in spite of the discovery range.
_PEERS = ('ROS_DISCOVERY_SERVER', 'ROS_STATIC_PEERS')


@contextmanager
def own_context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """Yield a context whose nodes discover each other and no others, whatever their domain is."""
    # Endpoints of one participant are matched without discovery.
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    for name in _PEERS:
        monkeypatch.delenv(name, raising=False)
    # Shared memory remains after a killed process, with the locks that it owned.
    monkeypatch.setenv('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
    context = Context()
    domain = _DOMAINS[next(_BEGINNINGS) % len(_DOMAINS)]
    rclpy.init(context=context, domain_id=domain, args=[])
    try:
        yield context
    finally:
        context.try_shutdown()
