// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The stages of a step, in the order of the tables of `step.c`; behind each is the file that says why and how.

#ifndef PHYSSIM_STAGES_H
#define PHYSSIM_STAGES_H

#include "world.h"

// Before the first sub-step of a step.

// Damp errors of the solver in what friction locks in place (`resting_damping.c`).
void damp_resting(World *world);
// Begin the sums that joints report of the step (`joint_report.c`).
void clear_joint_reports(World *world);
// Measure how far joints are out of their bounds that were just made or changed (`joint_report.c`).
void measure_drawn_joints(World *world);
// Have actors start whose condition is met (`actors.c`).
void begin_actors(World *world);
// Choose the velocity of the next actor; false where all have one (`actors.c`).
bool choose_velocity(World *world);
// Have actors move at their chosen velocities (`actors.c`).
void move_actors(World *world);

// In each sub-step, before Chipmunk's step.

// Find the leads by fields of bodies that requests have changed (`fields.c`).
void begin_fields(World *world);
// Have bodies begin or cease to fly freely where requests have changed that (`half_step.c`).
void begin_flights(World *world);
// Add the wrenches of commands, and constant forces on bodies (`applied_forces.c`).
void apply_forces(World *world);
// Add the forces of hands (`mouse_joints.c`).
void pull_grips(World *world);
// Add the forces of media and of attraction (`fields.c`).
void apply_fields(World *world);
// Find the velocities of the wheels of robots (`drives.c`).
void roll_wheels(World *world);
// Bring bodies to the velocity of the floor under them, by friction (`floor.c`).
void apply_floor(World *world);
// List the contacts of one-way bodies that carry a load (`one_way.c`).
void find_loaded(World *world);
// Have the coming move of fast bodies end where they first hit something (`continuous.c`).
void clamp_moves(World *world);
// Replace the boxes of fast bodies among many others by boxes of bodies at rest (`tight_boxes.c`).
void tighten_boxes(World *world);
// Put the constraints of joints where the sub-step needs them (`joint_parts.c`).
void prepare_parts(World *world);
// Set the rates of motors by their commands (`joint_motors.c`).
void command_motors(World *world);
// Have Chipmunk's solver resist rolling, until `end_rolling` (`rolling.c`).
void begin_rolling(World *world);
void end_rolling(World *world);

// Between Chipmunk's narrow phase and its solver.

// Ignore the contacts of bodies that pass each other, one of them one-way (`one_way.c`).
void ignore_passing(World *world);
// Ignore contacts of polygons that are apart, or whose faces have met by rounding (`first_touch.c`).
void ignore_false_contacts(World *world);
// List the contacts that begin (`first_touch.c`).
void find_begun(World *world);
// Give these the normals and points of the moment of their impact (`first_touch.c`).
void move_to_impacts(World *world);
// Give contacts at seams the normal of the face that is slid over, and ignore those behind it (`first_touch.c`).
void slide_over_edges(World *world);
// Write the contacts that begin to Chipmunk (`first_touch.c`).
void prepare_begun(World *world);
// Have overlaps be pushed out up to the slop of the two bodies (`overlap_bias.c`).
void set_overlap_biases(World *world);
// Have surfaces move along their outlines (`belts.c`).
void move_belts(World *world);
// Put the leading one of two points first (`contact_order.c`).
void order_points(World *world);
// List the greatest impulses that can be loads (`impact_loads.c`).
void list_load_bounds(World *world);
// Find how long ago impacts were, and their bounces then (`rest_of_step.c`).
void time_impacts(World *world);
// Have elastic contacts wait for faster impacts of their bodies (`impact_propagation.c`).
void defer_contacts(World *world);
// Reduce effective masses where friction is steep (`steep_friction.c`).
void damp_steep_friction(World *world);
// Solve the points of bodies that hit each other together (`block_solver.c`).
void solve_impacts(World *world);
// Find the islands of jointed bodies, with the contacts that these bear (`joint_solver.c`).
void find_joint_islands(World *world);
// List the contacts that resist rolling, and are no rows of these islands (`rolling.c`).
void find_rolls(World *world);

// After Chipmunk's step.

// Replace the leads by fields by those of this sub-step (`fields.c`).
void keep_fields(World *world);
// Add the leads by constant forces at the poses of now; `find_leads` finds those without (`applied_forces.c`).
void turn_leads(World *world);
// Have idle time outlive a sub-step in which a body was too fast for rest (`sleeping.c`).
void ignore_jitter(World *world);
// Find the velocities of jointed bodies (`joint_solver.c`).
void solve_joints(World *world);
// Add the impulses of joints to their reports (`joint_report.c`).
void report_joint_impulses(World *world);
// Have bodies that met end their move with the velocity after it (`rest_of_step.c`).
void finish_moves(World *world);
// Close the gaps of joints (`joint_solver.c`).
void correct_joint_positions(World *world);
// Add the impulses by which gaps were closed to the reports of joints (`joint_report.c`).
void report_joint_closings(World *world);
// Find what contacts and joints have changed the velocities of bodies on the floor by (`floor.c`).
void find_floor_pushes(World *world);
// Continue the odometry of robots (`odometry.c`).
void reckon_odometry(World *world);
// Discharge and charge the batteries of robots (`batteries.c`).
void use_batteries(World *world);
// Add contacts to the report of the frame (`contact_report.c`).
void report_contacts(World *world);
// Find which bodies are in free flight (`half_step.c`).
void find_free(World *world);
// Keep bodies awake that are slow for another reason than rest (`sleeping.c`).
void keep_awake(World *world);
// Have the next sub-step not start from the impulses by which gaps were closed (`joint_solver.c`).
void remove_closing_impulses(World *world);
// Have it not start from the impulses of impacts (`impact_loads.c`).
void remove_impact_impulses(World *world);

// At the end of a step.

// Find the joints that broke (`joint_report.c`).
void find_broken_joints(World *world);

// What stages use of each other.

// Find the leads of bodies in free flight, without those by constant forces (`applied_forces.c`).
void find_leads(World *world);
// The share of an impulse on two bodies in this sub-step that does not take back a half-step lead; before `find_free`.
double reported_share(const Body *a, const Body *b, Vec impulse);
// How far ahead of a disc the load of a contact acts where it rolls; 0 is where nothing rolls [m] (`rolling.c`).
double rolling_arm(const cpArbiter *arbiter);
// The rest of the sub-step after the impact of two bodies [s] (`rest_of_step.c`).
double remaining_time(const Body *a, const Body *b);
// By how much further a body is for a velocity after its impact than for that before it (`rest_of_step.c`).
Twist displacement_gained(const Body *body, Twist after, double remaining, double dt);
// Set what a body has still to go in the rest of its sub-step, by such a gain (`rest_of_step.c`).
void set_remaining_move(Body *body, Twist gained);
// Which sensors were crossed within the sub-step (`sensors.c`).
typedef void Crossing(World *world, const Body *body, const Body *sensor);
void find_crossings(World *world, Crossing *found);
// When a body and a sensor first met in this sub-step, as a share of it (0 .. 1) (`sensors.c`).
double crossing_time(World *world, Body *body, Body *sensor);

// The report of a world (`contact_report.c`); a new table of bodies renames it.
struct Report *new_report(void);
void rename_contacts(World *world, const int32_t *former, int count);
void free_report(World *world);

#endif
