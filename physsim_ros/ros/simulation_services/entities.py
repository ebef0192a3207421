# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Entities: the bodies of the world, by the services of `simulation_interfaces`, and filters of them.

An entity's name is that of its body. Its twist is that of its centre of mass, in the world's axes,
as on `~/states`; accelerations are neither reported nor accepted. Its description is its label;
its category and tags follow from what it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import check_pose
from physsim_ros.model.requests import ChangeBody, Command, Delete
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import extent_of
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world, Pose, REST
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.planar import named_frame, planar_pose, pose_message
from physsim_ros.ros.simulation_services.results import box_around, coded, coding_refusals
from simulation_interfaces.msg import (
    Bounds,
    EntityCategory,
    EntityFilters,
    EntityInfo,
    EntityState,
    Result,
    TagsFilter,
)
from simulation_interfaces.srv import SetEntityState


class Entities:
    """
    The services for entities; each returns a message about what was done, '' for nothing.

    :param control: of the node
    """

    def __init__(self, control: NodeControl) -> None:
        self._control = control
        self._frame_id = str(control.values['frame_id'])

    def delete(self, request: Any, _: Any) -> str:
        """Delete a body."""
        return self._control.simulation.perform(Delete(name=request.entity))

    def state(self, request: Any, response: Any) -> str:
        """Tell pose and twist of a body."""
        snapshot = self._control.loop.bring_up_to_date()
        response.state = self._state_of(snapshot, snapshot.row(request.entity))
        return ''

    def set_state(self, request: Any, _: Any) -> str:
        """Set pose and twist of a body, both in the frame of the world."""
        state, name = request.state, request.entity
        snapshot = self._control.loop.bring_up_to_date()
        body = snapshot.scene.bodies[snapshot.row(name)]
        if named_frame(state.header.frame_id, self._frame_id):
            raise coded(
                f'a state is set in the frame {self._control.values["frame_id"]!r} only',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='state.header.frame_id',
            )
        linear, angular = state.twist.linear, state.twist.angular
        twist = linear.x, linear.y, angular.z
        # An anchored body takes a pose, and rest.
        rests = body.anchored and twist == REST
        with coding_refusals(SetEntityState.Response.INVALID_POSE):
            pose = check_pose(planar_pose(state.pose, 'state.pose'), 'state.pose')
        command = Command(
            names=(name,),
            poses=np.array([pose]),
            twists=np.empty((0, 3)) if rests else np.array([twist]),
        )
        return self._control.simulation.perform(command)

    def names(self, request: Any, response: Any) -> str:
        """Tell the names of all bodies that pass filters."""
        snapshot = self._control.loop.bring_up_to_date()
        rows = passing(snapshot, request.filters)
        response.entities = [snapshot.scene.names[row] for row in rows]
        return ''

    def states(self, request: Any, response: Any) -> str:
        """Tell names, poses and twists of all bodies that pass filters."""
        snapshot = self._control.loop.bring_up_to_date()
        rows = list(passing(snapshot, request.filters))
        response.entities = [snapshot.scene.names[row] for row in rows]
        response.states = [self._state_of(snapshot, row) for row in rows]
        return ''

    def info(self, request: Any, response: Any) -> str:
        """Tell what a body is."""
        snapshot = self._control.loop.bring_up_to_date()
        body = snapshot.scene.bodies[snapshot.row(request.entity)]
        response.info = EntityInfo(
            category=EntityCategory(category=category_of(body)),
            description=_description_of(body),
            tags=list(tags_of(body)),
        )
        return ''

    def set_info(self, request: Any, _: Any) -> str:
        """Set the label of a body to a description."""
        snapshot, info = self._control.loop.bring_up_to_date(), request.info
        body = snapshot.scene.bodies[snapshot.row(request.entity)]
        # The first category is also that of a message in which none was set.
        categories = EntityCategory.CATEGORY_OBJECT, category_of(body)
        if info.category.category not in categories:
            raise coded(
                f'category {category_of(body)} follows from what the body is',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='info.category',
            )
        tags = set(tags_of(body))
        if info.tags and set(info.tags) != tags:
            raise coded(
                f'the tags {", ".join(sorted(tags))} follow from what the body is',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='info.tags',
            )
        if info.description == _description_of(body):
            return ''
        properties = Properties(label=info.description)
        change = ChangeBody(name=body.name, properties=properties)
        return self._control.simulation.perform(change)

    def bounds(self, request: Any, response: Any) -> str:
        """Tell the box around a body, in the body's frame."""
        snapshot = self._control.loop.bring_up_to_date()
        response.bounds = box_around(snapshot.scene.bodies[snapshot.row(request.entity)].shape)
        return ''

    def _state_of(self, snapshot: Snapshot, row: int) -> EntityState:
        state = EntityState()
        state.header.frame_id = self._frame_id
        state.header.stamp.sec, state.header.stamp.nanosec = divmod(snapshot.stamp, 10**9)
        state.pose = pose_message(snapshot.poses[row].tolist())
        vx, vy, spin = snapshot.twists[row].tolist()
        state.twist.linear.x, state.twist.linear.y, state.twist.angular.z = vx, vy, spin
        return state


def _description_of(body: Body) -> str:
    """Return the label of a body; of one without a label, its shape and mass."""
    return body.label or f'{body.shape.KEY}, {body.total_mass:.4g} kg'


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
    try:
        import pyarrow as pa  # noqa: PLC0415 - few need it
        import pyarrow.compute as pc  # noqa: PLC0415
    except ModuleNotFoundError as error:
        raise coded(
            'a filter needs pyarrow: install physsim_ros with its extra [viewer]',
            Result.RESULT_FEATURE_UNSUPPORTED,
            field='filter',
        ) from error
    try:
        matches: list[bool] = pc.match_substring_regex(pa.array(names), pattern).to_pylist()
    except (pa.ArrowInvalid, UnicodeError) as error:
        raise coded(
            f'{pattern!r} is no regular expression', Result.RESULT_OPERATION_FAILED, field='filter'
        ) from error
    return matches


def _overlap(bounds: Bounds) -> Callable[[Body, Pose], bool]:
    """Return whether the box around a body, of the world's axes, overlaps bounds."""
    if bounds.type == Bounds.TYPE_EMPTY:
        return lambda _body, _pose: True
    points = [(each.x, each.y) for each in bounds.points]
    if bounds.type not in (Bounds.TYPE_BOX, Bounds.TYPE_SPHERE):
        raise coded(
            'bounds are empty, a box or a sphere',
            Result.RESULT_FEATURE_UNSUPPORTED,
            field='bounds.type',
        )
    if len(points) != 2 or not np.isfinite(points).all():
        raise coded(
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
