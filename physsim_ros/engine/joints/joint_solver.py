# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Joint solver: jointed bodies and the contacts that they bear, solved directly after the engine.

**Problem.** Ten iterations of the engine's solver do not carry a load over a chain of light
bodies. A straight chain carries by tension alone, which no row of velocities asks for. A gap that
is closed by a velocity becomes energy where joints and contacts contradict each other.

**Method.** All rows of a joint, and those of the contacts of jointed bodies, are solved together
(`saddle_point`), in velocities and then in positions.

1. *Velocities.* The impulses that the engine gave to these rows are taken back. Joints and
   contacts along their normals are solved without friction, friction then within its cone
   (staggered projections: Kaufman, Sueda, James and Pai, SIGGRAPH Asia 2008). Both are
   projections, by which kinetic energy can only fall; contacts that bounce can make it rise. An
   island then has the greatest share of its bounces with which their impulses do no work.
2. *Curvature.* A point on a circle leaves its tangent in half a step, so that rows are solved for
   J v = - dt / 2 (dJ/dt) v; without that a pendulum loses (w dt)^2 / 2 of its energy in a step.
   An island gets no more energy by this than the projection took, and none where contacts press.
3. *Positions.* C(q) = 0 by Newton's method with the least mass-weighted displacement (fast
   projection: Goldenthal, Harmon, Fattal, Bercovier and Grinspun, SIGGRAPH 2007). Contacts are
   rows too, so that what joints pull in and what contacts push out is one system.
4. *Velocities, again.* The displacement of step 3 changes velocities as far as their energy falls
   by it (the velocity update of position based dynamics: Müller, Heidelberger, Hennix and
   Ratcliff, 2007). This is how a straight chain stops what falls on it: its rows have no
   velocity, only a gap of second order. A gap thus never becomes energy.

**Cost.** 0.2 to 0.4 ms a step for one machine; a factorisation of 100 rows takes 10 us.

Without it laws 14 to 16, 20, 22, 23, 33 and 34 fail. The engine's impulses are the first guess.
Impulses of springs and motors, and contacts between bodies without joints, stay the engine's.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints.contact_rows import ContactRows, read_contacts
from physsim_ros.engine.joints.joint_table import JointRows, JointTable
from physsim_ros.engine.joints.saddle_point import Problem, SaddlePoint, Solution
from physsim_ros.engine.settings import COLLISION_BIAS, COLLISION_SLOP
from physsim_ros.model.arrays import Flags, Floats, Ints

# Violated limits are closed but for this [m, rad]: Chipmunk stops a limit while it is violated.
LIMIT_SLOP = 1e-4
# The fastest that a gap is closed at [m/s, rad/s]: a body that is put elsewhere comes back like a
# thrown one, and joints that contradict each other move their bodies no further than that.
FASTEST_CORRECTION = 20.0
# E of velocities, as a share of the diagonal of J M^-1 J^T. The impulses are the engine's next
# guess; without E those of joints that contradict each other would be of any size.
VELOCITY_REGULARISATION = 1e-4
# E of positions: of joints, ...
POSITION_REGULARISATION = 1e-7
# ... and of contacts, which yield where joints contradict them.
CONTACT_REGULARISATION = 1e-3
# A Newton step is followed by another one in islands with a wider gap than this [m, rad]: ten
# planks in a straight row sag by 7 mm with a gap of 1e-6 m each.
CLOSED = 1e-5
# The first Newton step is made in islands with a wider gap than this [m, rad].
NEGLIGIBLE = 1e-7
# Greatest count of Newton steps in a step of the engine.
MOST_STEPS = 16
# The furthest that a body turns in a Newton step [rad]: rows are linear for small turns only, and
# points may be metres off.
MOST_TURN = 0.25
# The furthest that a body moves in a Newton step, in sums of all gaps of its island: joints that
# contradict each other have nearly singular equations, whose solutions are of any size.
MOST_LEVERAGE = 10.0
# Inverse masses of x, y and yaw.
_INVERSES = np.array([memory.BODY_INVERSE_MASS] * 2 + [memory.BODY_INVERSE_MOMENT])
# Greatest count of factorisations for friction; rows that are on the wrong side then have none.
FRICTION_ROUNDS = 10


class Bodies:
    """
    The jointed bodies, the background, and what they touch.

    :param table: of all bodies
    :param jointed: rows of the jointed bodies and the background
    :param touching: rows of bodies

    :ivar rows: (b,) intp: in the body table; the jointed bodies and the background come first
    :ivar places: (b,) int64: of `cpBody`
    :ivar inverse: (b, 3) float64: inverse masses, masses and moments; 0 is not dynamic
    :ivar dynamic: (b,) bool
    :ivar jointed: (b, 1) bool: jointed bodies, and the background
    :ivar poses: (b, 3) float64: of this step [m, rad]
    :ivar velocities: (b, 3) float64: of this step [m/s, rad/s]
    """

    def __init__(self, table: BodyTable, jointed: Rows, touching: Rows) -> None:
        others = np.zeros(len(table.places), np.bool_)
        others[touching] = True
        others[jointed] = False
        self.rows = np.concatenate((jointed, np.flatnonzero(others)))
        self.places = table.places[self.rows]
        self.inverse = memory.read_numbers(self.places, _INVERSES)
        self.inverse[~table.columns.dynamic[self.rows]] = 0.0
        self.dynamic: Flags = np.asarray(self.inverse.any(axis=1))
        self.jointed = (np.arange(len(self.rows)) < len(jointed))[:, None]
        self.poses: Floats
        self.velocities: Floats

    def read(self, table: BodyTable) -> None:
        """Read poses and velocities after the step of the engine."""
        state = table.state_with_background.take(self.rows, axis=0)
        self.poses, self.velocities = state[:, :3].copy(), state[:, 3:].copy()

    def write_velocities(self, changes: Floats) -> None:
        """Add (b, 3) changes to the velocities, here and in the engine."""
        self.velocities += changes
        moved = changes.any(axis=1)
        memory.write_numbers(self.places[moved], memory.BODY_TWIST, self.velocities[moved])

    def numbers_of(self, rows: Rows) -> Rows:
        """Return the numbers of bodies in the table, of any shape, among these."""
        order = np.argsort(self.rows)
        return order[np.searchsorted(self.rows, rows, sorter=order)]


class JointSolver:
    """
    Solves the joints of a space after each step.

    :param dt: of a step [s]
    """

    def __init__(self, dt: float) -> None:
        self._dt = dt
        # Kept while the same bodies are jointed and touch.
        self._key: tuple[JointTable, BodyTable, bytes] | None = None
        self._bodies: Bodies
        self._system: SaddlePoint

    def solve(self, joints: JointTable, table: BodyTable) -> None:
        """Change velocities, poses and impulses of jointed bodies and of what they touch."""
        if not len(joints.ends):
            return
        jointed = joints.rows(table.bodies)
        contacts = read_contacts(table, jointed[table.columns.dynamic[jointed]])
        key = joints, table, contacts.ends.tobytes()
        if key != self._key:
            self._key, self._bodies = key, Bodies(table, jointed, contacts.ends)
            ends = (joints.ends, *[self._bodies.numbers_of(contacts.ends)] * 2)
            self._system = SaddlePoint(np.concatenate(ends), self._bodies.inverse)
        bodies = self._bodies
        bodies.read(table)
        step = _Step(joints, contacts, bodies, self._system, self._dt)
        # A slow swing would fall asleep at its turn. The idle time of static bodies is infinite.
        memory.write_numbers(bodies.places[bodies.dynamic], memory.BODY_IDLE_TIME, 0.0)
        step.solve_velocities()
        step.solve_positions()
        table.forget_state()
        table.write_poses(bodies.rows[bodies.dynamic], bodies.poses[bodies.dynamic])


class _Step:
    """
    One step of the solver: rows of joints, then normals of contacts, then tangents.

    :param joints: of the space
    :param contacts: of jointed bodies
    :param bodies: of both
    :param system: of all rows
    :param dt: of the step [s]
    """

    def __init__(
        self,
        joints: JointTable,
        contacts: ContactRows,
        bodies: Bodies,
        system: SaddlePoint,
        dt: float,
    ) -> None:
        self._joints, self._contacts, self._bodies, self._dt = joints, contacts, bodies, dt
        self._system, self._islands, self._of_row = system, system.islands, system.island_of_row
        count, points = len(joints.ends), len(contacts)
        self._of_joints = slice(0, count)
        self._normals = slice(count, count + points)
        self._tangents = slice(count + points, count + 2 * points)
        self._slop = np.where(joints.equal, 0.0, LIMIT_SLOP)
        # Rows of joints that have not reached their greatest force.
        self._holding = np.ones(count, np.bool_)
        # The rows of joints where the engine's step ends.
        self._rows = joints.read(bodies.poses)

    def _per_row(
        self, joints: Floats | float, normals: Floats | float, tangents: Floats | float
    ) -> Floats:
        """Return (r,) float64 of values for joints, normals and tangents."""
        values = np.empty(len(self._of_row))
        values[self._of_joints], values[self._normals] = joints, normals
        values[self._tangents] = tangents
        return values

    # Velocities

    def solve_velocities(self) -> None:
        """Solve joints, contacts and friction in velocities."""
        joints, contacts, bodies, system = self._joints, self._contacts, self._bodies, self._system
        rows = self._rows
        jacobian = np.concatenate((rows.jacobian, contacts.normals, contacts.tangents))
        given = self._per_row(joints.impulses(rows), *contacts.impulses)
        without = -system.momenta(jacobian, given) * bodies.inverse
        rates = system.rates(jacobian, bodies.velocities + without)
        bounce = contacts.bounce
        solution = self._solve_impacts(jacobian, rates, bounce, given)
        if np.count_nonzero(bounce > 0.0):
            solution = self._without_gain(solution, jacobian, rates, bounce, given)
        changes = solution.changes
        more, bent = self._bend(jacobian, bodies.velocities + without + changes, solution)
        bodies.write_velocities(without + changes + bent)
        impulses = solution.impulses + more
        joints.write_impulses(rows, impulses[self._of_joints])
        first = self._normals.start
        contacts.write_impulses(impulses[first:].reshape(2, -1))
        self._holding = joints.holding(joints.equal & (solution.sides[self._of_joints] != 0))

    def _solve_impacts(
        self, jacobian: Floats, rates: Floats, bounce: Floats, given: Floats
    ) -> Solution:
        """
        Return the solution in velocities, friction included.

        :param rates: (r,) float64: J v without impulses
        :param bounce: (c,) float64: least velocities of contacts along their normals [m/s]
        :param given: (r,) float64: λ of the engine
        """
        joints, contacts, system = self._joints, self._contacts, self._system
        lower, upper = self._joint_bounds(self._rows)
        pressing = Problem(
            jacobian,
            self._per_row(0.0, bounce, -contacts.slide) - rates,
            self._per_row(np.maximum(lower, -joints.most), 0.0, 0.0),
            self._per_row(np.minimum(upper, joints.most), np.inf, 0.0),
        )
        even = np.full(len(rates), VELOCITY_REGULARISATION)
        solution = system.solve(pressing, _first_sides(pressing, given), even)
        if len(contacts):
            solution = self._solve_friction(pressing, solution, given, even)
        return system.refine(pressing, solution)

    def _without_gain(
        self, elastic: Solution, jacobian: Floats, rates: Floats, bounce: Floats, given: Floats
    ) -> Solution:
        """Return a solution with bounces, less the share of them that would create energy."""
        gained = self._gained(elastic, jacobian, rates, bounce)
        gains = gained > 0.0
        if not np.count_nonzero(gains):
            return elastic
        none = np.where(gains[self._of_row[self._normals]], np.minimum(bounce, 0.0), bounce)
        plastic = self._solve_impacts(jacobian, rates, none, given)
        lost = self._gained(plastic, jacobian, rates, bounce)
        return self._share_bounce(elastic, plastic, gained, lost)

    def _gained(
        self, solution: Solution, jacobian: Floats, rates: Floats, bounce: Floats
    ) -> Floats:
        """
        Return (b,) float64: of each island the work of the impulses of a solution [J].

        Velocities are relative to the surfaces that touch: the work that a kinematic body or a
        conveyor does is not counted.

        :param rates: (r,) float64: J v without the impulses
        :param bounce: (c,) float64: of the contacts, whose approach may have been as fast [m/s]
        """
        before = rates + self._per_row(0.0, 0.0, self._contacts.slide)
        after = before + self._system.rates(jacobian, solution.changes)
        # The engine measures the approach before gravity and springs act on it.
        approach = before[self._normals]
        before[self._normals] = np.where(bounce > 0.0, np.minimum(approach, -bounce), approach)
        work = solution.impulses * (before + after) / 2.0
        # Weighted counts are float64, which the types of NumPy 2.4 do not say.
        return np.bincount(self._of_row, work, len(self._islands))  # type: ignore[return-value]

    def _share_bounce(
        self, elastic: Solution, plastic: Solution, gained: Floats, lost: Floats
    ) -> Solution:
        """
        Return the solution between two, in each island the one whose impulses do no work.

        It meets the bounds of both, which are convex.

        :param elastic: the solution with bounces
        :param plastic: the same without those of islands that gain energy
        :param gained: (b,) float64: work in the first, by island [J]
        :param lost: (b,) float64: work in the second, by island [J]
        """
        changes = elastic.changes - plastic.changes
        impulses = elastic.impulses - plastic.impulses
        # Work is a quadratic function of the share: bend share² + slope share + lost.
        energy = self._system.products(changes, changes) / 2.0
        bend = np.bincount(self._islands, energy, len(self._islands))
        lost = np.minimum(lost, 0.0)
        slope = gained - lost - bend
        root = slope + np.sqrt(slope * slope - 4.0 * bend * lost)
        share = np.where(gained > 0.0, -2.0 * lost / np.maximum(root, 1e-300), 0.0)
        return plastic._replace(
            impulses=plastic.impulses + impulses * share[self._of_row],
            changes=plastic.changes + changes * share[self._islands][:, None],
        )

    def _joint_bounds(self, rows: JointRows) -> tuple[Floats, Floats]:
        """Return the least and the greatest λ of the rows of joints."""
        above = self._holding & (self._joints.equal | (rows.excess > 0.0))
        below = self._holding & (self._joints.equal | (rows.excess < 0.0))
        return np.where(above, -np.inf, 0.0), np.where(below, np.inf, 0.0)

    def _solve_friction(
        self, pressing: Problem, pressed: Solution, given: Floats, even: Floats
    ) -> Solution:
        """
        Return the solution with friction, for which contacts that press are equalities.

        :param pressing: joints and normals
        :param pressed: their solution
        :param given: (r,) float64: λ of the engine
        """
        acts, tangents = pressed.sides == 0, self._tangents
        most = self._contacts.friction * np.maximum(pressed.impulses[self._normals], 0.0)
        lower = np.where(acts, -np.inf, pressed.impulses)
        upper = np.where(acts, np.inf, pressed.impulses)
        lower[tangents], upper[tangents] = -most, most
        known = self._contacts.friction * given[self._normals] * (1.0 - 1e-9)
        slides = (np.abs(given[tangents]) >= known) | (most == 0.0)
        sides = pressed.sides.copy()
        sides[tangents] = np.where(slides, np.where(given[tangents] < 0.0, -1, 1), 0)
        cone = Problem(pressing.jacobian, pressing.wanted, lower, upper)
        solution = self._system.solve(cone, sides, even, FRICTION_ROUNDS)
        if not np.count_nonzero(solution.wrong):
            return solution
        wrong = solution.wrong.copy()
        wrong[: tangents.start] = False
        lower[wrong] = upper[wrong] = 0.0
        sides = np.where(wrong, -1, solution.sides)
        return self._system.solve(cone, sides, even, rounds=1)

    def _bend(
        self, jacobian: Floats, velocities: Floats, solution: Solution
    ) -> tuple[Floats, Floats]:
        """
        Return the impulses of the curvature, and what they change.

        :param velocities: (b, 3) float64: without them [m/s, rad/s]
        :param solution: whose factors the system has
        :return: (r,) float64 and (b, 3) float64
        """
        system, dt = self._system, self._dt
        halfway = self._joints.read(self._bodies.poses + velocities * (dt / 2.0)).jacobian
        turned = np.zeros_like(jacobian)
        turned[self._of_joints] = halfway - jacobian[self._of_joints]
        counts = self._per_row(self._joints.equal.astype(np.float64), 0.0, 0.0) * (
            solution.sides == 0
        )
        impulses, changes = system.solve_active(-system.rates(turned, velocities) * counts)
        lost = system.products(solution.changes, solution.changes)
        gained = system.products(changes, changes)
        share = np.sqrt(self._share(lost, gained))
        # Under a load rows can be singular, as those of a straight chain: there energy is lost.
        share[self._of_row[self._normals][solution.sides[self._normals] == 0]] = 0.0
        return impulses * share[self._of_row], changes * share[self._islands][:, None]

    def _share(self, lost: Floats, gained: Floats) -> Floats:
        """Return (b,) float64: of each island the share of a gain that what was lost pays."""
        count = len(self._islands)
        paid = np.bincount(self._islands, lost, count)
        owed = np.maximum(np.bincount(self._islands, gained, count), 1e-300)
        share: Floats = np.minimum(np.maximum(paid, 0.0), owed) / owed
        return share

    # Positions

    def solve_positions(self) -> None:
        """Close gaps in positions, and remove the velocity that opened them."""
        joints, contacts, bodies = self._joints, self._contacts, self._bodies
        normals = np.zeros((len(self._of_row), 2, 3))
        normals[self._normals] = contacts.normals
        start = bodies.poses.copy()
        moves = self._take_pushes(normals)
        bodies.poses += moves
        pushed = bodies.poses.copy()
        # Of an overlap the engine's share of a step is pushed out; nothing gets deeper.
        apart = contacts.distance + COLLISION_SLOP
        apart = apart - np.minimum(apart, 0.0) * COLLISION_BIAS**self._dt
        rows, most = self._rows, FASTEST_CORRECTION * self._dt
        if np.count_nonzero(moves):
            rows = joints.read(bodies.poses)
        gaps = self._gaps(rows)
        # Parts of gaps that are too wide to be closed in one step.
        left = gaps - np.minimum(np.maximum(gaps, -most), most)
        impulses = np.zeros(len(self._of_row))
        best = _BestIterates(self._system, bodies.poses, impulses)
        for number in range(MOST_STEPS + 1):
            gaps = self._gaps(rows) - left
            ways = self._system.rates(normals, bodies.poses - start)
            distance = apart + ways[self._normals]
            errors = np.concatenate((np.abs(gaps), -np.minimum(distance, 0.0)))
            of_row = self._of_row[: len(errors)]
            sums = np.zeros(len(self._islands))
            np.add.at(sums, of_row, errors)
            best.keep_better(sums, bodies.poses, impulses)
            wide = np.zeros(len(sums), np.bool_)
            wide[of_row[errors > (CLOSED if number else NEGLIGIBLE)]] = True
            if number == MOST_STEPS or not np.count_nonzero(wide):
                break
            solution = self._newton_step(
                JointRows(gaps, rows.jacobian), distance, impulses, wide[self._of_row]
            )
            share = self._trusted(solution.changes, sums)
            bodies.poses[:] += solution.changes * share[self._islands][:, None]
            impulses = impulses + solution.impulses * share[self._of_row]
            rows = joints.read(bodies.poses)
        if not np.count_nonzero(best.impulses):
            return
        bodies.poses[:] = best.poses
        self._remove_velocity(best.poses - pushed, rows, best.impulses)

    def _gaps(self, rows: JointRows) -> Floats:
        """Return (j,) float64: C of the rows of joints that hold, less the slop of limits."""
        excess = np.where(self._holding, rows.excess, 0.0)
        gaps: Floats = np.sign(excess) * np.maximum(np.abs(excess) - self._slop, 0.0)
        return gaps

    def _newton_step(
        self, rows: JointRows, distance: Floats, impulses: Floats, open_rows: Flags
    ) -> Solution:
        """
        Return the displacement that closes linear gaps and overlaps.

        :param rows: of joints, with the gaps to close
        :param distance: (c,) float64: of contacts, < 0 where they overlap [m]
        :param impulses: (r,) float64: λ of the displacement so far, the first guess
        :param open_rows: (r,) bool: rows of islands with gaps
        """
        contacts = self._contacts
        lower, upper = self._joint_bounds(rows)
        problem = Problem(
            np.concatenate((rows.jacobian, contacts.normals, contacts.tangents)),
            -self._per_row(rows.excess, distance, 0.0),
            np.where(open_rows, self._per_row(lower, 0.0, 0.0), 0.0),
            np.where(open_rows, self._per_row(upper, np.inf, 0.0), 0.0),
        )
        even = self._per_row(
            POSITION_REGULARISATION, CONTACT_REGULARISATION, CONTACT_REGULARISATION
        )
        return self._system.solve(problem, _first_sides(problem, impulses), even)

    def _take_pushes(self, normals: Floats) -> Floats:
        """
        Return (b, 3) float64: the ways by which other contacts push jointed bodies out.

        The pushes of the rows' own contacts are removed, since their overlaps are solved here.
        """
        bodies, contacts = self._bodies, self._contacts
        pushes = memory.read_numbers(bodies.places, memory.BODY_BIAS)
        bias = self._per_row(0.0, contacts.bias, 0.0)
        pushes -= self._system.momenta(normals, bias) * bodies.inverse
        pushes[~bodies.dynamic] = 0.0
        ways: Floats = np.where(bodies.jointed, pushes * self._dt, 0.0)
        # The engine moves what has no joints by the others itself, in the next step.
        others = np.where(bodies.jointed, 0.0, pushes)
        memory.write_numbers(bodies.places, memory.BODY_BIAS, others)
        return ways

    def _trusted(self, changes: Floats, errors: Floats) -> Floats:
        """
        Return (b,) float64: the share of a Newton step that each island makes (trust region).

        :param changes: (b, 3) float64: displacements [m, rad]
        :param errors: (b,) float64: sum of gaps and overlaps of each island [m, rad]
        """
        farthest, most_turn = np.zeros(len(errors)), np.zeros(len(errors))
        np.maximum.at(farthest, self._islands, np.hypot(changes[:, 0], changes[:, 1]))
        np.maximum.at(most_turn, self._islands, np.abs(changes[:, 2]))
        by_turn = MOST_TURN / np.maximum(most_turn, 1e-300)
        by_way = MOST_LEVERAGE * errors / np.maximum(farthest, 1e-300)
        trusted: Floats = np.minimum(1.0, np.minimum(by_turn, by_way))
        return trusted

    def _remove_velocity(self, moved: Floats, rows: JointRows, impulses: Floats) -> None:
        """
        Change velocities by a displacement, as far as their energy falls by it.

        :param moved: (b, 3) float64 [m, rad]
        :param rows: of the joints
        :param impulses: (r,) float64: λ of the displacement [kg m, kg m²]
        """
        bodies, system = self._bodies, self._system
        changes = moved / self._dt
        against = -system.products(bodies.velocities, changes)
        share = self._share(against, system.products(changes, changes))
        bodies.write_velocities(changes * share[self._islands][:, None])
        given = impulses * share[self._of_row] / self._dt
        joints, contacts = self._joints, self._contacts
        before = joints.impulses(rows)
        joints.write_impulses(rows, before + given[self._of_joints])
        impulses = contacts.impulses
        impulses[0] += given[self._normals]
        contacts.write_impulses(impulses)


class _BestIterates:
    """
    The iterate of the least error, island by island.

    :param system: of all rows
    :param poses: (b, 3) float64: the first iterate [m, rad]
    :param impulses: (r,) float64: λ of its displacement [kg m, kg m²]
    """

    def __init__(self, system: SaddlePoint, poses: Floats, impulses: Floats) -> None:
        self._islands, self._of_row = system.islands, system.island_of_row
        self.poses, self.impulses = poses.copy(), impulses
        self._least = np.full(len(self._islands), np.inf)

    def keep_better(self, errors: Floats, poses: Floats, impulses: Floats) -> None:
        """Keep an iterate in the islands where its error, (b,) float64 [m, rad], is the least."""
        better = errors < self._least
        self._least = np.minimum(errors, self._least)
        of_body = better[self._islands]
        self.poses[of_body] = poses[of_body]
        self.impulses = np.where(better[self._of_row], impulses, self.impulses)


def _first_sides(problem: Problem, guess: Floats) -> Ints:
    """Return (r,) int64: the sides of rows by a guess of λ."""
    return np.where(guess <= problem.lower, -1, np.where(guess >= problem.upper, 1, 0))
