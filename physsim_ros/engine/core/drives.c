// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Drives: from the last command of each robot to the velocity of the floor under its wheels.
//
// Problem: a robot does not have its commanded velocity at once, and not for ever: motors have a
// greatest acceleration, and a command counts until its timeout.
// Method: the velocity of the wheels goes to the commanded one on a straight line, as fast as the rim of no wheel
// accelerates more than it can; a robot that starts on an arc stays on it. The wheels turn so whatever the body
// does: where the floor cannot move it, they slip.
// Law: the travel of the wheels is the integral of their velocity by the trapezoidal rule, and exact.
//
// Cost: 0.2 µs a robot and step, with its odometry and its battery.

#include "robots.h"
#include "stages.h"

static double rim_speed(const Robot *robot, Twist velocity) {
    double most = 0.0;
    assert(robot->wheel_count <= (int)(sizeof(robot->wheels) / sizeof(robot->wheels[0])));
    for (int wheel = 0; wheel < robot->wheel_count; wheel++) {
        Twist by = robot->wheels[wheel];
        most = greatest(most, fabs(dot(by.v, velocity.v) + by.w * velocity.w));
    }
    return most;
}

// The velocity of the wheels after a step.
static Twist accelerated(const Robot *robot, Twist aim, double dt) {
    Twist before = robot->state.wheels, after = aim, change = twist_plus(aim, before, -1.0);
    double speed = rim_speed(robot, change), most = robot->acceleration * dt;
    if (speed > most) {
        after = twist_plus(before, change, most / speed);
    }
    if (robot->curvature < INFINITY) {
        double sharpest = robot->curvature * fabs(after.v.x);
        after.w = clamped(after.w, -sharpest, sharpest);
    }
    return after;
}

static bool is_same(Twist a, Twist b) {
    return a.v.x == b.v.x && a.v.y == b.v.y && a.w == b.w;
}

// A velocity of the wheels as that of the centre of mass, world axes.
static Twist at_center(Twist velocity, Vec center, double yaw) {
    return (Twist){rotated(velocity_at(velocity, center), rotation(yaw)), velocity.w};
}

// Accelerate the wheels.
void roll_wheels(World *world) {
    for (int number = 0; number < world->robot_count; number++) {
        Robot *robot = world->robots + number;
        double yaw = world->bodies[robot->body].own->begin.yaw;
        bool obeys = world->step < robot->state.until && !is_empty(robot);
        Twist aim = obeys ? robot->state.aim : (Twist){0}, after = robot->state.wheels;
        if (!is_same(robot->state.wheels, aim) || !is_same(aim, robot->state.aim)) {
            after = accelerated(robot, aim, world->dt);
        }
        robot->mean = twist_plus(robot->state.wheels, after, 1.0);
        robot->mean = twist_scaled(robot->mean, 0.5);
        robot->state.aim = aim;
        robot->state.wheels = after;
        double turn = robot->mean.w * world->dt;
        robot->under = at_center(robot->mean, robot->center, yaw + turn / 2.0);
        // The chord of the arc that they roll along.
        robot->under.v = scaled(robot->under.v, chord_by_arc(turn));
        robot->end = at_center(after, robot->center, yaw + turn);
    }
}
