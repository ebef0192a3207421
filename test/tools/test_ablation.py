# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tests of laws and of the engine fail without a stage."""

from functools import partial

import pytest
from tools.ablation.stages import STAGES, switched_off

from ..engine import test_support, test_warm_start
from ..engine.ccd import test_continuous
from ..engine.stages import (
    test_block_solver,
    test_false_contacts,
    test_internal_edges,
    test_sleeping,
)
from ..laws import (
    test_collisions,
    test_flight,
    test_floor,
    test_friction,
    test_impacts,
    test_machines,
    test_media,
    test_rows,
    test_stacks,
)
from ..laws.conftest import Report

REPORT = Report([])
# By the name of a stage, a case of a test that fails without it. Those of the others take seconds.
CASES = {
    'half-step velocity': partial(test_flight.test_gravity_may_point_anywhere, REPORT, (3, 4)),
    'support graph': (
        test_support.test_what_stood_on_a_box_that_is_deleted_falls_as_one_and_the_rest_stands
    ),
    'resting damping': partial(
        test_stacks.test_a_stack_sways_no_more_when_it_falls_asleep, REPORT, 0.3
    ),
    'floor': partial(test_floor.test_a_differential_drive_keeps_to_its_arc, REPORT, 0.2, 1.0),
    'continuous collision': partial(
        test_continuous.test_a_heavy_fast_body_does_not_push_a_light_one_through_a_wall, 1000.0
    ),
    'false contacts': test_false_contacts.test_squares_that_part_do_not_touch_again,
    'contact at impact': partial(
        test_collisions.test_a_disc_parts_from_a_corner_along_the_normal_of_their_impact,
        *(REPORT, 20, 8.0, True),
    ),
    'rest of the step': partial(
        test_impacts.test_a_ball_between_walls_goes_the_way_of_its_reported_velocity,
        *(REPORT, 0.4, 10.0),
    ),
    'internal edges': partial(
        test_internal_edges.test_a_body_slides_over_a_seam,
        *(test_internal_edges.BOX, 0.0, 3.0, 0.0, 0.0),
    ),
    'impact propagation': partial(
        test_rows.test_as_many_leave_a_row_as_came, REPORT, 2, 240.0, 0.0, 'boxes'
    ),
    'block solver': test_block_solver.test_a_box_on_a_pillar_of_boxes_bounces_straight,
    'joint solver': partial(test_machines.test_a_pendulum_keeps_its_energy, REPORT),
    'fields': partial(test_media.test_a_disc_floats_at_the_depth_of_archimedes, REPORT, 0.5),
    'steep friction': partial(
        test_friction.test_a_box_tips_about_its_corner_whatever_the_friction, REPORT, 3.0, 0.5
    ),
    'sleeping': test_sleeping.test_an_island_sleeps_without_velocity_while_another_one_moves,
    'warm start': test_warm_start.test_a_resting_stack_does_not_stir_where_it_is_renewed,
}


@pytest.mark.parametrize('name', CASES)
def test_a_test_fails_without_a_stage(name):
    (stage,) = (each for each in STAGES if each.name == name)
    with switched_off(stage), pytest.raises(AssertionError):
        CASES[name]()
