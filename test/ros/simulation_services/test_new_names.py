# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of names for many new bodies among many others."""

from __future__ import annotations

from physsim_ros.ros.simulation_services.new_names import NewNames


class Counted(dict[str, int]):
    """Rows by name, which count how often they are looked up."""

    def __init__(self, names: list[str]) -> None:
        super().__init__((name, row) for row, name in enumerate(names))
        self.looked_up = 0

    def __contains__(self, name: object) -> bool:
        self.looked_up += 1
        return super().__contains__(name)


def test_names_of_new_bodies_are_free_and_none_is_looked_for_from_the_first_on_again() -> None:
    many, new = 1000, 300
    taken = Counted([f'box/{number}' for number in range(many) if number != 7])
    names = NewNames(taken)
    found = []
    for _ in range(new):
        found.append(names.free_name('box'))
        # A name that is not added after all stays free.
        assert names.free_name('box') == found[-1]
        names.add(found[-1])
    assert found == ['box/7', *(f'box/{number}' for number in range(many, many + new - 1))]
    assert names.free_name('disc') == 'disc/0'
    assert taken.looked_up <= many + 2 * new
