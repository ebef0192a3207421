# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Plots beside the picture: energies, momenta, counts, pace, and traced bodies."""

from __future__ import annotations

import pytest

from .picture_file import body, frame, scene


def test_energies_and_momenta_are_plotted(recording):
    now = frame(scene(body()), [(2, 3, 0)])

    recording.draw(now)

    kinetic, potential = now.snapshot.kinetic_energy, now.snapshot.potential_energy
    energies = recording.last('plots/energy', 'Scalars:scalars')
    assert energies == pytest.approx([kinetic, potential, 0.0, kinetic + potential])
    # 2 kg at 1 m/s along x and y, at (2, 3), and a moment of 5/6 kg m² at 1 rad/s.
    assert recording.last('plots/momentum', 'Scalars:scalars') == pytest.approx([2.0, 2.0])
    about = recording.last('plots/angular_momentum', 'Scalars:scalars')
    assert about == pytest.approx(2 * (2 - 3) + 5 / 6)


@pytest.mark.parametrize(('speed', 'factor', 'shown'), [(4.0, 2.0, 0.5), (-1.0, -1.0, 1.0)])
def test_the_real_time_factor_is_by_the_speed_that_was_asked(recording, speed, factor, shown):
    recording.draw(frame(scene(body()), [(0, 3, 0)], speed=speed), real_time_factor=factor)

    assert recording.last('plots/pace', 'Scalars:scalars') == pytest.approx(shown)


def test_a_world_that_nothing_paces_has_no_real_time_factor(recording):
    recording.draw(frame(scene(body()), [(0, 3, 0)]), real_time_factor=0.0)

    assert recording.rows('plots/pace', 'Scalars:scalars') == []


def test_counts_are_sent_when_they_change_and_each_second(recording):
    few, more = scene(body()), scene(body(), body('box/1'))
    steps = range(0, 600, 4)
    recording.draw(*(frame(few, [(0.0, 0.0, 0.0)], step=step) for step in steps[:100]))
    recording.draw(*(frame(more, [(0.0, 0.0, 0.0)] * 2, step=step) for step in steps[100:]))
    rows = recording.rows('plots/counts', 'Scalars:scalars')
    assert [row.value[0] for row in rows] == [1.0, 1.0, 2.0]
    # A plot shows what lies in its last 15 s; values are sampled every tenth of a second.
    assert [row.frame for row in rows[:2]] == [0, 60]
    assert 100 <= rows[2].frame <= 106
