# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Subscribe to the answers, and take none."""

from __future__ import annotations

import time

from diagnostic_msgs.msg import DiagnosticStatus
from visitor import ALL, Visitor


def main() -> None:
    visitor = Visitor()
    subscription = visitor.node.create_subscription(
        DiagnosticStatus, '/physsim/events', lambda _: None, ALL
    )
    visitor.spin_until(subscription.get_publisher_count, 'answers')
    print('DEAF', flush=True)  # noqa: T201 - the test may begin
    while True:
        time.sleep(1.0)


if __name__ == '__main__':
    main()
