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


def test_counts_are_those_of_the_scene_and_of_its_contacts(recording):
    recording.draw(frame(scene(body(), body('box/1')), [(0.0, 0.0, 0.0)] * 2))

    assert [*recording.last('plots/counts', 'Scalars:scalars')] == [2.0, 0.0, 0.0]
