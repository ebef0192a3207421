# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Clicks and strokes: `clicked_point`, `~/stroke`, and the reading that `~/instead` builds.

Law: a click or stroke refers to the snapshot that was shown when it arrived.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import time

from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Path
from physsim_ros.drawing import DrawingSession, submit_reading, submit_told
from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.translation import Text
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.planar import named_frame, point_in_frame
from physsim_ros.ros.requests import conversions
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation


class DrawingTopics:
    """
    The topics on which a person draws.

    :param topics: of requests
    :param simulation: to which requests are submitted
    :param session: of the person
    :param frame_id: name of the world frame
    :param loop: of the node, with the snapshot that is shown
    """

    def __init__(
        self,
        topics: RequestTopics,
        simulation: Simulation,
        session: DrawingSession,
        *,
        frame_id: str,
        loop: FrameLoop,
    ) -> None:
        self._simulation = simulation
        self._session = session
        self._frame_id = frame_id
        self._loop = loop
        topics.subscribe(PointStamped, 'clicked_point', self._click)
        topics.subscribe(Path, '~/stroke', self._stroke)

    def read_instead(self) -> Text:
        """
        Build the next guess about the last stroke, and return a message about it.

        :raises Refusal: there is none, or the world cannot have it
        """
        self._loop.bring_up_to_date()
        reading = self._session.instead()
        origin = Origin('~/instead', 'poses')
        submit_reading(self._simulation, self._session, reading, origin)
        return reading.message

    def _click(self, message: PointStamped) -> None:
        origin = Origin('clicked_point', 'point')
        with self._drawing_on_snapshot(origin) as snapshot:
            point, frame = point_in_frame(message, self._frame_id)
            result = self._session.click(point, frame, snapshot)
            submit_told(self._simulation, result.requests, origin, message=result.message)

    def _stroke(self, message: Path) -> None:
        origin = Origin('~/stroke', 'poses')
        with self._drawing_on_snapshot(origin) as snapshot:
            name, samples, began = conversions.stroke_samples(message)
            frame = named_frame(name, self._frame_id)
            began = time.monotonic() if began is None else began
            reading = self._session.stroke(samples, frame, snapshot, began=began)
            submit_reading(self._simulation, self._session, reading, origin)

    @contextmanager
    def _drawing_on_snapshot(self, origin: Origin) -> Iterator[Snapshot]:
        """Yield the snapshot that a click or stroke refers to, and report its refusal."""
        try:
            yield self._loop.bring_up_to_date()
        except Refusal as refusal:
            self._simulation.requests.refuse(refusal, origin)
