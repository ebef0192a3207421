# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Films of worlds: poses and energies, frame by frame, and how far two films are apart."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from physsim_ros.simulation.simulation import Simulation

RATE, FRAMES = 240.0, 60.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Film:
    """
    What became of some bodies.

    :param names: of the bodies
    :param radii: (n,) float64: greatest distance of a point of each from its centre of mass [m]
    :param poses: (f, n, 3) float64: x, y [m], yaw [rad] of each in each frame
    :param energies: (f,) float64: kinetic, potential and elastic energy of the world [J]
    :param kinetic: (f,) float64: kinetic energy of the world [J]
    """

    names: tuple[str, ...]
    radii: np.ndarray
    poses: np.ndarray
    energies: np.ndarray
    kinetic: np.ndarray

    def with_poses(self, poses):
        """Return the film with other poses."""
        return replace(self, poses=poses)

    def with_names(self, names):
        """Return the film with other names of its bodies."""
        return replace(self, names=tuple(names))

    def rows(self, names):
        """Return the rows of some bodies."""
        row_of = {name: row for row, name in enumerate(self.names)}
        return [row_of[name] for name in names]


class Difference(NamedTuple):
    """
    How far two films are apart.

    :ivar way: greatest distance of a point of a body from where it is in the other film [m]
    :ivar energy: greatest difference of the energies, as a share of all that moves or falls [1]
    """

    way: float
    energy: float


def begin(state, *, rate=RATE, frames=FRAMES):
    """Return a simulation that begins with a state."""
    sim = Simulation(physics_rate=rate, publish_rate=frames)
    sim.begin(state)
    return sim


def film_of(snapshots):
    """Return the film of some snapshots; a body that is removed stays where it was last."""
    first = snapshots[0]
    names, poses = first.scene.names, [first.poses]
    for now in snapshots[1:]:
        row = now.poses
        if now.scene.names != names:
            row_of = {name: at for at, name in enumerate(now.scene.names)}
            row = np.array(
                [
                    now.poses[row_of[name]] if name in row_of else poses[-1][at]
                    for at, name in enumerate(names)
                ]
            )
        poses.append(row)
    return Film(
        names=names,
        radii=first.scene.outer_radii,
        poses=np.array(poses),
        energies=np.array(
            [now.kinetic_energy + now.potential_energy + now.elastic_energy for now in snapshots]
        ),
        kinetic=np.array([now.kinetic_energy for now in snapshots]),
    )


def play(sim, seconds, *, frames=FRAMES):
    """Return the film of a simulation from now on."""
    snapshots = [sim.world.snapshot()]
    snapshots += [sim.advance_frame().snapshot for _ in range(round(seconds * frames))]
    return film_of(snapshots)


def unaccounted(sim, seconds):
    """
    Return the change of velocity that gravity, contacts and joints do not account for [m/s].

    It is the greatest of all bodies and steps, for all steps since the first one, which begins
    with a jump of the engine's velocity (`half_step.c`).

    :param sim: one that publishes each step
    """
    sim.reports_contacts = True
    first = sim.advance_frame().snapshot
    scene, gravity = first.scene, np.array(first.scene.settings.gravity)
    row_of = {name: row for row, name in enumerate(scene.names)}
    moves = np.array([body.dynamic for body in scene.bodies])
    # The last row is that of the background.
    impulses = np.zeros((len(scene.names) + 1, 2))
    most = 0.0
    for step in range(1, round(seconds * RATE)):
        frame = sim.advance_frame()
        now, contacts = frame.snapshot, frame.contacts
        np.add.at(impulses, contacts.pairs[:, 0], -contacts.impulses)
        np.add.at(impulses, contacts.pairs[:, 1], contacts.impulses)
        for joint, pull in zip(now.scene.joints, now.pulls, strict=True):
            impulses[row_of.get(joint.a, -1)] -= pull / RATE
            impulses[row_of.get(joint.b, -1)] += pull / RATE
        given = impulses[:-1][moves] / scene.inertia[moves, :1] + gravity * step / RATE
        changed = (now.twists - first.twists)[moves, :2]
        most = max(most, np.hypot(*(given - changed).T).max(initial=0.0))
    return most


def difference(film, other):
    """Return how far another film is from one; bodies that only one of them has are left out."""
    both = [name for name in film.names if name in other.names]
    rows, others = film.rows(both), other.rows(both)
    off = other.poses[:, others] - film.poses[:, rows]
    way = np.hypot(off[..., 0], off[..., 1]) + film.radii[rows] * np.abs(off[..., 2])
    swing = np.ptp(film.energies - film.kinetic) + film.kinetic.max()
    lost = (other.energies - other.energies[0]) - (film.energies - film.energies[0])
    return Difference(
        way=float(way.max(initial=0.0)),
        energy=float(np.abs(lost).max() / swing) if swing else 0.0,
    )
