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
    "path-join": (1, 1_000),
    "string-join": (2, 1_000),
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
    "<bool_arg>": "lyrical",  # launch 3.9.7
    "<lifecycle_node>": "jazzy",  # launch_ros 0.26.12
    "<composable_lifecycle_node>": "lyrical",  # launch_ros 0.29.3
    "<log_debug>": "lyrical",  # launch 3.9.1
    "<log_error>": "lyrical",  # launch 3.9.1
    "<log_info>": "lyrical",  # launch 3.9.1
    "<log_warning>": "lyrical",  # launch 3.9.1
    "<rep_env>": "lyrical",  # launch 3.9.6
    "<let> in <include>": "jazzy",  # launch 3.4.7
    "attribute 'level' of <log>": "lyrical",  # launch 3.9.1
    "attribute 'sigkill_timeout'": "iron",  # launch 1.4.0
    "attribute 'sigterm_timeout'": "iron",  # launch 1.4.0
    "attribute 'respawn_max_retries'": "jazzy",  # launch 3.1.0
    "$(launch_log_dir)": "iron",  # launch 1.3.0
    "$(eval) with modules": "iron",  # launch 1.4.0
    "$(for-var)": "kilted",  # launch 3.8.0
    "$(index)": "kilted",  # launch 3.8.0
    "$(path-join)": "lyrical",  # launch 3.9.7
    "$(string-join)": "lyrical",  # launch 3.9.5
}
"""The first ROS distribution that supports a feature, for features that some supported distributions lack.

From the ``parse`` methods and ``expose_action``, ``expose_substitution`` of the last releases of launch and launch_ros: humble
(launch 1.0.14, launch_ros 0.19.14), iron (2.0.4, 0.24.2), jazzy (3.4.11, 0.26.12), kilted (3.8.8, 0.28.6), lyrical (3.9.8,
0.29.9) and rolling (3.10.0, 0.30.1).

Features that updates brought to every supported distribution are omitted: ``on_exit`` and ``emulate_tty``, ``$(if)``,
``$(any)``, ``$(all)``, ``$(equals)`` and ``$(not-equals)`` came to humble with launch 1.0.9, ``$(file-content)`` with 1.0.11.
"""
