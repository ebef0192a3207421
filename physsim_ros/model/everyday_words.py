# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Everyday words for kinds of joints, and for keys of bodies and joints."""

from __future__ import annotations

from collections.abc import Collection, Mapping

# The words for each property. Bodies and joints share words, as speed: of a body it is its
# velocity, of a motor its rate.
_WORDS: dict[str, tuple[str, ...]] = {
    'mass': ('weight', 'heavy', 'kg'),
    'density': ('specific_weight', 'rho'),
    'friction': ('rough', 'roughness', 'grip', 'slippery', 'slip', 'mu'),
    'elasticity': ('bouncy', 'bounce', 'bounciness', 'restitution', 'rebound'),
    'velocity': ('speed', 'v', 'vel', 'linear_velocity', 'twist'),
    'spin': ('angular_velocity', 'omega', 'rotation', 'turn'),
    'anchored': ('fixed', 'static', 'immovable', 'frozen', 'locked', 'pinned'),
    'kinematic': ('scripted', 'animated', 'platform'),
    'group': ('layer', 'category', 'filter', 'mask'),
    'sensor': ('trigger', 'ghost', 'detector', 'is_trigger'),
    'surface_velocity': ('conveyor', 'belt', 'belt_speed'),
    'robot': ('vehicle', 'drive'),
    'actor': ('path', 'trajectory', 'waypoints', 'tween', 'walk', 'pedestrian', 'behavior'),
    'at': ('position', 'pose', 'x', 'y', 'yaw', 'angle', 'orientation'),
    'color': ('colour', 'rgb', 'rgba'),
    'circle': ('disc', 'disk', 'sphere', 'radius', 'diameter'),
    'box': ('rectangle', 'cube', 'size', 'width', 'height'),
    'label': ('text', 'caption', 'note', 'title'),
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

# The words for each kind of joint; those of Box2D, Pymunk and URDF among them.
_KINDS: dict[str, tuple[str, ...]] = {
    'pin': ('weld', 'fixed', 'glue', 'nail'),
    'axle': ('hinge', 'revolute', 'continuous', 'pivot', 'bolt'),
    'motor': ('engine', 'actuator'),
    'spring': ('elastic', 'damped_spring', 'shock'),
    'rod': ('distance', 'bar', 'link', 'stick'),
    'rope': ('string', 'cord', 'cable', 'chain', 'slide'),
    'slider': ('prismatic', 'groove', 'rail', 'piston'),
    'gear': ('cog', 'gears'),
}


def property_meant(word: str, known: Collection[str]) -> str:
    """
    Return the property that people mean by a word, or ''.

    :param known: the properties that there are
    """
    return _meant(word, {name: _WORDS[name] for name in _WORDS if name in known})


def kind_meant(word: str) -> str:
    """Return the kind of joint that people mean by a word, or ''."""
    return _meant(word, _KINDS)


def _meant(word: str, table: Mapping[str, Collection[str]]) -> str:
    word = word.lower().replace(' ', '_').replace('-', '_')
    return next((name for name, words in table.items() if word in words), '')
