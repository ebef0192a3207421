// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Motors of axles and sliders: from the command of each to the rate of its row, and its greatest force.
//
// Problem: an arm goes to a position, along a trajectory, at a velocity, or pulls with a torque; whatever it carries,
// and no stronger than its motors are.
// Method: a velocity loop within a position loop, as drives of machines have them (cascade control). The inner loop is
// a row of the joint solver, which gives the joint its rate with all loads that act, as far as the greatest force
// allows; so a joint in its place bears any lesser load without sagging. The outer loop asks for the rate of the
// trajectory and `gain` times the distance that remains: the distance falls as exp(-gain t). A torque is a motor that
// is no stronger and never fast enough. Between two points of a trajectory the position is a cubic polynomial where
// both have rates, else a straight line, as the joint trajectory controller of ros2_control has them. Without a command
// a motor holds.
//
// Cost: 20 ns a motor and sub-step, beside its row.

#include "joint_rows.h"
#include "stages.h"

// The value between two points of a command.
static double interpolated(CommandPoint a, CommandPoint b, double time) {
    double span = b.time - a.time, share = (time - a.time) / span, change = b.value - a.value;
    if (isnan(a.rate) || isnan(b.rate)) {
        return a.value + share * change;
    }
    // Cubic Hermite interpolation.
    double start = a.rate * span, end = b.rate * span;
    double square = 3.0 * change - 2.0 * start - end, cube = start + end - 2.0 * change;
    return a.value + share * (start + share * (square + share * cube));
}

// The value of a command after some time [s]: beyond its ends it stays.
static double command_at(const Motor *motor, double time) {
    const CommandPoint *points = motor->points;
    int last = motor->point_count - 1, low = 0, high = last;
    if (time < points[0].time || time >= points[last].time) {
        return points[time < points[0].time ? 0 : last].value;
    }
    while (high - low > 1) {
        int middle = (low + high) / 2;
        *(points[middle].time <= time ? &low : &high) = middle;
    }
    return interpolated(points[low], points[high], time);
}

// The position of a joint where Chipmunk will move its bodies to [m, rad], 0 where they were joined: of an angle, that
// of the first body.
static double position_of(const World *world, const Motor *motor) {
    const Row *row = world->rows + motor->row;
    Jacobian jacobian;
    double x = row_after(world, world->joints + motor->joint, row, world->dt, &jacobian) - motor->zero;
    return row->kind == ROW_ANGLE ? -x : x;
}

// Set what a command asks of the row of a motor: rate of the joint, and greatest force.
static void obey(const World *world, const Motor *motor, double *rate, double *most) {
    double dt = world->dt;
    // Chipmunk moves bodies before it solves: a rate acts from the end of this sub-step on.
    double time = (double)((world->step - motor->begun) * SUB_STEPS + world->own->sub_step + 1) * dt;
    double value = command_at(motor, time);
    switch (motor->mode) {
    case COMMAND_POSITION:
        // The trajectory of a sub-step, and the share of the distance to it by which exp(-gain t) falls.
        *rate =
            (command_at(motor, time + dt) - value - expm1(-motor->gain * dt) * (value - position_of(world, motor))) /
            dt;
        break;
    case COMMAND_VELOCITY:
        *rate = value;
        break;
    default:
        *rate = copysign(motor->speed, value);
        *most = least(fabs(value), motor->effort);
    }
}

void command_motors(World *world) {
    for (int number = 0; number < world->motor_count; number++) {
        const Motor *motor = world->motors + number;
        Row *row = world->rows + motor->row;
        double rate = 0.0, most = motor->effort;
        if (motor->point_count > 0) {
            obey(world, motor, &rate, &most);
        }
        rate = clamped(rate, -motor->speed, motor->speed);
        row->rate = row->kind == ROW_ANGLE ? -rate : rate;
        row->most = most * world->dt;
    }
}
