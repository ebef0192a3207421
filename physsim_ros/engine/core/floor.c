// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The floor of a world that is seen from above: it pulls every body towards its own velocity.
//
// Problem: bodies on a floor slide to a stop, robots drive, stall and push, conveyors carry.
// Method: one mechanism. Under a body the floor has a velocity: 0, that of a conveyor, and of a robot besides that of
// its wheels against the floor. Friction brings the body to that velocity within its limit surface. It is solved before
// Chipmunk's step, implicitly, with the push of contacts and joints that the last sub-step has had (warm start): so
// friction resists what pushes a body, and a robot pushes at its full speed. A body that the floor carries moves
// exactly as the floor; one that slips has the mean of its velocities before and after as it is moved (velocity
// Verlet), the rest of friction as a force.
//
// Towed.
// Problem: the axle of a trailer rolls where it is drawn, and does not slide sideways.
// Method: of the velocities at which the middle of the axle does not move along it (a nonholonomic constraint; de
// Luca and Oriolo, "Modelling and control of nonholonomic mechanical systems", 1995) the floor has that which a push
// along the axle alone leads to, as Gauss' principle of least constraint has it; the limit surface bounds the push.
//
// Limit surface.
// Problem: a body that slides and turns at once has less friction either way than one that only slides or only
// turns; two separate limits would give it too much.
// Method: the limit surface of Goyal, Ruina and Papadopoulos ("Planar sliding with dry friction", 1991),
// approximated by the ellipsoid of Howe and Cutkosky ("Practical force-motion models for sliding manipulation",
// 1996): (f / F)² + (τ / T)² = 1 with F = μ m g and T = lever F. The body slips along its normal (maximum
// dissipation). One step is implicit (backward Euler), so that friction stops a body and never turns it round: the
// slip that remains is the root of a scalar equation, found by Newton's method as Moré and Sorensen do ("Computing a
// trust region step", 1983).
//
// Cost: 60 ns a body, 0.3 µs for one that slips; where there are conveyors, a query of their boxes for each body.
// Without it nothing stops, nothing drives (`test/laws/test_floor.py`).

#include "boxes.h"
#include "outline.h"
#include "stages.h"

// The share of the push of the last sub-step that the next one expects where the floor stands still. With all of it,
// bodies would stay pressed against each other by friction alone, for ever; so 2 % of the push decays in each sub-step.
static const double relaxed = 0.98;
// The greatest push that is expected, by the limit of friction: more is an impact, which is over.
static const double most_expected = 2.0;
// A push below this is none [m/s, rad/s], so that what rests is still to the last bit.
static const double least_push = 1e-11;
// Newton's steps. Without turning or without sliding the first is exact; eight leave 1e-12 of the slip at any ratio of
// the two limits from 0.01 to 100.
enum { ITERATIONS = 8 };

// The limit surface of a body, as changes of its velocity in a sub-step.
typedef struct LimitSurface {
    double lever;        // mean distance of the points that bear it [m]
    double most;         // greatest change of velocity [m/s]
    double most_turning; // greatest change of the speed of a turn at the lever [m/s]
} LimitSurface;

static LimitSurface surface_of(const World *world, const Body *body) {
    double most = body->braking * world->dt;
    double gyration_squared = body->engine->i / body->engine->m;
    return (LimitSurface){body->lever, most, most * body->lever * body->lever / gyration_squared};
}

// The square of a change of velocity by the surface; on it, 1.
static double square(Twist change, LimitSurface surface) {
    double x = change.v.x / surface.most, y = change.v.y / surface.most;
    double turn = change.w * surface.lever / surface.most_turning;
    return x * x + y * y + turn * turn;
}

// The change of velocity by friction that a slip gets. The slip s that remains solves
// (across / (s + most))² + (rim / (s + most_turning))² = 1, where turns count by the speed at the lever.
static Twist friction(Twist slip, LimitSurface surface) {
    double across = length(slip.v), rim = surface.lever * fabs(slip.w);
    double remaining = greatest(greatest(across - surface.most, rim - surface.most_turning), 0.0);
    for (int number = 0; number < ITERATIONS; number++) {
        double sliding = 1.0 / (remaining + surface.most), turning = 1.0 / (remaining + surface.most_turning);
        double a = across * sliding * across * sliding, b = rim * turning * rim * turning;
        remaining += (a + b) * (sqrt(a + b) - 1.0) / (a * sliding + b * turning);
    }
    return (Twist){scaled(slip.v, -surface.most / (remaining + surface.most)),
                   -slip.w * surface.most_turning / (remaining + surface.most_turning)};
}

typedef struct Conveyor {
    const Body *body;
    Twist twist; // before the floor acts on it
} Conveyor;

// The conveyors of a world, in the order of their bodies, and the boxes about them.
typedef struct Conveyors {
    Conveyor *list;
    int count;
    Tree tree;
} Conveyors;

static bool is_conveyor(const Body *body) {
    return body->surface.x != 0.0 || body->surface.y != 0.0;
}

static Conveyors conveyors_of(World *world) {
    Arena *arena = &world->own->arena;
    Conveyors conveyors = {.count = 0};
    for (int place = 0; place < world->body_count; place++) {
        conveyors.count += is_conveyor(world->bodies + place);
    }
    conveyors.list = TAKE(arena, Conveyor, conveyors.count);
    Box *boxes = TAKE(arena, Box, conveyors.count);
    int count = 0;
    for (int place = 0; place < world->body_count; place++) {
        const Body *body = world->bodies + place;
        if (is_conveyor(body)) {
            Vec reach = vec(body->reach, body->reach);
            boxes[count] = (Box){sub(body->own->begin.p, reach), add(body->own->begin.p, reach)};
            conveyors.list[count++] = (Conveyor){body, twist_of(body->engine)};
        }
    }
    conveyors.tree = tree_of(boxes, count, arena);
    return conveyors;
}

// The conveyor under a body: of several that which was spawned last; -1 is none.
typedef struct Under {
    const Conveyors *conveyors;
    const Body *body;
    int last;
} Under;

static bool find_under(int number, void *data) {
    Under *under = data;
    const Body *conveyor = under->conveyors->list[number].body;
    bool may_be = conveyor != under->body && number > under->last;
    if (may_be && body_covers(conveyor->engine, conveyor->own->begin, under->body->own->begin.p)) {
        under->last = number;
    }
    return true;
}

// The velocity at the centre of mass of a body of the conveyor under it.
static Twist conveyed(const Conveyors *conveyors, const Body *body) {
    Under under = {conveyors, body, -1};
    tree_query(&conveyors->tree, (Box){body->own->begin.p, body->own->begin.p}, find_under, &under);
    if (under.last < 0) {
        return (Twist){0};
    }
    const Conveyor *conveyor = conveyors->list + under.last;
    Pose begin = conveyor->body->own->begin;
    Vec surface = rotated(conveyor->body->surface, rotation(begin.yaw));
    Vec arm = sub(body->own->begin.p, begin.p);
    return (Twist){add(velocity_at(conveyor->twist, arm), surface), conveyor->twist.w};
}

// The velocity of the centre of mass next to one, by the kinetic energy, at which the axle of a towed body rolls: the
// middle of the axle, at the origin of the body, does not move along it.
static Twist twist_of_axle(const Body *body, Twist twist, double yaw) {
    const cpBody *engine = body->engine;
    Rotation by = rotation(yaw);
    Vec arm = rotated(negated(body->offset), by), along = rotated(vec(0.0, 1.0), by);
    double lever = cross(arm, along), inverse = engine->m_inv + engine->i_inv * lever * lever;
    double impulse = -dot(along, velocity_at(twist, arm)) / inverse;
    return (Twist){add(twist.v, scaled(along, impulse * engine->m_inv)), twist.w + impulse * engine->i_inv * lever};
}

// Bring a body to the velocity of the floor under it: its mean in the sub-step, and that at its end. Below a towed body
// these are the velocities at which its axle rolls.
static void bring_to_floor(World *world, Body *body, Twist mean, Twist end) {
    cpBody *engine = body->engine;
    double dt = world->dt, kept = world->own->kept;
    double linear = engine->m_inv * dt, angular = engine->i_inv * dt;
    Twist before = twist_of(engine);
    before = body->state.free ? twist_plus(before, body->own->lead, -1.0) : before;
    // What the sub-step brings without the floor: damping, gravity, forces of commands and hands.
    Twist after = {add(scaled(before.v, kept), add(scaled(engine->f, linear), scaled(world->space->gravity, dt))),
                   before.w * kept + engine->t * angular};
    LimitSurface surface = surface_of(world, body);
    double share = is_zero(mean) ? relaxed : 1.0;
    Twist expected = twist_scaled(body->state.push, share);
    double size = greatest(sqrt(square(expected, surface)) / most_expected, 1.0);
    expected = (Twist){scaled(expected.v, 1.0 / size), expected.w / size};
    Twist next = twist_plus(after, expected, 1.0);
    if (body->towed) {
        double yaw = body->own->begin.yaw, turn = next.w * dt;
        end = twist_of_axle(body, next, yaw + turn);
        Twist sum = twist_plus(before, end, 1.0);
        mean = twist_of_axle(body, twist_scaled(sum, 0.5), yaw + turn / 2.0);
    }
    Twist slip = twist_plus(next, end, -1.0);
    bool slides = square(slip, surface) > 1.0;
    Twist change = slides ? friction(slip, surface) : (Twist){negated(slip.v), -slip.w};
    Twist as_moved = mean;
    if (slides) {
        Twist sum = twist_plus(twist_plus(before, after, 1.0), twist_plus(expected, change, 1.0), 1.0);
        as_moved = twist_scaled(sum, 0.5);
    }
    body->own->under = mean;
    body->own->without_contacts = twist_plus(after, change, 1.0);
    if (!sleeps(body)) {
        set_twist(engine, as_moved);
        Vec added = add(scaled(sub(before.v, as_moved.v), kept), change.v);
        engine->f = add(engine->f, scaled(added, 1.0 / linear));
        engine->t += ((before.w - as_moved.w) * kept + change.w) / angular;
    }
}

// What drives a body along on the floor: the velocity that its wheels or feet have, mean and at the end.
typedef struct Driving {
    Twist mean, end;
} Driving;

// Return the driving of a body, and move on past its robot and its actor: both are listed in the order of the bodies.
static Driving take_driving(const World *world, int place, const Robot **robot, const Actor **actor) {
    Driving driving = {0};
    if (*robot < world->robots + world->robot_count && (*robot)->body == place) {
        driving.mean = (*robot)->under;
        driving.end = (*robot)->end;
        ++*robot;
    }
    if (*actor < world->actors + world->actor_count && (*actor)->body == place) {
        if ((*actor)->robot < 0) {
            driving.mean = driving.end = (*actor)->chosen;
        }
        ++*actor;
    }
    return driving;
}

void apply_floor(World *world) {
    if (!world->own->has_floor) {
        return;
    }
    Conveyors conveyors = conveyors_of(world);
    const Robot *robot = world->robots;
    const Actor *actor = world->actors;
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        Driving driving = take_driving(world, place, &robot, &actor);
        if (body->braking > 0.0) {
            Twist belt = conveyors.count > 0 ? conveyed(&conveyors, body) : (Twist){0};
            Twist mean = twist_plus(driving.mean, belt, 1.0), end = twist_plus(driving.end, belt, 1.0);
            if (sleeps(body) && !is_zero(mean)) {
                // Its drive, or a conveyor below it, moves now.
                world->chipmunk.body_activate(body->engine);
            }
            bring_to_floor(world, body, mean, end);
        }
    }
    assert(robot == world->robots + world->robot_count && actor == world->actors + world->actor_count);
}

void find_floor_pushes(World *world) {
    if (!world->own->has_floor) {
        return;
    }
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (body->braking == 0.0) {
            continue;
        }
        // Half of what is expected is the newest push. With all of it, a robot at a wall and the wall would push in
        // turns.
        Twist push =
            twist_plus(twist_plus(twist_of(body->engine), body->own->without_contacts, -1.0), body->state.push, 1.0);
        push = twist_scaled(push, 0.5);
        double size = greatest(greatest(fabs(push.v.x), fabs(push.v.y)), fabs(push.w));
        body->state.push = sleeps(body) || size < least_push ? (Twist){0} : push;
    }
}
