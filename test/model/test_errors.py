# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
}


@pytest.mark.parametrize(('name', 'code'), CODES.items())
def test_a_refusal_carries_its_stable_code(name: str, code: str) -> None:
    refusal = getattr(errors, name)('it is so', field='friction')

    assert isinstance(refusal, Refusal)
    assert isinstance(refusal, PhysSimError)
    assert (refusal.code, refusal.field, str(refusal)) == (code, 'friction', 'it is so')


def test_no_two_refusals_share_a_code() -> None:
    codes = [each.code for each in Refusal.__subclasses__()]

    assert len(set(codes)) == len(codes)


def test_a_refusal_of_the_whole_names_no_field() -> None:
    assert errors.Malformed('no').field == ''
