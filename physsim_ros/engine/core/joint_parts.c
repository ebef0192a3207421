// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The constraints that a joint consists of in Chipmunk: what they need before a step, and their impulses.

#include "joint_parts.h"
#include "joint_rows.h"
#include "saddle_point.h"
#include "stages.h"

// Length of the arm with which a pin pulls a slider across its line [m]; any will do.
static const double across_arm = 1.0;
// The constraint of a slider that limits its travel, after those across its line and of its turn.
enum { LIMIT_PART = 2 };
// An unstepped joint has come together where its rows are no more than this out of their bounds [m, rad]: ten times the
// slop of limits.
static const double drawn_apart = 1e-3;
// The least speed at which it is drawn together [m/s, rad/s], a quarter of the greatest (`joint_positions.c`): a joint
// that comes nearer more slowly is held apart by others.
static const double drawn_least = 5.0;

double *impulse_at(const Part *part, int component) {
    switch (part->kind) {
    case PART_PIVOT: {
        cpPivotJoint *pivot = (cpPivotJoint *)part->constraint;
        return component == 0 ? &pivot->jAcc.x : &pivot->jAcc.y;
    }
    case PART_PIN:
        return &((cpPinJoint *)part->constraint)->jnAcc;
    case PART_SLIDE:
        return &((cpSlideJoint *)part->constraint)->jnAcc;
    case PART_GEAR:
        return &((cpGearJoint *)part->constraint)->jAcc;
    case PART_ROTARY_LIMIT:
        return &((cpRotaryLimitJoint *)part->constraint)->jAcc;
    case PART_MOTOR:
    case PART_OWN:
    case PART_ROPE:
    case PART_DRIVE:
        return &((cpSimpleMotor *)part->constraint)->jAcc;
    default:
        assert(part->kind == PART_SPRING);
        return &((cpDampedSpring *)part->constraint)->jAcc;
    }
}

static Vec impulse_of_part(const Part *part) {
    return vec(*impulse_at(part, 0), part->kind == PART_PIVOT ? *impulse_at(part, 1) : 0.0);
}

// The force of a spring at a length [N]; Chipmunk's own (7.0.3) has no greatest one.
static double spring_force(cpConstraint *constraint, double distance) {
    const cpDampedSpring *spring = (cpDampedSpring *)constraint;
    double force = (spring->restLength - distance) * spring->stiffness;
    return clamped(force, -constraint->maxForce, constraint->maxForce);
}

void prepare_springs(World *world) {
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
    double distance = length(anchors.apart);
    Vec direction = distance > 0.0 ? scaled(anchors.apart, 1.0 / distance) : vec(0.0, 0.0);
    Jacobian jacobian = along(direction, anchors.arm_a, anchors.arm_b);
    return (Spring){joint,
                    jacobian,
                    {{scaled(jacobian.a.v, a->m_inv), jacobian.a.w * a->i_inv},
                     {scaled(jacobian.b.v, b->m_inv), jacobian.b.w * b->i_inv}},
                    distance - engine->restLength,
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

static void push(const Spring *spring, double impulse, const bool *pulled, Twist *changes) {
    int ends[2] = {spring->joint->a, spring->joint->b};
    for (int end = 0; end < 2; end++) {
        if (pulled[ends[end]]) {
            changes[ends[end]] = twist_sum(changes[ends[end]], spring->units[end], impulse);
        }
    }
}

void pull_springs(World *world, const bool *pulled, Twist *changes, double lapse) {
    int count = 0;
    const Spring *springs = list_springs(world, pulled, &count);
    for (int number = 0; number < count; number++) {
        const Spring *spring = springs + number;
        double force = clamped(-spring->stiffness * spring->strain, -spring->most, spring->most);
        push(spring, force * lapse, pulled, changes);
    }
    // Dampers act on the velocities after that, each as if it were alone.
    double *impulses = TAKE(&world->own->arena, double, count);
    for (int number = 0; number < count; number++) {
        const Spring *spring = springs + number;
        int ends[2] = {spring->joint->a, spring->joint->b};
        Twist twists[2];
        for (int end = 0; end < 2; end++) {
            twists[end] = twist_sum(true_twist(world->bodies[ends[end]].engine), changes[ends[end]], 1.0);
        }
        double speed = rate(spring->jacobian, (Ends){0, 1}, twists);
        double unit = rate(spring->jacobian, (Ends){0, 1}, spring->units);
        impulses[number] = -lapse * spring->damping * speed / (1.0 + lapse * spring->damping * unit);
    }
    for (int number = 0; number < count; number++) {
        push(springs + number, impulses[number], pulled, changes);
    }
}

// Where Chipmunk will move a body to.
static Pose ahead(const cpBody *body, double dt) {
    return moved(pose_of(body), twist_of(body), dt);
}

// Put the point from which a limit measures on the axis through the first anchor, as far along it as it was, so that it
// acts along the axis however far the anchor is off its line.
static void put_on_axis(const Joint *joint, const Anchors *anchors, cpSlideJoint *limit) {
    Vec axis = vec(joint->axis[0], joint->axis[1]), across = perpendicular(axis);
    Vec second = vec(joint->anchor_b[0], joint->anchor_b[1]);
    double along = dot(axis, sub(limit->anchorA, second));
    double beside = dot(across, rotated_back(anchors->apart, anchors->of_b));
    limit->anchorA = add(second, add(scaled(axis, along), scaled(across, beside)));
}

void prepare_parts(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        // A slider that is locked has a pivot instead.
        if (!joint->has_axis || joint->part_count == 0 || world->parts[joint->first_part].kind != PART_PIN) {
            continue;
        }
        cpPinJoint *pin = (cpPinJoint *)world->parts[joint->first_part].constraint;
        Pose a = ahead(world->bodies[joint->a].engine, world->dt), b = ahead(world->bodies[joint->b].engine, world->dt);
        Anchors anchors = anchors_at(joint, a, b);
        Vec across = perpendicular(rotated(vec(joint->axis[0], joint->axis[1]), anchors.of_b));
        Vec beside = sub(add(anchors.arm_b, anchors.apart), scaled(across, across_arm));
        pin->anchorA = rotated_back(beside, anchors.of_b);
        const Part *limit = world->parts + joint->first_part + LIMIT_PART;
        if (joint->part_count > LIMIT_PART && limit->kind == PART_SLIDE) {
            put_on_axis(joint, &anchors, (cpSlideJoint *)limit->constraint);
        }
    }
}

void core_read_impulses(const World *world, cpVect *impulses) {
    for (int number = 0; number < world->part_count; number++) {
        impulses[number] = impulse_of_part(world->parts + number);
    }
}

void core_write_impulses(World *world, const cpVect *impulses) {
    for (int number = 0; number < world->part_count; number++) {
        const Part *part = world->parts + number;
        *impulse_at(part, 0) = impulses[number].x;
        if (part->kind == PART_PIVOT) {
            *impulse_at(part, 1) = impulses[number].y;
        }
    }
}

static double joint_impulse(const World *world, const Joint *joint) {
    double most = 0.0;
    for (int number = 0; number < joint->part_count; number++) {
        most = greatest(most, length(world->parts[joint->first_part + number].total));
    }
    return most;
}

// The point of an anchor in the world [m].
static Vec world_point(const cpBody *body, Vec anchor) {
    return add(body->p, rotated(anchor, rotation(body->a)));
}

// The unit vector from the first anchor of a constraint to the second.
static Vec between(const cpConstraint *constraint, Vec at_a, Vec at_b) {
    Vec apart = sub(world_point(constraint->b, at_b), world_point(constraint->a, at_a));
    double distance = length(apart);
    return distance > 0.0 ? scaled(apart, 1.0 / distance) : vec(0.0, 0.0);
}

// The unit vector along which a constraint about an axis acts on the second body of its joint.
//
// Pin and limit have the bodies of the joint the other way round, and their anchors are put anew in each step, so
// that their lines are taken from the axis. Chipmunk turns the normal of a limit round at the lesser distance.
static Vec by_axis(const World *world, const Joint *joint, const Part *part) {
    const cpBody *a = world->bodies[joint->a].engine, *b = world->bodies[joint->b].engine;
    Vec axis = rotated(vec(joint->axis[0], joint->axis[1]), rotation(b->a));
    if (part->kind == PART_PIN) {
        return negated(perpendicular(axis));
    }
    if (part->kind == PART_DRIVE) {
        return negated(axis);
    }
    const cpSlideJoint *limit = (cpSlideJoint *)part->constraint;
    Vec at_a = world_point(a, vec(joint->anchor_a[0], joint->anchor_a[1]));
    // From the point beyond the upper limit, the anchor lies against the axis.
    double distance = dot(sub(at_a, world_point(b, limit->anchorA)), axis);
    bool at_lesser = 2.0 * fabs(distance) < limit->min + limit->max;
    return at_lesser == (distance > 0.0) ? axis : negated(axis);
}

// Whether a part acts along a line: that of a rod, a rope, a spring, a limit or a drive.
static bool is_axial(const Part *part) {
    return part->kind == PART_PIN || part->kind == PART_SLIDE || part->kind == PART_SPRING || part->kind == PART_ROPE ||
           part->kind == PART_DRIVE;
}

// The unit vector along which a rope with guides comes to its second end.
static Vec by_path(const World *world, const Joint *joint) {
    const Row *row = world->rows + joint->first_row + joint->row_count - 1;
    int span = row->guide_count - 2;
    const Guide *guide = world->guides + row->first_guide + span;
    Pose a = pose_of(world->bodies[guide[0].body].engine), b = pose_of(world->bodies[guide[1].body].engine);
    Jacobian jacobian;
    span_at(row, world->guides, span, a, b, &jacobian);
    return jacobian.b.v;
}

// The unit vector along which an axial part pushes the second body of its joint.
static Vec line_of(const World *world, const Joint *joint, const Part *part) {
    if (part->kind == PART_ROPE) {
        return by_path(world, joint);
    }
    // The anchors of all other kinds lie in the same place.
    const cpPinJoint *axial = (cpPinJoint *)part->constraint;
    bool by_line = joint->has_axis || part->kind == PART_DRIVE;
    return by_line ? by_axis(world, joint, part) : between(part->constraint, axial->anchorA, axial->anchorB);
}

static bool is_linear(const Part *part) {
    return part->kind == PART_PIVOT || is_axial(part);
}

// An impulse of a part on the second body of its joint; of one that acts on the turn of the bodies, the first number.
static Vec pull_of(const World *world, const Joint *joint, const Part *part, Vec impulse) {
    impulse = is_axial(part) ? scaled(line_of(world, joint, part), impulse.x) : impulse;
    const Body *a = world->bodies + joint->a, *b = world->bodies + joint->b;
    return is_linear(part) ? scaled(impulse, reported_share(a, b, impulse)) : impulse;
}

void clear_totals(World *world) {
    for (int number = 0; number < world->part_count; number++) {
        world->parts[number].total = vec(0.0, 0.0);
    }
}

void add_impulses(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        for (Part *part = world->parts + joint->first_part, *end = part + joint->part_count; part < end; part++) {
            part->closing = vec(0.0, 0.0);
            part->total = add(part->total, pull_of(world, joint, part, impulse_of_part(part)));
        }
    }
}

void add_closings(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        for (Part *part = world->parts + joint->first_part, *end = part + joint->part_count; part < end; part++) {
            part->total = add(part->total, pull_of(world, joint, part, part->closing));
        }
    }
}

void core_read_joints(const World *world, double *impulses, cpVect *pulls, uint8_t *pressing) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        impulses[number] = joint_impulse(world, joint);
        const Part *first = world->parts + joint->first_part;
        pulls[number] = vec(0.0, 0.0);
        for (const Part *part = first; part < first + joint->part_count; part++) {
            pulls[number] = is_linear(part) ? add(pulls[number], part->total) : pulls[number];
        }
        pressing[number] =
            joint->presses && joint->part_count > 0 && dot(first->total, line_of(world, joint, first)) > 0.0;
    }
}

// Return x of a row.
static double x_of_row(const World *world, const Joint *joint, const Row *row) {
    Pose a = pose_of(world->bodies[joint->a].engine), b = pose_of(world->bodies[joint->b].engine);
    const Guide *guide = world->guides + row->first_guide;
    Jacobian jacobian;
    double x = row->offset;
    if (row->kind == ROW_PATH) {
        for (int span = 0; span < row->guide_count - 1; span++, guide++) {
            a = pose_of(world->bodies[guide[0].body].engine);
            b = pose_of(world->bodies[guide[1].body].engine);
            x += span_at(row, world->guides, span, a, b, &jacobian);
        }
        return x;
    }
    Anchors anchors = anchors_at(joint, a, b);
    x += row_at(row, joint, &anchors, a, b, &jacobian);
    return row->guide_count == 0 ? x : x + carrier_at(joint, pose_of(world->bodies[guide->body].engine), &jacobian);
}

// How far the row of a joint that is furthest out of its bounds is out of them [m, rad].
static double apart_by(const World *world, const Joint *joint) {
    double most = 0.0;
    for (const Row *row = world->rows + joint->first_row, *end = row + joint->row_count; row < end; row++) {
        double x = x_of_row(world, joint, row);
        most = greatest(most, row->law == LAW_BOUNDS ? greatest(x - row->upper, row->lower - x) : 0.0);
    }
    return most;
}

void find_gaps(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        double apart = joint->unstepped ? apart_by(world, joint) : 0.0;
        joint->apart = apart > drawn_apart ? apart : 0.0;
    }
}

// Whether an unstepped joint has come nearer in the step, and is still apart.
static bool is_drawn(const World *world, const Joint *joint) {
    double apart = apart_by(world, joint);
    return apart > drawn_apart && joint->apart - apart > drawn_least * (double)SUB_STEPS * world->dt;
}

void find_broken(World *world) {
    world->has_broken = false;
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        // The first step of a joint takes back the half-step lead of a body that was in free flight: that impulse is no
        // load.
        joint->broken = !joint->unstepped && joint->most < INFINITY && joint_impulse(world, joint) > joint->most;
        joint->unstepped = joint->unstepped && is_drawn(world, joint);
        world->has_broken = world->has_broken || joint->broken;
    }
}
