# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Spawn thousands of bodies in one burst, and count the answers; then in one array.

With the word `paused` behind the count, the world remains paused.
"""

from __future__ import annotations

import sys
import time

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, Visitor
from visualization_msgs.msg import Marker, MarkerArray


def main() -> None:
    count = int(sys.argv[1])
    visitor = Visitor('/physsim/pause', '/physsim/clear', '/physsim/play')
    # Without the services, whose answers come there too.
    events = visitor.listen_if(
        DiagnosticStatus, '/physsim/events', lambda event: event.name.startswith('~/spawn')
    )
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    array = visitor.publisher(MarkerArray, '/physsim/spawn_array')
    visitor.greet(events, spawn)

    def flood(topic: str) -> dict[str, object]:
        """Send a burst, and return its answers."""
        # Far apart, so that the flood alone is what costs.
        markers = [disc(topic, number, number * 0.5, 0.0, 0.2) for number in range(count)]
        began = time.monotonic()
        if topic == 'spawn':
            for marker in markers:
                spawn.publish(marker)
        else:
            array.publish(MarkerArray(markers=markers))
        sent = time.monotonic()
        visitor.spin_until(lambda: len(events) >= count, f'{count} answers to {topic}')
        answered = time.monotonic()
        # Should anything be answered twice, that comes before this is answered.
        spawn.publish(Marker(ns='nobody', action=Marker.DELETE))
        visitor.spin_until(lambda: events[-1].hardware_id == 'nobody/0', 'the last answer')
        names = [f'{topic}/{number}' for number in range(count)]
        visitor.call('/physsim/pause')
        # Only now: thousands of bodies are more than Python reads sixty times a second.
        states = visitor.read(MultiDOFJointState, '/physsim/states')
        result = {
            'answers': len(events) - 1,
            'in_order': [each.hardware_id for each in events[:-1]] == names,
            'ok': sum(each.level == DiagnosticStatus.OK for each in events[:-1]),
            'topics': sorted({each.name for each in events[:count]}),
            'listed_in_order': list(states.joint_names) == names,
            'sent': sent - began,
            'answered': answered - began,
        }
        visitor.call('/physsim/clear')
        if 'paused' not in sys.argv:
            visitor.call('/physsim/play')
        events.clear()
        return result

    visitor.finish(spawn=flood('spawn'), spawn_array=flood('spawn_array'))


if __name__ == '__main__':
    main()
