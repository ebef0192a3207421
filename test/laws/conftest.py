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

"""The table of all laws: measured against exact, with unit and tolerance, at the end of a run."""

from dataclasses import dataclass, field

import pytest


@dataclass
class Report:
    """
    Collects what the laws measure.

    Of several cases of one quantity, the row shows the one that is furthest off.
    """

    rows: dict[tuple, list] = field(default_factory=dict)

    def check(self, law, what, measured, exact, tolerance, unit, *, relative=False):
        """
        Record a measurement, and fail where it is off by more than the tolerance.

        :param tolerance: of the difference, or of the ratio less one where `relative`
        """
        off = abs(measured - exact)
        if relative:
            off /= abs(exact)
        key = (law, what, unit, tolerance)
        # A number that is none is further off than every number.
        worst = self.rows.setdefault(key, [0, -1.0, 0.0, 0.0])
        worst[0] += 1
        if not off <= worst[1]:
            worst[1:] = [off, measured, exact]
        assert off <= tolerance, f'law {law}, {what}: {measured!r} {unit}, exact {exact!r}'

    def lines(self):
        """Yield the table, line by line."""
        yield (
            f'{"law":>3}  {"what":<46} {"measured":>14} {"exact":>14} {"off by":>9} '
            f'{"tolerance":>9}  {"unit":<9} cases'
        )
        for (law, what, unit, tolerance), (cases, off, measured, exact) in sorted(
            self.rows.items(), key=lambda row: row[0][0]
        ):
            mark = '' if off <= tolerance else '  BROKEN'
            yield (
                f'{law:>3}  {what:<46} {measured:>14.8g} {exact:>14.8g} {off:>9.2g} '
                f'{tolerance:>9.2g}  {unit:<9} {cases:>5}{mark}'
            )


_REPORT = pytest.StashKey[Report]()


def pytest_configure(config):
    config.stash[_REPORT] = Report()


def pytest_terminal_summary(terminalreporter, config):
    report = config.stash[_REPORT]
    if report.rows:
        terminalreporter.section('the laws: measured against exact')
        for line in report.lines():
            terminalreporter.write_line(line)


@pytest.fixture(scope='session')
def report(request):
    """Hand out what collects the measurements of the session."""
    return request.config.stash[_REPORT]
