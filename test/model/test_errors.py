# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The codes of refusal are those of the contract, one for each class."""

from physsim_ros.model.errors import Malformed, Refusal


def test_no_two_refusals_share_a_code():
    # The table of docs/interface/codes.md has them all (test/style/test_documents.py).
    codes = [each.code for each in Refusal.__subclasses__()]
    assert len(set(codes)) == len(codes)


def test_a_refusal_of_the_whole_names_no_field():
    assert Malformed('no').field == ''
