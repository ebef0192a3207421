// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#include "outline.h"
#include <stddef.h>

Corner corner_in_world(const cpShape *shape, int number) {
    switch (kind_of(shape)) {
    case SHAPE_CIRCLE:
        return (Corner){((const cpCircleShape *)shape)->tc, {0.0, 0.0}};
    case SHAPE_SEGMENT: {
        const cpSegmentShape *segment = (const cpSegmentShape *)shape;
        return number == 0 ? (Corner){segment->ta, negated(segment->tn)} : (Corner){segment->tb, segment->tn};
    }
    default: {
        const cpSplittingPlane *plane = ((const cpPolyShape *)shape)->planes + number;
        return (Corner){plane->v0, plane->n};
    }
    }
}

Corner corner_on_body(const cpShape *shape, int number) {
    switch (kind_of(shape)) {
    case SHAPE_CIRCLE:
        return (Corner){((const cpCircleShape *)shape)->c, {0.0, 0.0}};
    case SHAPE_SEGMENT: {
        const cpSegmentShape *segment = (const cpSegmentShape *)shape;
        return number == 0 ? (Corner){segment->a, negated(segment->n)} : (Corner){segment->b, segment->n};
    }
    default: {
        const cpPolyShape *polygon = (const cpPolyShape *)shape;
        const cpSplittingPlane *plane = polygon->planes + polygon->count + number;
        return (Corner){plane->v0, plane->n};
    }
    }
}

// The distance of a point from a segment [m].
static double distance_from(Vec point, Vec start, Vec end) {
    Vec segment = sub(end, start), to = sub(point, start);
    double share = clamped(dot(to, segment) / greatest(dot(segment, segment), 1e-300), 0.0, 1.0);
    return length(sub(to, scaled(segment, share)));
}

bool covers(const cpShape *shape, Vec point) {
    int last = corner_count(shape) - 1;
    if (last < 2) {
        Vec start = corner_on_body(shape, 0).point, end = corner_on_body(shape, last).point;
        return distance_from(point, start, end) <= radius_of(shape);
    }
    for (int number = 0; number <= last; number++) {
        Corner corner = corner_on_body(shape, number);
        if (dot(corner.normal, sub(point, corner.point)) > radius_of(shape)) {
            return false;
        }
    }
    return true;
}

bool body_covers(const cpBody *body, Pose pose, Vec point) {
    Vec local = rotated_back(sub(point, pose.p), rotation(pose.yaw));
    for (const cpShape *shape = body->shapeList; shape != NULL; shape = shape->next) {
        if (covers(shape, local)) {
            return true;
        }
    }
    return false;
}
