// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Fields: forces that depend on where bodies are and how they move, of media (`media.c`).
//
// Problem: as of applied forces (`applied_forces.c`), a force at the pose and velocity with which a sub-step begins is
// that of a moment too early: what floats or swings gains energy, and what falls in air is too fast.
// Method: velocity Verlet, as of gravity in `half_step.c`: forces are those of the poses after the move, and the lead of
// a body in free flight has half of what they change its velocity by. Unlike gravity, that half depends on velocities,
// and on other bodies; so it is state, and what a request sets is made into it as the next step begins: by the force at
// the true velocity, over half a sub-step. True velocities do not jump where a field begins or ends.
// Bodies that fields pull while they rest do not sleep where the field changes, nor before they float still.
//
// Cost: none without fields.

#include "media.h"
#include "stages.h"

static bool is_moved_by_fields(const Body *body) {
    return body->dynamic && !sleeps(body);
}

static Twist weight_of(const World *world, const cpBody *engine) {
    return (Twist){add(engine->f, scaled(world->space->gravity, engine->m)), engine->t};
}

// Find the forces of media on all bodies for the time between now and a later moment [s], at its middle.
static void find_pulls(World *world, double ahead, double lapse) {
    if (world->own->pulls == NULL) {
        world->own->pulls = allocated((size_t)world->body_count, sizeof(Pull));
    }
    Media media = media_of(world, ahead);
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            // A body in free flight goes on with the acceleration that is half in its lead.
            Twist change = {0}, twist = true_twist(body->engine);
            if (body->state.free) {
                change = body->state.lead;
            }
            Pose pose = moved(pose_of(body->engine), twist_sum(twist, change, ahead / world->dt), ahead);
            twist = twist_sum(twist, change, 2.0 * ahead / world->dt);
            world->own->pulls[place] = pull_of_media(world, &media, body, pose, twist, lapse);
        }
    }
}

// Half of what a force changes a velocity by in a sub-step.
static Twist half_change(const World *world, const cpBody *engine, Twist force) {
    return (Twist){scaled(force.v, engine->m_inv * world->dt / 2.0), force.w * engine->i_inv * world->dt / 2.0};
}

void begin_fields(World *world) {
    if (!world->has_fields || !world->fields_changed || !has_stage(world, STAGE_FIELDS)) {
        return;
    }
    world->fields_changed = false;
    find_leads(world);
    find_pulls(world, 0.0, world->dt / 2.0);
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            Twist twist = true_twist(body->engine), others = weight_of(world, body->engine);
            Twist force = force_of_pull(world->own->pulls + place, body->engine, twist, others);
            Twist field = half_change(world, body->engine, force);
            if (body->state.free) {
                Twist more = twist_sum(field, body->state.field, -1.0);
                set_twist(body->engine, twist_sum(twist_of(body->engine), more, 1.0));
            }
            body->state.field = field;
        }
    }
}

void apply_fields(World *world) {
    if (!world->has_fields || !has_stage(world, STAGE_FIELDS)) {
        return;
    }
    if (world->own->sub_step == 0) {
        // Velocities change at the ends of the four sub-steps.
        find_pulls(world, world->dt * (SUB_STEPS + 1) / 2.0, world->dt);
    }
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            Twist twist = twist_of(body->engine), others = weight_of(world, body->engine);
            Twist force = force_of_pull(world->own->pulls + place, body->engine, twist, others);
            body->scratch.field = half_change(world, body->engine, force);
            body->engine->f = add(body->engine->f, force.v);
            body->engine->t += force.w;
        }
    }
}

void keep_fields(World *world) {
    for (int place = 0; world->has_fields && place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            body->state.field = body->scratch.field;
        }
    }
}
