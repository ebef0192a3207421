// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows of many bodies, solved directly and together.
//
// Problem: impulses λ change velocities v by M⁻¹ Jᵀ λ; the rows J v are to reach their targets.
// Method: those impulses,
//
//     [ M   Jᵀ ] [ dv ]   [ 0            ]
//     [ J  -E  ] [ -λ ] = [ target - J v ],
//
// form a sparse, symmetric, quasi-definite system (`ldl`). E is a small part of the diagonal of J M⁻¹ Jᵀ, since rows
// may say the same twice, as the joints of a parallelogram do.
//
// Islands whose bodies and rows are those of the sub-step before keep their patterns and orders of elimination.
// Cost: of a chain of fifty axles 30 µs for a new pattern and 12 µs a factorisation.

#include "saddle_point.h"
#include "elimination_order.h"
#include <string.h>

enum { NO_UNKNOWN = -1 };

// The bodies that forces move, and the groups of rows, as the nodes of a graph.
typedef struct Nodes {
    int body_count, count;
    int *bodies;     // of each node of a body, the body
    int *first_rows; // of each node of a group, its first row; one more at the end
} Nodes;

static bool has_mass(Inverse inverse) {
    return inverse.mass > 0.0;
}

static Nodes nodes_of(const System *system, Arena *arena) {
    Nodes nodes = {.bodies = TAKE(arena, int, system->body_count),
                   .first_rows = TAKE(arena, int, system->row_count + 1)};
    for (int body = 0; body < system->body_count; body++) {
        system->body_unknowns[body] = NO_UNKNOWN;
        if (has_mass(system->inverses[body])) {
            system->body_unknowns[body] = nodes.body_count;
            nodes.bodies[nodes.body_count++] = body;
        }
    }
    int group_count = 0;
    for (int row = 0; row < system->row_count; row++) {
        if (row == 0 || system->groups[row] != system->groups[row - 1]) {
            nodes.first_rows[group_count++] = row;
        }
    }
    nodes.first_rows[group_count] = system->row_count;
    nodes.count = nodes.body_count + group_count;
    return nodes;
}

static int add_end(const System *system, int body, int *ends, int count) {
    int node = system->body_unknowns[body];
    for (int end = 0; end < count; end++) {
        node = ends[end] == node ? NO_UNKNOWN : node;
    }
    if (node == NO_UNKNOWN) {
        return count;
    }
    ends[count] = node;
    return count + 1;
}

// The nodes of the bodies of a row that forces move, at most two for each of its links.
static int ends_that_move(const System *system, int row, int *ends) {
    int count = add_end(system, system->ends[row].a, ends, 0);
    count = add_end(system, system->ends[row].b, ends, count);
    for (int link = system->further[row]; link < system->further[row + 1]; link++) {
        count = add_end(system, system->ends[link].a, ends, count);
        count = add_end(system, system->ends[link].b, ends, count);
    }
    return count;
}

static int *order_of(const System *system, const Nodes *nodes, Arena *arena) {
    int group_count = nodes->count - nodes->body_count;
    int *weights = TAKE(arena, int, nodes->count), *starts = TAKE(arena, int, nodes->count + 2);
    int *neighbours = TAKE(arena, int, 4 * system->link_count + 1), *ends = TAKE(arena, int, 2 * system->link_count);
    for (int node = 0; node < nodes->body_count; node++) {
        weights[node] = 3;
    }
    for (int group = 0; group < group_count; group++) {
        int node = nodes->body_count + group;
        weights[node] = nodes->first_rows[group + 1] - nodes->first_rows[group];
        int count = ends_that_move(system, nodes->first_rows[group], ends);
        starts[node + 2] += count;
        for (int end = 0; end < count; end++) {
            starts[ends[end] + 2]++;
        }
    }
    for (int node = 1; node <= nodes->count; node++) {
        starts[node + 1] += starts[node];
    }
    for (int group = 0; group < group_count; group++) {
        int count = ends_that_move(system, nodes->first_rows[group], ends);
        for (int end = 0; end < count; end++) {
            neighbours[starts[nodes->body_count + group + 1]++] = ends[end];
            neighbours[starts[ends[end] + 1]++] = nodes->body_count + group;
        }
    }
    return elimination_order((Graph){nodes->count, weights, starts, neighbours}, arena);
}

// Number the unknowns in the order in which they are eliminated.
static int number_unknowns(System *system, const Nodes *nodes, const int *order) {
    int count = 0;
    for (int place = 0; place < nodes->count; place++) {
        if (order[place] < nodes->body_count) {
            system->body_unknowns[nodes->bodies[order[place]]] = count;
            count += 3;
            continue;
        }
        int group = order[place] - nodes->body_count;
        for (int row = nodes->first_rows[group]; row < nodes->first_rows[group + 1]; row++) {
            system->row_unknowns[row] = count++;
        }
    }
    assert(count == 3 * nodes->body_count + system->row_count);
    return count;
}

// The column and the line of an entry of J of a link above the diagonal; whether there is one.
static bool entry_at(const System *system, int row, int link, int number, int *column, int *line) {
    assert(number >= 0 && number < 6);
    int body = system->body_unknowns[number < 3 ? system->ends[link].a : system->ends[link].b];
    int unknown = body + number % 3, own = system->row_unknowns[row];
    *column = own > unknown ? own : unknown;
    *line = own > unknown ? unknown : own;
    return body != NO_UNKNOWN;
}

// Count the entries of a link by columns.
static void count_entries(const System *system, int row, int link, int *starts) {
    int column = 0, line = 0;
    for (int number = 0; number < 6; number++) {
        if (entry_at(system, row, link, number, &column, &line)) {
            starts[column + 2]++;
        }
    }
}

static void place_entries(System *system, int row, int link, int *starts, int *rows) {
    int column = 0, line = 0;
    for (int number = 0; number < 6; number++) {
        system->places[link][number] = NO_UNKNOWN;
        if (entry_at(system, row, link, number, &column, &line)) {
            system->places[link][number] = starts[column + 1];
            rows[starts[column + 1]++] = line;
        }
    }
}

static void lay_out_entries(System *system, Arena *arena) {
    int size = system->factors.size;
    int *starts = TAKE(arena, int, size + 2), *rows = TAKE(arena, int, 6 * system->link_count);
    for (int row = 0; row < system->row_count; row++) {
        count_entries(system, row, row, starts);
        for (int link = system->further[row]; link < system->further[row + 1]; link++) {
            count_entries(system, row, link, starts);
        }
    }
    for (int each = 1; each <= size; each++) {
        starts[each + 1] += starts[each];
    }
    for (int row = 0; row < system->row_count; row++) {
        place_entries(system, row, row, starts, rows);
        for (int link = system->further[row]; link < system->further[row + 1]; link++) {
            place_entries(system, row, link, starts, rows);
        }
    }
    system->factors.starts = starts;
    system->factors.rows = rows;
}

// Find the order of elimination, and where matrix and factors are not 0.
static void find_pattern(System *system, Arena *arena) {
    system->body_unknowns = TAKE(arena, int, system->body_count);
    system->row_unknowns = TAKE(arena, int, system->row_count);
    system->places = arena_take(arena, (size_t)system->link_count, sizeof(*system->places));
    Nodes nodes = nodes_of(system, arena);
    system->factors.size = number_unknowns(system, &nodes, order_of(system, &nodes, arena));
    lay_out_entries(system, arena);
    ldl_analyse(&system->factors, arena);
}

bool has_layout(const System *system, Layout layout) {
    if (system->body_count != layout.body_count || system->row_count != layout.row_count ||
        system->link_count != layout.further[layout.row_count]) {
        return false;
    }
    for (int body = 0; body < layout.body_count; body++) {
        if (has_mass(layout.inverses[body]) == (system->body_unknowns[body] == NO_UNKNOWN)) {
            return false;
        }
    }
    size_t rows = (size_t)layout.row_count, links = (size_t)system->link_count;
    return memcmp(system->further, layout.further, (rows + 1) * sizeof(int)) == 0 &&
           memcmp(system->groups, layout.groups, rows * sizeof(int)) == 0 &&
           memcmp(system->ends, layout.ends, links * sizeof(Ends)) == 0;
}

System system_of(Arena *arena, Layout layout) {
    size_t rows = (size_t)layout.row_count, links = (size_t)layout.further[layout.row_count];
    System system = {.body_count = layout.body_count,
                     .row_count = layout.row_count,
                     .link_count = layout.further[layout.row_count],
                     .inverses = layout.inverses,
                     .ends = arena_copy(arena, layout.ends, links, sizeof(Ends)),
                     .further = arena_copy(arena, layout.further, rows + 1, sizeof(int)),
                     .groups = arena_copy(arena, layout.groups, rows, sizeof(int))};
    find_pattern(&system, arena);
    system.factors.values = TAKE(arena, double, 6 * system.link_count);
    system.factors.diagonal = TAKE(arena, double, system.factors.size);
    system.side = TAKE(arena, double, system.factors.size);
    return system;
}

void begin_system(System *system, const Inverse *inverses) {
    system->inverses = inverses;
    for (int body = 0; body < system->body_count; body++) {
        int unknown = system->body_unknowns[body];
        if (unknown != NO_UNKNOWN) {
            system->factors.diagonal[unknown] = system->factors.diagonal[unknown + 1] = 1.0 / inverses[body].mass;
            system->factors.diagonal[unknown + 2] = 1.0 / inverses[body].moment;
        }
    }
    memset(system->factors.changed, true, (size_t)system->factors.size * sizeof(bool));
}

Solution solution_for(const System *system, Arena *arena) {
    return (Solution){.impulses = TAKE(arena, double, system->row_count),
                      .changes = TAKE(arena, Twist, system->body_count),
                      .sides = TAKE(arena, int8_t, system->row_count),
                      .wrong = TAKE(arena, bool, system->row_count)};
}

double mass_product(const System *system, const Twist *u, const Twist *v) {
    double sum = 0.0;
    for (int body = 0; body < system->body_count; body++) {
        Inverse inverse = system->inverses[body];
        if (has_mass(inverse)) {
            sum += dot(u[body].v, v[body].v) / inverse.mass + u[body].w * v[body].w / inverse.moment;
        }
    }
    return sum;
}

double softness_unit(Jacobian jacobian, Inverse a, Inverse b) {
    double linear = dot(jacobian.a.v, jacobian.a.v) * a.mass + dot(jacobian.b.v, jacobian.b.v) * b.mass;
    double angular = jacobian.a.w * jacobian.a.w * a.moment + jacobian.b.w * jacobian.b.w * b.moment;
    return linear > 0.0 ? linear : angular;
}

double row_softness_unit(const System *system, const Jacobian *jacobians, int row) {
    Ends ends = system->ends[row];
    double unit = softness_unit(jacobians[row], system->inverses[ends.a], system->inverses[ends.b]);
    for (int link = system->further[row]; link < system->further[row + 1]; link++) {
        ends = system->ends[link];
        unit += softness_unit(jacobians[link], system->inverses[ends.a], system->inverses[ends.b]);
    }
    return unit;
}

static void set_link(System *system, int row, int link, Jacobian jacobian) {
    double entries[6] = {jacobian.a.v.x, jacobian.a.v.y, jacobian.a.w, jacobian.b.v.x, jacobian.b.v.y, jacobian.b.w};
    int column = 0, line = 0;
    for (int number = 0; number < 6; number++) {
        if (entry_at(system, row, link, number, &column, &line)) {
            system->factors.values[system->places[link][number]] = entries[number];
            system->factors.changed[column] = true;
        }
    }
}

void set_row(System *system, int row, const Jacobian *jacobians, double stiffness) {
    Jacobian none = {0};
    system->factors.diagonal[system->row_unknowns[row]] = -stiffness;
    system->factors.changed[system->row_unknowns[row]] = true;
    set_link(system, row, row, jacobians == NULL ? none : jacobians[row]);
    for (int link = system->further[row]; link < system->further[row + 1]; link++) {
        set_link(system, row, link, jacobians == NULL ? none : jacobians[link]);
    }
}

void solve_with(System *system, const int8_t *sides, const double *wanted, const Twist *momenta, double *impulses,
                Twist *changes) {
    double *x = system->side;
    for (int body = 0; body < system->body_count; body++) {
        int unknown = system->body_unknowns[body];
        if (unknown != NO_UNKNOWN) {
            Twist given = momenta == NULL ? (Twist){0} : momenta[body];
            x[unknown] = given.v.x, x[unknown + 1] = given.v.y, x[unknown + 2] = given.w;
        }
    }
    for (int row = 0; row < system->row_count; row++) {
        x[system->row_unknowns[row]] = sides[row] == 0 ? wanted[row] : 0.0;
    }
    ldl_solve(&system->factors, x);
    for (int row = 0; row < system->row_count; row++) {
        if (sides[row] == 0) {
            impulses[row] = -x[system->row_unknowns[row]];
        }
    }
    for (int body = 0; body < system->body_count; body++) {
        int unknown = system->body_unknowns[body];
        changes[body] = unknown == NO_UNKNOWN ? (Twist){0} : (Twist){{x[unknown], x[unknown + 1]}, x[unknown + 2]};
    }
}

void solve_active(System *system, const int8_t *sides, const double *wanted, double *impulses, Twist *changes) {
    for (int row = 0; row < system->row_count; row++) {
        impulses[row] = 0.0;
    }
    solve_with(system, sides, wanted, NULL, impulses, changes);
}
