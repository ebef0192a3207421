// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Fields: forces that depend on where bodies are and how they move, of media (`media.c`) and of bodies on each
// other (`attraction.c`).
//
// Problem: as of applied forces (`applied_forces.c`), a force at the pose and velocity with which a sub-step begins is
// that of a moment too early: a floating body gains energy, and a falling one is too fast in air.
// Method: velocity Verlet, as of gravity in `half_step.c`: forces are those of the poses after the move, and the lead
// of a body in free flight has half of what they change its velocity by. Unlike gravity, that half depends on
// velocities, and on other bodies; so it is kept with the state of the body. A request that changes a body or a field
// leaves that half stale: as the next step begins, it is found anew, by the force at the true velocity over half a
// sub-step, and the velocity in the engine changes by the difference, so that the true velocity does not jump. A body
// that fields pull does not fall asleep where they can change (attraction, gusts, a region that moves), and a floating
// one only once it is still.
//
// Cost: that of media and of attraction; nothing in a world without fields.
// Without it what floats gains energy, and orbits open.

#include "attraction.h"
#include "media.h"
#include "stages.h"

static bool is_moved_by_fields(const Body *body) {
    return body->dynamic && !sleeps(body);
}

static Twist given_force(const World *world, const cpBody *engine) {
    return (Twist){add(engine->f, scaled(world->space->gravity, engine->m)), engine->t};
}

// Find the force of media on a body for the time between now and a later moment [s], at its middle.
static void find_fluid_force(World *world, const Media *media, Body *body, double ahead, double lapse) {
    const cpBody *engine = body->engine;
    Twist now = true_twist(engine), change = {0};
    if (body->state.free) {
        // It goes on with the acceleration that is half in its lead.
        change = body->own->lead;
    }
    Pose pose = moved(pose_of(engine), twist_plus(now, change, ahead / world->dt), ahead);
    Flight flight = {body->state.free, ahead, now, twist_plus(now, change, 2.0 * ahead / world->dt),
                     given_force(world, engine)};
    world->own->fluid_forces[body - world->bodies] = fluid_force(world, media, body, pose, &flight, lapse);
}

// Half of what a force changes a velocity by in a sub-step.
static Twist half_change(const World *world, const cpBody *engine, Twist force) {
    return (Twist){scaled(force.v, engine->m_inv * world->dt / 2.0), force.w * engine->i_inv * world->dt / 2.0};
}

// The force of attraction on each body (body_count), a time after now [s, N, N m].
static Twist *attracted(World *world, double ahead) {
    Twist *forces = TAKE(&world->own->arena, Twist, world->body_count);
    const Vec *each = attractions(world, ahead);
    for (int number = 0; number < world->attractor_count; number++) {
        forces[world->attractors[number].body].v = each[number];
    }
    return forces;
}

// The mean force of all fields on a body in a time that begins with a twist; `attraction` is the part of attraction.
static Twist force_of_fields(const World *world, const Body *body, Twist twist, Twist attraction) {
    const FluidForce *fluid = world->own->fluid_forces + (body - world->bodies);
    Twist others = twist_plus(given_force(world, body->engine), attraction, 1.0);
    return twist_plus(mean_fluid_force(fluid, body->engine, twist, others), attraction, 1.0);
}

static bool has_fresh(const World *world) {
    for (int place = 0; place < world->body_count; place++) {
        if (world->bodies[place].state.fresh) {
            return true;
        }
    }
    return false;
}

static void begin_field(World *world, const Media *media, Body *body, Twist attraction) {
    if (world->region_count > 0) {
        find_fluid_force(world, media, body, 0.0, world->dt / 2.0);
    }
    Twist force = force_of_fields(world, body, true_twist(body->engine), attraction);
    Twist field = half_change(world, body->engine, force);
    if (body->state.free) {
        Twist more = twist_plus(field, body->state.field, -1.0);
        set_twist(body->engine, twist_plus(twist_of(body->engine), more, 1.0));
    }
    body->state.field = field;
}

void begin_fields(World *world) {
    if (!world->has_fields || world->own->sub_step > 0) {
        return;
    }
    if (world->own->fluid_forces == NULL) {
        world->own->fluid_forces = allocated((size_t)world->body_count, sizeof(FluidForce));
    }
    if (!has_fresh(world)) {
        return;
    }
    find_leads(world);
    turn_leads(world);
    Media media = media_of(world, 0.0);
    const Twist *attraction = attracted(world, 0.0);
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (body->state.fresh && is_moved_by_fields(body)) {
            begin_field(world, &media, body, attraction[place]);
        }
        body->state.fresh = false;
    }
}

static bool lacks_fluid_force(const World *world, int place) {
    return is_moved_by_fields(world->bodies + place) && !world->own->fluid_forces[place].found;
}

static void wake_reached(World *world, const Media *media) {
    for (int place = 0; place < world->body_count; place++) {
        if (sleeps(world->bodies + place) && reaches(media, world->bodies + place)) {
            world->chipmunk.body_activate(world->bodies[place].engine);
        }
    }
}

// Find the forces of media for the step that begins; within it, those on bodies that have been woken since.
static void find_fluid_forces(World *world) {
    bool begins = world->own->sub_step == 0, lacks = begins;
    for (int place = 0; place < world->body_count; place++) {
        world->own->fluid_forces[place].found = world->own->fluid_forces[place].found && !begins;
        lacks = lacks || lacks_fluid_force(world, place);
    }
    if (!lacks) {
        return;
    }
    // Velocities change at the ends of the sub-steps that remain.
    double ahead = world->dt * (SUB_STEPS - world->own->sub_step + 1) / 2.0;
    Media media = media_of(world, ahead);
    if (begins) {
        wake_reached(world, &media);
    }
    for (int place = 0; place < world->body_count; place++) {
        if (lacks_fluid_force(world, place)) {
            find_fluid_force(world, &media, world->bodies + place, ahead, world->dt);
        }
    }
}

void apply_fields(World *world) {
    if (!world->has_fields) {
        return;
    }
    if (world->region_count > 0) {
        find_fluid_forces(world);
    }
    const Twist *attraction = attracted(world, world->dt);
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            Twist force = force_of_fields(world, body, twist_of(body->engine), attraction[place]);
            body->own->field = half_change(world, body->engine, force);
            body->engine->f = add(body->engine->f, force.v);
            body->engine->t += force.w;
        }
    }
    for (int number = 0; number < world->attractor_count; number++) {
        world->bodies[world->attractors[number].body].own->stirred = true;
    }
}

void keep_fields(World *world) {
    if (!world->has_fields) {
        return;
    }
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (is_moved_by_fields(body)) {
            body->state.field = body->own->field;
        }
    }
    find_leads(world);
}
