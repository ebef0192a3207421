# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of the core against brute force: random cases by seed, and all possible answers."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest

SEEDS = range(40)


class Parts:
    """The calls of `calls.h` with arrays of NumPy."""

    def __init__(self, parts):
        self.ffi, self.lib = parts
        self.held = []

    def array(self, values, kind='double'):
        array = np.array(values, np.int32 if kind == 'int' else np.float64)
        self.held.append(self.ffi.from_buffer(array))
        return array, self.ffi.cast(f'{kind} *', self.held[-1])


@pytest.fixture
def call(parts):
    return Parts(parts)


# Memory of a step


@pytest.mark.parametrize('seed', SEEDS)
def test_memory_is_empty_when_it_is_taken_and_grows_to_what_a_step_needs(call, seed):
    random = np.random.default_rng(seed)
    sizes = random.integers(1, 400, int(random.integers(1, 20)))
    kept = int(random.integers(len(sizes)))

    assert call.lib.call_arena(len(sizes), call.array(sizes, 'int')[1], kept)


# Sets


@pytest.mark.parametrize('seed', SEEDS)
def test_the_root_of_a_set_is_the_least_of_all_that_pairs_tie_together(call, seed):
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 30))
    pairs = random.integers(count, size=(int(random.integers(30)), 2))
    roots, pointer = call.array(np.zeros(count), 'int')

    call.lib.call_sets(count, len(pairs), call.array(pairs, 'int')[1], pointer)

    wanted = np.arange(count)
    for _ in pairs:
        for a, b in pairs:
            wanted[[a, b]] = min(wanted[[a, b]])
    assert roots.tolist() == wanted.tolist()


# Factors of a sparse matrix


def columns_of(matrix):
    """Return the entries above the diagonal that are not 0, as `ldl.h` has them."""
    size = len(matrix)
    rows = [[r for r in range(c) if matrix[r, c]] for c in range(size)]
    starts = np.cumsum([0, *map(len, rows)])
    values = [matrix[r, c] for c in range(size) for r in rows[c]]
    return starts, [r for each in rows for r in each], values


def sparse(random):
    """Return a random quasi-definite matrix."""
    size = int(random.integers(1, 14))
    matrix = random.normal(size=(size, size)) * (random.random((size, size)) < 0.4)
    matrix = np.triu(matrix, 1)
    # Masses, then rows, of which only those couple that are of different kinds.
    signs = random.choice([-1.0, 1.0], size)
    matrix *= signs[:, None] != signs[None, :]
    return matrix + matrix.T + np.diag(signs * random.uniform(0.1, 3.0, size))


def factored(call, former, matrix, side):
    """Return the solution by factors of a former matrix, made anew where columns differ."""
    starts, rows, values = columns_of(matrix)
    _, _, former_values = columns_of(former)
    x, pointer = call.array(side)
    call.lib.call_ldl(
        len(matrix),
        *(call.array(each, 'int')[1] for each in (starts, rows or [0])),
        *(call.array(each)[1] for each in (former_values or [0.0], np.diag(former))),
        *(call.array(each)[1] for each in (values or [0.0], np.diag(matrix))),
        pointer,
    )
    return x


@pytest.mark.parametrize('seed', SEEDS)
def test_factors_solve_what_a_dense_solver_does(call, seed):
    random = np.random.default_rng(seed)
    matrix = sparse(random)
    side = random.normal(size=len(matrix))

    x = factored(call, matrix, matrix, side)

    assert x == pytest.approx(np.linalg.solve(matrix, side), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
def test_factors_that_are_made_anew_where_columns_change_are_those_of_the_whole(call, seed):
    random = np.random.default_rng(seed)
    former = sparse(random)
    side = random.normal(size=len(former))
    factors = np.where(random.random(len(former)) < 0.3, 1.25, 1.0)
    changed = np.triu(former) * factors
    changed += np.triu(changed, 1).T

    x = factored(call, former, changed, side)

    assert x.tolist() == factored(call, changed, changed, side).tolist()


# Contacts that press or part


def lcp_solutions(matrix, rates):
    """Yield every λ >= 0 with A λ + b >= 0 of which one is 0 in each row."""
    for active in product([False, True], repeat=len(rates)):
        at = np.flatnonzero(active)
        found = np.zeros(len(rates))
        if len(at):
            found[at] = np.linalg.solve(matrix[np.ix_(at, at)], -rates[at])
        if found.min() >= -1e-12 and (matrix @ found + rates).min() >= -1e-12:
            yield found


def solved_lcp(call, matrix, rates):
    """Return whether the core solves contacts, and their impulses."""
    count = len(rates)
    padded = np.zeros((8, 8))
    padded[:count, :count] = matrix
    impulses, pointer = call.array(np.zeros(8))
    at_matrix = call.ffi.cast('double (*)[8]', call.array(padded)[1])
    at_rates = call.array(np.pad(rates, (0, 8 - count)))[1]
    return call.lib.call_lcp(count, at_matrix, at_rates, pointer), impulses[:count]


@pytest.mark.parametrize('seed', SEEDS)
def test_impulses_of_contacts_are_the_only_ones_of_all_sets_of_contacts(call, seed):
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 7))
    root = random.normal(size=(count, count + 1))
    matrix = root @ root.T * np.outer(*[10 ** random.uniform(-1, 1, count)] * 2)
    matrix = (matrix + matrix.T) / 2
    rates = random.normal(size=count)

    solved, impulses = solved_lcp(call, matrix, rates)

    (wanted,) = lcp_solutions(matrix, rates)
    assert solved
    scale = np.sqrt(np.diag(matrix))
    assert impulses * scale == pytest.approx(wanted * scale, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize('count', range(1, 9))
def test_contacts_that_say_the_same_share_an_impulse(call, count):
    solved, impulses = solved_lcp(call, np.full((count, count), 0.7), np.full(count, -2.1))

    assert solved
    assert impulses == pytest.approx(np.full(count, 3.0 / count), rel=1e-5)


# Two contacts that push a body nearly against each other.
WEDGE = np.array([[1.0, -0.9], [-0.9, 1.0]])


def test_a_contact_that_presses_by_ever_so_little_presses(call):
    # The first guess has both contacts part.
    solved, impulses = solved_lcp(call, WEDGE, np.array([1.0, -2e-7]))

    assert solved
    assert impulses == pytest.approx([0.0, 2e-7], rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(('closeness', 'is_solved'), [(1e-5, True), (1e-7, False)])
def test_a_body_wedged_between_two_that_do_not_move_has_no_solution(call, closeness, is_solved):
    matrix = np.array([[1.0, closeness - 1.0], [closeness - 1.0, 1.0]])

    solved, _ = solved_lcp(call, matrix, np.array([-1.0, -1.0]))

    assert solved == is_solved


# Rows with bounds


def mixed_solutions(matrix, wanted, lower, upper):
    """Yield every λ within bounds whose rows reach their targets, or pass them at a bound."""
    for sides in map(np.array, product([-1, 0, 1], repeat=len(wanted))):
        at = np.flatnonzero(sides == 0)
        found = np.select([sides < 0, sides > 0], [lower, upper], 0.0)
        if not np.isfinite(found).all():
            continue
        if len(at):
            known = wanted - matrix @ found
            found[at] = np.linalg.solve(matrix[np.ix_(at, at)], known[at])
        beyond = (matrix @ found - wanted) * sides
        if (
            (found >= lower - 1e-9).all()
            and (found <= upper + 1e-9).all()
            and beyond.max() <= 1e-9
        ):
            yield found


def solved_rows(call, inverses, former_ends, ends, jacobians, *columns):
    """Return how many rows the core leaves wrong, impulses, and changes of velocities."""
    impulses, at_impulses = call.array(np.zeros(len(ends)))
    changes, at_changes = call.array(np.zeros((len(inverses), 3)))
    wrong = call.lib.call_mixed_lcp(
        len(inverses),
        call.array(inverses)[1],
        len(ends),
        *(call.array(each, 'int')[1] for each in (ends, former_ends)),
        call.array(np.arange(len(ends)), 'int')[1],
        *(call.array(each)[1] for each in (jacobians, *columns)),
        at_impulses,
        at_changes,
    )
    return wrong, impulses, changes


@pytest.mark.parametrize('seed', SEEDS)
def test_impulses_of_rows_are_the_only_ones_of_all_sets_of_bounds(call, seed):
    random = np.random.default_rng(seed)
    bodies, rows = int(random.integers(2, 5)), int(random.integers(1, 6))
    inverses = random.uniform(0.1, 3.0, (bodies, 2))
    inverses[0] = 0.0  # the background
    ends = np.array([random.choice(bodies, 2, replace=False) for _ in range(rows)])
    jacobians = random.normal(size=(rows, 6))
    wanted = random.normal(size=rows)
    lower = random.choice([-np.inf, 0.0, -0.3], rows)
    upper = random.choice([np.inf, 0.2], rows)
    softness = random.uniform(0.01, 0.1, rows)
    dense = np.zeros((rows, 3 * bodies))
    for row, (a, b) in enumerate(ends):
        dense.reshape(rows, bodies, 3)[row, [a, b]] = jacobians[row].reshape(2, 3)
    inverse_mass = np.repeat(inverses, (2, 1), axis=1).ravel()
    # E, as a share of J M⁻¹ Jᵀ as if the row acted at the centres of mass.
    linear = np.einsum(
        'rbi,rbi,rb->r', *[jacobians.reshape(rows, 2, 3)[..., :2]] * 2, inverses[ends, 0]
    )
    matrix = dense * inverse_mass @ dense.T + np.diag(softness * linear)

    former_ends = ends[::-1] if random.random() < 0.5 else ends
    wrong, impulses, changes = solved_rows(
        call, inverses, former_ends, ends, jacobians, wanted, lower, upper, softness
    )

    first, *others = mixed_solutions(matrix, wanted, lower, upper)
    assert wrong == 0
    assert impulses == pytest.approx(first, rel=1e-6, abs=1e-6)
    assert all(first == pytest.approx(other, rel=1e-6, abs=1e-6) for other in others)
    assert changes.ravel() == pytest.approx(inverse_mass * (dense.T @ impulses), abs=1e-9)


@pytest.mark.parametrize(
    ('cosine', 'wanted', 'exact'),
    [(-0.9, (-1.0, 2e-6), (0.0, 2e-6)), (0.0, (1.0, -2e-8), (1.0, 0.0))],
    ids=['one that presses a little', 'none that pulls a little'],
)
def test_rows_are_on_their_sides_to_their_rounding(call, cosine, wanted, exact):
    inverses = np.array([[0.0, 0.0], [1.0, 1.0]])
    across = (1.0 - cosine * cosine) ** 0.5
    jacobians = np.array([[0.0] * 3 + [1.0, 0.0, 0.0], [0.0] * 3 + [cosine, across, 0.0]])
    lower, upper, softness = np.zeros(2), np.full(2, np.inf), np.full(2, 1e-12)

    ends = [[0, 1], [0, 1]]
    wrong, impulses, _ = solved_rows(
        call, inverses, ends, ends, jacobians, wanted, lower, upper, softness
    )

    assert wrong == 0
    assert impulses == pytest.approx(exact, rel=1e-6, abs=1e-9)


# Orders of elimination


def fill_of(edges, weights, order):
    """Return the weight of the edges that eliminating nodes in an order adds."""
    near = [{b for a, b in edges if a == node} for node in range(len(weights))]
    fill = 0
    for node in order:
        for one in near[node]:
            near[one].discard(node)
            for other in near[node] - near[one] - {one}:
                fill += weights[one] * weights[other]
            near[one] |= near[node] - {one}
    return fill / 2


def order_of(call, edges, weights):
    edges = sorted(edges)
    starts = np.searchsorted([a for a, _ in edges], range(len(weights) + 1))
    order, pointer = call.array(np.zeros(len(weights)), 'int')
    call.lib.call_elimination_order(
        len(weights),
        *(call.array(each, 'int')[1] for each in (weights, starts, [b for _, b in edges] or [0])),
        pointer,
    )
    return order.tolist()


def both_ways(pairs):
    return {edge for a, b in pairs for edge in ((a, b), (b, a))}


@pytest.mark.parametrize('seed', SEEDS)
def test_the_elimination_of_a_tree_fills_nothing(call, seed):
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 40))
    names = random.permutation(count)
    edges = both_ways((names[k], names[random.integers(k)]) for k in range(1, count))

    order = order_of(call, edges, np.ones(count, int))

    assert sorted(order) == [*range(count)]
    assert fill_of(edges, np.ones(count), order) == 0


@pytest.mark.parametrize('seed', SEEDS)
def test_an_elimination_fills_little_more_than_the_best_of_all_orders(call, seed):
    random = np.random.default_rng(seed)
    count = 6
    weights = random.integers(1, 4, count)
    pairs = [(a, b) for a in range(count) for b in range(a) if random.random() < 0.45]
    edges = both_ways(pairs)

    order = order_of(call, edges, weights)

    fills = [fill_of(edges, weights, each) for each in permutations(range(count))]
    assert sorted(order) == [*range(count)]
    # A greedy order: of these cases the worst makes an eighth of what lies between best and worst.
    assert fill_of(edges, weights, order) <= min(fills) + 0.15 * (max(fills) - min(fills))


# Boxes


@pytest.mark.parametrize('seed', SEEDS)
def test_a_tree_finds_the_boxes_that_overlap_and_no_others(call, seed):
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 70))
    low = random.normal(size=(count + 2, 2)) * random.choice([1.0, 100.0], (count + 2, 1))
    # Numbers of one decimal, so that edges meet.
    boxes = np.round(np.hstack([low, low + random.exponential(1.0, low.shape)]), 1)
    boxes, replacement, asked = boxes[:count], boxes[count], boxes[count + 1]
    changed = int(random.integers(count))
    found, pointer = call.array(np.zeros(count), 'int')
    at_boxes = call.array(boxes)[1]
    others = [call.array(each)[1] for each in (replacement, asked)]

    number = call.lib.call_boxes(count, at_boxes, changed, *others, count + 1, pointer)

    boxes[changed] = replacement
    wanted = np.all(boxes[:, :2] <= asked[2:], axis=1) & np.all(asked[:2] <= boxes[:, 2:], axis=1)
    assert sorted(found[:number]) == np.flatnonzero(wanted).tolist()
    for most in range(1, number):
        # The search ends when enough are found.
        assert call.lib.call_boxes(count, at_boxes, changed, *others, most, pointer) == most


# Times of impact

SLOP = 1e-3
DEPTH = 0.02
MOMENTS = np.linspace(0.0, 1.0, 4001)


def case_of(call, corners, pose, *, radius=0.0, change=(0.0, 0.0, 0.0)):
    """Return a `Case` of `calls.h`."""
    case = call.ffi.new('Case *')
    case.corners = call.array(corners)[1]
    case.normals = call.array(normals_of(corners))[1]
    case.count, case.radius = len(corners), radius
    case.pose, case.change = list(pose), list(change)
    return case


def convex(random):
    """Return the corners of a point, a segment or a polygon, counter-clockwise, and its radius."""
    count = int(random.integers(1, 7))
    angles = np.sort(random.uniform(0.0, 2 * np.pi, count))
    if count > 2:
        angles = (np.arange(count) + random.uniform(-0.3, 0.3, count)) * 2 * np.pi / count
    corners = np.column_stack([np.cos(angles), np.sin(angles)]) * random.uniform(0.2, 1.0)
    return corners, random.uniform(0.1, 0.5) if count < 3 else 0.0


def normals_of(corners):
    """Return the normals of the faces that end at each corner."""
    edges = corners - np.roll(corners, 1, axis=0)
    sizes = np.hypot(*edges.T)
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    return np.where(sizes[:, None] > 0, normals / np.where(sizes > 0, sizes, 1.0)[:, None], 0.0)


def ways_of(corners, pose, change):
    """Return the corners in the world at each of `MOMENTS`."""
    x, y, yaw = (np.asarray(pose)[:, None] + np.outer(change, MOMENTS))[:, :, None]
    return np.stack(
        [
            x + corners[:, 0] * np.cos(yaw) - corners[:, 1] * np.sin(yaw),
            y + corners[:, 0] * np.sin(yaw) + corners[:, 1] * np.cos(yaw),
        ],
        axis=-1,
    )


def gaps_of(one, other):
    """Return the distance of two convex outlines at each moment; < 0 is the least overlap."""
    apart, near = np.full(len(MOMENTS), -np.inf), np.full(len(MOMENTS), np.inf)
    for a, b in ((one, other), (other, one)):
        for k in range(a.shape[1]):
            start, end = a[:, k - 1], a[:, k]
            edge = end - start
            size = np.maximum(np.hypot(*edge.T), 1e-100)  # of a point
            normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / size[:, None]
            to = b - start[:, None]
            share = np.clip(np.einsum('tki,ti->tk', to, edge) / size[:, None] ** 2, 0.0, 1.0)
            rest = to - share[..., None] * edge[:, None]
            near = np.minimum(near, np.hypot(*np.moveaxis(rest, -1, 0)).min(axis=1))
            if a.shape[1] > 1:
                heights = np.einsum('tki,ti->tk', b - end[:, None], normal)
                apart = np.maximum(apart, heights.min(axis=1))
    return np.where((apart < 0.0) & (apart > -np.inf), apart, near)


@pytest.mark.parametrize('turns', [0.0, 2.0])
@pytest.mark.parametrize('seed', SEEDS)
def test_shapes_meet_when_they_first_overlap_by_the_slop(call, seed, turns):
    random = np.random.default_rng(seed)
    cases, radii, ways = [], 0.0, []
    for side in (-1.0, 1.0):
        corners, radius = convex(random)
        pose = np.array([side * 1.5, 0.0, 0.0]) + random.uniform(-0.4, 0.4, 3)
        change = np.array([-side * 1.5, *random.uniform(-0.5, 0.5, 2)]) * [1.0, 1.0, turns]
        cases.append(case_of(call, corners, pose, radius=radius, change=change))
        ways.append(ways_of(corners, pose, change))
        radii += radius
    gaps = gaps_of(*ways) - radii
    skin = SLOP if radii == 0.0 else min(SLOP, radii / 2.0)

    share = call.lib.call_time_of_impact(*cases, SLOP, DEPTH)

    if share == np.inf:
        # The rest of the approach is less than the safe depth; of what turns it is not told.
        assert turns or gaps.min() >= -skin - DEPTH
    else:
        assert gaps[share >= MOMENTS].min() >= -skin - 1e-9
        # One that turns may end before, where it takes too many advances.
        assert np.interp(share, MOMENTS, gaps) <= (-0.9 * skin + 1e-6 if not turns else 0.0)


# Parts of bodies in a region


def immersed(call, corners, pose, region, *, radius=0.0):
    """Return area, first moment and outline of what of a shape is in a region, or None for all."""
    found, pointer = call.array(np.zeros(4))
    given = case_of(call, corners, pose, radius=radius)
    at_region = call.ffi.NULL if region is None else case_of(call, region, (0.0, 0.0, 0.0))
    call.lib.call_immersed(given, at_region, pointer)
    return found


@pytest.mark.parametrize('seed', SEEDS)
def test_corners_on_the_edge_of_a_region_are_before_and_behind_it_in_turn(call, seed):
    random = np.random.default_rng(seed)
    pose = random.uniform(-3.0, 3.0, 3)
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    # Its lower side has nine corners on one line, on which the edge of the region lies.
    corners = np.array([*((0.5 * number, 0.0) for number in range(9)), (4.0, 1.0), (0.0, 1.0)])
    below = np.array([[-9.0, 0.0], [-9.0, -9.0], [9.0, -9.0], [9.0, 0.0]])
    above = -below
    for region, area in ((below, 0.0), (above, 4.0)):
        world = region @ [[cos, sin], [-sin, cos]] + pose[:2]

        found, *_ = immersed(call, corners, pose, world)

        assert found == pytest.approx(area, abs=1e-9)


def rounded(corners, radius):
    """Return the corners of a polygon that is a disc or a segment but for 1e-5 of its size."""
    angles = np.linspace(0.0, 2 * np.pi, 1440, endpoint=False)
    circle = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ahead = circle @ (corners[-1] - corners[0])
    if not ahead.any():
        return corners[0] + circle
    first = int(np.flatnonzero((ahead >= 0) & (np.roll(ahead, 1) < 0))[0])
    circle, ahead = np.roll(circle, -first, axis=0), np.roll(ahead, -first)
    return np.where((ahead >= 0)[:, None], corners[-1], corners[0]) + circle


def clipped(corners, region):
    """Return the part of a polygon that lies in a convex region (Sutherland and Hodgman)."""
    for start, end in zip(region, np.roll(region, -1, axis=0), strict=True):
        edge = end - start
        heights = edge[0] * (corners[:, 1] - start[1]) - edge[1] * (corners[:, 0] - start[0])
        kept = []
        for k in range(len(corners)):
            before, now = heights[k - 1], heights[k]
            if (before < 0) != (now < 0):
                share = before / (before - now)
                kept.append(corners[k - 1] + share * (corners[k] - corners[k - 1]))
            if now >= 0:
                kept.append(corners[k])
        if not kept:
            return np.zeros((1, 2))
        corners = np.array(kept)
    return corners


def area_and_moment(corners):
    following = np.roll(corners, -1, axis=0)
    crossed = corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0]
    return crossed.sum() / 2, (crossed[:, None] * (corners + following)).sum(axis=0) / 6


@pytest.mark.parametrize('corner_count', [1, 2])
@pytest.mark.parametrize('seed', SEEDS)
def test_a_round_body_is_wet_where_it_lies_in_a_region(call, seed, corner_count):
    random = np.random.default_rng(seed)
    corners, radius = random.uniform(-0.5, 0.5, (corner_count, 2)), random.uniform(0.1, 0.6)
    angles = (np.arange(3) + random.uniform(-0.3, 0.3, 3)) * 2 * np.pi / 3
    region = random.uniform(-0.5, 0.5, 2) + np.column_stack([np.cos(angles), np.sin(angles)])

    area, *moment, _ = immersed(call, corners, (0.0, 0.0, 0.0), region, radius=radius)

    wanted_area, wanted_moment = area_and_moment(clipped(rounded(corners, radius), region))
    assert area == pytest.approx(wanted_area, abs=2e-5)
    assert moment == pytest.approx(wanted_moment, abs=2e-5)


@pytest.mark.parametrize('seed', SEEDS)
def test_what_is_dry_and_what_is_wet_is_the_whole_body(call, seed):
    random = np.random.default_rng(seed)
    corners, radius = convex(random)
    pose = random.uniform(-0.5, 0.5, 3)
    above = np.array([[-9.0, 0.0], [9.0, 0.0], [9.0, 9.0], [-9.0, 9.0]])
    all_around = np.array([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]])

    parts = [immersed(call, corners, pose, each, radius=radius) for each in (above, -above)]

    whole = immersed(call, corners, pose, all_around, radius=radius)
    *_, outline = immersed(call, corners, pose, None, radius=radius)
    assert sum(parts) == pytest.approx(whole, abs=1e-9)
    assert whole[3] == pytest.approx(outline, abs=1e-9)
