// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Drives: from the last command of each robot to the velocity of the floor under its wheels; and its odometry.
//
// Problem: a robot does not have its commanded velocity at once, and not for ever: motors have a
// greatest acceleration, and a command counts until its timeout.
// Method: the velocity of the wheels goes to the commanded one on a straight line, as fast as the rim of no wheel
// accelerates more than it can; a robot that starts on an arc stays on it. The wheels turn so whatever the body
// does: where the floor cannot move it, they slip.
// Law: the travel of the wheels is the integral of their velocity by the trapezoidal rule, and exact.
//
// Odometry.
// Method: the travel of the wheels in a step is an arc whose turn the gyroscope measures (exact integration of a
// constant twist; Siegwart, Nourbakhsh, "Autonomous Mobile Robots"). Errors are random walks: those of the distance
// grow with its root, those of the heading with the root of distance and turn (Thrun, Burgard, Fox, "Probabilistic
// Robotics", section 5.4, in the limit of short moves). Noise is a function of seed, name and step; without slip there
// is none. The covariance of the reckoned pose is propagated along the path as that of an extended Kalman filter is
// (ibid., section 3.3): P <- F P Fᵀ + Q, where F tells how far an error of the heading moves the end of the chord, and
// Q the new errors.
//
// Battery.
// Method: the charge is the integral of the currents (coulomb counting); each is constant. Where none is left, wheels
// brake as at the end of a command. Where the centre of mass of the robot is on a dock, that charges the battery.
//
// Cost: 0.2 µs a robot and step.

#include "outline.h"
#include "stages.h"

// The chord of an arc by its length, for the turn along it [rad].
static double chord_by_arc(double turn) {
    return turn != 0.0 ? sin(turn / 2.0) / (turn / 2.0) : 1.0;
}

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
    Twist before = robot->state.wheels, after = aim, change = twist_sum(aim, before, -1.0);
    double speed = rim_speed(robot, change), most = robot->acceleration * dt;
    if (speed > most) {
        after = twist_sum(before, change, most / speed);
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

// Whether a robot has a battery, and that is empty.
static bool is_empty(const Robot *robot) {
    return robot->battery.capacity > 0.0 && robot->state.drawn >= robot->battery.charge;
}

static bool is_on(const Body *body, const Body *dock) {
    Vec away = sub(body->scratch.begin.p, dock->scratch.begin.p);
    Vec local = rotated_back(away, rotation(dock->scratch.begin.yaw));
    for (const cpShape *shape = dock == body ? NULL : dock->engine->shapeList; shape != NULL; shape = shape->next) {
        if (covers(shape, local)) {
            return true;
        }
    }
    return false;
}

// Drain the battery of a robot by a sub-step, and charge it on a dock.
static void use_battery(const World *world, Robot *robot) {
    const Battery *battery = &robot->battery;
    if (battery->capacity == 0.0) {
        return;
    }
    const Body *body = world->bodies + robot->body;
    Twist wheels = robot->state.wheels;
    double current = battery->idle;
    current += wheels.v.x != 0.0 || wheels.v.y != 0.0 || wheels.w != 0.0 ? battery->moving : 0.0;
    for (int number = 0; number < battery->dock_count; number++) {
        if (is_on(body, world->bodies + battery->docks[number])) {
            current -= battery->charging;
            break;
        }
    }
    double drawn = robot->state.drawn + current * world->dt;
    robot->state.drawn = clamped(drawn, battery->charge - battery->capacity, battery->charge);
}

// Accelerate the wheels.
void roll_wheels(World *world) {
    for (int number = 0; has_stage(world, STAGE_FLOOR) && number < world->robot_count; number++) {
        Robot *robot = world->robots + number;
        double yaw = world->bodies[robot->body].scratch.begin.yaw;
        bool obeys = world->step < robot->state.until && !is_empty(robot);
        Twist aim = obeys ? robot->state.aim : (Twist){0}, after = robot->state.wheels;
        if (!is_same(robot->state.wheels, aim) || !is_same(aim, robot->state.aim)) {
            after = accelerated(robot, aim, world->dt);
        }
        robot->mean = twist_sum(robot->state.wheels, after, 1.0);
        robot->mean = (Twist){scaled(robot->mean.v, 0.5), robot->mean.w / 2.0};
        robot->state.aim = aim;
        robot->state.wheels = after;
        double turn = robot->mean.w * world->dt;
        robot->under = at_center(robot->mean, robot->center, yaw + turn / 2.0);
        // The chord of the arc that they roll along.
        robot->under.v = scaled(robot->under.v, chord_by_arc(turn));
        robot->end = at_center(after, robot->center, yaw + turn);
    }
}

// A reckoned pose after a displacement, as seen from the robot.
static Pose reckoned(Pose pose, Vec displacement, double turn) {
    Vec chord = rotated(scaled(displacement, chord_by_arc(turn)), rotation(pose.yaw + turn / 2.0));
    return (Pose){add(pose.p, chord), pose.yaw + turn};
}

// The covariance after a chord in the frame of the odometry, with new errors along it and of the heading.
static void propagate_covariance(Robot *robot, Vec chord, double distance, double turn) {
    double *p = robot->state.covariance, x = -chord.y, y = chord.x, heading = p[5];
    p[0] += 2.0 * x * p[3] + x * x * heading;
    p[1] += x * p[4] + y * p[3] + x * y * heading;
    p[2] += 2.0 * y * p[4] + y * y * heading;
    p[3] += x * heading;
    p[4] += y * heading;
    p[5] += robot->slip[1] * robot->slip[1] * (distance + fabs(turn));
    double square = dot(chord, chord);
    if (square > 0.0) {
        double along = robot->slip[0] * robot->slip[0] * distance / square;
        p[0] += along * chord.x * chord.x;
        p[1] += along * chord.x * chord.y;
        p[2] += along * chord.y * chord.y;
    }
}

// Add the step to the travel of the wheels, and to the odometry.
void reckon_odometry(World *world) {
    for (int number = 0; has_stage(world, STAGE_FLOOR) && number < world->robot_count; number++) {
        Robot *robot = world->robots + number;
        const Body *body = world->bodies + robot->body;
        Vec travel = scaled(robot->mean.v, world->dt), measured = travel;
        double turn = body->engine->a - body->scratch.begin.yaw, drift = 0.0, distance = length(travel);
        if (robot->noise != NULL) {
            const cpVect noise = scaled(robot->noise[world->own->call_step], 1.0 / sqrt(SUB_STEPS));
            double share = distance > 0.0 ? 1.0 + noise.x * robot->slip[0] / sqrt(distance) : 1.0;
            measured = scaled(travel, share);
            drift = noise.y * robot->slip[1] * sqrt(distance + fabs(turn));
        }
        robot->state.travel = twist_sum(robot->state.travel, robot->mean, world->dt);
        Pose before = robot->state.odometry;
        robot->state.odometry = reckoned(before, measured, turn + drift);
        if (robot->noise != NULL) {
            propagate_covariance(robot, sub(robot->state.odometry.p, before.p), distance, turn);
        }
    }
}

void use_batteries(World *world) {
    for (int number = 0; has_stage(world, STAGE_FLOOR) && number < world->robot_count; number++) {
        use_battery(world, world->robots + number);
    }
}
