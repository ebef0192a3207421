// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Springs between two points: a greatest force, which Chipmunk's own have not, and the half-step lead of what hangs on
// them (`half_step.c`).

#include "springs.h"
#include "joint_rows.h"

// The force of a spring at a length [N]; Chipmunk's own (7.0.3) has no greatest one.
static double spring_force(cpConstraint *constraint, double distance) {
    const cpDampedSpring *spring = (cpDampedSpring *)constraint;
    double force = (spring->restLength - distance) * spring->stiffness;
    return clamped(force, -constraint->maxForce, constraint->maxForce);
}

// Mark bodies that springs pull, and those in islands of joints that hang by a spring from something fixed, or that
// motors hold there: such a body is not in free flight (`half_step.c`).
static void mark_sprung(World *world) {
    reset_memory(world);
    int *parents = sets_of(world);
    bool *hangs = TAKE(&world->own->arena, bool, world->body_count);
    bool *swings = TAKE(&world->own->arena, bool, world->body_count);
    bool *turns = TAKE(&world->own->arena, bool, world->body_count);
    for (int place = 0; place < world->body_count; place++) {
        world->bodies[place].own->on_spring = false;
    }
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        if (world->bodies[joint->a].dynamic && world->bodies[joint->b].dynamic) {
            unite(parents, joint->a, joint->b);
        }
    }
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        bool elastic = is_spring_joint(world, joint);
        int ends[2] = {joint->a, joint->b};
        for (int end = 0; end < 2; end++) {
            Body *body = world->bodies + ends[end];
            if (body->dynamic) {
                int root = root_of(parents, ends[end]);
                hangs[root] = hangs[root] || !world->bodies[ends[1 - end]].dynamic;
                swings[root] = swings[root] || elastic;
                body->own->on_spring = body->own->on_spring || elastic;
            }
        }
    }
    for (int number = 0; number < world->motor_count; number++) {
        const Joint *joint = world->joints + world->motors[number].joint;
        turns[root_of(parents, joint->a)] = turns[root_of(parents, joint->b)] = true;
    }
    for (int place = 0; place < world->body_count; place++) {
        int root = root_of(parents, place);
        world->bodies[place].own->sprung = hangs[root] && swings[root];
        world->bodies[place].own->motored = hangs[root] && turns[root];
    }
}

void prepare_springs(World *world) {
    mark_sprung(world);
    for (int number = 0; number < world->part_count; number++) {
        if (world->parts[number].kind == PART_SPRING) {
            ((cpDampedSpring *)world->parts[number].constraint)->springForceFunc = spring_force;
        }
    }
}

// A spring, and what an impulse of 1 N s along its line changes the velocities of its bodies by.
typedef struct Spring {
    const Joint *joint;
    Jacobian jacobian;
    Twist units[2];
    double strain, stiffness, damping, most; // [m, N/m, N s/m, N]
} Spring;

static Spring spring_of(const World *world, const Joint *joint) {
    const cpDampedSpring *engine = (cpDampedSpring *)world->parts[joint->first_part].constraint;
    const cpBody *a = world->bodies[joint->a].engine, *b = world->bodies[joint->b].engine;
    const Row *row = joint->row_count > 0 ? world->rows + joint->first_row : NULL;
    Anchors anchors = anchors_at(joint, pose_of(a), pose_of(b));
    Jacobian jacobian = line_jacobian(unit_or(anchors.offset, vec(0.0, 0.0)), anchors.arm_a, anchors.arm_b);
    return (Spring){joint,
                    jacobian,
                    {{scaled(jacobian.a.v, a->m_inv), jacobian.a.w * a->i_inv},
                     {scaled(jacobian.b.v, b->m_inv), jacobian.b.w * b->i_inv}},
                    length(anchors.offset) - engine->restLength,
                    row ? row->stiffness : engine->stiffness,
                    row ? row->damping : 0.0,
                    engine->constraint.maxForce};
}

static Spring *list_springs(const World *world, const bool *pulled, int *count) {
    Spring *springs = TAKE(&world->own->arena, Spring, world->joint_count);
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        if (is_spring_joint(world, joint) && (pulled[joint->a] || pulled[joint->b])) {
            springs[(*count)++] = spring_of(world, joint);
        }
    }
    return springs;
}

static void push_ends(const Spring *spring, double impulse, const bool *pulled, Twist *changes) {
    int ends[2] = {spring->joint->a, spring->joint->b};
    for (int end = 0; end < 2; end++) {
        if (pulled[ends[end]]) {
            changes[ends[end]] = twist_plus(changes[ends[end]], spring->units[end], impulse);
        }
    }
}

void pull_springs(World *world, const bool *pulled, Twist *changes, double lapse) {
    int count = 0;
    const Spring *springs = list_springs(world, pulled, &count);
    for (int number = 0; number < count; number++) {
        const Spring *spring = springs + number;
        double force = clamped(-spring->stiffness * spring->strain, -spring->most, spring->most);
        push_ends(spring, force * lapse, pulled, changes);
    }
    // Dampers act on the velocities after that, each as if it were alone.
    double *impulses = TAKE(&world->own->arena, double, count);
    for (int number = 0; number < count; number++) {
        const Spring *spring = springs + number;
        int ends[2] = {spring->joint->a, spring->joint->b};
        Twist twists[2];
        for (int end = 0; end < 2; end++) {
            twists[end] = twist_plus(true_twist(world->bodies[ends[end]].engine), changes[ends[end]], 1.0);
        }
        double speed = link_rate(spring->jacobian, (Ends){0, 1}, twists);
        double unit = link_rate(spring->jacobian, (Ends){0, 1}, spring->units);
        impulses[number] = -lapse * spring->damping * speed / (1.0 + lapse * spring->damping * unit);
    }
    for (int number = 0; number < count; number++) {
        push_ends(springs + number, impulses[number], pulled, changes);
    }
}
