# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Actors: bodies that move on their own, by a mapping below the key `actor` of a body.

An actor is a path, or a pedestrian of some model; values only, checked as they are made. The core
moves them (`engine/core/actors.c`). Start with `actor`; a new kind is a class and a member of
`ACTORS`.
"""

from __future__ import annotations

from physsim_ros.model.actors.actor import Actor, Path, Start
from physsim_ros.model.actors.pedestrians import Orca, Pedestrian, SocialForce
from physsim_ros.model.declarations import OfKind

# By the word for it, in the order of `ACTOR_PATH`, `ACTOR_SOCIAL_FORCE`, `ACTOR_ORCA` of
# `engine/core/core.h`.
ACTORS: dict[str, type[Actor]] = {each.KIND: each for each in (Path, SocialForce, Orca)}

# The check of an actor.
actor_from = OfKind('actor', ACTORS)

__all__ = ['ACTORS', 'Actor', 'Orca', 'Path', 'Pedestrian', 'SocialForce', 'Start', 'actor_from']
