// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Position corrections that keep the energy: of continuous collision and of first touches.
//
// A body that is set back against gravity or a wrench gets the velocity that it had at that place. Otherwise each
// bounce of a falling body would gain the potential energy of the displacement. Of jointed bodies the joint solver
// removes the work.

#ifndef PHYSSIM_WORK_CORRECTION_H
#define PHYSSIM_WORK_CORRECTION_H

#include "world.h"

// The velocity that a body had at the place to which it is set back, by a displacement [m].
static inline Twist corrected_twist(const World *world, const cpBody *body, Vec back) {
    Vec pull = add(world->space->gravity, scaled(body->f, body->m_inv));
    double way = length(back), work = dot(pull, back);
    if (work == 0.0) {
        return twist_of(body);
    }
    Vec along = scaled(back, 1.0 / way);
    // The engine's velocity is that of half a step earlier.
    double speed = dot(body->v, along) + dot(pull, along) * world->dt / 2.0, square = speed * speed + 2.0 * work;
    double change = copysign(sqrt(greatest(square, 0.0)), speed) - speed;
    // Energy that the translation does not have came from the spin.
    double missing = least(square, 0.0) * body->i_inv / body->m_inv;
    double spin = copysign(sqrt(greatest(body->w * body->w + missing, 0.0)), body->w);
    return (Twist){add(body->v, scaled(along, change)), missing < 0.0 ? spin : body->w};
}

#endif
