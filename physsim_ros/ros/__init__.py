# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The node: a Simulation as topics, services and parameters of ROS 2.

Beside `testing`, only this folder imports rclpy and message packages. Not here: decisions about
requests (`simulation`), geometry of pictures (`view`). Start with `node`, which connects the rest:
what arrives is in `requests`, what is published in `publishers` and `encoders`, and `programs` has
what is started by a command.
"""
