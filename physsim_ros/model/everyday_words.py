# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Everyday words for properties of bodies and joints, with the property that each means."""

from __future__ import annotations

from collections.abc import Collection

# The words for each property. Bodies and joints share words, as speed: of a body it is its
# velocity, of a motor its rate.
_WORDS: dict[str, tuple[str, ...]] = {
    'mass': ('weight', 'heavy', 'kg'),
    'density': ('specific_weight', 'rho'),
    'friction': ('rough', 'roughness', 'grip', 'slippery', 'slip', 'mu'),
    'elasticity': ('bouncy', 'bounce', 'bounciness', 'restitution', 'rebound'),
    'velocity': ('speed', 'v', 'linear_velocity', 'twist'),
    'spin': ('angular_velocity', 'omega', 'rotation', 'turn'),
    'anchored': ('fixed', 'static', 'immovable', 'frozen', 'locked', 'pinned'),
    'kinematic': ('scripted', 'animated', 'platform'),
    'group': ('layer', 'category', 'filter', 'mask'),
    'sensor': ('trigger', 'ghost', 'detector', 'is_trigger'),
    'surface_velocity': ('conveyor', 'belt', 'belt_speed'),
    'robot': ('vehicle', 'drive'),
    'lower': ('min', 'minimum', 'from'),
    'upper': ('max', 'maximum', 'to'),
    'rate': ('speed', 'angular_velocity', 'omega', 'rpm', 'motor_speed', 'target'),
    'max_torque': ('torque', 'strength', 'power'),
    'stiffness': ('k', 'spring_constant', 'hardness', 'stiff'),
    'damping': ('damper', 'viscosity', 'c'),
    'rest_length': ('natural_length', 'free_length', 'rest'),
    'length': ('distance', 'long'),
    'ratio': ('transmission', 'teeth'),
    'phase': ('angle', 'offset'),
    'max_force': ('force',),
    'break_force': ('breaks', 'breakable', 'breaking_force', 'fragile'),
    'collide': ('collision', 'collisions', 'collide_connected'),
}


def property_meant(word: str, known: Collection[str]) -> str:
    """
    Return the property that people mean by a word, or ''.

    :param known: the properties that there are
    """
    word = word.lower().replace(' ', '_').replace('-', '_')
    return next((name for name, words in _WORDS.items() if word in words and name in known), '')
