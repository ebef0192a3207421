# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Look at everything that the world says, while it runs, while it is paused, and late.

Words on the command line: the topics on which the world is asked for something.
"""

from __future__ import annotations

import sys
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, KEPT, stamp_of, Visitor
from visualization_msgs.msg import Marker, MarkerArray

STREAMS = {
    'poses': PoseArray,
    'states': MultiDOFJointState,
    'contacts': MultiDOFJointState,
    'markers': MarkerArray,
    'events': DiagnosticStatus,
}


def endpoints(infos: list[Any]) -> list[list[str]]:
    """Return type, reliability and durability of the world's ends of a topic."""
    return [
        [info.topic_type, info.qos_profile.reliability.name, info.qos_profile.durability.name]
        for info in infos
        if info.node_name == 'physsim'
    ]


def spots(picture: MarkerArray) -> dict[str, list[float]]:
    return {
        f'{each.ns}/{each.id}': [each.pose.position.x, each.pose.position.y]
        for each in picture.markers
    }


def main() -> None:
    visitor = Visitor(*(f'/physsim/{name}' for name in ('pause', 'step', 'play')))
    heard = {name: visitor.listen(kind, f'/physsim/{name}') for name, kind in STREAMS.items()}
    clocks = visitor.listen(Clock, '/clock')
    diagnostics = visitor.listen(DiagnosticArray, '/diagnostics')
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    visitor.greet(heard['events'], spawn)

    floor = Marker(ns='floor', type=Marker.CUBE, text='{anchored: true, elasticity: 0}')
    floor.scale.x, floor.scale.y = 20.0, 1.0
    floor.pose.position.y = -0.5
    spawn.publish(floor)
    for number in range(3):
        # Their names are in no order; where they are listed is when they came.
        spawn.publish(disc('ball', 7 - number, 2.0 * number, 0.3, 0.5, '{elasticity: 0}'))
    spawn.publish(Marker(ns='bad', type=Marker.ARROW))
    visitor.spin_until(lambda: len(heard['events']) == 5, 'five answers')
    for received in heard.values():
        if received is not heard['events']:
            received.clear()
    visitor.spin_until(lambda: len(heard['states']) >= 60, 'a second')
    visitor.spin_until(
        lambda: (
            diagnostics
            and 'bodies 4'
            in [f'{pair.key} {pair.value}' for pair in diagnostics[-1].status[0].values]
        ),
        'diagnostics of four bodies',
    )
    running = {name: list(received) for name, received in heard.items()}
    late_running = visitor.listen(MarkerArray, '/physsim/markers', KEPT)
    visitor.spin_until(lambda: late_running, 'a picture for who comes late')

    paused = visitor.call('/physsim/pause')
    again = visitor.call('/physsim/pause')
    late_picture = visitor.listen(MarkerArray, '/physsim/markers', KEPT)
    late_states = visitor.listen(MultiDOFJointState, '/physsim/states')
    late_poses = visitor.listen(PoseArray, '/physsim/poses')
    visitor.spin_until(
        lambda: late_picture and late_states and late_poses, 'a paused world for who comes late'
    )
    stopped = stamp_of(late_states[-1])
    stepped = visitor.call('/physsim/step')
    visitor.spin_until(lambda: stamp_of(late_states[-1]) > stopped, 'a step')
    after_step = stamp_of(late_states[-1])
    played = visitor.call('/physsim/play')
    visitor.spin_until(lambda: stamp_of(late_states[-1]) > after_step + 100_000_000, 'time again')

    services = visitor.node.get_service_names_and_types_by_node('physsim', '/')
    seconds = [each.clock.sec * 1_000_000_000 + each.clock.nanosec for each in clocks]
    visitor.finish(
        publishers={
            topic: endpoints(visitor.node.get_publishers_info_by_topic(topic))
            for topic in (
                *(
                    f'/physsim/{name}'
                    for name in (*STREAMS, 'map', 'preview', 'timeline', 'drag/update')
                ),
                '/clock',
                '/diagnostics',
            )
        },
        subscriptions={
            topic: endpoints(visitor.node.get_subscriptions_info_by_topic(topic))
            for topic in sys.argv[1:]
        },
        services=dict(services),
        events=[
            [each.level[0], each.name, each.hardware_id, each.message]
            + [[pair.key, pair.value] for pair in each.values]
            for each in running['events']
        ],
        stamps={name: [stamp_of(each) for each in running[name]] for name in ('poses', 'states')},
        frames=sorted(
            {
                each.header.frame_id
                for name in ('poses', 'states', 'contacts')
                for each in running[name]
            }
        ),
        marker_frames=sorted(
            {mark.header.frame_id for each in running['markers'] for mark in each.markers}
        ),
        names=[list(each.joint_names) for each in running['states']],
        places=[
            [[way.translation.x, way.translation.y] for way in each.transforms]
            for each in running['states']
        ],
        poses=[
            [[pose.position.x, pose.position.y] for pose in each.poses]
            for each in running['poses']
        ],
        contacts=[
            [
                list(each.joint_names),
                [[push.force.x, push.force.y] for push in each.wrench],
                [[way.translation.x, way.translation.y] for way in each.transforms],
            ]
            for each in running['contacts']
        ],
        pictures=[spots(each) for each in running['markers']],
        late_running=spots(late_running[0]),
        late_picture=spots(late_picture[-1]),
        late_places=[[way.translation.x, way.translation.y] for way in late_states[0].transforms],
        late_poses=len(late_poses[0].poses),
        clocks=seconds,
        diagnostics=[
            [stamp_of(each), each.status[0].level[0], each.status[0].name]
            + [[pair.key, pair.value] for pair in each.status[0].values]
            for each in diagnostics
        ],
        calls=[paused, again, stepped, played],
        stopped=stopped,
        after_step=after_step,
    )


if __name__ == '__main__':
    main()
