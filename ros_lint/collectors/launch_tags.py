"""The tags and substitutions of launch files in XML and YAML, and since when there are (reference, section G3.3)."""

from __future__ import annotations

from collections.abc import Mapping

SUBSTITUTIONS: Mapping[str, tuple[int, int]] = {
    "all": (0, 1_000),
    "and": (2, 2),
    "anon": (1, 1),
    "any": (0, 1_000),
    "command": (1, 2),
    "dirname": (0, 0),
    "env": (1, 2),
    "equals": (2, 2),
    "eval": (1, 2),
    "exec-in-pkg": (2, 2),
    "file-content": (1, 1),
    "filename": (0, 0),
    "find-exec": (1, 1),
    "find-pkg-prefix": (1, 1),
    "find-pkg-share": (1, 1),
    "if": (2, 3),
    "launch_log_dir": (0, 0),
    "log_dir": (0, 0),
    "not": (1, 1),
    "not-equals": (2, 2),
    "or": (2, 2),
    "param": (1, 2),
    "string-join": (1, 1_000),
    "var": (1, 2),
}
"""How many arguments each takes, at least and at most."""

EXTENSIONS: Mapping[str, str] = {
    "gz_server": "ros_gz_sim",
    "gz_spawn_model": "ros_gz_sim",
    "ros_gz_bridge": "ros_gz_bridge",
    "ros_gz_sim": "ros_gz_sim",
    "gz_robot_plugin": "ros_gz_sim",
    "trace": "tracetools_launch",
    "test": "launch_testing",
}
"""Tags that other packages add, and the packages (entry point group ``launch.frontend.launch_extension``)."""
