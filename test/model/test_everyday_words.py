# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Refusals that tell the property which an everyday word means."""

from physsim_ros.files import BODY_KEYS
from physsim_ros.model.actors import actor_from
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.declarations import check_key
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.joints import JOINT_KEYS, JointKind, JointProperties, kind_from
from physsim_ros.model.robots.drives import drive_from
from physsim_ros.model.robots.sensors import sensor_from
from physsim_ros.model.settings import WorldSettings
import pytest


@pytest.mark.parametrize(
    ('word', 'name'),
    [('bouncy', 'elasticity'), ('Bounciness', 'elasticity'), ('restitution', 'elasticity'),
     ('weight', 'mass'), ('speed', 'velocity'), ('angular velocity', 'spin'),
     ('fixed', 'anchored'), ('static', 'anchored'), ('rough', 'friction'),
     ('is-trigger', 'sensor'),
     ('layer', 'group'), ('caption', 'label'), ('thruster', 'forces')],
)  # fmt: skip
def test_an_everyday_word_for_a_property_of_a_body_is_told_its_name(word, name):
    with pytest.raises(UnknownProperty) as refused:
        Properties.from_mapping({word: 1})

    assert str(refused.value) == f"there is no property '{word}'; use '{name}'"
    assert refused.value.field == word


@pytest.mark.parametrize(
    ('word', 'name'),
    [('speed', 'rate'), ('rpm', 'rate'), ('k', 'stiffness'), ('min', 'lower'), ('max', 'upper'),
     ('torque', 'max_torque'), ('natural_length', 'rest_length'), ('breakable', 'break_force')],
)  # fmt: skip
def test_an_everyday_word_for_a_property_of_a_joint_is_told_its_name(word, name):
    with pytest.raises(UnknownProperty, match=f"; use '{name}'$"):
        JointProperties.from_mapping({word: 1})


@pytest.mark.parametrize(
    ('word', 'hint'),
    [('weld', "use 'pin'"), ('Hinge', "use 'axle'"), ('prismatic', "use 'slider'"),
     ('sprng', "nearest is 'spring'"), ('Motr', "nearest is 'motor'"), ('xyz', 'there are pin')],
)  # fmt: skip
def test_a_word_for_a_kind_of_joint_is_told_its_name(word, hint):
    with pytest.raises(BadProperty, match=f"^there is no kind of joint '{word}'; {hint}"):
        kind_from(word)


@pytest.mark.parametrize(
    ('check', 'word', 'hint'),
    [(sensor_from, 'lidar', "use 'laser'"), (sensor_from, 'Ultrasonic', "use 'range'"),
     (sensor_from, 'lasr', "nearest is 'laser'"), (drive_from, 'diff-drive', "use 'differential'"),
     (drive_from, 'ackermann', "use 'car'"), (drive_from, 'xyz', 'there are differential'),
     (actor_from, 'pedestrian', "use 'social_force'"), (actor_from, 'rvo2', "use 'orca'")],
)  # fmt: skip
def test_a_word_for_a_kind_of_sensor_drive_or_actor_is_told_its_name(check, word, hint):
    with pytest.raises(BadProperty, match=f"^there is no kind of {check.noun} '{word}'; {hint}"):
        check({'kind': word}, check.noun)


@pytest.mark.parametrize(
    ('declared', 'word', 'name'),
    [(AppliedForce, 'position', 'at'), (WorldSettings, 'damper', 'damping')],
)
def test_an_everyday_word_for_a_field_of_a_mapping_is_told_its_name(declared, word, name):
    with pytest.raises(UnknownProperty, match=f"; use '{name}'$"):
        check_key(word, declared.WORDS)


@pytest.mark.parametrize('check', [sensor_from, drive_from, actor_from])
def test_the_everyday_words_of_kinds_are_no_kinds(check):
    words = [word for each in check.everyday.values() for word in each]
    assert all(check.everyday.values())
    assert not {*words} & check.kinds.keys()
    assert len({*words}) == len(words)


def test_a_key_of_another_kind_is_refused_with_those_of_this_one():
    with pytest.raises(UnknownProperty) as refused:
        drive_from({'kind': 'omni', 'wheelbase': 0.3}, 'drive')

    assert str(refused.value) == (
        'drives of kind omni have no wheelbase; they have max_speed, max_turn, acceleration, '
        'traction, timeout, latency, command_rate, track, wheel_radius'
    )
    assert refused.value.field == 'wheelbase'


def test_every_property_has_everyday_words_and_none_of_them_is_a_key():
    assert all(Properties.WORDS.values())
    assert all(JointProperties.WORDS.values())
    every = {**JOINT_KEYS, **BODY_KEYS}
    said = (word for words in (*JOINT_KEYS.values(), *BODY_KEYS.values()) for word in words)
    assert every.keys().isdisjoint(said)


def test_every_kind_of_joint_has_everyday_words_and_none_of_them_is_a_kind():
    for kind in JointKind:
        assert kind.schema.words
        assert not {*JointKind}.intersection(kind.schema.words)
