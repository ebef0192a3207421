# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A context of ROS for one test, hidden from other processes, or shared with those it starts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from physsim_ros.testing.domain import own_domain
import pytest
import rclpy
from rclpy.context import Context

# Environment variables that name peers in spite of the discovery range: with `ROS_LOCALHOST_ONLY`,
# which is deprecated, rcl ignores that range, and profiles of a DDS may list peers.
_PEERS = (
    'ROS_LOCALHOST_ONLY',
    'ROS_DISCOVERY_SERVER',
    'ROS_STATIC_PEERS',
    'FASTDDS_DEFAULT_PROFILES_FILE',
    'FASTRTPS_DEFAULT_PROFILES_FILE',
    'CYCLONEDDS_URI',
)


@contextmanager
def own_context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """Yield a context whose nodes discover each other and no others, whatever their domain is."""
    # Endpoints of one participant are matched without discovery.
    with _context(monkeypatch, 'OFF') as context:
        yield context


@contextmanager
def shared_context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """
    Yield a context on a domain of its own; processes that the test starts are on it, too.

    They inherit `ROS_DOMAIN_ID`. No other test of this machine has that domain meanwhile.
    """
    with _context(monkeypatch, 'LOCALHOST') as context:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(context.get_domain_id()))
        yield context


@contextmanager
def _context(monkeypatch: pytest.MonkeyPatch, discovery: str) -> Iterator[Context]:
    """Yield a context on a domain of its own, with a discovery range."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', discovery)
    for name in _PEERS:
        monkeypatch.delenv(name, raising=False)
    # Shared memory remains after a killed process, with the locks that it owned.
    monkeypatch.setenv('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
    with own_domain() as domain:
        context = Context()
        rclpy.init(context=context, domain_id=domain, args=[])
        try:
            yield context
        finally:
            context.try_shutdown()
