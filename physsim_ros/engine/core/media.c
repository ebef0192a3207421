// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Media: water, air and other fluids in regions, or all over the world.
//
// Problem: a fluid bears, slows and carries away the part of a body that lies in it.
// Method: of each body the part that lies in a region is found (`immersion.h`), area A with its centroid, and outline.
//   Buoyancy: -ρ A g at the centroid (Archimedes). In air that fills the world, what lies in no region.
//   Linear drag: -3 η u for each metre of outline, u its velocity in the medium. A disc has 6π η r v, as a ball has by
//   Stokes, whose traction is the same all over its surface; and 6π η r³ ω.
//   Quadratic drag: -½ c ρ |n·u| u for each metre of outline that faces the flow, n its normal; in all ½ c ρ v² times
//   the width across the flow. Turning counts by its part along n, at the centre of a round piece: friction alone would
//   slow down the spin of a disc, and quadratic drag has none.
// Both drags are -D (q - f) of the twists q of body and f of medium, with a matrix D that is symmetric and not
// negative. Buoyancy and D are found once a step, for the middle of the moments at which its sub-steps change
// velocities, or of those that remain as a body wakes; drag in each sub-step, of the velocity in the middle of that
// (implicit midpoint rule). Where drag stops a body within a sub-step, the velocity is later than the middle, by
// exponential fitting (W. Liniger, R. Willoughby, "Efficient Integration Methods for Stiff Systems", SIAM J. Numer.
// Anal. 1970). D in free flight is that of the mean of a guess of the twist and of the twist to which the drag of the
// guess leads (Newton's method for v² = a, which is Heron's).
// Scope: no mass of medium that moves along (added mass), no lift, no waves; a medium is not pushed.
// Laws: drag takes energy from what moves in a medium at rest; no drag is too strong for the steps, nor a bubble too
// light; what is dry, what is wet and their sum are the same outline.
// Cost: a hundred bodies that float apart take 1.7 to 1.9 times as long as a hundred that fall in no air.
// Without it laws 70 and 71 fail: nothing floats.

#include "media.h"
#include "stages.h"

// Media

static Vec gust_of(const Region *region, double time) {
    Vec gust = {0};
    for (int number = 0; region->gusty && number < WAVES; number++) {
        Rotation phase = rotation(region->waves[number].rate * time);
        gust = add(gust, scaled(region->waves[number].cosine, phase.c));
        gust = add(gust, scaled(region->waves[number].sine, phase.s));
    }
    return gust;
}

Media media_of(World *world, double ahead) {
    Arena *arena = &world->own->arena;
    Media media = {0};
    double time = (double)(world->step * SUB_STEPS + world->own->sub_step) * world->dt + ahead;
    int count = 0;
    for (int number = 0; number < world->region_count; number++) {
        const Region *region = world->regions + number;
        const cpShape *shape = region->body < 0 ? NULL : world->bodies[region->body].engine->shapeList;
        for (; shape != NULL; shape = shape->next) {
            count++;
        }
    }
    media.basins = TAKE(arena, Basin, count);
    media.currents = TAKE(arena, Twist, count);
    media.reached = TAKE(arena, Reached, count);
    Box *boxes = TAKE(arena, Box, count);
    for (int number = 0; number < world->region_count; number++) {
        const Region *region = world->regions + number;
        Vec gust = gust_of(region, time);
        if (region->body < 0) {
            media.air = region;
            media.wind = (Twist){add(region->flow, gust), 0.0};
            continue;
        }
        const cpBody *engine = world->bodies[region->body].engine;
        Twist twist = twist_of(engine);
        Pose pose = moved(pose_of(engine), twist, ahead);
        Vec flow = rotated(add(region->flow, gust), rotation(pose.yaw));
        for (const cpShape *shape = engine->shapeList; shape != NULL; shape = shape->next) {
            Basin basin = basin_of(region, shape, pose, arena);
            boxes[media.basin_count] = box_of_way(basin.center, basin.center, basin.radius);
            media.basins[media.basin_count] = basin;
            media.currents[media.basin_count++] = (Twist){add(twist.v, flow), 0.0};
        }
    }
    media.tree = tree_of(boxes, media.basin_count, arena);
    return media;
}

// Drag

// Add to D a weight of B'B, where B has the columns x, y and `turn`: how a point moves with the body.
static void add_moving_point(Drag *sum, double weight, Vec turn, double square) {
    sum->linear += weight;
    sum->turning = add(sum->turning, scaled(turn, weight));
    sum->angular += weight * square;
}

static void add_linear_side(Drag *sum, double weight, Side side) {
    Vec edge = sub(side.end, side.begin), middle = scaled(add(side.begin, side.end), 0.5);
    double square = dot(middle, middle) + dot(edge, edge) / 12.0;
    add_moving_point(sum, weight * length(edge), perpendicular(middle), square);
}

static void add_linear_bow(Drag *sum, double weight, Bow bow) {
    double turn = bow.to - bow.from, r = bow.radius;
    Vec rim = {sin(bow.to) - sin(bow.from), cos(bow.from) - cos(bow.to)}; // integral of the unit vector
    double square = (dot(bow.center, bow.center) + r * r) * turn + 2.0 * r * dot(bow.center, rim);
    sum->linear += weight * r * turn;
    sum->turning = add(sum->turning, scaled(perpendicular(add(scaled(bow.center, turn), scaled(rim, r))), weight * r));
    sum->angular += weight * r * square;
}

// The part of a side that faces the flow: its normal velocity f and that by turning q are linear along it, so that the
// integrals of f, f q and f q² are exact by Gauss's rule of two points.
static void add_quadratic_side(Drag *sum, double weight, Side side, Twist flow) {
    Vec edge = sub(side.end, side.begin);
    double size = length(edge);
    if (size <= 0.0) {
        return;
    }
    Vec normal = scaled(negated(perpendicular(edge)), 1.0 / size);
    double turn_begin = dot(normal, perpendicular(side.begin)), straight = dot(normal, flow.v);
    double first = straight + flow.w * turn_begin, last = first - flow.w * size;
    if (first <= 0.0 && last <= 0.0) {
        return;
    }
    double from = first < 0.0 ? first / (first - last) : 0.0, to = last < 0.0 ? first / (first - last) : 1.0;
    for (int point = 0; point < 2; point++) {
        double share = from + (to - from) * (0.5 + (point == 0 ? -1.0 : 1.0) * 0.28867513459481288);
        double turn = turn_begin - size * share;
        double facing = weight * size * (to - from) / 2.0 * (first + (last - first) * share);
        add_moving_point(sum, facing, scaled(normal, turn), turn * turn);
    }
}

// The integral of the positive part of the cosine from 0 to an angle.
static double facing_up_to(double angle) {
    double since = angle + pi / 2.0, turns = floor(since / full_turn);
    double rest = since - full_turn * turns;
    return 2.0 * turns + (rest < pi ? 1.0 - cos(rest) : 2.0);
}

static void add_quadratic_bow(Drag *sum, double weight, Bow bow, Twist flow) {
    Vec velocity = velocity_at(flow, bow.center);
    double speed = length(velocity), along = atan2(velocity.y, velocity.x);
    double width = bow.radius * (facing_up_to(bow.to - along) - facing_up_to(bow.from - along));
    add_moving_point(sum, weight * width * speed, perpendicular(bow.center), dot(bow.center, bow.center));
}

// The matrix D of a part of a body that moves through a medium with a twist.
static Drag drag_of(const Immersion *wet, const Region *medium, Twist flow) {
    Drag sum = {0};
    double linear = 3.0 * medium->viscosity, quadratic = 0.5 * medium->drag * medium->density;
    for (int number = 0; number < wet->side_count && linear > 0.0; number++) {
        add_linear_side(&sum, linear, wet->sides[number]);
    }
    for (int number = 0; number < wet->bow_count && linear > 0.0; number++) {
        add_linear_bow(&sum, linear, wet->bows[number]);
    }
    for (int number = 0; number < wet->side_count && quadratic > 0.0; number++) {
        add_quadratic_side(&sum, quadratic, wet->sides[number], flow);
    }
    for (int number = 0; number < wet->bow_count && quadratic > 0.0; number++) {
        add_quadratic_bow(&sum, quadratic, wet->bows[number], flow);
    }
    return sum;
}

static Drag drag_sum(Drag a, Drag b, double share) {
    return (Drag){a.linear + b.linear * share, add(a.turning, scaled(b.turning, share)), a.angular + b.angular * share};
}

static Twist drag_at(Drag d, Twist twist) {
    return (Twist){add(scaled(twist.v, d.linear), scaled(d.turning, twist.w)),
                   dot(d.turning, twist.v) + d.angular * twist.w};
}

static Twist symmetric_product(Symmetric s, Twist twist) {
    return (Twist){
        {s.xx * twist.v.x + s.xy * twist.v.y + s.xw * twist.w, s.xy * twist.v.x + s.yy * twist.v.y + s.yw * twist.w},
        s.xw * twist.v.x + s.yw * twist.v.y + s.ww * twist.w};
}

// The inverse of M + D t, which is positive definite: cofactors by determinant.
static Symmetric inverse_with(Drag drag, double time, const cpBody *engine) {
    double m = engine->m + drag.linear * time, i = engine->i + drag.angular * time;
    Vec turning = scaled(drag.turning, time);
    Symmetric cofactor = {.xx = m * i - turning.y * turning.y,
                          .xy = turning.y * turning.x,
                          .yy = m * i - turning.x * turning.x,
                          .xw = -m * turning.x,
                          .yw = -m * turning.y,
                          .ww = m * m};
    double share = 1.0 / (m * cofactor.xx + turning.x * cofactor.xw);
    return (Symmetric){cofactor.xx * share, cofactor.xy * share, cofactor.yy * share,
                       cofactor.xw * share, cofactor.yw * share, cofactor.ww * share};
}

// Where in a time the velocity is taken that drag is of, 1/2 .. 1, by the share that drag would take of a velocity.
static double fitted(double decay) {
    return decay < 1e-3 ? 0.5 + decay / 12.0 : 1.0 / -expm1(-decay) - 1.0 / decay;
}

static bool resists(const Region *medium) {
    return medium->viscosity > 0.0 || (medium->density > 0.0 && medium->drag > 0.0);
}

// What of a body a medium acts on; taken off with a negative sign.
typedef struct Share {
    Immersion wet;
    const Region *medium;
    Twist current;
    double sign;
} Share;

static Twist buoyancy_on(const Share *share, Vec gravity) {
    double weight = -share->medium->density * share->sign;
    return (Twist){scaled(gravity, weight * share->wet.area), weight * cross(share->wet.first_moment, gravity)};
}

// Add the drag on a body that moves with a twist.
static void add_drag(FluidForce *fluid, const Share *shares, int count, Twist twist) {
    for (int number = 0; number < count; number++) {
        const Share *share = shares + number;
        if (resists(share->medium)) {
            Drag drag = drag_of(&share->wet, share->medium, twist_plus(twist, share->current, -1.0));
            fluid->steady = twist_plus(fluid->steady, drag_at(drag, share->current), share->sign);
            fluid->drag = drag_sum(fluid->drag, drag, share->sign);
            fluid->has_drag = true;
        }
    }
}

static void fit_drag(FluidForce *fluid, const cpBody *engine, double lapse) {
    double most = greatest(fluid->drag.linear * engine->m_inv, fluid->drag.angular * engine->i_inv);
    double time = lapse * fitted(lapse * greatest(most, 0.0));
    fluid->inverse = inverse_with(fluid->drag, time, engine);
}

// The twist that a body in free flight has after a time, by implicit Euler with the drag of a guess of that twist.
static Twist twist_after(FluidForce fluid, const Share *shares, int count, const Flight *flight, const cpBody *engine) {
    add_drag(&fluid, shares, count, flight->guess);
    Symmetric inverse = inverse_with(fluid.drag, flight->ahead, engine);
    Twist all = twist_plus(twist_plus(fluid.steady, flight->others, 1.0), drag_at(fluid.drag, flight->now), -1.0);
    return twist_plus(flight->now, symmetric_product(inverse, all), flight->ahead);
}

// A disc around a body, and how many basins are found that it reaches.
typedef struct Looking {
    const Media *media;
    Vec center;
    double reach;
    int count;
} Looking;

static bool note_reached(int number, void *data) {
    Looking *looking = data;
    const Media *media = looking->media;
    Containment containment = containment_of(media->basins + number, looking->center, looking->reach);
    if (containment != OUTSIDE) {
        media->reached[looking->count++] = (Reached){number, containment};
    }
    return true;
}

static int by_basin(const void *one, const void *other) {
    return ((const Reached *)one)->basin - ((const Reached *)other)->basin;
}

// Find the basins that a disc around a body reaches, in their order, and return their count. For thousands of bodies,
// memory for the shares of all basins would be cleared once for each body.
static int find_reached(const Media *media, Vec center, double reach) {
    Looking looking = {media, center, reach, 0};
    tree_query(&media->tree, box_of_way(center, center, reach), note_reached, &looking);
    sort(media->reached, looking.count, sizeof(Reached), by_basin);
    return looking.count;
}

FluidForce fluid_force(World *world, const Media *media, Body *body, Pose pose, const Flight *flight, double lapse) {
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    const Region *air = media->air;
    int count = 0, reached_count = find_reached(media, pose.p, body->reach);
    Share *shares = TAKE(arena, Share, 2 * reached_count + 1);
    body->own->afloat = false;
    body->own->stirred = air != NULL && air->gusty;
    for (const Reached *each = media->reached, *end = each + reached_count; each < end; each++) {
        const Basin *basin = media->basins + each->basin;
        bool outlined = resists(basin->region) || (air != NULL && resists(air));
        Immersion wet = immersed(body, pose, each->containment == INSIDE ? NULL : basin, outlined, arena);
        body->own->afloat = body->own->afloat || each->containment == CROSSING;
        body->own->stirred = body->own->stirred || basin->region->gusty || basin->moves;
        shares[count++] = (Share){wet, basin->region, media->currents[each->basin], 1.0};
        if (air != NULL) {
            shares[count++] = (Share){wet, air, media->wind, -1.0};
        }
    }
    if (air != NULL) {
        shares[count++] = (Share){immersed(body, pose, NULL, resists(air), arena), air, media->wind, 1.0};
    }
    FluidForce fluid = {.found = true};
    for (int number = 0; number < count; number++) {
        fluid.steady = twist_plus(fluid.steady, buoyancy_on(shares + number, world->space->gravity), 1.0);
    }
    Twist guess = flight->guess;
    if (flight->free && count > 0) {
        Twist after = twist_after(fluid, shares, count, flight, body->engine);
        guess = twist_plus(guess, twist_plus(after, guess, -1.0), 0.5);
    }
    add_drag(&fluid, shares, count, guess);
    if (fluid.has_drag) {
        fit_drag(&fluid, body->engine, lapse);
    }
    arena_release(arena, mark);
    return fluid;
}

bool reaches(const Media *media, const Body *body) {
    int count = find_reached(media, body->engine->p, body->reach);
    for (int number = 0; number < count; number++) {
        if (media->basins[media->reached[number].basin].moves) {
            return true;
        }
    }
    return false;
}

Twist mean_fluid_force(const FluidForce *fluid, const cpBody *engine, Twist twist, Twist others) {
    if (!fluid->has_drag) {
        return fluid->steady;
    }
    // M a = others + steady - D (q + a t), solved for the acceleration a.
    Twist all = twist_plus(twist_plus(fluid->steady, others, 1.0), drag_at(fluid->drag, twist), -1.0);
    Twist acceleration = symmetric_product(fluid->inverse, all);
    Twist force = {scaled(acceleration.v, engine->m), acceleration.w * engine->i};
    return twist_plus(force, others, -1.0);
}
