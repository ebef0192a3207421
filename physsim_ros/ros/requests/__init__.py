# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests from the graph: topics and services, and their messages as requests of the simulation.

Law: a message is validated here, a request where it is applied. Not here: what a request does
(`simulation`), answers (`ros.publishers`). Start with `request_topics`; a message goes through
`conversions`.
"""
