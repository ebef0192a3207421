# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A caller of the services of `simulation_interfaces`, and the codes of their results."""

from __future__ import annotations

from typing import Any

from physsim_ros.testing import PhysSim

from ...client import Client

UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, OPERATION_FAILED = range(5)
NAME_NOT_UNIQUE, NAME_INVALID, UNSUPPORTED_FORMAT, NO_RESOURCE = 101, 102, 103, 104
NAMESPACE_INVALID, RESOURCE_PARSE_ERROR, INVALID_POSE = 105, 106, 109


class Caller:
    """Calls services of the standard by their names."""

    def __init__(self, physsim: PhysSim) -> None:
        self.physsim, self.client = physsim, Client(physsim)
        self.world_dir = physsim.node.world_files.directory

    def __call__(self, service: str, **fields: Any) -> Any:
        from simulation_interfaces import srv  # noqa: PLC0415 - built for the test

        kind = getattr(srv, service)
        name = ''.join(f'_{each.lower()}' if each.isupper() else each for each in service)
        request = kind.Request()
        for path, value in fields.items():
            *parts, last = path.split('__')
            target = request
            for part in parts:
                target = getattr(target, part)
            setattr(target, last, value)
        return self.client.request(kind, f'~/simulation/{name[1:]}', request)

    def code(self, service: str, **fields: Any) -> int:
        """Call a service, check that a refusal says why, and return the code of its result."""
        result = self(service, **fields).result
        assert (result.result == OK) or result.error_message
        return int(result.result)


def names_in(physsim: PhysSim) -> tuple[str, ...]:
    """Return the names of the bodies of a world, whether a frame has shown them or not."""
    return physsim.node.simulation.world.snapshot().scene.names
