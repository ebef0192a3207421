# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The publisher of `/diagnostics`, once a second.

Law: a viewer or recording that has failed, and a second node of this node's name, are reported as
events, whether `/diagnostics` has subscribers or not.
"""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.qos_safe_node import NodeWithoutQosEvents, SAME_NAME_REMEDY
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.simulation.simulation import Simulation

# From one message to the next [ns].
_PERIOD = 1_000_000_000


class DiagnosticsPublisher:
    """
    The publisher of the diagnostics of a node.

    :param node: that owns it
    :param simulation: of the node
    :param outputs: of the node, with the statistics of frames
    :param topics: of requests
    :param boundary: of the node
    """

    def __init__(
        self,
        node: NodeWithoutQosEvents,
        simulation: Simulation,
        outputs: Outputs,
        topics: RequestTopics,
        boundary: ErrorBoundary,
    ) -> None:
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

    def publish_due(self, now_ns: int, *, message_delay: float) -> None:
        """
        Publish the diagnostics if a second is over; called at each tick.

        :param now_ns: steady time, monotonic [ns]
        :param message_delay: time that messages wait before they are handled [s]
        """
        if now_ns < self._due:
            return
        self._due = now_ns + _PERIOD
        with self._boundary.output('/diagnostics'):
            self._publish(message_delay)

    def _publish(self, message_delay: float) -> None:
        outputs, boundary = self._outputs, self._boundary
        longest = boundary.take_longest()
        outputs.report_answers(
            (*outputs.viewer.poll(), *self._new_namesakes(), *boundary.take_events())
        )
        if outputs.frame is None or self._publisher.get_subscription_count() == 0:
            return
        simulation, events = self._simulation, outputs.topics.events
        self._publisher.publish(
            outputs.statistics.report(
                outputs.frame.snapshot,
                node=self._name,
                speed=simulation.speed,
                late_frames=simulation.playback.clock.late_frames,
                viewer=outputs.viewer.state,
                viewer_failure=outputs.viewer.failure,
                message_delay=message_delay,
                waiting_requests=len(simulation.requests),
                undecodable=self._topics.undecodable,
                waiting_answers=events.waiting,
                stopped_subscriber=events.stopped,
                memory=simulation.past.budget.in_megabytes,
                failures=boundary.failures,
                longest=longest,
            )
        )

    def _new_namesakes(self) -> list[Answer]:
        """Return an event if there are more nodes of this name than at the last count."""
        before, self._namesakes = self._namesakes, self._node.count_nodes(self._name)
        if self._namesakes <= max(before, 1):
            return []
        message = f'{self._namesakes} nodes are named {self._name}, and all do what one is asked'
        return [
            Answer(topic='same_name', message=f'{message}: {SAME_NAME_REMEDY}', code='same_name')
        ]
