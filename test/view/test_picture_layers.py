# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Over and under the bodies: walls, grid, contacts, what is being drawn; and the camera."""

from __future__ import annotations

import itertools
import math

import numpy as np
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.view.legend import CUT
from physsim_ros.view.preview import LINGER
import pytest

from .picture_file import body, contacts, frame, scene, TOLERANCE


def test_the_walls_lie_just_outside_the_bounds(recording):
    recording.draw(frame(scene(bounds=(-10.0, 0.0, 10.0, 12.0)), []))

    corners = recording.last('world/walls', 'Mesh3D:vertex_positions')[:, :2].reshape(-1, 6, 2)
    low, high = corners.min(axis=1), corners.max(axis=1)
    floor, ceiling, left, right = np.hstack((low, high))
    assert floor[3] == pytest.approx(0.0, abs=1e-6)
    assert ceiling[1] == pytest.approx(12.0)
    assert left[2] == pytest.approx(-10.0)
    assert right[0] == pytest.approx(10.0)


@pytest.mark.parametrize('unit', [1.0, 10.0])
def test_the_grid_has_a_line_at_every_whole_unit_and_says_which(recording, unit):
    left, right, top = -10.0 * unit, 10.0 * unit, 12.0 * unit
    recording.draw(frame(scene(bounds=(left, 0.0, right, top)), []))

    lines = np.array(recording.last('world/grid', 'LineStrips3D:strips').tolist())
    begins, ends = np.moveaxis(lines, 1, 0)[..., :2]
    assert (np.count_nonzero(begins == ends, axis=1) == 1).all()
    for axis in (0, 1):
        along = np.sort(begins[begins[:, axis] == ends[:, axis], axis])
        assert np.diff(along) == pytest.approx(unit)
        assert abs(along).min() < TOLERANCE
    places = recording.last('world/grid/metres', 'Points3D:positions')
    labels = recording.last('world/grid/metres', 'Points3D:labels')
    for (x, y, _), label in zip(places, labels, strict=True):
        # Labels hang below their points: those at the left are raised by half their height.
        assert label in {f'{x:g} m', f'{math.floor(y / unit) * unit:g} m'}
        assert x < left or y < 0.0, 'a label covers the world'
    across = {
        float(label[:-2]) for (_, y, _), label in zip(places, labels, strict=True) if y < 0.0
    }
    up = {float(label[:-2]) for (x, _, _), label in zip(places, labels, strict=True) if x < left}
    assert across == {left, left / 2.0, 0.0, right / 2.0, right}
    assert up == {0.0, 5.0 * unit, 10.0 * unit}


def draw_contacts(recording, batches):
    """Draw frames with contacts of a box, batch by batch."""
    box, steps = scene(body()), itertools.count(step=4)
    for batch in batches:
        recording.draw(
            *(
                frame(box, [(step, 0, 0)], step=step, contacts=each)
                for each, step in zip(batch, steps, strict=False)
            )
        )


def test_applied_forces_are_arrows_at_their_points_that_turn_with_thrusters(recording):
    wind = AppliedForce(force=(0.0, -4.0))
    thruster = AppliedForce(force=(2.0, 0.0), at=(1.0, 0.0), axes='body')
    pushed = scene(body(forces=(wind, thruster)))

    recording.draw(frame(pushed, [(5.0, 0.0, math.pi / 2)]))
    recording.draw(frame(scene(body()), [(5.0, 0.0, 0.0)], step=4))

    origins = recording.rows('world/forces', 'Arrows3D:origins')
    vectors = recording.rows('world/forces', 'Arrows3D:vectors')
    assert [len(row.value) for row in origins] == [2, 0]
    assert origins[0].value[:, :2] == pytest.approx(np.array(((5.0, 0.0), (5.0, 1.0))), abs=1e-6)
    down, up = vectors[0].value[:, :2]
    assert down == pytest.approx((0.0, -2 * up[1]), abs=1e-6)
    assert up[0] == pytest.approx(0.0, abs=1e-6)


def test_contacts_are_arrows_by_force_on_the_movable_body_as_long_as_they_last(recording):
    weight = 2.0 * 9.81
    press, heavy = contacts((0.0, -weight / 60)), contacts((0.0, -2 * weight / 60))

    # Two in one batch, so that they have one scale.
    draw_contacts(recording, [[contacts()], [press, heavy], [contacts()], [contacts()]])

    origins = recording.rows('world/contacts', 'Arrows3D:origins')
    vectors = recording.rows('world/contacts', 'Arrows3D:vectors')
    assert [(row.frame, len(row.value)) for row in origins] == [(1, 1), (2, 1), (3, 0)]
    assert origins[0].value[0, :2] == pytest.approx((1.0, 2.0))
    first, second = vectors[0].value[0], vectors[1].value[0]
    assert first[0] == 0
    assert first[1] > 0
    assert second == pytest.approx(2 * first, rel=1e-4)


def test_arrows_fit_the_greatest_force_of_most_frames_and_the_legend_tells_it(recording):
    forces = {40: 50, 30: 50, 90: 100, 10: 10, 8: 10}
    # The last of a batch is an impact: its arrow is cut.
    batches = [[*[force] * 31, 100 * force] for force in forces]
    draw_contacts(recording, [[contacts((0.0, -each / 60)) for each in row] for row in batches])

    rows = recording.rows('world/contacts', 'Arrows3D:vectors')
    lengths = [np.hypot(*row.value[0, :2]) for row in rows]
    unit = lengths[31] / CUT
    assert lengths[31::32] == pytest.approx([CUT * unit] * 5, rel=1e-4)
    shares = [length / unit for length in lengths[30::32]]
    assert shares == pytest.approx([force / full for force, full in forces.items()], rel=1e-4)
    labels = recording.rows('world/camera/legend/labels', 'Points2D:labels')
    assert [row.value[0] for row in labels] == [
        f'contact force: this length = {full} N (max {CUT * full:g} N)' for full in (50, 100, 10)
    ]


def test_contacts_in_next_to_no_gravity_are_arrows_too(recording):
    recording.draw(
        frame(scene(body(), gravity=(0.0, 5e-324)), [(0, 0, 0)], contacts=contacts((0.0, -0.1)))
    )

    (vector,) = recording.rows('world/contacts', 'Arrows3D:vectors')[0].value
    assert vector[1] > 0
    assert np.isfinite(vector).all()


def test_thousands_of_contacts_are_sent_less_often(recording):
    draw_contacts(recording, [[contacts(*[(0.0, -1.0)] * 1500)] * 60])

    rows = recording.rows('world/contacts', 'Arrows3D:origins')
    assert 1 < len(rows) <= 8
    assert rows[-1].frame == 59


def test_what_is_half_drawn_lies_over_the_world_until_it_is_dropped(recording):
    box, half = scene(body()), Preview(lines=(((0, 0), (3, 4)),), points=((3, 4),), label='wall')
    # Nothing moves: a preview alone is something new to see.
    for preview in (NO_PREVIEW, half, half, NO_PREVIEW):
        recording.draw(frame(box, [(0, 0, 0)], stepped=False, preview=preview))

    (shown, cleared) = recording.rows('world/preview/lines', 'LineStrips3D:strips')
    assert (shown.frame, cleared.frame) == (1, 2)
    ((start, end),) = shown.value
    assert [*start[:2], *end[:2]] == [0, 0, 3, 4]
    assert len(cleared.value) == 0
    labels = recording.rows('world/preview/label', 'Points3D:labels')
    assert [[*row.value] for row in labels] == [['wall'], []]


def test_the_reading_of_a_stroke_is_seen_for_a_while(recording):
    box, read = scene(body()), Preview(lines=(((0, 0), (3, 4)),), label='wall 90%')
    for step in range(round(60 * LINGER) + 2):
        recording.draw(frame(box, [(step, 0, 0)], step=4 * step, preview=read))

    rows = recording.rows('world/preview/lines', 'LineStrips3D:strips')
    assert [(row.frame, len(row.value)) for row in rows] == [(0, 1), (60 * LINGER, 0)]


def eyes(recording):
    return [row.value[0] for row in recording.rows('world/camera', 'Transform3D:translation')]


def test_the_camera_stands_still_while_bodies_move(recording):
    one, two = scene(body()), scene(body(), body('box/1'))

    recording.draw(*(frame(one, [(step, 0, 0)], step=step) for step in range(20)))
    recording.draw(frame(two, [(0.5, 0, 0), (0, 0.5, 0)], step=20))

    first, second = eyes(recording)
    assert first == pytest.approx(second)


def test_the_camera_looks_at_the_bounds_and_follows_them(recording):
    recording.draw(frame(scene(bounds=(0.0, 0.0, 10.0, 2.0)), []))
    recording.draw(frame(scene(bounds=(100.0, 0.0, 300.0, 40.0)), [], step=4))

    first, second = eyes(recording)
    assert first[:2] == pytest.approx((5.0, 1.0))
    assert second[:2] == pytest.approx((200.0, 20.0))
    assert second[2] == pytest.approx(20 * first[2], rel=1e-5)


def test_the_camera_steps_back_for_bodies_that_are_far_outside(recording):
    near, far = scene(body()), scene(body(), body('box/1'))

    recording.draw(frame(near, [(0, 0, 0)]))
    recording.draw(frame(far, [(0, 0, 0), (100, 0, 0)], step=4))

    _, eye = eyes(recording)
    assert eye[:2] == pytest.approx((50.0, 0.0))


def test_an_empty_world_can_be_drawn(recording):
    recording.draw(frame(scene(), []), frame(scene(), [], step=4))

    assert len(eyes(recording)) == 2
