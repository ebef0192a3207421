# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table of all laws: measured against exact, with unit and tolerance, at the end of a run."""

from itertools import chain
import math

import pytest

# Under which the report of a test keeps what it has measured; so it comes through where tests run
# in several processes.
MEASURED = 'measured'


class Report:
    """
    Collects what a law measures.

    Of several cases of one quantity it keeps the one that is furthest off.

    :param properties: of the test
    """

    def __init__(self, properties):
        self._properties = properties
        self._rows = {}

    def check(self, law, what, measured, exact, tolerance, unit, *, relative=False):
        """
        Record a measurement, and fail where it is off by more than the tolerance.

        :param tolerance: of the difference, or of the ratio less one where `relative`
        """
        measured, exact, tolerance = float(measured), float(exact), float(tolerance)
        off = abs(measured - exact)
        if relative:
            off /= abs(exact)
        key = (law, what, unit, tolerance)
        if key not in self._rows:
            self._rows[key] = [*key, 0, -1.0, 0.0, 0.0]
            self._properties.append((MEASURED, self._rows[key]))
        _, _, _, _, cases, worst, *_ = row = self._rows[key]
        row[4] = cases + 1
        # A number that is none is further off than every number.
        if not off <= worst:
            row[5:] = off, measured, exact
        assert off <= tolerance, f'law {law}, {what}: {measured!r} {unit}, exact {exact!r}'


def table(rows):
    """Yield the table, line by line; of the rows of one quantity the one furthest off."""
    yield (
        f'{"law":>3}  {"what":<46} {"measured":>14} {"exact":>14} {"off by":>9} '
        f'{"tolerance":>9}  {"unit":<9} cases'
    )
    quantities = {}
    for law, what, unit, tolerance, *values in rows:
        quantities.setdefault((law, what, unit, tolerance), []).append(values)
    for (law, what, unit, tolerance), cases in sorted(quantities.items()):
        _, off, measured, exact = max(
            cases, key=lambda case: math.inf if math.isnan(case[1]) else case[1]
        )
        mark = '' if off <= tolerance else '  BROKEN'
        yield (
            f'{law:>3}  {what:<46} {measured:>14.8g} {exact:>14.8g} {off:>9.2g} '
            f'{tolerance:>9.2g}  {unit:<9} {sum(case[0] for case in cases):>5}{mark}'
        )


def pytest_terminal_summary(terminalreporter):
    rows = [
        value
        for test in chain.from_iterable(terminalreporter.stats.values())
        for name, value in getattr(test, 'user_properties', ())
        if name == MEASURED and test.when == 'call'
    ]
    if rows:
        terminalreporter.section('the laws: measured against exact')
        for line in table(rows):
            terminalreporter.write_line(line)


@pytest.fixture
def report(request):
    """Hand out what collects the measurements of a test."""
    return Report(request.node.user_properties)
