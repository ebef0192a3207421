# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Poses, twists and wrenches; plane vectors: rotation counter-clockwise, products, distances."""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.arrays import Floats

# x, y [m].
Point = tuple[float, float]
# x, y [m], yaw [rad] of a body's origin.
Pose = tuple[float, float, float]
# vx, vy [m/s] of the centre of mass, spin [rad/s]; world axes.
Twist = tuple[float, float, float]
# fx, fy [N] at the centre of mass, torque [N m]; world axes.
Wrench = tuple[float, float, float]

ORIGIN: Pose = (0.0, 0.0, 0.0)
REST: Twist = (0.0, 0.0, 0.0)
NO_WRENCH: Wrench = (0.0, 0.0, 0.0)


def rotated(vector: Point, yaw: float) -> Point:
    """Return a vector rotated counter-clockwise by yaw [rad]."""
    if vector == (0.0, 0.0):
        return vector
    cos, sin = math.cos(yaw), math.sin(yaw)
    return cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]


def local_to_world(point: Point, pose: Pose) -> Point:
    """Return a point of the frame of a pose as a point of the world [m]."""
    x, y = rotated(point, pose[2])
    return pose[0] + x, pose[1] + y


def world_to_local(point: Point, pose: Pose) -> Point:
    """Return a point of the world as a point of the frame of a pose [m]."""
    return rotated((point[0] - pose[0], point[1] - pose[1]), -pose[2])


def composed(pose: Pose, inner: Pose) -> Pose:
    """Return a pose in the frame of another one as a pose of the world."""
    return *local_to_world(inner[:2], pose), pose[2] + inner[2]


def seen_from(pose: Pose, other: Pose) -> Pose:
    """Return another pose of the world as a pose in the frame of a pose."""
    return *world_to_local(other[:2], pose), other[2] - pose[2]


def rotated_each(vectors: Floats, yaw: Floats | float) -> Floats:
    """
    Return vectors, each rotated counter-clockwise by its own yaw.

    :param vectors: (..., 2) float64
    :param yaw: (...) float64, or of a shape that broadcasts to it [rad]
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y = vectors[..., 0], vectors[..., 1]
    across = cos * x - sin * y
    result = np.empty((*across.shape, 2))
    result[..., 0] = across
    result[..., 1] = sin * x + cos * y
    return result


def cross(a: Floats, b: Floats) -> Floats:
    """Return (...) float64: the z component of the cross product of plane vectors (..., 2)."""
    product: Floats = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def dots(a: Floats, b: Floats) -> Floats:
    """
    Return (...) float64: the dot products of plane vectors (..., 2).

    `@` and `einsum` sum in another order where a processor has other vectors.
    """
    product: Floats = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def dot(a: complex, b: complex) -> float:
    """
    Return the dot product of two plane vectors as complex numbers, x + y i.

    They are built into Python: for a few vectors ten times as fast as Pymunk's `Vec2d` or arrays.
    """
    return a.real * b.real + a.imag * b.imag


def norms(vectors: Floats) -> Floats:
    """Return (...) float64: the lengths of plane vectors (..., 2)."""
    length: Floats = np.hypot(vectors[..., 0], vectors[..., 1])
    return length


def next_vertices(vertices: Floats) -> Floats:
    """
    Return the vertex after each of a polygon, (n, 2) float64; the first follows the last.

    `np.roll` takes 20 times as long for a few.
    """
    return np.concatenate((vertices[1:], vertices[:1]))


def segment_distances(points: Floats, start: Floats, end: Floats) -> Floats:
    """
    Return the distances of points from segments [m].

    :param points: (n, 2) float64 [m]
    :param start: (2,) float64 of one segment, (n, 2) of one for each point, or (k, 1, 2) [m]
    :param end: the same
    :return: (n,) float64, or (k, n)
    """
    along, away = end - start, points - start
    share = np.clip(dots(away, along) / np.maximum(dots(along, along), 1e-300), 0.0, 1.0)
    result: Floats = norms(away - share[..., None] * along)
    return result
