# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A node without QoS event handlers.

By default rclpy (`use_default_callbacks=True`) gives every publisher and subscription a handler of
incompatible-QoS events, which logs a warning. In rmw_fastrtps of ROS 2 Jazzy, reading such an
event locks the mutex of the event and then that of the endpoint, while the threads of Fast DDS
lock them in the opposite order: a deadlock (https://github.com/ros2/rmw_fastrtps/pull/890). The
other end of the topic still logs the warning. The class can go once that fix is in the oldest
supported release.
"""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription


class NodeWithoutQosEvents(Node):
    """A node whose publishers and subscriptions have no QoS event handlers."""

    def create_publisher(self, *args: Any, **options: Any) -> Publisher:
        """Create a publisher, as `Node.create_publisher` does."""
        options.setdefault('event_callbacks', PublisherEventCallbacks(use_default_callbacks=False))
        return super().create_publisher(*args, **options)

    def create_subscription(self, *args: Any, **options: Any) -> Subscription:
        """Create a subscription, as `Node.create_subscription` does."""
        options.setdefault(
            'event_callbacks', SubscriptionEventCallbacks(use_default_callbacks=False)
        )
        return super().create_subscription(*args, **options)
