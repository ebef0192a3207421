// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Odometry of robots: the pose that the travel of the wheels tells, with its covariance.
//
// Problem: a robot does not know its pose, only how far its wheels have turned and how fast it turns; each error of
// these stays in the pose that it reckons.
// Method: the travel of the wheels in a sub-step is an arc whose turn the gyroscope measures (exact integration of a
// constant twist; Siegwart, Nourbakhsh, "Autonomous Mobile Robots"). Errors are random walks: those of the distance
// grow with its root, those of the heading with the root of distance and turn (Thrun, Burgard, Fox, "Probabilistic
// Robotics", section 5.4, in the limit of short moves). Noise is a function of seed, name and step; a robot
// whose deviations (`slip`) are 0 has none. The covariance of the reckoned pose is propagated along the path as that of
// an extended Kalman filter is (ibid., section 3.3): P <- F P Fᵀ + Q, where F tells how far an error of the heading
// moves the end of the chord, and Q the new errors.
// Scope: wheels that slip count as travel; a push that moves the robot does not.
// Law: without noise, and without slip between wheels and floor, the reckoned pose is the true one.
// Cost: within that of `drives.c`.

#include "robots.h"
#include "stages.h"

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

// Add the sub-step to the travel of the wheels, and to the odometry.
void reckon_odometry(World *world) {
    for (int number = 0; number < world->robot_count; number++) {
        Robot *robot = world->robots + number;
        const Body *body = world->bodies + robot->body;
        Vec travel = scaled(robot->mean.v, world->dt), measured = travel;
        double turn = body->engine->a - body->own->begin.yaw, drift = 0.0, distance = length(travel);
        if (robot->noise != NULL) {
            const cpVect noise = scaled(robot->noise[world->own->call_step], 1.0 / sqrt(SUB_STEPS));
            double share = distance > 0.0 ? 1.0 + noise.x * robot->slip[0] / sqrt(distance) : 1.0;
            measured = scaled(travel, share);
            drift = noise.y * robot->slip[1] * sqrt(distance + fabs(turn));
        }
        robot->state.travel = twist_plus(robot->state.travel, robot->mean, world->dt);
        Pose before = robot->state.odometry;
        robot->state.odometry = reckoned(before, measured, turn + drift);
        if (robot->noise != NULL) {
            propagate_covariance(robot, sub(robot->state.odometry.p, before.p), distance, turn);
        }
    }
}
