# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
