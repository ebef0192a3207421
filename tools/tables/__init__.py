# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make tables`: docs, configuration and types repeat what is declared of fields."""
