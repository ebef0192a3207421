// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Batteries of robots, and docks that charge them.
//
// Method: the charge is the integral of the currents (coulomb counting); each is constant. Where none is left, wheels
// brake as at the end of a command. Where the centre of mass of the robot is on a dock, that charges the battery.

#include "outline.h"
#include "stages.h"

static bool is_docked(const Body *body, const Body *dock) {
    return dock != body && body_covers(dock->engine, dock->own->begin, body->own->begin.p);
}

// Drain the battery of a robot by a sub-step, and charge it on a dock.
static void use_battery(const World *world, Robot *robot) {
    const Battery *battery = &robot->battery;
    if (battery->capacity == 0.0) {
        return;
    }
    const Body *body = world->bodies + robot->body;
    double current = battery->idle;
    current += is_zero(robot->state.wheels) ? 0.0 : battery->moving;
    for (int number = 0; number < battery->dock_count; number++) {
        if (is_docked(body, world->bodies + battery->docks[number])) {
            current -= battery->charging;
            break;
        }
    }
    double drawn = robot->state.drawn + current * world->dt;
    robot->state.drawn = clamped(drawn, battery->charge - battery->capacity, battery->charge);
}

void use_batteries(World *world) {
    for (int number = 0; number < world->robot_count; number++) {
        use_battery(world, world->robots + number);
    }
}
