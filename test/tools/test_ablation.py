# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""All stages together keep each scene within its tolerance, and each stage can be switched off."""

import pytest
from tools.ablation.scenes import error_of, fails, SCENES
from tools.ablation.stages import STAGES, switched_off

# Scenes that take less than half a second; `make ablate` plays all.
SLOW = {'fast bar (35)', 'pendulum (15)', 'chain of 50 (20)', 'gear train', 'bridge', 'at rest'}
FAST = [scene for scene in SCENES if scene.name not in SLOW]


@pytest.mark.parametrize('scene', FAST, ids=lambda scene: scene.name)
def test_a_scene_is_within_its_tolerance(scene):
    error = error_of(scene)
    assert not fails(scene, error), f'{error:.3g} {scene.unit}'


@pytest.mark.parametrize('stage', STAGES, ids=lambda stage: stage.name)
def test_every_stage_can_be_switched_off(stage):
    with switched_off(stage):
        pass


@pytest.mark.parametrize(
    ('name', 'without'),
    [
        ('free flight (1)', 'half-step velocity'),
        ('removed floor', 'support graph'),
        ('stack of ten (18)', 'resting damping'),
        ('slide on a floor (37)', 'floor'),
        ('robot on an arc (38)', 'floor'),
        ('thin wall (25)', 'continuous collision'),
        ('disc on a corner (6)', 'contact at impact'),
        ('between walls (46)', 'rest of the step'),
        ('seams of tiles', 'internal edges'),
        ('flat fall (8)', 'block solver'),
        ('elastic rows, 2 of 5 (36)', 'impact propagation'),
        ('checkpoint (26)', 'warm start'),
        ('raft (70)', 'fields'),
        ('box that tips (78)', 'steep friction'),
    ],
)
def test_a_scene_fails_without_a_stage(name, without):
    (scene,) = (each for each in SCENES if each.name == name)
    (stage,) = (each for each in STAGES if each.name == without)
    with switched_off(stage):
        error = error_of(scene)
    assert fails(scene, error), f'{error:.3g} {scene.unit}'
