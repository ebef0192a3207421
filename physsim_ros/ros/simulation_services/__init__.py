# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The services of the standard `simulation_interfaces`, where that package is installed.

Laws: they do what topics and services of the node do, by the same requests; what is refused
changes nothing, and has a result code of the standard.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from physsim_ros.ros.node_control import NodeControl
    from physsim_ros.ros.requests.services import ServiceCalls
    from rclpy.node import Node

__all__ = ['create_simulation_services']


def create_simulation_services(
    node: Node, control: NodeControl, calls: ServiceCalls
) -> Callable[[], object]:
    """
    Offer the services below `~/simulation/`, if their package is installed.

    :param node: that offers them
    :param control: what they do to the node
    :param calls: of services

    :return: ends what `Node.destroy_node` does not
    """
    if find_spec('simulation_interfaces') is None:
        return lambda: None
    from physsim_ros.ros.simulation_services.services import SimulationServices  # noqa: PLC0415

    return SimulationServices(node, control, calls).close
