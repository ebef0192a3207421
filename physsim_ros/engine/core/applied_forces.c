// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Applied forces: constant forces at points of bodies, in a fixed direction or turning with the body; and the wrenches
// of commands, which end.
//
// Problem: the torque of a force at an arm, and the direction of a thruster, depend on the pose of the body. With the
// pose at which a sub-step begins, the velocity gained is that of a moment too early: a swinging body gains energy.
// Method: velocity Verlet, as of gravity in `half_step.c`: Chipmunk moves bodies first and accelerates them then, so
// forces are those of the pose after the move; and the lead of a body in free flight, half a sub-step of its
// acceleration, is that of the pose that it has now.
//
// Cost: 15 ns a force and sub-step.
// Without it thrusters and wrenches push nothing.

#include "stages.h"

// Force and torque about the centre of mass, of a force on a body with that yaw; world axes.
static Twist wrench_of(const AppliedForce *applied, double yaw) {
    Rotation by = rotation(yaw);
    Vec force = applied->turns ? rotated(applied->force, by) : applied->force;
    return (Twist){force, cross(rotated(applied->arm, by), force)};
}

// Half a sub-step of gravity and of the wrench on a body, with the part of fields.
static Twist steady_lead(const World *world, const Body *body) {
    if (!body->dynamic) {
        return (Twist){0};
    }
    const cpBody *engine = body->engine;
    // Quotients, as in Python, so that a velocity that is set is reported to the bit.
    Vec change = vec(body->wrench.v.x / engine->m, body->wrench.v.y / engine->m);
    Twist gained = {add(world->space->gravity, change), body->wrench.w / engine->i};
    return twist_plus(body->state.field, gained, world->dt / 2.0);
}

void turn_leads(World *world) {
    if (!has_stage(world, STAGE_HALF_STEP)) {
        return;
    }
    const Body *last = NULL;
    for (int number = 0; number < world->force_count; number++) {
        const AppliedForce *applied = world->forces + number;
        Body *body = world->bodies + applied->body;
        const cpBody *engine = body->engine;
        // Forces are listed in the order of their bodies.
        assert(last == NULL || last <= body);
        body->own->lead = body == last ? body->own->lead : steady_lead(world, body);
        last = body;
        Twist wrench = wrench_of(applied, engine->a);
        Twist change = {scaled(wrench.v, engine->m_inv), wrench.w * engine->i_inv};
        body->own->lead = twist_plus(body->own->lead, change, world->dt / 2.0);
    }
}

void find_leads(World *world) {
    if (!has_stage(world, STAGE_HALF_STEP)) {
        return;
    }
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->own->lead = steady_lead(world, body);
    }
}

// Apply the wrenches of commands; Chipmunk clears forces after each sub-step.
static void apply_wrenches(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (!is_zero(body->wrench)) {
            world->chipmunk.body_activate(body->engine);
            body->engine->f = body->wrench.v;
            body->engine->t = body->wrench.w;
        }
    }
}

void apply_forces(World *world) {
    apply_wrenches(world);
    for (int number = 0; number < world->force_count; number++) {
        const AppliedForce *applied = world->forces + number;
        cpBody *engine = world->bodies[applied->body].engine;
        world->chipmunk.body_activate(engine);
        Twist wrench = wrench_of(applied, pose_after(engine, world->dt).yaw);
        engine->f = add(engine->f, wrench.v);
        engine->t += wrench.w;
    }
}
