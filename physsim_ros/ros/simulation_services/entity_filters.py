# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Filters of entities: by name, category, tags and place, as `simulation_interfaces` has them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import extent_of
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world, Pose
from physsim_ros.ros.simulation_services.results import failed
from simulation_interfaces.msg import Bounds, EntityCategory, EntityFilters, Result, TagsFilter


def category_of(body: Body) -> int:
    """Return the category of a body, by the standard."""
    if body.robot is not None:
        return int(EntityCategory.CATEGORY_ROBOT)
    if body.anchored:
        return int(EntityCategory.CATEGORY_STATIC_OBJECT)
    if body.kinematic:
        return int(EntityCategory.CATEGORY_DYNAMIC_OBJECT)
    return int(EntityCategory.CATEGORY_OBJECT)


def tags_of(body: Body) -> Iterator[str]:
    """Yield the words that say what a body is."""
    yield body.shape.KEY
    yield from (name for name in ('anchored', 'kinematic', 'sensor') if getattr(body, name))
    if body.robot is not None:
        yield 'robot'


def passes_tags(tags: set[str], tags_filter: TagsFilter) -> bool:
    """Return whether tags pass a filter."""
    wanted = set(tags_filter.tags)
    if tags_filter.filter_mode == TagsFilter.FILTER_MODE_ALL:
        return wanted <= tags
    return not wanted or bool(wanted & tags)


def passing(snapshot: Snapshot, filters: EntityFilters) -> Iterator[int]:
    """Return the rows of the bodies that pass all filters, in spawn order."""
    bodies = snapshot.scene.bodies
    named = _matching(snapshot.scene.names, filters.filter)
    categories = {each.category for each in filters.categories}
    overlaps = _overlap(filters.bounds)
    return (
        row
        for row, body in enumerate(bodies)
        if named[row]
        and (not categories or category_of(body) in categories)
        and passes_tags(set(tags_of(body)), filters.tags)
        and overlaps(body, snapshot.poses[row].tolist())
    )


def _matching(names: tuple[str, ...], pattern: str) -> list[bool]:
    """
    Return which names have a match of a regular expression.

    Those of Python take exponential time for some patterns, of whoever is on the graph. RE2, which
    comes with Rerun in pyarrow, takes linear time for all.
    """
    if not pattern or not names:
        return [True] * len(names)
    import pyarrow as pa  # noqa: PLC0415 - few need it
    import pyarrow.compute as pc  # noqa: PLC0415

    try:
        matches: list[bool] = pc.match_substring_regex(pa.array(names), pattern).to_pylist()
    except (pa.ArrowInvalid, UnicodeError) as error:
        raise failed(
            f'{pattern!r} is no regular expression', Result.RESULT_OPERATION_FAILED, field='filter'
        ) from error
    return matches


def _overlap(bounds: Bounds) -> Callable[[Body, Pose], bool]:
    """Return whether the box around a body, of the world's axes, overlaps bounds."""
    if bounds.type == Bounds.TYPE_EMPTY:
        return lambda _body, _pose: True
    points = [(each.x, each.y) for each in bounds.points]
    if bounds.type not in (Bounds.TYPE_BOX, Bounds.TYPE_SPHERE):
        raise failed(
            'bounds are empty, a box or a sphere',
            Result.RESULT_FEATURE_UNSUPPORTED,
            field='bounds.type',
        )
    if len(points) != 2 or not np.isfinite(points).all():
        raise failed(
            'bounds need two finite points', Result.RESULT_OPERATION_FAILED, field='bounds.points'
        )
    (first, second) = points
    if bounds.type == Bounds.TYPE_SPHERE:
        low = high = first
        reach = second[0]
    else:
        low, high = np.minimum(first, second).tolist(), np.maximum(first, second).tolist()
        reach = 0.0

    def overlaps(body: Body, pose: Pose) -> bool:
        (left, bottom), (right, top) = _world_box(body, pose)
        across = max(left - high[0], low[0] - right, 0.0)
        along = max(bottom - high[1], low[1] - top, 0.0)
        return bool(np.hypot(across, along) <= reach)

    return overlaps


def _world_box(body: Body, pose: Pose) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the lower left and the upper right corner of the box around a body's box."""
    low, high = extent_of(body.shape.form)
    corners = [local_to_world((x, y), pose) for x in (low[0], high[0]) for y in (low[1], high[1])]
    xs, ys = zip(*corners, strict=True)
    return (min(xs), min(ys)), (max(xs), max(ys))
