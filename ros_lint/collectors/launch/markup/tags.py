"""The tags and substitutions of XML and YAML launch files, with the ROS distributions that added them."""

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
    "for-var": (1, 2),
    "if": (2, 3),
    "index": (1, 2),
    "launch_log_dir": (0, 0),
    "log_dir": (0, 0),
    "not": (1, 1),
    "not-equals": (2, 2),
    "or": (2, 2),
    "param": (1, 2),
    "string-join": (1, 1_000),
    "var": (1, 2),
}
"""The minimum and maximum number of arguments of each substitution."""

EXTENSIONS: Mapping[str, str] = {
    "gz_server": "ros_gz_sim",
    "gz_spawn_model": "ros_gz_sim",
    "ros_gz_bridge": "ros_gz_bridge",
    "ros_gz_sim": "ros_gz_sim",
    "gz_robot_plugin": "ros_gz_sim",
    "trace": "tracetools_launch",
}
"""Tags that packages add with the entry point group ``launch.frontend.launch_extension``, each with its package."""

ROS_1: Mapping[str, str] = {
    "$(find)": "$(find-pkg-share)",
    "$(arg)": "$(var)",
    "$(optenv)": "$(env name default)",
    "type of <node>": "exec",
    "required of <node>": "on_exit",
    "ns of <node>": "namespace",
    "ns of <group>": "<push_ros_namespace>",
    "ns of <include>": "<push_ros_namespace> in a <group>",
    "value of <arg>": "<let>",
    "doc of <arg>": "description",
    "command of <param>": "$(command)",
    "<rosparam>": "<param from=...> in a node",
    "<remap>": "<set_remap>",
    "<param>": "<set_parameter>",
    "<env>": "<set_env>",
    "<machine>": "none",
}
"""Features of ROS 1 launch files that ROS 2 does not have, and their replacements."""

SINCE: Mapping[str, str] = {
    "<set_ros_log_dir>": "iron",  # launch_ros 0.22.0
    "<for>": "kilted",  # launch 3.8.0
    "<for_each>": "kilted",  # launch 3.8.0
    "<lifecycle_node>": "lyrical",  # launch_ros 0.29.4
    "<composable_lifecycle_node>": "lyrical",  # launch_ros 0.29.3
    "<let> in <include>": "jazzy",  # launch 3.4.7
    "attribute 'sigkill_timeout'": "iron",  # launch 1.4.0
    "attribute 'sigterm_timeout'": "iron",  # launch 1.4.0
    "attribute 'respawn_max_retries'": "jazzy",  # launch 3.1.0
    "$(launch_log_dir)": "iron",  # launch 1.3.0
    "$(eval) with modules": "iron",  # launch 1.4.0
    "$(for-var)": "kilted",  # launch 3.8.0
    "$(index)": "kilted",  # launch 3.8.0
    "$(string-join)": "lyrical",  # launch 3.9.5
}
"""The first ROS distribution that supports a feature, for features that some supported distributions lack.

From the ``parse`` methods and ``expose_action``, ``expose_substitution`` of the branches humble, iron, jazzy and rolling of
ros2/launch and ros2/launch_ros as of 2024-12. Later features are from their changelogs of humble (launch 1.0.14, launch_ros
0.19.13), jazzy (3.4.10, 0.26.11), kilted (3.8.7, 0.28.4) and rolling (3.9.6, 0.29.5).

Features that updates brought to every supported distribution are omitted: ``on_exit`` and ``emulate_tty``, ``$(if)``,
``$(any)``, ``$(all)``, ``$(equals)`` and ``$(not-equals)`` came to humble with launch 1.0.9, ``$(file-content)`` with 1.0.11.
"""
