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
