# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies that ask for no colour get one by their name: next by id, next colour."""

from physsim_ros.model.colors import color_of
import pytest


def test_the_next_ten_bodies_of_a_namespace_have_ten_colours():
    colors = [color_of(f'ball/{number}') for number in range(10)]

    assert len(set(colors)) == 10
    assert [color_of(f'ball/{number}') for number in range(10, 20)] == colors


@pytest.mark.parametrize('name', ['a/0', 'a/-7', 'Würfel/2147483647', 'a/b/c/-2147483648'])
def test_any_name_has_an_opaque_colour_and_keeps_it(name):
    color = color_of(name)

    assert color == color_of(name)
    assert all(0.0 <= channel <= 1.0 for channel in color)
    assert color[3] == 1.0


def test_first_bodies_of_different_namespaces_differ_in_colour():
    assert len({color_of(f'{namespace}/0') for namespace in 'abcdefgh'}) > 3
