# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Look at what the world says, while it runs, while it is paused, and late.

Words on the command line: the topics that it publishes, `--`, and those on which it is asked.
"""

from __future__ import annotations

import sys
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, KEPT, stamp_of, Visitor
from visualization_msgs.msg import Marker, MarkerArray


def endpoints(infos: list[Any]) -> list[list[str]]:
    """Return type, reliability and durability of the world's ends of a topic."""
    return [
        [info.topic_type, info.qos_profile.reliability.name, info.qos_profile.durability.name]
        for info in infos
        if info.node_name == 'physsim'
    ]


def names(picture: MarkerArray) -> list[str]:
    return [f'{each.ns}/{each.id}' for each in picture.markers]


def main(published: list[str], heard: list[str]) -> None:
    visitor = Visitor(*(f'/physsim/{name}' for name in ('pause', 'step', 'play')))
    events = visitor.listen(DiagnosticStatus, '/physsim/events')
    states = visitor.listen(MultiDOFJointState, '/physsim/states')
    clocks = visitor.listen(Clock, '/clock')
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    visitor.greet(events, spawn)
    for number in range(3):
        # Their names are in no order; where they are listed is when they came.
        spawn.publish(disc('ball', 7 - number, 2.0 * number, 0.3, 0.5))
    spawn.publish(Marker(ns='bad', type=Marker.ARROW))
    visitor.spin_until(lambda: len(events) == 4, 'four answers')
    answers = list(events)
    states.clear()
    visitor.spin_until(lambda: len(states) >= 60, 'a second')
    stamps = [stamp_of(each) for each in states]
    late_running = visitor.listen(MarkerArray, '/physsim/markers', KEPT)
    visitor.spin_until(lambda: late_running, 'a picture for who comes late')

    calls = [visitor.call('/physsim/pause'), visitor.call('/physsim/pause')]
    late_picture = visitor.listen(MarkerArray, '/physsim/markers', KEPT)
    late_states = visitor.listen(MultiDOFJointState, '/physsim/states')
    visitor.spin_until(lambda: late_picture and late_states, 'a paused world for who comes late')
    stopped = stamp_of(late_states[-1])
    calls.append(visitor.call('/physsim/step'))
    visitor.spin_until(lambda: stamp_of(late_states[-1]) > stopped, 'a step')
    calls.append(visitor.call('/physsim/play'))
    until = stopped + 100_000_000
    visitor.spin_until(lambda: stamp_of(late_states[-1]) > until, 'time again')

    node = visitor.node
    visitor.finish(
        publishers={
            each: endpoints(node.get_publishers_info_by_topic(each)) for each in published
        },
        subscriptions={
            each: endpoints(node.get_subscriptions_info_by_topic(each)) for each in heard
        },
        services=dict(node.get_service_names_and_types_by_node('physsim', '/')),
        events=[
            [each.level[0], each.name, each.hardware_id, each.message]
            + [[pair.key, pair.value] for pair in each.values]
            for each in answers
        ],
        stamps=stamps,
        clocks=[each.clock.sec * 1_000_000_000 + each.clock.nanosec for each in clocks],
        late_running=names(late_running[0]),
        late_picture=names(late_picture[-1]),
        late_names=list(late_states[0].joint_names),
        calls=calls,
    )


if __name__ == '__main__':
    end = sys.argv.index('--')
    begin = end + 1
    main(sys.argv[1:end], sys.argv[begin:])
