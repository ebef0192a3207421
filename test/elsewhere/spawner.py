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

"""Spawn a body, and tell which bodies there are."""

from __future__ import annotations

import sys

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, Visitor
from visualization_msgs.msg import Marker


def main() -> None:
    namespace = sys.argv[1]
    visitor = Visitor()
    events = visitor.listen(DiagnosticStatus, '/physsim/events')
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    visitor.greet(events, spawn)
    spawn.publish(disc(namespace, 0, 0.0, 0.0, 1.0))
    visitor.spin_until(lambda: events, 'the answer')
    states = visitor.read(MultiDOFJointState, '/physsim/states')
    visitor.finish(names=states.joint_names)


if __name__ == '__main__':
    main()
