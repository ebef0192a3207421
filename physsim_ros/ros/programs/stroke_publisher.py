# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A node that publishes strokes to a running world, and receives the answers.

Law: it uses topics and services only, and publishes a stroke after the answer to the last one. The
world reads each stroke by itself, since the stamps of two strokes are far apart.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
import math
import signal
import time

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
import numpy as np
from physsim_ros.drawing import DRAWING_RANGES
from physsim_ros.model.arrays import Floats
from physsim_ros.ros.qos_safe_node import LOSSLESS, NodeWithoutQosEvents, SAME_NAME_REMEDY
from rclpy.experimental import EventsExecutor
from rclpy.task import Future
from rclpy.time import Time
from std_srvs.srv import Trigger

# Time between two strokes by their stamps [s]: no world reads strokes so far apart together.
_PAUSE = 1.0 + DRAWING_RANGES['regroup'].high
# Wait for a second world after the first was discovered [s]: discovery of two nodes on one machine
# was 0.2 s apart. Nodes that come later are found before the next stroke.
_DISCOVERY = 0.5


class Unanswered(Exception):
    """There is no world, or it does not answer."""


class SeveralWorlds(Exception):
    """More than one node has the name of the world: all of them would draw a stroke."""


class Interrupted(Exception):
    """The program was interrupted by a signal."""


class StrokePublisher(NodeWithoutQosEvents):
    """
    A node that publishes strokes and receives the answers.

    :param world: name of the node of the world
    :param patience: timeout for the discovery of the world, and for each answer [s]
    """

    def __init__(self, world: str, *, patience: float) -> None:
        super().__init__('physsim_draw')
        self._patience = patience
        self._answers: deque[DiagnosticStatus] = deque()
        # The least stamp of the next stroke [ns].
        self._next_stamp = 0
        self._strokes = self.create_publisher(Path, f'{world}/stroke', LOSSLESS)
        self._world = self._strokes.topic_name.rpartition('/')[0]
        self._events = self.create_subscription(
            DiagnosticStatus, f'{world}/events', self._receive, LOSSLESS
        )
        self._buttons = {
            name: self.create_client(Trigger, f'{world}/{name}') for name in ('pause', 'play')
        }
        self._executor = EventsExecutor()
        self._executor.add_node(self)
        self._stopped: list[int] = []
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda received, _: self._stopped.append(received))

    def wait_for_world(self) -> None:
        """
        Wait until publishers and subscriptions have been matched with those of the world.

        :raises Unanswered: there is no world
        """
        events, strokes = self._events, self._strokes
        self._spin_until(
            lambda: strokes.get_subscription_count() and events.get_publisher_count(),
            f'there is no world at {self._world}',
        )
        self._spin_for(_DISCOVERY)

    def draw_stroke(
        self, stroke: Floats, *, frame_id: str, at_once: bool
    ) -> list[DiagnosticStatus]:
        """
        Publish a stroke after the duration of drawing it, and return the answers to it.

        :param stroke: (n, 3) float64: x, y [m], time [s]
        :param frame_id: of the stroke; '' is the world frame
        :param at_once: whether to publish without that duration
        :raises SeveralWorlds: there is more than one world of that name
        :raises Unanswered: the world does not answer
        """
        if not at_once:
            self._spin_for(float(stroke[-1, 2]))
        worlds = self.count_nodes(self._world)
        if worlds > 1:
            raise SeveralWorlds(f'{worlds} worlds are named {self._world}: {SAME_NAME_REMEDY}')
        self._answers.clear()
        self._strokes.publish(self._message(stroke, frame_id))
        self._spin_until(lambda: self._answers, 'the world does not answer')
        # The first answer reports the reading, and the number of answers that follow.
        values = {pair.key: pair.value for pair in self._answers[0].values}
        count = 1 + int(values.get('requests', '0'))
        self._spin_until(lambda: len(self._answers) >= count, 'the world does not answer')
        return [self._answers.popleft() for _ in range(count)]

    def call_service(self, service: str) -> None:
        """
        Call `~/pause` or `~/play`.

        :raises Unanswered: it does not answer
        """
        client = self._buttons[service]
        self._spin_until(client.service_is_ready, f'{service} is not there')
        futures: list[Future] = []

        def answered() -> bool:
            # Called again each second: a service that has not discovered its client yet drops the
            # response.
            if time.monotonic() >= began + len(futures):
                futures.append(client.call_async(Trigger.Request()))
            return any(future.done() for future in futures)

        began = time.monotonic()
        self._spin_until(answered, f'{service} is not answered')

    def close(self) -> None:
        """Destroy the node and its executor."""
        self._executor.remove_node(self)
        self._executor.shutdown()
        self.destroy_node()

    def _message(self, stroke: Floats, frame_id: str) -> Path:
        message = Path()
        message.header.frame_id = frame_id
        began = max(self.get_clock().now().nanoseconds, self._next_stamp)
        self._next_stamp = began + round((float(np.ptp(stroke[:, 2])) + _PAUSE) * 1e9)
        for x, y, seconds in stroke.tolist():
            sample = PoseStamped()
            sample.header.frame_id = frame_id
            sample.header.stamp = Time(nanoseconds=began + round(seconds * 1e9)).to_msg()
            sample.pose.position.x, sample.pose.position.y = x, y
            sample.pose.orientation.w = 1.0
            message.poses.append(sample)
        return message

    def _receive(self, status: DiagnosticStatus) -> None:
        if status.name == '~/stroke':
            self._answers.append(status)

    def _spin_for(self, duration: float) -> None:
        """Spin for a duration [s]."""
        ended = time.monotonic() + duration
        self._spin_until(lambda: time.monotonic() >= ended, '', math.inf)

    def _spin_until(
        self, predicate: Callable[[], object], otherwise: str, patience: float | None = None
    ) -> None:
        deadline = time.monotonic() + (self._patience if patience is None else patience)
        while not predicate():
            if self._stopped:
                # Raised once, so that `play` can still be called.
                self._stopped.clear()
                raise Interrupted
            if time.monotonic() > deadline:
                raise Unanswered(f'{otherwise} (waited {self._patience:g} s)')
            self._executor.spin_once(timeout_sec=0.01)
