"""Environment variables that have the same value in every ROS 2 distribution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

ROS_2: Final[Mapping[str, str]] = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}
"""Values of the variables that build scripts, launch files and conditions in manifests can read (REP 149)."""
