# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Impact propagation: elastic contacts next to each other are solved one after the other.

**Problem.** Chipmunk takes the restitution of a contact from the approach velocity before the step
and solves all contacts together. The second of two touching balls has no approach velocity against
the third when the first hits it, so that contact is solved as inelastic, and the row takes the
impact as one body. Where a body is in two impacts at once, the ten iterations of the solver do not
converge, and energy is lost or gained.

**Method.** Sequential impacts: pairwise Newton restitution, the fastest approach first, each round
being one step of the engine. See Smith, Kaufman, Vouga, Tamstorf and Grinspun, *Reflections on
Simultaneous Impact*, SIGGRAPH 2012, section 3 (Gauss-Seidel impacts). A contact is deferred by
a step while one of its bodies is in a faster impact. The next step finds the velocity that the
impact has given, and passes it on.

**Scope.** Contacts of a restitution from `ELASTIC` on. Contacts under load, as in a stack, and
deep ones are not deferred, nor contacts that are equally fast: what is symmetric stays so. Each
decision depends on the contacts of the two bodies in this step alone.

**Cost.** Nothing in a world without an elastic body; else the contacts of the step are read in
batch, and those that are deferred are visited one by one, about 5 us each.

Without it laws 17 (Newton's cradle), 21 (elastic discs keep their energy) and 36 (elastic rows)
fail.

**Limits.** A contact that is deferred sinks by a step of the impact: a pile of 1,000 bodies of
restitution 0.8 comes to rest with contacts up to 33 mm deep, one in a hundred deeper than 21 mm,
where the solver alone leaves 5 mm.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.model.arrays import Floats, Ints
import pymunk
from pymunk import batch

# ruff: noqa: SLF001 - Chipmunk's contacts have no public way to be written

# Restitution from which an impact is passed on, rather than taken together: below it, more than
# 7 / 16 of the energy of an impact is lost anyway.
ELASTIC = 0.75
# Approach velocity from which two bodies are in an impact [m/s]; bodies at rest tremble by less.
SLOWEST = 0.05
# Overlap below which contacts are those of polygons that just touch [m]: ten times the rounding of
# a position within a kilometre of the origin.
GRAZING = 1e-12
# Approach velocities of this ratio are equal but for rounding.
ALIKE = 1.0 - 1e-9
# Approach that a deferred contact permits, in velocities of the impact. That changes the velocity
# of a body of any mass by two at most: two for each body and the contact's own approach make five.
PERMITTED = 5.0
# Share of the impact next to a contact that its impulse of the last step has to stop, so that it
# is under load.
LOAD_SHARE = 0.05

_F = batch.ArbiterFields
_FIELDS = _F.BODY_A_ID | _F.BODY_B_ID | _F.NORMAL | _F.CONTACT_COUNT
_FIELDS |= _F.POINT_A_1 | _F.POINT_B_1 | _F.DISTANCE_1
_FIELDS |= _F.POINT_A_2 | _F.POINT_B_2 | _F.DISTANCE_2


class ImpactPropagation:
    """
    Defers contacts next to an impact by a step.

    :param pm_space: of the engine, whose `collision_persistence` is 1
    :param io: of it
    """

    def __init__(self, pm_space: pymunk.Space, io: BatchIO) -> None:
        self._pm_space = pm_space
        self._io = io

    def defer_contacts(self, table: BodyTable) -> None:
        """Defer the contacts of bodies that are in a faster impact."""
        if table.columns.most_elastic < ELASTIC:
            return
        dynamic = table.columns.dynamic
        contacts = self._contacts(table)
        if contacts is None:
            return
        rows, counts, approach, depths = contacts
        # The fastest approach of each body; bodies that forces do not move take no impact.
        impacts = np.zeros(len(dynamic))
        # Polygons that just touch have one point by rounding, and both in the next step.
        grazing = (approach > SLOWEST) & (depths < GRAZING) & (counts == 1)
        hits = (approach > SLOWEST) & ~grazing
        for side in rows[hits].T:
            np.maximum.at(impacts, side, approach[hits])
        impacts[~dynamic] = 0.0
        nearby = np.where(grazing, 2.0 * approach, impacts[rows].max(axis=1))
        weaker = approach < ALIKE * nearby
        # One that is deeper than a step of the impact takes it is solved with the others.
        weaker &= depths < COLLISION_SLOP + nearby * self._pm_space.current_time_step
        self._defer_all(table, rows[weaker], nearby[weaker])

    def _contacts(self, table: BodyTable) -> tuple[Ints, Ints, Floats, Floats] | None:
        """
        Return the elastic contacts of the coming solve; None where there are none.

        :return: (k, 2) rows of the bodies, (k,) counts of points, (k,) approach velocities [m/s]
            and (k,) depths [m], the greater one of two points
        """
        ints, floats = self._io.read_contacts(_FIELDS)
        ids, numbers = ints.reshape(-1, 3), floats.reshape(-1, 12)
        rows, elasticity = table.rows_of(ids[:, :2]), table.columns.elasticity
        # Sensors have no points.
        elastic = (elasticity[rows].prod(axis=1) >= ELASTIC) & (ids[:, 2] > 0)
        if not elastic.any():
            return None
        rows, counts, numbers = rows[elastic], ids[elastic, 2], numbers[elastic]
        # (k, 2, 5): both points of a contact, on either body, and their distance.
        normals, both = numbers[:, None, :2], numbers[:, 2:].reshape(-1, 2, 5)
        both[counts == 1, 1] = both[counts == 1, 0]
        points, distances = both[..., :4].reshape(-1, 2, 2, 2), both[..., 4]
        # (k, 2, 2, ...): contact, point, body.
        states = table.read_states()[rows][:, None]
        arms = points - states[..., :2]
        velocities = states[..., 3:5] + states[..., 5:] * np.stack(
            (-arms[..., 1], arms[..., 0]), axis=-1
        )
        speeds = ((velocities[:, :, 1] - velocities[:, :, 0]) * normals).sum(axis=-1)
        return rows, counts, -speeds.min(axis=1), -distances.min(axis=1)

    def _defer_all(self, table: BodyTable, rows: Ints, impacts: Floats) -> None:
        """
        Defer contacts that approach less fast than an impact next to them.

        :param rows: (k, 2) of their bodies
        :param impacts: (k,) approach velocity of the impact [m/s]
        """
        # A dynamic body comes first: it has fewer contacts than the ground.
        rows = np.where(table.columns.dynamic[rows[:, :1]], rows, rows[:, ::-1])
        found: dict[int, dict[Any, float]] = {}
        for (one, other), impact in zip(rows.tolist(), impacts.tolist(), strict=True):
            others, body = found.setdefault(one, {}), self._pm_body(table, other)._body
            # Two bodies may touch in several contacts, which the engine lists by their addresses:
            # the least impact counts for all of them.
            others[body] = min(impact, others.get(body, impact))
        for one, others in found.items():
            pm_body = self._pm_body(table, one)

            def look(
                arbiter: pymunk.Arbiter,
                own: Any = pm_body._body,
                others: dict[Any, float] = others,
            ) -> None:
                raw = arbiter._arbiter
                impact = others.get(raw.body_b if raw.body_a == own else raw.body_a)
                if impact is not None:
                    _defer(raw, impact)

            pm_body.each_arbiter(look)

    def _pm_body(self, table: BodyTable, row: int) -> pymunk.Body:
        """Return the engine's body of a row; of the last one, the background."""
        return table.bodies[row].pm_body if row < len(table.bodies) else self._pm_space.static_body


def _defer(arbiter: Any, impact: float) -> None:
    """
    Exclude a contact from this step, unless it is as fast as the impact or under load.

    Private fields of Chipmunk 7 as in Pymunk 7.3.1, `cpContact` of `cpArbiter.contacts`:
    `bounce` [m/s] is set to `e * v_n` by `cpArbiterPreStep`, `v_n < 0` being approach; the solver
    seeks an impulse `jnAcc >= 0` [kg m/s] for which `v_n >= -bounce`, from that of the step before
    on. A great positive `bounce` permits approach. `nMass` [kg] is the effective mass. Pymunk can
    skip a contact (`Arbiter.process_collision`), but not between narrow phase and solver; with
    that, this can go.

    :param arbiter: `cpArbiter`
    :param impact: approach velocity of the fastest impact of the two bodies [m/s], > 0
    """
    points = [arbiter.contacts[place] for place in range(arbiter.count)]
    for point in points:
        if -point.bounce >= ALIKE * impact * arbiter.e:
            return
        # An impulse of the last step where bodies do not part is a load, as in a stack.
        if point.bounce < SLOWEST * arbiter.e and point.jnAcc > LOAD_SHARE * impact * point.nMass:
            return
    for point in points:
        point.bounce = PERMITTED * impact
        point.jnAcc = point.jtAcc = 0.0
