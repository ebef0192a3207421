# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Where frames go: a window, a browser, a file, or the page; each by a thread of its own.

Not here: what a frame looks like (`recording`). Start with `sink` and `sink_worker`, which feeds
one from a bounded queue; `endpoints` opens windows and servers and ends their processes.
"""
