// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The stages of a step; `step.c` has their order.

#ifndef PHYSSIM_STAGES_H
#define PHYSSIM_STAGES_H

#include "world.h"

// Wrenches of commands, and free flight of bodies that requests have changed (`half_step.c`).
void begin_half_step(World *world);

// Constant forces on bodies, and leads of bodies in free flight (`applied_forces.c`). `find_leads` leaves these forces
// out; `turn_leads`, which follows it, adds them, and finds leads anew where forces turn with their bodies.
void apply_forces(World *world);
void find_leads(World *world);
void turn_leads(World *world);

// Forces that depend on where all bodies are and how they move: media (`media.c`), attraction (`attraction.c`);
// their half-step treatment (`fields.c`).
void begin_fields(World *world);
void apply_fields(World *world);
void keep_fields(World *world);

// Forces of hands (`mouse_joints.c`).
void pull_grips(World *world);

// Errors of the solver in what friction locks in place (`resting_damping.c`).
void damp_resting(World *world);

// Actors: where they go, and at which velocity (`actors.c`). `choose_velocity` chooses that of the next actor, and is
// false where all have one.
void begin_actors(World *world);
bool choose_velocity(World *world);
void move_actors(World *world);

// Wheels (`drives.c`), odometry (`odometry.c`) and batteries (`batteries.c`) of robots.
void roll_wheels(World *world);
void reckon_odometry(World *world);
void use_batteries(World *world);

// The floor under bodies, and how contacts and joints have pushed what it carries (`floor.c`).
void apply_floor(World *world);
void find_floor_pushes(World *world);

// One-way bodies (`one_way.c`): contacts that carry a load, and bodies that pass.
void find_loaded(World *world);
void find_passing(World *world);

// Fast bodies end their step where they first hit something (`continuous.c`), and move on after that
// (`rest_of_step.c`); they keep small boxes (`tight_boxes.c`).
void clamp_moves(World *world);
void finish_moves(World *world);
void tighten_boxes(World *world);

// Constraints are put where the step needs them (`joint_parts.c`), and motors get their rates (`joint_motors.c`).
void prepare_parts(World *world);
void command_motors(World *world);

// Have Chipmunk's solver resist rolling, until the step ends (`rolling.c`).
void begin_rolling(World *world);
// How far ahead of a disc the load of a contact acts where it rolls; 0 is where nothing rolls [m].
double rolling_arm(const cpArbiter *arbiter);
void end_rolling(World *world);

// Between narrow phase and solver: contacts that begin (`first_touch.c`), their slop (`overlap_bias.c`), surfaces that
// move along their outlines (`belts.c`), the first of two points (`contact_order.c`), the greatest load
// (`impact_loads.c`), when impacts were (`rest_of_step.c`), contacts next to an impact (`impact_propagation.c`), rounds
// of the solvers (`steep_friction.c`), points that are hit at once (`block_solver.c`), contacts that roll
// (`rolling.c`).
void ignore_false_contacts(World *world);
void find_begun(World *world);
void move_to_impacts(World *world);
void slide_over_edges(World *world);
void prepare_begun(World *world);
void set_overlap_biases(World *world);
void move_belts(World *world);
void order_points(World *world);
void list_load_bounds(World *world);
void time_impacts(World *world);
void defer_contacts(World *world);
void damp_steep_friction(World *world);
void solve_impacts(World *world);
void find_rolls(World *world);
// The rest of the step after impacts (`rest_of_step.c`): how long it is for two bodies that met in this step [s]; by
// how much further a body is for a velocity after its impact than for that before it, and what it has still to go then.
double remaining_time(const Body *a, const Body *b);
Twist displacement_gained(const Body *body, Twist after, double remaining, double dt);
void set_remaining_move(Body *body, Twist gained);

// Joints, with the contacts that jointed bodies bear (`joint_solver.c`); those that broke (`joint_report.c`).
void find_joint_islands(World *world);
void solve_joints(World *world);
void correct_joint_positions(World *world);
// Impulses from which the next step does not start: of gaps that were closed (`joint_solver.c`), and of impacts
// (`impact_loads.c`).
void remove_closing_impulses(World *world);
void remove_impact_impulses(World *world);
void clear_joint_reports(World *world);
void measure_drawn_joints(World *world);
// Add to what joints report: their impulses, and those by which gaps were closed.
void report_joint_impulses(World *world);
void report_joint_closings(World *world);
void find_broken_joints(World *world);

// Mark bodies in free flight (`half_step.c`), and keep slow movers awake (`sleeping.c`).
void find_free(World *world);
// The share of an impulse on two bodies in this sub-step that does not take back a half-step lead; before `find_free`.
double reported_share(const Body *a, const Body *b, Vec impulse);
void ignore_jitter(World *world);
void keep_awake(World *world);

// Which sensors were crossed within the sub-step (`sensors.c`).
typedef void Crossing(World *world, const Body *body, const Body *sensor);
void find_crossings(World *world, Crossing *found);
// When a body and a sensor first met in this sub-step, as a share of it (0 .. 1).
double crossing_time(World *world, Body *body, Body *sensor);

// What touched, and how it pressed (`contact_report.c`).
void report_contacts(World *world);
struct Report *new_report(void);
void rename_contacts(World *world, const int32_t *former, int count);
void free_report(World *world);

#endif
