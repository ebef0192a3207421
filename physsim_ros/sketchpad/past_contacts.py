# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The contacts of the past that pages ask for: touches of bodies, and forces on them.

Law: they are found by a replay, so that a gate or a body tells the same if it is chosen after a
run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math
import time
from typing import Any, NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.rope_path import spans
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world
from physsim_ros.simulation.past import CachedFrame
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.body_pasts import row_in
from physsim_ros.sketchpad.contacts import touches_content
from physsim_ros.sketchpad.message import Content

# Time of a replay in a period of publishing [s]: a quarter of one of 60 Hz.
REPLAY_TIME = 0.004
# Kinds of the forces of a past, as pages call them; air is media and attraction.
PAST_KINDS = ('normal', 'friction', 'joint', 'air')
# Greatest number of looks at the contacts of the past that a page may ask for at once.
MOST_SEARCHES = 32


class _Search(NamedTuple):
    """
    A look at the contacts of the past.

    :ivar tell: gets the frames, part by part, in the order of time
    :ivar step: last one that was looked at
    :ivar end: last one to look at
    :ivar runs: whether the look goes on while time runs
    """

    tell: Callable[[Sequence[CachedFrame]], None]
    step: int
    end: int
    runs: bool


class PastContacts:
    """
    The contacts before pages asked for them, as a replay of the line in force finds them.

    Frames without contacts are replayed, a part at each call, while the world does not go back.

    :param simulation: with the past
    :param send: sends a message to the page of a number
    """

    def __init__(self, simulation: Simulation, send: Callable[[Content, int], None]) -> None:
        self._simulation = simulation
        self._send = send
        # By page and body, whose forces are looked for; '' is for the touches of followed bodies.
        self._searches: dict[tuple[int, str], _Search] = {}

    def ask_touches(self, page: int, names: frozenset[str]) -> None:
        """Send a page the touches of bodies from the oldest step on; no names end that."""
        rate = self._simulation.physics_rate

        def tell(frames: Sequence[CachedFrame]) -> None:
            for snapshot, contacts in frames:
                content = touches_content(snapshot, contacts, names, rate)
                if content is not None:
                    self._send(content, page)

        self._searches.pop((page, ''), None)
        if names:
            self._begin((page, ''), tell, self._simulation.step, runs=True)

    def ask_forces(self, page: int, name: str) -> None:
        """Send a page the forces on a body in the line in force, while time stands."""
        rate = self._simulation.physics_rate

        def tell(frames: Sequence[CachedFrame]) -> None:
            columns = past_forces(frames, name, rate)
            self._send({'type': 'past_forces', 'name': name, **columns}, page)

        if sum(number == page for number, _ in self._searches) < MOST_SEARCHES:
            self._begin((page, name), tell, self._simulation.past.line.head, runs=False)

    def forget(self, page: int) -> None:
        """Forget what a page has asked for."""
        self._searches = {key: each for key, each in self._searches.items() if key[0] != page}

    def _begin(
        self,
        key: tuple[int, str],
        tell: Callable[[Sequence[CachedFrame]], None],
        end: int,
        *,
        runs: bool,
    ) -> None:
        self._searches[key] = _Search(tell, self._simulation.past.line.oldest, end, runs)

    def send_due(self) -> None:
        """Look at the next frames of the past, for a few milliseconds."""
        simulation = self._simulation
        past = simulation.past
        # Until contacts are reported, cached frames are taken as they are, without contacts.
        if simulation.speed < 0.0 or not past.reports_contacts or past.cursor.is_working:
            return
        begin, is_still = time.monotonic(), simulation.speed == 0.0
        due = [key for key, search in self._searches.items() if search.runs or is_still]
        while due and time.monotonic() - begin < REPLAY_TIME:
            key = due.pop(0)
            tell, step, end, runs = self._searches.pop(key)
            end, step = min(end, past.line.head), max(step, past.line.oldest)
            frames: list[CachedFrame] = []
            while step < end and time.monotonic() - begin < REPLAY_TIME:
                wanted = min(end, step - step % past.frame_steps + past.frame_steps)
                if past.frames.replay_to_frame(wanted) is not None:
                    frames += past.frames.frames_after(step, wanted)
                    step = wanted
            if frames:
                tell(frames)
            if step < end:
                # It is the first one at the next call.
                self._searches = {key: _Search(tell, step, end, runs), **self._searches}


def past_forces(frames: Sequence[CachedFrame], name: str, rate: float) -> dict[str, Any]:
    """
    Return the columns of the forces on a body: time [s], sums by kind, x and y each [N].

    :param frames: in the order of time
    :param name: of the body; of one that was not there the columns are empty
    :param rate: steps a second of simulation
    """
    times: list[float] = []
    rows: list[Floats] = []
    row = -1
    for snapshot, contacts in frames:
        row = row_in(name, snapshot.scene, row)
        if row < 0 or contacts is None or not contacts.steps:
            continue
        # The force of a hand is not known.
        if any(grip.body == name for grip in snapshot.grips):
            continue
        # 1 for what acts on b, -1 on a, 0 on other bodies.
        sides = _sides(contacts.pairs, row)
        acting = contacts.impulses * sides[:, None] * (rate / contacts.steps)
        along = (acting * contacts.normals).sum(axis=1, keepdims=True) * contacts.normals
        pulls = np.zeros((1, 2))
        if len(snapshot.pulls) == len(snapshot.scene.joints):
            pulls = _pulls(snapshot, name, row)
        times.append(snapshot.stamp * 1e-9)
        fields = snapshot.fields[[row]] if len(snapshot.fields) else np.zeros((1, 2))
        forces = along, acting - along, pulls, fields
        rows.append(np.concatenate([each.sum(axis=0) for each in forces]))
    columns = np.array(rows).reshape(-1, 8)
    kinds = dict(zip(PAST_KINDS, np.hsplit(columns, 4), strict=True))
    return {'time': times, **{kind: forces.tolist() for kind, forces in kinds.items()}}


def _pulls(snapshot: Snapshot, name: str, row: int) -> Floats:
    """Return (j, 2) float64: the force of each joint on a body, world axes [N]."""
    scene, poses = snapshot.scene, snapshot.poses
    pulls: Floats = snapshot.pulls * _sides(scene.joint_rows, row)[:, None]
    for number, joint in enumerate(scene.joints):
        names = (joint.a, *(guide.body for guide in joint.guides), joint.b)
        if joint.kind is not JointKind.ROPE or not joint.guides or name not in names:
            continue
        seat = joint.seat
        passed = [
            (seat.ax, seat.ay),
            *((x, y) for _, x, y, *_ in joint.guides),
            (seat.bx, seat.by),
        ]
        places = [
            (x, y) if body == WORLD else local_to_world((x, y), tuple(poses[scene.row_of[body]]))
            for body, (x, y) in zip(names, passed, strict=True)
        ]
        radii = (0.0, *(guide.radius for guide in joint.guides), 0.0)
        headings = np.array([span.heading for span in spans(places, radii)])
        along = np.stack((np.cos(headings), np.sin(headings)), axis=1)
        ends = np.array([each == name for each in names], dtype=float)
        # The tension is the same in all spans, and draws the ends of each to one another.
        pulls[number] = math.hypot(*snapshot.pulls[number]) * (ends[:-1] - ends[1:]) @ along
    return pulls


def _sides(pairs: Ints, row: int) -> Floats:
    """Return (n,) float64: 1 where a body is the second of a pair, -1 where the first, else 0."""
    sides: Floats = np.subtract(pairs[:, 1] == row, pairs[:, 0] == row, dtype=float)
    return sides
