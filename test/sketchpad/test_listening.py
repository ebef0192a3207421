# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page takes its port, or one of the next 20."""

from __future__ import annotations

import errno

from physsim_ros.model.errors import PhysSimError
from physsim_ros.sketchpad.server import website
import pytest


@pytest.mark.parametrize(('port', 'last'), [(8765, 8785), (65530, 65535), (0, 0)])
def test_a_port_that_is_taken_is_followed_by_the_next_20(
    monkeypatch: pytest.MonkeyPatch, port: int, last: int
) -> None:
    tried = []

    def taken(number: int, _: str) -> None:
        tried.append(number)
        raise OSError(errno.EADDRINUSE, 'taken')

    monkeypatch.setattr(website, 'bind_sockets', taken)
    with pytest.raises(PhysSimError, match=f'port {last}'):
        website.listening_sockets('127.0.0.1', port)
    assert tried == list(range(port, last + 1))


@pytest.mark.parametrize('address', ['a..b', '192.0.2.1', 'no address'])
def test_an_address_that_is_none_of_this_machine_is_refused(address: str) -> None:
    with pytest.raises(PhysSimError, match='cannot listen on'):
        website.listening_sockets(address, 8765)
