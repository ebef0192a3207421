# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A process without standard streams prints nothing into the files that it opens."""

import subprocess
import sys

PROGRAM = """
import sys
from physsim_ros.ros.programs.process import open_closed_streams
open_closed_streams()
for stream in (sys.stdout, sys.stderr):
    stream.write('lost')
    stream.flush()
with open(sys.argv[1], 'w') as file:
    print(file.fileno() > 2, file=file)
"""


def test_what_is_printed_without_standard_streams_goes_nowhere(tmp_path):
    path = tmp_path / 'file'
    words = 'bash', '-c', 'exec "$@" <&- >&- 2>&-', 'bash', sys.executable, '-c', PROGRAM, path
    assert subprocess.run(words, check=False).returncode == 0
    assert path.read_text() == 'True\n'
