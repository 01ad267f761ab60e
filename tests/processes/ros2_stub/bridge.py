# SPDX-License-Identifier: Apache-2.0
"""The bridge of the examples with a stand-in for ROS 2. Usage: bridge.py BRIDGE [OPTION...]"""
import os
import runpy
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rclpy_stub  # noqa: E402,F401

sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
