# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
A node without QoS event handlers.

By default rclpy (`use_default_callbacks=True`) gives every publisher and subscription a handler of
incompatible-QoS events, which logs a warning. In rmw_fastrtps of ROS 2 Jazzy, reading such an
event locks the mutex of the event and then that of the endpoint, while the threads of Fast DDS
lock them in the opposite order: a deadlock (https://github.com/ros2/rmw_fastrtps/pull/890). The
other end of the topic still logs the warning. This module can go once that fix is in the oldest
supported release.
"""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

# Reliable, KEEP_ALL: a burst of thousands of messages loses none.
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)


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
