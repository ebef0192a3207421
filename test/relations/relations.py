# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The table of relations: each plays a scene in another way, and tells where its bodies are then.

A relation returns the film of the other world in the coordinates, times and names of the scene,
so that both are compared body by body, frame by frame.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
import math
from pathlib import Path
import tempfile

import numpy as np
from physsim_ros.files import load_world, save_world
from physsim_ros.model.actors import Pedestrian
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Command
from physsim_ros.model.transform import NO_WRENCH, rotated

from . import changes
from .films import begin, difference, Film, film_of, FRAMES, play, RATE, unaccounted
from .scenes import far_away, Scene

# To where bodies are put that are far away [m].
FAR = (300.0, 50.0)
# Difference of the energies of two films of a chaotic scene, as a share of all that moves or falls
# [1]: 22 bodies of any elasticity that are moved by a picometre differ by 0.05 after 1.5 s.
CHAOS = 0.2


@cache
def film(scene: Scene) -> Film:
    """Play a scene."""
    return play(begin(scene.state), scene.seconds)


@dataclass(frozen=True, kw_only=True)
class Relation:
    """
    A relation that holds for scenes.

    :param law: what holds, as a sentence
    :param other: plays a scene in another way; returns its film as that of the scene
    :param tolerance: of the places of points of bodies [m]
    :param reason: of the tolerance
    :param applies: whether it says anything about a state
    :param plain: each plays a scene; the other is compared with that which is nearest. A body to
        which something is joined is solved with its contacts by another method, as if a slack
        rope held it, unless what is joined has no effect at all
    :param keeps_energy: whether the other world has the energy of the scene, by which chaotic ones
        are compared; else their places are
    """

    law: str
    other: Callable[[Scene], Film]
    tolerance: float
    reason: str
    applies: Callable[[WorldState], bool] = lambda _: True
    plain: tuple[Callable[[Scene], Film], ...] = (film,)
    keeps_energy: bool = True

    def is_about(self, scene: Scene) -> bool:
        """Return whether it says anything about a scene."""
        return self.applies(scene.state)

    def limit(self, scene: Scene) -> float:
        """Return the tolerance of a scene [m]; of a chaotic one that of its energy [1]."""
        return CHAOS if self._is_of_energy(scene) else self.tolerance

    def _is_of_energy(self, scene: Scene) -> bool:
        return scene.chaotic and self.keeps_energy and self.tolerance > 0.0

    def off(self, scene: Scene) -> float:
        """Return how far the other world of a scene is off [m]; of a chaotic one in energy [1]."""
        other = self.other(scene)
        found = [difference(plain(scene), other) for plain in self.plain]
        return min(each.energy if self._is_of_energy(scene) else each.way for each in found)


def _changed(change):
    """Return what plays the world that a function makes of a scene's."""
    return lambda scene: play(begin(change(scene.state)), scene.seconds)


def _turned(angle, vector):
    def other(scene):
        seen = play(begin(changes.turned(scene.state, angle, vector)), scene.seconds)
        x, y, yaw = np.moveaxis(seen.poses, -1, 0)
        # The inverse turn.
        (cos, sin) = vector((1.0, 0.0))
        back = (cos * x + sin * y, cos * y - sin * x, yaw - angle)
        return seen.with_poses(np.stack(back, axis=-1))

    return other


def _moved(by):
    def other(scene):
        seen = play(begin(changes.moved(scene.state, by)), scene.seconds)
        return seen.with_poses(seen.poses - (*by, 0.0))

    return other


def _mirrored(scene):
    seen = play(begin(changes.mirrored(scene.state)), scene.seconds)
    return seen.with_poses(seen.poses * (1.0, -1.0, -1.0))


def _carried(velocity):
    def other(scene):
        seen = play(begin(changes.carried(scene.state, velocity)), scene.seconds)
        times = np.arange(len(seen.poses)) / FRAMES
        way = np.array((*velocity, 0.0)) * times[:, None, None]
        return seen.with_poses(seen.poses - way)

    return other


def _heavier(factor):
    def other(scene):
        seen = play(begin(changes.heavier(scene.state, factor)), scene.seconds)
        return replace(seen, energies=seen.energies / factor, kinetic=seen.kinetic / factor)

    return other


def _larger(size, time):
    def other(scene):
        state = changes.larger(scene.state, size, time)
        sim = begin(state, rate=RATE / time, frames=FRAMES / time)
        seen = play(sim, scene.seconds * time, frames=FRAMES / time)
        unit = (size / time) ** 2
        return replace(
            seen.with_poses(seen.poses / (size, size, 1.0)),
            energies=seen.energies / unit,
            kinetic=seen.kinetic / unit,
        )

    return other


def _renamed(scene):
    seen = play(begin(changes.renamed(scene.state)), scene.seconds)
    before = {new: old for old, new in changes.new_names(scene.state).items()}
    return seen.with_names(before[name] for name in seen.names)


def _published(frames):
    def other(scene):
        seen = play(begin(scene.state, frames=frames), scene.seconds, frames=frames)
        every = round(frames / FRAMES)
        return replace(
            seen,
            poses=seen.poses[::every],
            energies=seen.energies[::every],
            kinetic=seen.kinetic[::every],
        )

    return other


def _reported(scene):
    sim = begin(scene.state)
    sim.reports_contacts = True
    return play(sim, scene.seconds)


def _halves(scene):
    """Return the counts of frames before and after the middle of a scene."""
    count = round(scene.seconds * FRAMES)
    return count // 2, count - count // 2


def _first_half(scene):
    """Return a simulation at the middle of a scene, and the snapshots up to it."""
    sim = begin(scene.state)
    seen = [sim.world.snapshot()]
    seen += [sim.advance_frame().snapshot for _ in range(_halves(scene)[0])]
    return sim, seen


def _second_half(scene, sim, seen):
    seen += [sim.advance_frame().snapshot for _ in range(_halves(scene)[1])]
    return film_of(seen)


def _loaded(scene):
    sim, seen = _first_half(scene)
    with tempfile.TemporaryDirectory() as directory:
        path = save_world(sim.save(), 'saved', world_dir=directory, physics_rate=RATE)
        again = begin(load_world(Path(path), physics_rate=RATE))
    return _second_half(scene, again, seen)


def _begun_again(scene):
    """Play a scene which begins in its middle with its own state."""
    sim, seen = _first_half(scene)
    return _second_half(scene, begin(sim.save()), seen)


def _restored(scene):
    sim, seen = _first_half(scene)
    saved = sim.checkpoint()
    other = begin(scene.state)
    other.restore(saved)
    return _second_half(scene, other, seen)


def _commanded(scene):
    """Play a scene in which a node sets the velocities of bodies to what they are, each frame."""
    sim = begin(scene.state)
    seen = [sim.world.snapshot()]
    for _ in range(round(scene.seconds * FRAMES)):
        now = seen[-1]
        rows = [row for row, body in enumerate(now.scene.bodies) if changes.moves_freely(body)]
        if rows:
            names = tuple(now.scene.names[row] for row in rows)
            sim.perform(Command(names=names, twists=now.twists[rows]))
        seen.append(sim.advance_frame().snapshot)
    return film_of(seen)


def _at_checkpoint(scene):
    """Play a scene that takes a checkpoint in its middle."""
    sim, seen = _first_half(scene)
    sim.checkpoint()
    return _second_half(scene, sim, seen)


def _sought(scene):
    """Play a scene, and show it again from the past: back, and there again."""
    sim, seen = _first_half(scene)
    _second_half(scene, sim, seen)
    shown = [seen[0]]
    for now in seen[:0:-7]:
        sim.seek(now.stamp)
        sim.apply_requests()
    for now in seen[1:]:
        sim.seek(now.stamp)
        shown.append((sim.apply_requests() or sim.frame).snapshot)
    return film_of(shown)


@cache
def _at_rate(scene, factor):
    """Play a scene with a multiple of the steps a second."""
    return play(begin(scene.state, rate=factor * RATE), scene.seconds)


class _Nearer(Relation):
    """Twice the rate comes nearer to four times the rate, or does not go away."""

    def is_about(self, scene: Scene) -> bool:
        """Return whether paths of a scene come nearer to anything."""
        return not scene.chaotic

    def off(self, scene: Scene) -> float:
        """Return by how much further away twice the rate is [m]."""
        exact = _at_rate(scene, 4)
        once, twice = (difference(exact, seen).way for seen in (film(scene), self.other(scene)))
        return max(twice - once, 0.0)


class _Accounted(Relation):
    """The reported impulses account for the change of momentum; no other world is played."""

    def limit(self, scene: Scene) -> float:
        """Return the tolerance [m/s]: as a flight begins or ends, half a sub-step of gravity."""
        return self.tolerance + math.hypot(*scene.state.settings.gravity) / (8.0 * RATE)

    def off(self, scene: Scene) -> float:
        """Return which change of the velocity of a body is not accounted for [m/s]."""
        return unaccounted(self.other(scene), scene.seconds)


def _any(predicate):
    """Return whether a predicate is true of any body of a state."""
    return lambda state: any(map(predicate, state.bodies))


def _has_floor(state):
    return any(changes.is_floor(state, held) for held in state.bodies)


def _has_plain(state):
    return any(map(changes.is_plain, state.bodies))


def _moves_alone(state):
    """Return whether nothing but forces moves bodies, and nothing is fixed at a place."""
    settings = state.settings
    plain = all(
        held.body.robot is None
        and held.body.actor is None
        and held.body.surface_velocity == (0.0, 0.0)
        for held in state.bodies
    )
    return plain and not (settings.bounds or settings.floor_friction or settings.damping)


def _is_moved_by_bodies(state):
    """Return whether nothing but weight, contacts and joints of two bodies moves bodies."""
    settings = state.settings
    pushed = any(held.body.forces or held.wrench != NO_WRENCH for held in state.bodies)
    guided = any(joint.guides for joint in state.joints)
    air = settings.air_density or settings.air_viscosity
    fields = air or settings.gravitation or settings.coulomb
    fields = fields or any(held.body.medium is not None for held in state.bodies)
    plain = _moves_alone(replace(state, settings=replace(settings, bounds=None)))
    return plain and not (pushed or guided or fields)


def _has_units(state):
    """Return whether all its dimensions are in the bodies and joints that can be scaled."""
    plain = all(held.body.robot is None and held.body.actor is None for held in state.bodies)
    limits = any(
        joint.properties.max_force is not None or joint.properties.break_force is not None
        for joint in state.joints
    )
    return plain and not limits and not state.settings.damping


def _has_no_side(state):
    """Return whether nobody turns to the right before others, as pedestrians do."""
    return not any(isinstance(held.body.actor, Pedestrian) for held in state.bodies)


def _is_calm(state):
    """Return whether there are no gusts, which depend on the time and on no direction."""
    media = [held.body.medium for held in state.bodies if held.body.medium is not None]
    return not any(medium.gusts for medium in (*media, state.settings.air))


def _is_free(state):
    return state.settings.bounds is None


ROUNDING = 'rounding: a billionth of a metre after thousands of sub-steps'
THRESHOLDS = 'overlaps and speeds at which contacts change are in metres (docs/decisions/scale.md)'
MICROMETRE = 'a mass of a ten-millionth moves the point of contact and the period by as much'

# A rope that is never taut to each of a few bodies, whose contacts are solved with joints then.
TIED = cache(_changed(partial(changes.tied, kind=JointKind.ROPE, length=1e4)))

RELATIONS = {
    'shaken': Relation(
        law='a body that begins a picometre elsewhere ends up there',
        other=_changed(partial(changes.shaken, by=1e-12, seed=1)),
        tolerance=1e-9,
        reason=ROUNDING,
    ),
    'dust pinned': Relation(
        law='a ten-millionth of its mass, pinned to a body, does as a slack rope or nothing',
        other=_changed(partial(changes.pinned, share=1e-7)),
        plain=(film, TIED),
        tolerance=1e-4,
        reason=MICROMETRE,
        applies=_has_plain,
    ),
    'gram pinned': Relation(
        law='a thousandth of a body, pinned to its middle, does as a slack rope or changes little',
        other=_changed(partial(changes.pinned, share=1e-3)),
        plain=(film, TIED),
        tolerance=3e-3,
        reason='the moment of inertia is less by a thousandth',
        applies=_has_plain,
    ),
    'slack rope': Relation(
        law='a rope that is never taut changes nothing',
        other=TIED,
        tolerance=1e-4,
        reason='contacts are solved by another method, to the same law',
        applies=_has_plain,
    ),
    'damper of nothing': Relation(
        law='a damper of 1e-9 N s/m and kilogram does as a slack rope or nothing',
        other=_changed(
            partial(
                changes.tied,
                kind=JointKind.SPRING,
                stiffness=0.0,
                damping=lambda body: 1e-9 * body.total_mass,
                rest_length=1.0,
            )
        ),
        plain=(film, TIED),
        tolerance=1e-4,
        reason='contacts are solved by another method, to the same law',
        applies=_has_plain,
    ),
    'welded halves': Relation(
        law='two halves of a box, pinned to each other, move as the box',
        other=_changed(changes.welded),
        tolerance=1e-3,
        reason='each half has contact points of its own',
        applies=lambda state: any(map(changes.is_splittable, changes.few_plain(state))),
    ),
    'compounds': Relation(
        law='a box moves as the compound of its halves',
        other=_changed(changes.compounds),
        tolerance=1e-3,
        reason='each half has contact points of its own',
        applies=_any(changes.is_splittable),
    ),
    'other kinds': Relation(
        law='a box moves as the polygon of its corners, a disc as the compound of itself',
        other=_changed(changes.of_other_kinds),
        tolerance=0.0,
        reason='the engine gets the same numbers',
    ),
    'tiled': Relation(
        law='a floor of tiles is a floor',
        other=_changed(changes.tiled),
        tolerance=1e-3,
        reason='a body on a seam has contact points on both tiles',
        applies=_has_floor,
    ),
    'mirrored': Relation(
        law='the mirror image moves as the mirror image',
        other=_mirrored,
        tolerance=1e-9,
        reason=ROUNDING,
        applies=lambda state: _has_no_side(state) and _is_calm(state),
    ),
    'turned by 90°': Relation(
        law='a world that is turned with its gravity moves as before',
        other=_turned(math.pi / 2, changes.quarter),
        tolerance=1e-9,
        reason=ROUNDING,
    ),
    'turned by 40°': Relation(
        law='a world that is turned with its gravity moves as before',
        other=_turned(0.7, lambda vector: rotated(vector, 0.7)),
        tolerance=1e-9,
        reason=ROUNDING,
        applies=_is_free,
    ),
    'moved': Relation(
        law='a world that lies a kilometre away moves as before',
        other=_moved((1000.0, -700.0)),
        tolerance=1e-7,
        reason='places have 1e-13 m there',
    ),
    'heavier': Relation(
        law='masses and forces of a thousand times as much move as before',
        other=_heavier(1000.0),
        tolerance=1e-9,
        reason=ROUNDING,
    ),
    'four times as large': Relation(
        law='a world of four times the lengths and twice the times moves as before',
        other=_larger(4.0, 2.0),
        tolerance=1e-4,
        reason=THRESHOLDS,
        applies=_has_units,
    ),
    'ten times as large': Relation(
        law='a world of ten times the lengths and gravity moves as before',
        other=_larger(10.0, 1.0),
        tolerance=1e-4,
        reason=THRESHOLDS,
        applies=lambda state: _has_units(state) and not state.settings.floor_friction,
    ),
    'carried': Relation(
        law='a world that moves at a constant velocity moves as before',
        other=_carried((3.0, 1.0)),
        tolerance=1e-9,
        reason=ROUNDING,
        applies=_moves_alone,
        keeps_energy=False,
    ),
    'reordered': Relation(
        law='the order of bodies and joints changes nothing',
        other=_changed(changes.reordered),
        tolerance=1e-9,
        reason=ROUNDING,
    ),
    'beside a crowd': Relation(
        law='what happens three hundred metres away changes nothing',
        other=lambda scene: play(
            begin(changes.beside(scene.state, far_away(), FAR)), scene.seconds
        ),
        tolerance=1e-9,
        reason=ROUNDING,
        keeps_energy=False,
    ),
    'limits far off': Relation(
        law='limits of joints that are not reached change nothing',
        other=_changed(changes.limited),
        tolerance=1e-9,
        reason=ROUNDING,
        applies=lambda state: bool(state.joints),
    ),
    'renamed': Relation(
        law='names change nothing',
        other=_renamed,
        tolerance=0.0,
        reason='nothing is sorted by name',
    ),
    'published often': Relation(
        law='the publish rate changes nothing',
        other=_published(240.0),
        tolerance=0.0,
        reason='frames only read',
    ),
    'reported': Relation(
        law='reports of contacts change nothing',
        other=_reported,
        tolerance=0.0,
        reason='reports only read',
    ),
    'saved and loaded': Relation(
        law='a world that is saved and loaded midway goes on as one that begins with its state',
        other=_loaded,
        plain=(_begun_again,),
        tolerance=0.0,
        reason='a file has all bits',
    ),
    'begun again midway': Relation(
        law='a world that begins midway with its own state goes on as before',
        other=_begun_again,
        tolerance=1e-9,
        reason=ROUNDING,
        applies=_is_calm,
    ),
    'commanded': Relation(
        law='a velocity that is set to what it is changes nothing',
        other=_commanded,
        tolerance=1e-3,
        reason='a body that touches another is told its velocity to g dt / 8',
        applies=_has_plain,
    ),
    'restored': Relation(
        law='a world that is restored midway goes on as that which made the checkpoint',
        other=_restored,
        plain=(_at_checkpoint,),
        tolerance=0.0,
        reason='a checkpoint has all bits',
    ),
    'accounted': _Accounted(
        law='impulses of contacts and joints, and gravity, are what changes a momentum',
        other=lambda scene: begin(scene.state, frames=RATE),
        tolerance=1e-6,
        reason='a rod has turned a little by the end of a step',
        applies=_is_moved_by_bodies,
    ),
    'twice the rate': _Nearer(
        law='a world of twice the rate is nearer to that of four times the rate',
        other=partial(_at_rate, factor=2),
        tolerance=1e-4,
        reason='the moment within a sub-step of a first touch is a matter of luck',
    ),
    'sought there and back': Relation(
        law='the past is shown as it was',
        other=_sought,
        tolerance=0.0,
        reason='a replay makes the same bits',
    ),
}
