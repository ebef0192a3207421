# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Nodes of one name: ROS 2 allows them, and each of them receives the requests of both."""

from __future__ import annotations

from rclpy.node import Node

REMEDY = 'give one a namespace (--ros-args -r __ns:=/other), or a ROS_DOMAIN_ID of its own'


def count_nodes(name: str, *, seen_by: Node) -> int:
    """
    Return the number of nodes with a name, as far as they have been discovered.

    :param name: with namespace, as `/physsim`
    :param seen_by: the node whose view of the graph is asked
    """
    nodes = seen_by.get_node_names_and_namespaces()
    return sum(f'{namespace.rstrip("/")}/{each}' == name for each, namespace in nodes)
