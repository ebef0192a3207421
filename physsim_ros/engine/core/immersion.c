// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Immersion: which part of a body lies in a region, its exact area and centroid, and what of its outline is wet.
//
// Problem: buoyancy acts at the centroid of what is wet, and drag on the wet outline; a body at the surface has a part
// of each.
// Method: area and first moment are those of the pieces of the body: polygons are clipped at the edges of the region
// (Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 1974); of discs, triangles and sectors are summed along
// the edges of the region. The outline is that of the convex hull, which no other part of the body shields from the
// flow.
// Scope: where pieces overlap, both count, as they do for the mass. Round pieces among several are polygons in the
// outline, and a round region is a polygon of 96 corners and the same area.
// Cost: in `media.c`.

#include "immersion.h"

// Corners of the polygon that counts for a round region.
enum { ROUND_CORNERS = 96 };

// A corner of a polygon, and whether the edge from it on is of the outline of the body.
typedef struct Vertex {
    Vec point;
    bool own;
} Vertex;

// A polygon that is clipped.
typedef struct Polygon {
    Vertex *vertices;
    int count, most;
} Polygon;

// An edge of a basin as seen from the centre of mass of a body: a corner, and the normal outwards.
typedef struct Line {
    Vec corner, normal;
} Line;

// A basin as seen from the centre of mass of a body, and the edges that the body may cross.
typedef struct Clip {
    const Basin *basin;
    Vec origin;
    Line *lines;
    int line_count;
} Clip;

static Polygon polygon_with_room(int most, Arena *arena) {
    return (Polygon){TAKE(arena, Vertex, most), 0, most};
}

static inline void add_vertex(Polygon *polygon, Vec point, bool own) {
    assert(polygon->count < polygon->most);
    polygon->vertices[polygon->count++] = (Vertex){point, own};
}

// Regions

// Add corners on an arc, as a polygon of the same area has them.
static void add_round(Basin *basin, Vec center, double radius, double from, int count) {
    double step = 2.0 * pi / (double)ROUND_CORNERS, outer = radius * sqrt(step / sin(step));
    for (int number = 0; number < count; number++) {
        Rotation by = rotation(from + step * (number + 0.5));
        basin->corners[basin->count++] = add(center, vec(outer * by.c, outer * by.s));
    }
}

Basin basin_of(const Region *region, const cpShape *shape, Pose pose, Arena *arena) {
    int count = corner_count(shape), most = count < 3 ? ROUND_CORNERS : count;
    const cpBody *engine = shape->body;
    Basin basin = {.region = region,
                   .moves = !is_zero(twist_of(engine)),
                   .corners = TAKE(arena, Vec, most),
                   .normals = TAKE(arena, Vec, most)};
    Rotation by = rotation(pose.yaw);
    if (count < 3) {
        Vec a = corner_on_body(shape, 0).point, b = corner_on_body(shape, count - 1).point;
        double along = atan2(b.y - a.y, b.x - a.x) - pi / 2.0;
        add_round(&basin, b, radius_of(shape), along, ROUND_CORNERS / 2);
        add_round(&basin, a, radius_of(shape), along + pi, ROUND_CORNERS / 2);
    } else {
        for (int number = 0; number < count; number++) {
            basin.corners[basin.count++] = corner_on_body(shape, number).point;
        }
    }
    for (int number = 0; number < basin.count; number++) {
        basin.corners[number] = add(pose.p, rotated(basin.corners[number], by));
        basin.center = add(basin.center, scaled(basin.corners[number], 1.0 / basin.count));
    }
    for (int number = 0; number < basin.count; number++) {
        Vec corner = basin.corners[number], edge = sub(basin.corners[(number + 1) % basin.count], corner);
        basin.normals[number] = scaled(negated(perpendicular(edge)), 1.0 / length(edge));
        basin.radius = greatest(basin.radius, length(sub(corner, basin.center)));
    }
    return basin;
}

Containment containment_of(const Basin *basin, Vec center, double reach) {
    Vec offset = sub(center, basin->center);
    double apart = basin->radius + reach;
    if (dot(offset, offset) >= apart * apart) {
        return OUTSIDE;
    }
    Containment containment = INSIDE;
    for (int number = 0; number < basin->count; number++) {
        double depth = dot(basin->normals[number], sub(center, basin->corners[number]));
        if (depth >= reach) {
            return OUTSIDE;
        }
        containment = depth > -reach ? CROSSING : containment;
    }
    return containment;
}

// Polygons

// What of a convex polygon lies behind a line.
static Polygon clipped(Polygon from, Line line, Arena *arena) {
    // As many again: rounding can put corners that are nearly on one line before and behind it in turn.
    Polygon kept = polygon_with_room(2 * from.count, arena);
    Vertex a = from.vertices[0];
    double out_a = dot(line.normal, sub(a.point, line.corner));
    for (int number = 1; number <= from.count; number++) {
        Vertex b = from.vertices[number < from.count ? number : 0];
        double out_b = dot(line.normal, sub(b.point, line.corner));
        if (out_a <= 0.0) {
            add_vertex(&kept, a.point, a.own);
        }
        if ((out_a <= 0.0) != (out_b <= 0.0)) {
            Vec crossing = add(a.point, scaled(sub(b.point, a.point), out_a / (out_a - out_b)));
            add_vertex(&kept, crossing, out_a > 0.0 && a.own);
        }
        a = b;
        out_a = out_b;
    }
    return kept;
}

static void add_area(Immersion *wet, Vec a, Vec b, Vec c) {
    double area = cross(sub(b, a), sub(c, a)) / 2.0;
    wet->area += area;
    wet->first_moment = add(wet->first_moment, scaled(add(a, add(b, c)), area / 3.0));
}

// Clip a polygon at the edges of a basin that its body may cross; no basin leaves it whole.
static Polygon in_basin(Polygon polygon, const Clip *clip, Arena *arena) {
    for (int number = 0; clip != NULL && number < clip->line_count && polygon.count > 0; number++) {
        polygon = clipped(polygon, clip->lines[number], arena);
    }
    return polygon;
}

static void add_bulk(Immersion *wet, Polygon polygon) {
    const Vertex *vertices = polygon.vertices;
    for (int number = 2; number < polygon.count; number++) {
        add_area(wet, vertices[0].point, vertices[number - 1].point, vertices[number].point);
    }
}

static void take_room(Immersion *wet, int sides, int bows, Arena *arena) {
    wet->sides = TAKE(arena, Side, sides);
    wet->bows = TAKE(arena, Bow, bows);
    wet->side_room = sides;
    wet->bow_room = bows;
}

static void add_bow(Immersion *wet, Bow bow) {
    assert(wet->bow_count < wet->bow_room);
    wet->bows[wet->bow_count++] = bow;
}

static void add_sides(Immersion *wet, Polygon polygon) {
    for (int number = 0; number < polygon.count; number++) {
        if (polygon.vertices[number].own) {
            const Vertex *end = polygon.vertices + (number + 1 < polygon.count ? number + 1 : 0);
            assert(wet->side_count < wet->side_room);
            wet->sides[wet->side_count++] = (Side){polygon.vertices[number].point, end->point};
        }
    }
}

// Discs

// Add the sector between the directions of two points, which lie outside the disc as the edge between them does.
static void add_sector(Immersion *wet, Vec center, double radius, Vec a, Vec b) {
    double turn = atan2(cross(a, b), dot(a, b)), from = atan2(a.y, a.x);
    Rotation begin = rotation(from), end = rotation(from + turn);
    double area = radius * radius * turn / 2.0, third = radius * radius * radius / 3.0;
    Vec moment = vec(third * (end.s - begin.s), third * (begin.c - end.c));
    wet->area += area;
    wet->first_moment = add(wet->first_moment, add(scaled(center, area), moment));
    add_bow(wet, (Bow){center, radius, from, from + turn});
}

// Add the segment of a disc that a line cuts off, behind its normal; `ahead` is how far before it the centre is [m].
static void add_disc_segment(Immersion *wet, Vec center, double radius, Vec normal, double ahead) {
    if (ahead >= radius) {
        return;
    }
    double half = ahead <= -radius ? pi : acos(ahead / radius), down = atan2(-normal.y, -normal.x);
    double chord = radius * sin(half), area = radius * radius * half - ahead * chord;
    Vec moment = scaled(normal, -2.0 / 3.0 * chord * chord * chord);
    wet->area += area;
    wet->first_moment = add(wet->first_moment, add(scaled(center, area), moment));
    add_bow(wet, (Bow){center, radius, down - half, down + half});
}

// Add what of a disc lies in a convex polygon, as the sum over the triangles that the centre makes with its edges.
static void add_disc(Immersion *wet, Vec center, double radius, const Polygon *basin) {
    for (int number = 0; number < basin->count; number++) {
        Vec a = sub(basin->vertices[number].point, center);
        Vec b = sub(basin->vertices[(number + 1) % basin->count].point, center), edge = sub(b, a);
        double square = dot(edge, edge), middle = dot(a, edge);
        double within = middle * middle - square * (dot(a, a) - radius * radius);
        double half = sqrt(greatest(within, 0.0));
        double enters = clamped((-middle - half) / square, 0.0, 1.0);
        double leaves = clamped((-middle + half) / square, 0.0, 1.0);
        if (within <= 0.0 || enters >= leaves) {
            add_sector(wet, center, radius, a, b);
            continue;
        }
        Vec first = add(a, scaled(edge, enters)), last = add(a, scaled(edge, leaves));
        if (enters > 0.0) {
            add_sector(wet, center, radius, a, first);
        }
        add_area(wet, center, add(center, first), add(center, last));
        if (leaves < 1.0) {
            add_sector(wet, center, radius, last, b);
        }
    }
}

// All edges of a basin, as seen from the centre of mass of a body.
static Polygon basin_edges(const Clip *clip, Arena *arena) {
    Polygon edges = polygon_with_room(clip->basin->count, arena);
    for (int number = 0; number < clip->basin->count; number++) {
        add_vertex(&edges, sub(clip->basin->corners[number], clip->origin), false);
    }
    return edges;
}

static void add_disc_in_basin(Immersion *wet, Vec center, double radius, const Clip *clip, Arena *arena) {
    if (clip->line_count == 1) {
        Line line = clip->lines[0];
        add_disc_segment(wet, center, radius, line.normal, dot(line.normal, sub(center, line.corner)));
    } else {
        Polygon edges = basin_edges(clip, arena);
        add_disc(wet, center, radius, &edges);
    }
}

// Pieces of a body

static Vec corner_at(const cpShape *shape, int number, Rotation by) {
    return rotated(corner_on_body(shape, number).point, by);
}

static Polygon polygon_of(const cpShape *shape, Rotation by, Arena *arena) {
    int count = corner_count(shape);
    Polygon polygon = polygon_with_room(count, arena);
    for (int number = 0; number < count; number++) {
        add_vertex(&polygon, corner_at(shape, number, by), true);
    }
    return polygon;
}

static Polygon hull_of(const Body *body, Rotation by, Arena *arena) {
    Polygon polygon = polygon_with_room(body->hull_count, arena);
    for (int number = 0; number < body->hull_count; number++) {
        add_vertex(&polygon, rotated(body->hull[number], by), true);
    }
    return polygon;
}

// The bar between the ends of a segment; only its long sides are of the outline.
static Polygon bar_of(Vec a, Vec b, double radius, Arena *arena) {
    Vec along = sub(b, a), side = scaled(perpendicular(along), radius / length(along));
    Polygon bar = polygon_with_room(4, arena);
    add_vertex(&bar, sub(a, side), true);
    add_vertex(&bar, sub(b, side), false);
    add_vertex(&bar, add(b, side), true);
    add_vertex(&bar, add(a, side), false);
    return bar;
}

// Add a segment: a bar, and at each end half a disc.
static void add_segment(Immersion *wet, Vec a, Vec b, double radius, const Clip *clip, Arena *arena) {
    Polygon bar = in_basin(bar_of(a, b, radius, arena), clip, arena);
    add_bulk(wet, bar);
    add_sides(wet, bar);
    Vec ends[2] = {b, a};
    for (int end = 0; end < 2; end++) {
        Vec away = sub(ends[end], ends[1 - end]);
        if (clip == NULL) {
            double from = atan2(away.y, away.x) - pi / 2.0;
            add_bow(wet, (Bow){ends[end], radius, from, from + pi});
        } else {
            Polygon beyond = clipped(basin_edges(clip, arena), (Line){ends[end], negated(away)}, arena);
            add_disc(wet, ends[end], radius, &beyond);
        }
    }
}

static void add_piece(Immersion *wet, const cpShape *shape, Rotation by, const Clip *clip, Arena *arena) {
    double radius = radius_of(shape);
    switch (kind_of(shape)) {
    case SHAPE_CIRCLE:
        if (clip == NULL) {
            add_bow(wet, (Bow){corner_at(shape, 0, by), radius, 0.0, 2.0 * pi});
        } else {
            add_disc_in_basin(wet, corner_at(shape, 0, by), radius, clip, arena);
        }
        break;
    case SHAPE_SEGMENT:
        add_segment(wet, corner_at(shape, 0, by), corner_at(shape, 1, by), radius, clip, arena);
        break;
    default: {
        Polygon polygon = in_basin(polygon_of(shape, by, arena), clip, arena);
        add_bulk(wet, polygon);
        add_sides(wet, polygon);
    }
    }
}

static Clip clip_of(const Basin *basin, Vec origin, double reach, Arena *arena) {
    Clip clip = {basin, origin, TAKE(arena, Line, basin->count), 0};
    for (int number = 0; number < basin->count; number++) {
        Line line = {sub(basin->corners[number], origin), basin->normals[number]};
        if (dot(line.normal, line.corner) < reach) {
            clip.lines[clip.line_count++] = line;
        }
    }
    return clip;
}

Immersion immersed(const Body *body, Pose pose, const Basin *basin, bool outlined, Arena *arena) {
    Immersion wet = {0};
    if (basin == NULL && !outlined) {
        wet.area = body->area;
        return wet;
    }
    Rotation by = rotation(pose.yaw);
    Clip clip = basin == NULL ? (Clip){0} : clip_of(basin, pose.p, body->reach, arena);
    const Clip *edges = basin == NULL ? NULL : &clip;
    for (const cpShape *shape = body->engine->shapeList; shape != NULL; shape = shape->next) {
        // A polygon has a side an edge. Each edge of a basin makes two arcs at most; for each end of a segment the
        // basin is clipped, to twice its edges at most.
        int edge_count = basin == NULL ? 0 : basin->count;
        size_t mark = arena_mark(arena);
        take_room(&wet, corner_count(shape), kind_of(shape) == SHAPE_POLYGON ? 0 : 8 * edge_count + 2, arena);
        if (basin != NULL || body->hull_count == 0) {
            add_piece(&wet, shape, by, edges, arena);
        }
        if (body->hull_count > 0) {
            // Of its pieces only areas and moments count; the outline is that of the hull.
            wet.side_count = wet.bow_count = 0;
            arena_release(arena, mark);
        }
    }
    if (basin == NULL) {
        wet.area = body->area;
        wet.first_moment = (Vec){0};
    }
    if (body->hull_count > 0 && outlined) {
        take_room(&wet, body->hull_count, 0, arena);
        add_sides(&wet, in_basin(hull_of(body, by, arena), edges, arena));
    }
    return wet;
}
