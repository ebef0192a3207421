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

"""Spawn thousands of bodies in one burst, and count the answers."""

from __future__ import annotations

import sys
import time

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, Visitor
from visualization_msgs.msg import Marker, MarkerArray


def main() -> None:
    count, topic = int(sys.argv[1]), sys.argv[2]
    visitor = Visitor()
    events = visitor.listen(DiagnosticStatus, '/physsim/events')
    states = visitor.listen(MultiDOFJointState, '/physsim/states')
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    array = visitor.publisher(MarkerArray, '/physsim/spawn_array')
    visitor.greet(events, spawn)
    # Far apart and without weight on each other, so that the flood alone is what costs.
    markers = [disc('flood', number, number * 0.5, 0.0, 0.2) for number in range(count)]
    began = time.monotonic()
    if topic == 'spawn':
        for marker in markers:
            spawn.publish(marker)
    else:
        array.publish(MarkerArray(markers=markers))
    sent = time.monotonic()
    visitor.spin_until(lambda: len(events) >= count, f'{count} answers; {len(events)} came')
    answered = time.monotonic()
    # Should anything be answered twice, it comes before this does.
    before = len(events)
    last = Marker(ns='nobody', action=Marker.DELETE)
    spawn.publish(last)
    visitor.spin_until(lambda: any(each.hardware_id == 'nobody/0' for each in events), 'the last')
    names = [f'flood/{number}' for number in range(count)]
    states.clear()
    visitor.spin_until(lambda: states and len(states[-1].joint_names) == count, 'all bodies')
    visitor.finish(
        answers=before,
        after=len(events) - before,
        in_order=[each.hardware_id for each in events[:count]] == names,
        ok=sum(each.level == DiagnosticStatus.OK for each in events[:count]),
        topics=sorted({each.name for each in events[:count]}),
        listed_in_order=list(states[-1].joint_names) == names,
        sent=sent - began,
        answered=answered - began,
    )


if __name__ == '__main__':
    main()
