// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What Python and the core share: the tables that describe a scene, the state that steps change, and the calls.
//
// Python builds the tables when a request changes the scene, in arrays of NumPy whose fields are those declared here;
// the core never allocates or frees them. cffi reads this file as it is, but for lines that begin with '#'.

#ifndef PHYSSIM_CORE_H
#define PHYSSIM_CORE_H

#include "chipmunk.h"
#include <stdint.h>

// Where a body is: x, y [m], yaw [rad].
typedef struct Pose {
    cpVect p;
    double yaw;
} Pose;

// A velocity [m/s] and a spin [rad/s]; also changes of a pose [m, rad], and momenta [N s, N m s].
typedef struct Twist {
    cpVect v;
    double w;
} Twist;

// Pose and velocity of the engine's origin of a body.
typedef struct Motion {
    Pose pose;
    Twist twist;
} Motion;

// What outlives a step of a body, besides pose and velocity, which Chipmunk has. Python hands it on to the next table.
// A checkpoint has all of it but `released`: what falls by that is in free flight there.
typedef struct BodyState {
    uint8_t free;     // in free flight, so that its velocity leads
    uint8_t released; // something that it touched was removed or moved since the last step
    uint8_t thrown;   // its velocity was set since the last step
    uint8_t fresh;    // its lead by fields is to be found as the next step begins
    Twist field;      // its lead by fields (`fields.c`), half of what they change its velocity by in a sub-step
    Twist push;       // change of velocity by contacts and joints, a mean of the last steps, on a floor
} BodyState;

// A body: what requests say of it, which Python writes, and its state. The last body of the table is the background,
// which has the walls.
typedef struct Body {
    cpBody *engine;
    uint8_t dynamic;       // forces move it
    uint8_t anchored;      // it does not move at all
    uint8_t sensor;        // its contacts have no effect
    uint8_t towed;         // it rolls on an axle without a motor
    cpVect offset;         // the engine's origin in the body's frame [m]
    double reach;          // outer radius about the engine's origin [m]
    double inner;          // half the width of its thinnest piece [m]
    double safe_depth;     // how far it may be entered in a sub-step unseen [m]
    double slop;           // how far it may overlap others at rest [m]
    double turning_radius; // how far out its turning counts for continuous collision [m]
    double corners;        // of its pieces, the cost of continuous collision
    double pieces;         // count of its pieces
    double area;           // [m²]
    const cpVect *hull;    // corners of the convex hull of several pieces, about the centre of mass [m]
    int32_t hull_count;    // 0 of a body of one piece, and where there is no medium
    int64_t group;         // bodies of one group pass through each other; 0 is none
    Twist wrench;          // force [N] and torque [N m] that act on it
    double braking;        // greatest deceleration by friction with the floor [m/s²]; 0 where none acts
    double lever;          // mean distance of the points that bear it on the floor [m]
    double belt;           // velocity of its surface along its outline, counter-clockwise [m/s]
    double rolling;        // coefficient of rolling resistance
    cpVect one_way;        // direction in its axes in which others pass it, of length 1; 0 is none
    uint8_t closed_sides;  // others do not pass it across that direction
    cpVect surface;        // velocity of the surface of a conveyor, in the body's axes [m/s]
    BodyState state;
    uint8_t lost;            // it has left the range of numbers in the last step
    struct BodyPrivate *own; // what the core keeps of it, as long as it steps this table
} Body;

// A grip of a hand on a body; Box2D's mouse joint.
typedef struct Grip {
    int32_t body;
    cpVect anchor; // in the body's frame, its origin the centre of mass [m]
    cpVect target; // of the hand in the world [m]
} Grip;

// A constant force on a body that forces move.
typedef struct AppliedForce {
    int32_t body;
    uint8_t turns; // with the body; else it is along the axes of the world
    cpVect force;  // [N]
    cpVect arm;    // from the centre of mass to where it acts, in the axes of the body [m]
} AppliedForce;

enum { WAVES = 8 };

// A wave of gusts: its rate [rad/s], and the factors of cos and sin [m/s].
typedef struct Wave {
    double rate;
    cpVect cosine, sine;
} Wave;

// A region that a medium fills: that of a body, or of all the world.
typedef struct Region {
    int32_t body;     // -1 is all of the world that no other region fills: its air
    uint8_t gusty;    // it has gusts
    double density;   // [kg/m²]
    double viscosity; // [N s/m²]
    double drag;      // coefficient of quadratic drag
    cpVect flow;      // in the axes of the body [m/s]
    Wave waves[WAVES];
} Region;

// A body that attracts others, and is attracted where forces move it.
typedef struct Attractor {
    int32_t body;
    cpVect center; // of mass, from the engine's origin [m]
    double mass;   // [kg]
    double charge; // [C]
} Attractor;

// What outlives a step of a robot, as `RobotState` of `model/states.py`; velocities are as seen from the robot.
typedef struct RobotState {
    Twist aim;            // velocity that the last command aims at; 0 after its timeout
    int64_t until;        // step at which the command ends
    Twist wheels;         // velocity that the wheels have
    Twist travel;         // integral of that
    Pose odometry;        // by wheels and gyroscope, from the pose in which it was spawned
    double covariance[6]; // of the odometry: xx, xy, yy [m²], x yaw, y yaw [m rad], yaw yaw [rad²]
    double drawn;         // charge that its battery has given since it was spawned, less what docks have given [A s]
} RobotState;

// The battery of a robot. A dock is a body that charges it.
enum { DOCKS = 16 };
typedef struct Battery {
    double capacity;     // [A s]; 0 is no battery
    double charge;       // with which it was spawned [A s]
    double idle, moving; // current that it gives: all the time, and besides while a wheel turns [A]
    double charging;     // current that a dock gives [A]
    int32_t dock_count;
    int32_t docks[DOCKS]; // places of their bodies
} Battery;

// A robot: its drive, and what its wheels and its odometry have done.
typedef struct Robot {
    // These fields are set by Python.
    int32_t body;
    int32_t wheel_count; // that drive
    Twist wheels[4];     // speed of the rim of each wheel, by the velocity of the floor
    double acceleration; // greatest of the rim of a wheel [m/s²]
    double curvature;    // greatest of its path [1/m]
    cpVect center;       // of mass in the frame of the body [m]
    double slip[2];      // deviation of the odometry after 1 m of travel: in distance [√m], in heading [rad/√m]
    Battery battery;
    const cpVect *noise; // (steps): two normal numbers for each step of this call; NULL without slip
    RobotState state;
    // These fields are set and used within a step.
    Twist mean;       // velocity of the wheels
    Twist under, end; // velocity that they give to the centre of mass: mean, and at the end; world axes
} Robot;

// What moves an actor, and what it does at its last point; Python finds both by their names in `model/actors`.
enum { ACTOR_PATH, ACTOR_SOCIAL_FORCE, ACTOR_ORCA };
enum { ONCE, LOOP, TO_AND_FRO };

// A point of an actor, and when a path is there.
typedef struct Waypoint {
    double time; // since it started [s]
    Pose pose;
} Waypoint;

// A path: its greatest speed [m/s] and turn rate [rad/s], and whether it turns its body (1).
typedef struct Path {
    double speed, turn_rate, turns;
} Path;

// The desired and the greatest speed of a pedestrian [m/s], and the distance at which it has reached a point [m].
typedef struct Pace {
    double speed, max_speed, goal_radius;
} Pace;

// Parameters of the social force model (`social_force.c`).
typedef struct SocialForce {
    double relaxation_time;             // τ [s]
    double repulsion, range, step_time; // of pedestrians: V⁰ [m²/s²], σ [m], Δt [s]
    double wall_repulsion, wall_range;  // of walls: U⁰ [m²/s²], R [m]
    double cosine_of_sight, behind;     // cos φ, c
} SocialForce;

// Parameters of optimal reciprocal collision avoidance (`orca.c`).
typedef struct Orca {
    double horizon, wall_horizon; // [s]
} Orca;

// What outlives a step of an actor, as `ActorState` of `model/states.py`.
typedef struct ActorState {
    int64_t begun;   // step at which it starts, or started
    int64_t reached; // count of the points that it has reached
} ActorState;

// An actor: a body that moves on its own.
typedef struct Actor {
    // These fields are set by Python.
    int32_t body;
    int32_t kind, repeat;
    int32_t robot;          // number of its robot; -1 if it is none
    int32_t holonomic;      // a robot that moves sideways
    int32_t gate, by, near; // places of the bodies that it waits for; -1 is none
    int32_t waits;          // for a gate or a distance
    int32_t point_count;    // of a looped path the first one again
    const Waypoint *points;
    int64_t delay;   // steps between the gate and its start
    double distance; // to `near` [m]
    double ahead;    // of the origin of a robot, the point of it that is led [m]
    Twist most;      // greatest speed of a robot in x [m/s], and turn rate [rad/s]
    Path path;
    Pace pace;
    SocialForce social_force;
    Orca orca;
    ActorState state;
    // These fields are set and used within a step.
    Twist chosen; // velocity of the centre of mass in the coming step, world axes
} Actor;

// Kinds of constraint rows: which number x of the poses of two bodies a row bounds.
enum {
    ROW_X,        // x of the first anchor less that of the second [m]
    ROW_Y,        // the same of y
    ROW_ANGLE,    // ratio yaw_b - yaw_a [rad]
    ROW_DISTANCE, // distance of the two anchors [m]
    ROW_ACROSS,   // distance of the first anchor from the axis of the second body [m]
    ROW_ALONG,    // displacement of the first anchor along that axis [m]
    ROW_ROLL,     // the same, and ratio (yaw_a - yaw_b) [m]
    ROW_PATH      // length of a rope past its guides [m]
};

// Laws of constraint rows: lower <= x <= upper, both the same for an equality; the force of a spring and its damper,
// without which x is `lower`; x changes at `rate`, with a force of any size up to `most`; x does not change, likewise;
// x does not rise, as in a ratchet, or does not fall.
enum { LAW_BOUNDS, LAW_SPRING, LAW_DRIVE, LAW_FRICTION, LAW_FALLS, LAW_RISES };

// What a rope passes, in order along it: the bodies at its ends, rings, and wheels. Of a gear it is the carrier.
typedef struct Guide {
    int32_t body;
    cpVect anchor;                  // the centre of a wheel in the frame of its body, from the centre of mass [m]
    double radius;                  // > 0 where the rope runs counter-clockwise around a wheel, < 0 clockwise [m]
    double yaw;                     // of the body, as the joint was drawn [rad]
    double heading_in, heading_out; // of the rope as it was drawn: where it comes, and where it goes [rad]
} Guide;

// A constraint row.
typedef struct Row {
    int32_t kind;
    int32_t law;
    int32_t part, component; // the constraint that has the impulse of the row, and which of its two numbers that is
    double lower, upper;     // [m, rad]
    double below, above;     // factors from Chipmunk's impulse to λ, where x is below the lower bound, and elsewhere
    double most;             // greatest absolute value of λ in a sub-step [N s, N m s]
    double rate;             // of x where it is driven, of the upper bound elsewhere [m/s, rad/s]
    double least, greatest;  // upper bound that such a rate leads to [m]
    double offset;           // of a path, the length that is added to it [m]
    double ratio;            // of an angle; of a rack, the radius of its pinion [m]
    double stiffness;        // of a spring [N/m, N m/rad]
    double damping;          // of a spring, with what its stiffness adds to it [N s/m, N m s/rad]
    int32_t first_guide, guide_count;
} Row;

// A point of a command: when [s], which position, rate, or force or torque, and at which rate there; NAN is none.
typedef struct CommandPoint {
    double time, value, rate;
} CommandPoint;

// What the value of a command is, in the order of `model/motor_command.py`.
enum { COMMAND_POSITION, COMMAND_VELOCITY, COMMAND_EFFORT };

// A motor of an axle or a slider.
typedef struct Motor {
    int32_t joint, row; // numbers of them
    double effort;      // greatest force [N] or torque [N m]
    double speed;       // greatest rate [m/s, rad/s]
    double gain;        // rate by the distance that remains [1/s]
    double zero;        // x of the row where the joint is at 0 [m, rad]
    int32_t mode;       // of its command, as the two below; without points it holds
    int32_t point_count;
    const CommandPoint *points;
    int64_t begun; // step at which the command began
} Motor;

// Kinds of constraints of Chipmunk. From PART_OWN on the core alone solves them: a motor without torque keeps the
// impulse of their row. PART_ROPE pulls the second body of its joint along the last span of its path, PART_DRIVE along
// the axis.
enum {
    PART_PIVOT,
    PART_PIN,
    PART_SLIDE,
    PART_GEAR,
    PART_ROTARY_LIMIT,
    PART_MOTOR,
    PART_SPRING,
    PART_OWN,
    PART_ROPE,
    PART_DRIVE
};

// A constraint of a joint.
typedef struct Part {
    int32_t kind;
    cpConstraint *constraint;
    cpVect total; // impulse on the second body of the joint in the last step, world axes; of a torque, the first number
    cpVect closing; // impulse with which positions were closed in this sub-step, as Chipmunk would store it
} Part;

// A joint; its parts follow one another, and so do its rows.
typedef struct Joint {
    cpVect anchor_a;   // in the frame of the first body, its origin the centre of mass [m]
    cpVect anchor_b;   // the same in the frame of the second
    cpVect axis;       // unit vector of a slider or a rack in the frame of the second body
    double most;       // impulse in a step beyond which it breaks [N s, N m s]
    uint8_t has_axis;  // the direction from its first to its second point is an axis of the second body
    uint8_t presses;   // its first part may push the bodies apart
    uint8_t unstepped; // its first step is to come, or it is being drawn together since it was made
    uint8_t broken;    // in the last step
    int32_t a, b;      // places of its bodies in the table
    int32_t first_part, part_count;
    int32_t first_row, row_count; // none where Chipmunk alone solves it, as a spring without damping
    // Of an unstepped one that is to be drawn together: how far its rows are out of their bounds, else 0 [m, rad].
    double excess;
} Joint;

// Functions of Chipmunk, from Pymunk's own library.
typedef struct Chipmunk {
    void (*space_step)(cpSpace *, double);
    void (*body_activate)(cpBody *);
    void (*reindex_body)(cpSpace *, cpBody *);
    uint8_t (*shape_query)(cpSpace *, cpShape *, void (*)(cpShape *, void *, void *), void *);
    void (*each_arbiter)(cpSpace *, void (*)(cpArbiter *, void *), void *);
    double (*point_query)(const cpShape *, cpVect, cpPointQueryInfo *);
    void (*remove_shape)(cpSpace *, cpShape *);
} Chipmunk;

// The stages that can be left out, to measure what fails without each (`make ablate`). The first two are
// no rows of the tables in `step.c`: `applied_forces.c` tests the one, `half_step.c` the other.
enum {
    STAGE_HALF_STEP = 1,
    STAGE_SUPPORT = 2,
    STAGE_RESTING_DAMPING = 4,
    STAGE_FLOOR = 8,
    STAGE_CONTINUOUS = 16,
    STAGE_TIGHT_BOXES = 32,
    STAGE_FALSE_CONTACTS = 64,
    STAGE_IMPACT = 128,
    STAGE_REST_OF_STEP = 256,
    STAGE_EDGES = 512,
    STAGE_PROPAGATION = 1024,
    STAGE_BLOCK_SOLVER = 2048,
    STAGE_JOINTS = 4096,
    STAGE_LOADS = 8192,
    STAGE_ORDER = 16384,
    STAGE_FIELDS = 32768,
    STAGE_STEEP_FRICTION = 65536,
    STAGE_ALL = 2 * STAGE_STEEP_FRICTION - 1
};

enum { SUB_STEPS = 4 };

// Of each body, safe depths in its inner radius: two that approach by less than the lesser safe depth in a sub-step
// need no time of impact, since each keeps its centre well on the side it came from.
enum { SAFE_DEPTHS = 4 };

// Corners of a polygon whose time of impact costs as much as that of a round shape, most of which does not depend on
// the corners.
enum { ROUND_COST = 4 };

// A pair of bodies that touched during a frame.
typedef struct Contact {
    int64_t pair[2]; // places of the two bodies, the lesser first; -1, always second, is the background
    cpVect point;    // mean of the latest contact points [m]
    cpVect normal;   // from the first to the second body
    cpVect impulse;  // sum over the frame of what acts on the second body [N s]
    int64_t points;  // count of contact points; 0 for an overlap of a sensor
} Contact;

// A pair of bodies that began to touch during a frame.
typedef struct Begun {
    int64_t pair[2]; // as that of a contact
    double time;     // since the frame began [steps]
} Begun;

// A piece of what rays meet (`rays.c`): a disc, or a convex polygon, whose edges follow one another counter-clockwise.
// A wall is a polygon of one edge, with all that is behind it.
typedef struct Piece {
    int32_t body;                   // its row in the scene
    int32_t owner;                  // that of the robot of which the body is a part, else the same
    int32_t first_edge, edge_count; // no edges: a disc
    cpVect center;                  // of the disc, or of a circle around the polygon, in the frame of the body [m]
    double radius;                  // of the same [m]
} Piece;

// An edge of a piece, in the frame of its body.
typedef struct Edge {
    cpVect begin, end; // [m]
    cpVect normal;     // outward unit vector
} Edge;

// A world: what Python sets, and what the core keeps between steps.
typedef struct World {
    cpSpace *space;
    Chipmunk chipmunk;
    double dt; // length of a sub-step [s]
    uint32_t stages;
    uint8_t reports_contacts;
    uint8_t statics_moved;    // an anchored body or a wall has been moved since the last step
    uint8_t has_fields;       // fields act, or velocities lead by them
    double drag_acceleration; // greatest force of a hand, by the mass of its body [m/s²]
    // Of attraction (`attraction.c`): G [N m^p/kg²], k [N m^p/C²], p and ε [m].
    double gravitation, coulomb, attraction_power, softening;
    int64_t step;        // count of steps that the world has made
    int64_t age;         // count of steps since the space was built
    double longest_call; // time in which a call of `core_step` is to end, if one sub-step does [s]
    double farthest;     // a body beyond this position, angle or velocity is lost [m, rad, m/s, rad/s]
    // The bodies with the background, the others as they are in the world.
    Body *bodies;
    Joint *joints;
    Part *parts;
    Row *rows;
    Motor *motors;         // in the order of their joints
    Guide *guides;         // of rows
    Grip *grips;           // in the order of their bodies
    AppliedForce *forces;  // in the order of their bodies
    Region *regions;       // in the order of their bodies; the air comes last
    Attractor *attractors; // in the order of their bodies
    Robot *robots;
    Actor *actors;
    int32_t body_count, joint_count, part_count, row_count, guide_count, motor_count, grip_count, force_count,
        region_count, attractor_count, robot_count, actor_count;
    // These fields are results of the last steps.
    uint8_t within_step; // a step is begun and not ended
    uint8_t has_broken;  // a joint
    uint8_t has_lost;    // a body
    int64_t swept;       // pairs of bodies whose time of impact has been looked for since the world was made
    int32_t contact_count, begun_count;
    int32_t reported_steps; // count of steps that have been reported since the frame began
    Contact *contacts;      // of the frame, by place
    Begun *begun;
    struct Private *own;
} World;

// All that the library exports.
#pragma GCC visibility push(default)

// A hash of the sources that the library was compiled from (`sources.py`).
const char *core_sources(void);

// `hook` is a constraint in the space that changes nothing: by it the core is called between narrow phase and solver.
World *core_new(cpSpace *space, Chipmunk chipmunk, double dt, cpConstraint *hook);
void core_free(World *world);

// Have the core step other bodies. `former` has the place (count) that each body had in the table before; -1 is none.
void core_use_bodies(World *world, Body *bodies, int32_t count, const int32_t *former);
void core_use_joints(World *world, Joint *joints, int32_t joint_count, Part *parts, int32_t part_count, Row *rows,
                     int32_t row_count, Guide *guides, int32_t guide_count);

// Remove the shapes of bodies from the space, and note what touched them as released.
void core_remove_shapes(World *world, cpBody **bodies, int32_t count);

// Make a number of steps, and return how many were ended: fewer where a joint breaks, a body is lost, or the call has
// taken long. The next call goes on with a step that is begun, before which nothing of the world may be read or
// changed.
int32_t core_step(World *world, int32_t count);

// The state that the next step begins with, after all requests until now, (body_count - 1): motions, whether each body
// is in free flight, and whether its support was removed.
void core_read_state(World *world, Motion *motions, uint8_t *free, uint8_t *unsupported);
// Poses of the bodies' origins, and true velocities of their centres of mass.
void core_observe(World *world, Pose *poses, Twist *twists);
// Set poses and velocities; no body may sleep.
void core_write_state(World *world, const Motion *motions);

// Impulses from which the next step starts, (part_count) [N s, N m s]; the second is 0 but for pivots.
void core_read_impulses(const World *world, cpVect *impulses);
void core_write_impulses(World *world, const cpVect *impulses);

// Of each joint (joint_count): the greatest impulse of its parts in the last step [N s, N m s], its linear impulse on
// the second body [N s], and whether it pushed its bodies apart.
void core_read_joints(const World *world, double *impulses, cpVect *pulls, uint8_t *pressing);

// List the contacts since the frame began; begin the next one.
void core_take_contacts(World *world);
void core_clear_contacts(World *world);
// Continue with the sums of a world of the same bodies.
void core_copy_contacts(World *world, const World *old);

// Find how far it is from `origin` along each of some directions, counter-clockwise within a turn, to the nearest piece
// of any body but those of `own` (-1 is none), by the poses of all bodies. A distance is INFINITY where nothing is
// within `reach`; beyond it, it may also be true. All are 0 where the origin lies in a piece. [m]
void core_cast_rays(const Piece *pieces, int32_t piece_count, const Edge *edges, const Pose *poses, int32_t own,
                    cpVect origin, double reach, const cpVect *directions, int32_t count, double *distances);

#pragma GCC visibility pop

#endif
