"""What every environment of ROS 2 says of itself, whatever the distribution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

ROS_2: Final[Mapping[str, str]] = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}
"""Variables of the environment that builds, launches and conditions of manifests can ask for (REP 149)."""
