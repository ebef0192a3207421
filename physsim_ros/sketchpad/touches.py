# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Touches of bodies that a page follows: gates of its stopwatch, bodies whose collisions it counts.

Law: a touch has the time of the step in which it began, whatever the frames are.
"""

from __future__ import annotations

from typing import Any

from physsim_ros.model.snapshot import Frame

# Greatest number of bodies that a page follows.
MOST_FOLLOWED = 64


def touches_content(
    frame: Frame, followed: frozenset[str], physics_rate: float
) -> dict[str, Any] | None:
    """
    Return the message of the touches of followed bodies that began during a frame.

    :param followed: names of the bodies
    :param physics_rate: steps a second of simulation
    :return: None where there is none
    """
    contacts = frame.contacts
    if contacts is None or not len(contacts.begun):
        return None
    # Row -1 is a wall of the bounds.
    names = [*frame.snapshot.scene.names, '']
    first = frame.snapshot.step - contacts.steps
    pairs = zip(contacts.begun.tolist(), contacts.begun_at.tolist(), strict=True)
    found = [
        (names[one], names[other], (first + time) / physics_rate)
        for (a, b), time in pairs
        for one, other in ((a, b), (b, a))
        if names[one] in followed
    ]
    return {'type': 'touches', 'touches': found} if found else None
