// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Actors: bodies that move on their own, along a path or as people walk.
//
// Problem: a robot has to be tried among what moves: doors, carts, lifts, people. They have to be where they are at the
// same time in each run.
// Method: at the beginning of a step each actor finds the velocity of the step from the state of the world, so that all
// that outlives the step is when it started and how many points it has reached. A path is linear from point to point;
// the velocity brings the body to where the path is at the end of the step (deadbeat control), at most at twice the
// greatest speed of the path. Pedestrians choose theirs by a model (`social_force.c`, `orca.c`).
// What the velocity does: a kinematic body has it. Any other one stands on the floor, which moves under its feet as
// under the wheels of a robot (`floor.c`), so that it can be pushed. A robot gets it as a command; a drive that does
// not move sideways leads a point ahead of it (input-output linearisation; Siciliano et al., "Robotics: Modelling,
// Planning and Control", 2009, section 11.6), and pedestrians see it as a disc about that point (effective centre and
// radius; Snape et al., "Smooth and collision-free navigation for multiple robots under differential-drive
// constraints", 2010).
//
// Cost: 0.1 µs an actor on a path; of pedestrians see their models.

#include "orca.h"
#include "outline.h"
#include "social_force.h"
#include "stages.h"
#include "way_around.h"

// Time in which a robot makes up for its distance from the path, and in which a pedestrian comes to rest at its last
// point [s]. The drives of the shipped robots reach their speed in a tenth of a second or two.
static const double settling_time = 0.5;
static const int64_t never = INT64_C(1) << 62;

static Vec shortened(Vec a, double most) {
    double size = length(a);
    return size > most ? scaled(a, most / size) : a;
}

// Starting

static bool is_inside(const World *world, int gate, int place) {
    const cpBody *at = world->bodies[gate].engine;
    return body_covers(at, pose_of(at), world->bodies[place].engine->p);
}

static bool is_opened(const World *world, const Actor *actor) {
    if (actor->gate < 0) {
        return false;
    }
    if (actor->by >= 0) {
        return is_inside(world, actor->gate, actor->by);
    }
    for (int place = 0; place < world->body_count - 1; place++) {
        const Body *body = world->bodies + place;
        bool counts = !body->anchored && !body->sensor && place != actor->body && place != actor->gate;
        if (counts && is_inside(world, actor->gate, place)) {
            return true;
        }
    }
    return false;
}

static bool is_near(const World *world, const Actor *actor) {
    if (actor->near < 0) {
        return false;
    }
    Vec offset = sub(world->bodies[actor->near].engine->p, world->bodies[actor->body].engine->p);
    return length(offset) <= actor->distance;
}

static void start_actors(World *world) {
    for (int number = 0; number < world->actor_count; number++) {
        Actor *actor = world->actors + number;
        // Whether a gate is open is looked for only while its actor waits: that can go through all bodies.
        if (actor->state.begun == never && (!actor->waits || is_opened(world, actor) || is_near(world, actor))) {
            actor->state.begun = world->step + actor->delay;
        }
    }
}

// Paths

// Where a path is at a time since it started.
static Pose pose_on_path(const Actor *actor, double time) {
    const Waypoint *first = actor->points, *last = first + actor->point_count - 1;
    double whole = last->time;
    if (actor->repeat == ONCE || whole == 0.0) {
        time = least(time, whole);
    } else if (actor->repeat == LOOP) {
        time = fmod(time, whole);
    } else {
        time = fmod(time, 2.0 * whole);
        time = time > whole ? 2.0 * whole - time : time;
    }
    int low = 0, high = actor->point_count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        *(first[middle].time <= time ? &low : &high) = middle;
    }
    const Waypoint *a = first + low, *b = first + high;
    double share = b == a ? 0.0 : clamped((time - a->time) / (b->time - a->time), 0.0, 1.0);
    Twist displacement = {sub(b->pose.p, a->pose.p), b->pose.yaw - a->pose.yaw};
    return moved(a->pose, displacement, share);
}

// The velocity of the centre of mass that brings a kinematic body in a step to where its path is at the end.
static Twist keep_to_path(const Actor *actor, const Body *body, Pose end, double dt) {
    double turn = actor->path.turns != 0.0 ? remainder(end.yaw - body->engine->a, full_turn) : 0.0;
    Rotation by = rotation(body->engine->a + turn);
    Vec displacement = sub(add(end.p, rotated(body->offset, by)), body->engine->p);
    double most_turn = 2.0 * actor->path.turn_rate;
    return (Twist){shortened(scaled(displacement, 1.0 / dt), 2.0 * actor->path.speed),
                   clamped(turn / dt, -most_turn, most_turn)};
}

// The velocity of a path, and what makes up for the distance from it: of the centre of mass of a body on the floor, of
// a robot that of the point that is led.
static Twist chase_path(const World *world, const Actor *actor, Pose now, Pose end, double dt) {
    const Body *body = world->bodies + actor->body;
    Vec offset = rotated(body->offset, rotation(body->engine->a));
    Vec led = actor->robot >= 0 ? arm_of(world, actor) : negated(offset);
    Vec error = sub(now.p, add(body->engine->p, led)), along = scaled(sub(end.p, now.p), 1.0 / dt);
    double turn = 0.0;
    if (actor->path.turns != 0.0) {
        turn = (end.yaw - now.yaw) / dt + remainder(now.yaw - body->engine->a, full_turn) / settling_time;
    }
    Twist velocity = {add(along, scaled(error, 1.0 / settling_time)), turn};
    velocity.v = actor->robot >= 0 ? velocity.v : velocity_at(velocity, offset);
    return velocity;
}

static Twist follow_path(const World *world, const Actor *actor, double dt) {
    const Body *body = world->bodies + actor->body;
    double time = (double)(world->step - actor->state.begun) * dt;
    Pose now = pose_on_path(actor, time), end = pose_on_path(actor, time + dt);
    return body->dynamic ? chase_path(world, actor, now, end, dt) : keep_to_path(actor, body, end, dt);
}

// Pedestrians

// The number of the point to which a pedestrian goes.
static int next_point(const Actor *actor) {
    int count = actor->point_count;
    assert(count > 0);
    if (actor->repeat == ONCE) {
        return actor->state.reached < count ? (int)actor->state.reached : count - 1;
    }
    if (actor->repeat == LOOP) {
        return (int)(actor->state.reached % count);
    }
    int number = count > 1 ? (int)(actor->state.reached % (2 * count - 2)) : 0;
    return number < count ? number : 2 * count - 2 - number;
}

// The velocity that a pedestrian would have alone.
static Vec desired_velocity(const World *world, const Surroundings *around, Actor *actor, const Disc *self) {
    Vec offset = sub(actor->points[next_point(actor)].pose.p, self->point);
    bool ends = actor->repeat == ONCE;
    if (length(offset) <= actor->pace.goal_radius && !(ends && actor->state.reached >= actor->point_count)) {
        actor->state.reached++;
        offset = sub(actor->points[next_point(actor)].pose.p, self->point);
    }
    double speed = actor->pace.speed;
    if (ends && actor->state.reached >= actor->point_count - 1) {
        speed = least(speed, length(offset) / settling_time);
    }
    return scaled(heading_to(world, around, self, add(self->point, offset)), speed);
}

static Vec walk(World *world, const Surroundings *around, Actor *actor, double dt) {
    const Disc *self = around->discs;
    while (self->body != world->bodies + actor->body) {
        self++;
        assert(self < around->discs + around->disc_count);
    }
    Vec desired = desired_velocity(world, around, actor, self);
    return actor->kind == ACTOR_ORCA ? walk_by_orca(world, around, actor, self, desired)
                                     : walk_by_social_force(world, around, actor, self, desired, dt);
}

// Commands and velocities of all actors

// Command a robot, unless a command of somebody else still holds.
static void command(const World *world, const Actor *actor, Robot *robot) {
    if (world->step < robot->state.until || !has_begun(world, actor)) {
        return;
    }
    Vec local = rotated_back(actor->chosen.v, rotation(world->bodies[actor->body].engine->a));
    double turn = actor->chosen.w;
    if (!actor->holonomic) {
        turn = local.y / actor->ahead;
        local = vec(local.x, 0.0);
    }
    robot->state.aim = (Twist){shortened(local, actor->most.v.x), clamped(turn, -actor->most.w, actor->most.w)};
    robot->state.until = world->step + 1;
}

static void move_actor(const World *world, const Actor *actor) {
    Body *body = world->bodies + actor->body;
    if (!is_zero(actor->chosen) && sleeps(body)) {
        world->chipmunk.body_activate(body->engine);
    }
    if (actor->robot >= 0) {
        command(world, actor, robot_of(world, actor));
    } else if (!body->dynamic) {
        set_twist(body->engine, actor->chosen);
    }
}

void begin_actors(World *world) {
    start_actors(world);
    world->own->next_actor = 0;
    world->own->surroundings = NULL;
}

bool choose_velocity(World *world) {
    Private *own = world->own;
    if (own->next_actor == world->actor_count) {
        return false;
    }
    Actor *actor = world->actors + own->next_actor++;
    double dt = world->dt * (double)SUB_STEPS;
    actor->chosen = (Twist){0};
    if (!has_begun(world, actor)) {
        return true;
    }
    if (actor->kind == ACTOR_PATH) {
        actor->chosen = follow_path(world, actor, dt);
        return true;
    }
    if (own->surroundings == NULL) {
        own->surroundings = TAKE(&own->arena, Surroundings, 1);
        *own->surroundings = surroundings_of(world);
    }
    actor->chosen.v = walk(world, own->surroundings, actor, dt);
    return true;
}

void move_actors(World *world) {
    // All have seen the world as it was.
    for (int number = 0; number < world->actor_count; number++) {
        move_actor(world, world->actors + number);
    }
}
