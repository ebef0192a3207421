# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world whose parts raise an error that nobody expects."""

from __future__ import annotations

from typing import Any

from physsim_ros.testing import PhysSim
import pytest


def fail(*_: object, **__: object) -> Any:
    raise ZeroDivisionError('by zero')


class Doors:
    """The world of a test, of which a part fails from some moment on."""

    def __init__(
        self,
        physsim: PhysSim,
        monkeypatch: pytest.MonkeyPatch,
        capfd: pytest.CaptureFixture[str],
    ) -> None:
        self.physsim = physsim
        self.node = physsim.node
        self.monkeypatch = monkeypatch
        self._capfd = capfd
        # Those that would end the test.
        self.errors: list[BaseException] = []
        self.node.boundary.on_error = self.errors.append

    def fail(self, owner: object, name: str) -> None:
        """Have a part raise an error that nobody expects."""
        self.monkeypatch.setattr(owner, name, fail)

    def repair(self) -> None:
        """Have all parts work again, and check that errors were logged."""
        assert {type(each) for each in self.errors} == {ZeroDivisionError}
        self.monkeypatch.undo()
        log = self._capfd.readouterr().err
        assert 'failure 1, ' in log
        assert 'ZeroDivisionError: by zero' in log

    def run_on(self) -> None:
        """Check that time goes on."""
        before = self.physsim.time
        self.physsim.run(0.1)
        assert self.physsim.time == pytest.approx(before + 0.1)
