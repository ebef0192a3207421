# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The motions of bodies in the past that pages ask for.

Law: the world's thread only looks up the snapshots; the server's thread makes the columns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import groupby
from operator import attrgetter
import time
from typing import Any

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import rotated_each
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.message import Content

# Greatest number of frames of a past: a minute at 60 Hz.
MOST_FRAMES = 3600
# Time from one past to the next, for all pages together [s]: a past takes some 35 ms of the
# server's thread.
PAST_PERIOD = 0.2


class BodyPasts:
    """
    The pasts of bodies that pages ask for, sent one after the other.

    A page that asks for several meanwhile gets the last.

    :param simulation: with the past
    :param send: sends a message to the page of a number
    """

    def __init__(self, simulation: Simulation, send: Callable[[Content, int], None]) -> None:
        self._simulation = simulation
        self._send = send
        # Body and identifier of the message that asks, by page, in the order of their turns.
        self._asked: dict[int, tuple[str, str]] = {}
        # Steady time from which on the next one is sent [s].
        self._due = 0.0

    def ask(self, page: int, name: str, request_id: str) -> None:
        """
        Send a page the motion of a body in the line in force, when it is its turn.

        :param name: of the body; '' is no body, and its columns are empty
        :param request_id: of the message that asks
        """
        if name:
            # A page that asks again keeps its turn.
            self._asked[page] = (name, request_id)
            self.send_due(time.monotonic())
        else:
            self.forget(page)
            self._send(partial(_body_content, name, request_id, ()), page)

    def forget(self, page: int) -> None:
        """Forget the body that a page has asked for."""
        self._asked.pop(page, None)

    def send_due(self, now: float) -> None:
        """
        Send the next past, where one is asked for and due.

        :param now: steady time [s]
        """
        if not self._asked or now < self._due:
            return
        self._due = now + PAST_PERIOD
        page = next(iter(self._asked))
        name, request_id = self._asked.pop(page)
        simulation = self._simulation
        past = simulation.past
        snapshots = past.frames.snapshots(past.line.head, MOST_FRAMES)
        self._send(partial(_body_content, name, request_id, snapshots), page)


def _body_content(name: str, request_id: str, snapshots: Sequence[Snapshot]) -> dict[str, Any]:
    return {'type': 'body', 'request': request_id, 'name': name, **body_past(snapshots, name)}


def body_past(snapshots: Sequence[Snapshot], name: str) -> dict[str, list[float]]:
    """
    Return the columns of a body's past: time [s], x, y of its centre of mass [m], yaw, velocities.

    :param snapshots: in the order of time
    :param name: of the body; of one that was not there the columns are empty
    """
    times: list[float] = []
    columns = [np.empty((0, 6))]
    row = -1
    for scene, group in groupby(snapshots, attrgetter('scene')):
        row = row_in(name, scene, row)
        if row >= 0:
            shown = list(group)
            times += [each.stamp * 1e-9 for each in shown]
            poses = np.array([each.poses[row] for each in shown])
            twists = np.array([each.twists[row] for each in shown])
            centroid = np.array(scene.bodies[row].shape.form.centroid)
            centers = poses[:, :2] + rotated_each(centroid, poses[:, 2])
            columns.append(np.concatenate((centers, poses[:, 2:], twists), axis=1))
    x, y, yaw, vx, vy, spin = np.concatenate(columns).T.tolist()
    return {'time': times, 'x': x, 'y': y, 'yaw': yaw, 'vx': vx, 'vy': vy, 'w': spin}


def row_in(name: str, scene: Scene, before: int) -> int:
    """
    Return the row of a body in a scene; -1 where it is not there.

    :param before: its row in another scene, which is often its row here
    """
    names = scene.names
    if 0 <= before < len(names) and names[before] == name:
        return before
    return names.index(name) if name in names else -1
