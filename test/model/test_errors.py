# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The codes of refusal are those of the contract, one for each class."""

from physsim_ros.model import errors
from physsim_ros.model.errors import PhysSimError, Refusal
import pytest

# In INTERFACE, "Codes of refusal", as far as they are in force.
CODES = {
    'Malformed': 'malformed',
    'UnknownShape': 'unknown_shape',
    'BadSize': 'bad_size',
    'BadOutline': 'bad_outline',
    'NotPlanar': 'not_planar',
    'UnknownFrame': 'unknown_frame',
    'UnknownProperty': 'unknown_property',
    'BadProperty': 'bad_property',
    'UnknownBody': 'unknown_body',
    'UnknownJoint': 'unknown_joint',
    'Anchored': 'anchored',
    'NothingThere': 'nothing_there',
    'NotRecognised': 'not_recognised',
    'WorldFull': 'world_full',
    'BadWorldFile': 'bad_world_file',
    'Failed': 'failed',
}


@pytest.mark.parametrize(('name', 'code'), CODES.items())
def test_a_refusal_carries_its_stable_code(name, code):
    refusal = getattr(errors, name)('it is so', field='friction')

    assert isinstance(refusal, Refusal)
    assert isinstance(refusal, PhysSimError)
    assert (refusal.code, refusal.field, str(refusal)) == (code, 'friction', 'it is so')


def test_no_two_refusals_share_a_code():
    codes = [each.code for each in Refusal.__subclasses__()]

    assert len(set(codes)) == len(codes)


def test_a_refusal_of_the_whole_names_no_field():
    assert errors.Malformed('no').field == ''
