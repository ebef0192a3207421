// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ONE_WAY_H
#define PHYSSIM_ONE_WAY_H

#include "world.h"

// Whether the bodies of a contact pass each other, since one of them is one-way.
bool passes(const World *world, const cpArbiter *arbiter);

// Whether another body passes a one-way body in a motion from some poses, by its way relative to it [m]: where it does
// not begin on the side that bears it, or does not come against it.
bool is_passed(const Body *body, Pose pose, const Body *other, Pose other_pose, Vec way);

#endif
