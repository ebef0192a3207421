# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`/diagnostics` once a second: cost of a frame, late frames, real-time factor, energies, waits.

Law: a viewer or recording that has failed, and a second node of this node's name, are reported as
events, whether `/diagnostics` has subscribers or not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.timeline import run_state
from physsim_ros.model.translation import Text
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.simulation import Simulation
from rclpy.node import Node
from rclpy.time import Time

# From one message to the next [ns].
_PERIOD = 1_000_000_000
# Wait of messages above which the diagnostics warn [s].
LONG_DELAY = 1.0
# CPU time of a message above which they do [s]: a pause that a person sees.
LONG_MESSAGE = 0.1
# Real-time factor over speed, below which late frames are an error and not a warning [1].
FAR_BEHIND = 0.5
# ROS 2 allows nodes of one name, and each of them receives the requests of both.
_SAME_NAME_REMEDY = (
    'give one a namespace (--ros-args -r __ns:=/other), or a ROS_DOMAIN_ID of its own'
)


class Diagnostics:
    """
    The diagnostics of a node.

    :param node: that publishes them
    :param simulation: of the node
    :param outputs: of the node, with the statistics of frames
    :param topics: of requests
    :param boundary: of the node

    :ivar message_delay: time that messages wait before they are handled [s]
    """

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        outputs: Outputs,
        topics: RequestTopics,
        boundary: ErrorBoundary,
    ) -> None:
        self.message_delay = 0.0
        self._node = node
        self._name = node.get_fully_qualified_name()
        # Nodes of this name at the last count, this one included.
        self._namesakes = 1
        self._simulation = simulation
        self._outputs = outputs
        self._topics = topics
        self._boundary = boundary
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._due = 0
        # Counts since the start, as they were a second ago.
        self._counted: Counter[str] = Counter()
        # The message that took the longest since the last report, and its CPU time [s].
        self._longest = ('', 0.0)

    def publish_due(self, now_ns: int) -> None:
        """
        Publish the diagnostics if a second is over; called at each tick.

        :param now_ns: steady time, monotonic [ns]
        """
        if now_ns < self._due:
            return
        self._due = now_ns + _PERIOD
        outputs, boundary = self._outputs, self._boundary
        with boundary.containing('/diagnostics'):
            self._longest = boundary.take_longest()
            events = *outputs.viewer.poll(), *self._new_namesakes(), *boundary.take_events()
            outputs.report_answers(events)
            new = self._count_second()
            if outputs.frame is not None and self._publisher.get_subscription_count():
                self._publisher.publish(self._report(self._snapshot(outputs.frame), new))
            outputs.statistics.begin_second()

    def _snapshot(self, frame: Frame) -> Snapshot:
        """Return the snapshot of now, or of the last frame where the world is not there."""
        simulation = self._simulation
        return simulation.world.snapshot() if simulation.playback.is_there else frame.snapshot

    def _count_second(self) -> Counter[str]:
        """Return the counts of the last second, by name."""
        counts = Counter(
            {
                'late frames': self._simulation.playback.clock.late_frames,
                'undecodable messages': self._topics.undecodable,
                'unexpected errors': self._boundary.failures,
            }
        )
        before, self._counted = self._counted, counts
        return counts - before

    def _report(self, snapshot: Snapshot, new: Counter[str]) -> DiagnosticArray:
        """
        Return the message of the last second.

        :param new: counts of that second, by name
        """
        statistics, speed = self._outputs.statistics, self._simulation.speed
        factor = statistics.factor
        concerns = list(self._concerns(new, factor))
        is_far_behind = new['late frames'] > 0 and abs(factor) < FAR_BEHIND * abs(speed)
        level = DiagnosticStatus.WARN if concerns else DiagnosticStatus.OK
        done = run_state(speed) if speed <= 0 else f'{statistics.frames} frames'
        values = self._values(snapshot, new)
        status = DiagnosticStatus(
            level=DiagnosticStatus.ERROR if is_far_behind else level,
            name='physsim: world',
            message='; '.join(concerns) or done,
            hardware_id=self._name,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = Time(nanoseconds=snapshot.stamp).to_msg()
        return array

    def _values(self, snapshot: Snapshot, new: Counter[str]) -> dict[str, object]:
        """
        Return the values of the message, by their keys.

        :param new: counts of the last second, by name
        """
        outputs, simulation = self._outputs, self._simulation
        statistics = outputs.statistics
        name, took = self._longest
        used, budget = simulation.past.budget.in_megabytes
        px, py = snapshot.momentum
        return {
            'bodies': len(snapshot.scene.bodies),
            'simulation time [s]': f'{snapshot.stamp * 1e-9:.3f}',
            'speed': f'{simulation.speed:zg}',
            'real-time factor': f'{statistics.factor:z.3f}',
            'frames': statistics.frames,
            'late frames': self._counted['late frames'],
            'late frames in this second': new['late frames'],
            'step cost [ms]': f'{statistics.step_cost * 1e3:.3f}',
            'frame cost [ms]': f'{statistics.frame_cost * 1e3:.3f}',
            'wait of requests [s]': f'{self.message_delay:.3f}',
            'requests that wait': len(simulation.requests),
            'longest message [ms]': f'{took * 1e3:.1f} {name}'.rstrip(),
            'undecodable messages': self._counted['undecodable messages'],
            'unexpected errors': self._counted['unexpected errors'],
            'answers that wait': outputs.publishers.events.waiting,
            'memory of the past [MB]': f'{used:.1f} of {budget:g}',
            'kinetic energy [J]': f'{snapshot.kinetic_energy:.6g}',
            'potential energy [J]': f'{snapshot.potential_energy:.6g}',
            'elastic energy [J]': f'{snapshot.elastic_energy:.6g}',
            'momentum [kg m/s]': f'{px:.6g}, {py:.6g}',
            'viewer': outputs.viewer.state,
        }

    def _concerns(self, new: Counter[str], factor: float) -> Iterator[str]:
        """
        Yield what is amiss in the last second, and what to do.

        :param new: counts of that second, by name
        :param factor: real-time factor [1]
        """
        if new['late frames']:
            yield (
                f'{new["late frames"]} frames late, real-time factor {factor:z.2f}: '
                'fewer bodies, joints or viewers, or a lower speed'
            )
        if self.message_delay > LONG_DELAY:
            yield f'requests wait {self.message_delay:.1f} s: send fewer of them'
        name, took = self._longest
        if took > LONG_MESSAGE:
            yield f'{name} took {took:.1f} s, in which time stood: send less at once'
        if lost := new['undecodable messages']:
            yield f'{lost} messages cannot be decoded: check their publishers'
        if failed := new['unexpected errors']:
            yield f'{failed} unexpected errors: report them with the log of the node'
        if self._outputs.publishers.events.stopped:
            yield 'a subscriber of ~/events has stopped and loses answers: end it'
        if failure := self._outputs.viewer.failure:
            yield f'{failure}: set parameter viewer to open it again'
        sketchpad = self._outputs.sketchpad
        if sketchpad is not None and (unsaved := sketchpad.autosave_failure) is not None:
            remedy = 'save the world by name, make room in world_dir, or give each node its own'
            yield f'{unsaved.message}: {remedy}'

    def _new_namesakes(self) -> list[Answer]:
        """Return an event if there are more nodes of this name than at the last count."""
        # As far as this node has discovered them.
        nodes = self._node.get_node_names_and_namespaces()
        names = [f'{namespace.rstrip("/")}/{name}' for name, namespace in nodes]
        before, self._namesakes = self._namesakes, names.count(self._name)
        if self._namesakes <= max(before, 1):
            return []
        message = Text(
            '{count} nodes are named {name}, and all do what one is asked: {remedy}',
            count=self._namesakes,
            name=self._name,
            remedy=Text(_SAME_NAME_REMEDY),
        )
        return [Answer(topic='same_name', message=message, code='same_name')]
