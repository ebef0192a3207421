// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Mouse joints: the forces by which hands draw bodies to themselves.
//
// Problem: a body that is dragged has to follow the hand without oscillation, at any mass, and must not crush or
// throw what is in its way.
// Method: Box2D's mouse joint, a soft constraint at the point of the grip with a greatest force (E. Catto, "Soft
// Constraints", GDC 2011; `b2MakeSoft` and `mouse_joint.c` in Box2D v3): a spring of 5 Hz, the default of
// `b2MouseJointDef`, damped critically, which acts on the effective mass at the grip, so that its response is the
// same for any mass and anchor. It is solved implicitly for the pose and velocity that Chipmunk's step will have,
// and applied as a force of that sub-step, before contacts and joints. Several hands on one body are solved by
// projected Gauss-Seidel, as many sweeps as hands, and at most as many as the iterations of Chipmunk's solver.
// Cost: 0.1 µs a sub-step for each grip.
// Without it nothing can be dragged.

#include "stages.h"

// Undamped frequency of the spring [Hz], and its damping ratio: 1 is critical.
static const double frequency = 5.0, damping_ratio = 1.0;

// The spring in one sub-step (`b2MakeSoft`).
typedef struct Softness {
    double bias_rate; // [1/s]
    double mass_scale, impulse_scale;
} Softness;

static Softness softness(double dt) {
    double omega = 2.0 * pi * frequency;
    double a1 = 2.0 * damping_ratio + dt * omega, a2 = dt * omega * a1, a3 = 1.0 / (1.0 + a2);
    return (Softness){omega / a1, a2 * a3, a3};
}

// Solve one grip on a body that has a velocity, which is changed. Return its impulse, which was `before` [N s].
static Vec solve_grip(const World *world, const Body *body, const Grip *grip, Softness soft, Vec arm, Pose pose,
                      Twist *twist, Vec before) {
    double mass_inverse = body->engine->m_inv, moment_inverse = body->engine->i_inv;
    // dC/dt + bias_rate C
    Vec gap = sub(add(pose.p, arm), grip->target);
    Vec u = add(velocity_at(*twist, arm), scaled(gap, soft.bias_rate));
    // K: the inverse of the effective mass at the grip.
    double k11 = mass_inverse + arm.y * arm.y * moment_inverse, k12 = -arm.x * arm.y * moment_inverse;
    double k22 = mass_inverse + arm.x * arm.x * moment_inverse;
    double share = soft.mass_scale / (k11 * k22 - k12 * k12);
    Vec impulse = {before.x - share * (k22 * u.x - k12 * u.y) - soft.impulse_scale * before.x,
                   before.y - share * (k11 * u.y - k12 * u.x) - soft.impulse_scale * before.y};
    double size = length(impulse), most = world->drag_acceleration * body->engine->m * world->dt;
    if (size > most) {
        impulse = scaled(impulse, most / size);
    }
    Vec change = sub(impulse, before);
    twist->v = add(twist->v, scaled(change, mass_inverse));
    twist->w += cross(arm, change) * moment_inverse;
    return impulse;
}

// Add the forces of all hands on one body; its weight and wrench act in the same sub-step.
static void pull_body(World *world, Body *body, const Grip *grips, int count) {
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    Vec *impulses = TAKE(arena, Vec, count), *arms = TAKE(arena, Vec, count);
    world->chipmunk.body_activate(body->engine);
    // Chipmunk moves bodies first, and accelerates them then.
    Twist twist = twist_of(body->engine);
    Pose pose = moved(pose_of(body->engine), twist, world->dt);
    twist = twist_plus(twist_scaled(twist, world->own->kept), body->own->lead, 2.0);
    Rotation by = rotation(pose.yaw);
    Softness soft = softness(world->dt);
    for (int number = 0; number < count; number++) {
        arms[number] = rotated(grips[number].anchor, by);
    }
    int sweeps = count < world->space->iterations ? count : world->space->iterations;
    for (int sweep = 0; sweep < sweeps; sweep++) {
        for (int number = 0; number < count; number++) {
            impulses[number] =
                solve_grip(world, body, grips + number, soft, arms[number], pose, &twist, impulses[number]);
        }
    }
    for (int number = 0; number < count; number++) {
        body->engine->f = add(body->engine->f, scaled(impulses[number], 1.0 / world->dt));
        body->engine->t += cross(arms[number], impulses[number]) / world->dt;
    }
    arena_release(arena, mark);
}

void pull_grips(World *world) {
    const Grip *grips = world->grips;
    int last = 0;
    for (int first = 0; first < world->grip_count; first = last) {
        int place = grips[first].body;
        assert(place >= 0 && place < world->body_count && (first == 0 || grips[first - 1].body < place));
        for (last = first; last < world->grip_count && grips[last].body == place; last++) {
        }
        if (world->bodies[place].dynamic) {
            pull_body(world, world->bodies + place, grips + first, last - first);
        }
    }
}
