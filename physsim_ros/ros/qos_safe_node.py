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
A node that listens to no QoS events.

Left alone, rclpy has every publisher and subscription listen for QoS that does not fit, to warn of
it. Whoever reads or clears such an event takes a lock of the middleware's and then one of the
endpoint's; the middleware's own threads take them the other way round, and both stand still for
ever (https://github.com/ros2/rmw_fastrtps/pull/890). The other end of a topic still warns.
"""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

# A burst of thousands must lose nothing.
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)


class QuietNode(Node):
    """A node whose publishers and subscriptions listen to no QoS events."""

    def create_publisher(self, *args: Any, **options: Any) -> Publisher:
        """Create a publisher, as any node does."""
        options.setdefault('event_callbacks', PublisherEventCallbacks(use_default_callbacks=False))
        return super().create_publisher(*args, **options)

    def create_subscription(self, *args: Any, **options: Any) -> Subscription:
        """Create a subscription, as any node does."""
        options.setdefault(
            'event_callbacks', SubscriptionEventCallbacks(use_default_callbacks=False)
        )
        return super().create_subscription(*args, **options)
