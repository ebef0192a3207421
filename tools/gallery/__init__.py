# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make gallery`: the pictures of README and docs, by the recorder and the viewer themselves."""
