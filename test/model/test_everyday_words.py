# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Refusals that tell the property which an everyday word means."""

from dataclasses import fields

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.joints import JointKind, JointProperties, kind_from
from physsim_ros.model.texts import EVERYDAY_WORDS
import pytest

KEYS = {each.name for kind in (Properties, JointProperties) for each in fields(kind)} | {
    *('at', 'box', 'circle', 'color')  # of a body in a world file
}


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


def test_every_property_has_everyday_words_and_none_of_them_is_a_property():
    assert set(EVERYDAY_WORDS) == KEYS
    assert not {word for words in EVERYDAY_WORDS.values() for word in words} & KEYS


def test_every_kind_of_joint_has_everyday_words_and_none_of_them_is_a_kind():
    for kind in JointKind:
        assert kind.schema.words
        assert not {*JointKind}.intersection(kind.schema.words)
