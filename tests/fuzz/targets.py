"""Targets: which files of a workspace are mutated."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from random import Random
from typing import Final, NamedTuple

from tests.fuzz import trees
from tests.fuzz.mutate import Material, mutate
from tests.fuzz.seeds import Files, Other, Seed

WHOLE: Final = "whole run"
CACHE: Final = "cache"
BASELINE: Final = "baseline"


class Target(NamedTuple):
    """A format."""

    name: str
    pattern: str
    """Matches the paths of the files of the format."""
    words: str
    """Words of the format, which replace other words."""
    made: Mapping[str, str] = {}
    """Files that every workspace of the target has. They are seeds where the cases have too few of the format."""


_PACKAGE: Final = {
    "q/package.xml": """<package format="3">
  <name>q</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>MIT</license>
  <depend>rclcpp</depend>
  <exec_depend>launch_ros</exec_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "q/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(q)
find_package(ament_cmake REQUIRED)
find_package(std_msgs REQUIRED)
add_executable(n src/n.cpp)
install(TARGETS n DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME} OPTIONAL)
ament_package()
""",
    "q/src/n.cpp": "#include <rclcpp/rclcpp.hpp>\n#include <nav_msgs/msg/odometry.hpp>\nint main() {}\n",
}
_SETUP: Final = """from setuptools import find_packages, setup
import os
from glob import glob
package_name = 'r'
setup(
    name=package_name, version='0.1.0', packages=find_packages(exclude=['test']),
    data_files=[('share/ament_index/resource_index/packages', ['resource/' + package_name]),
                (os.path.join('share', package_name, 'launch'), glob('launch/*.launch.py'))],
    install_requires=['setuptools'], entry_points={'console_scripts': ['n = r.n:main']},
)
"""
_PYTHON: Final = {
    "r/package.xml": _PACKAGE["q/package.xml"].replace(">q<", ">r<").replace("ament_cmake", "ament_python"),
    "r/setup.py": _SETUP,
    "r/setup.cfg": "[develop]\nscript_dir=$base/lib/r\n[install]\ninstall_scripts=$base/lib/r\n[options]\ninstall_requires = a\n",
    "r/pyproject.toml": '[project]\nname = "r"\ndependencies = ["numpy>=1"]\n[project.scripts]\nn = "r.n:main"\n',
    "r/r/__init__.py": "",
    "r/r/n.py": "import rclpy\nfrom std_msgs.msg import String\n\ndef main():\n    rclpy.init()\n",
    "r/resource/r": "",
}
_LAUNCH_YAML: Final = """launch:
- arg: {name: a, default: $(find-pkg-share q)/b}
- node: {pkg: q, exec: n, name: x, param: [{from: $(var a)}, {name: p, value: 1}], remap: [{from: s, to: t}]}
- include: {file: $(find-pkg-share q)/launch/b.launch.py, arg: [{name: c, value: $(env HOME d)}]}
- group: [{push_ros_namespace: {namespace: e}}, {executable: {cmd: ls -l, if: $(eval 1 == 1)}}]
"""
_COLCON: Final = {
    "q/colcon.pkg": '{"name": "q", "type": "cmake", "dependencies": ["r"], "hooks": ["share/q/hook.dsv"]}\n',
    "colcon.meta": "names:\n  q: {dependencies: [r], cmake-args: [-DX=1]}\npaths:\n  q: {name: z}\n",
    "defaults.yaml": "build: {symlink-install: true, packages-select: [q]}\n",
    "colcon_defaults.yaml": "build: {base-paths: [src]}\n",
}
_REPOSITORIES: Final = {
    "a.repos": "repositories:\n  x/y: {type: git, url: 'https://x.org/y.git', version: main}\n",
    "b.rosinstall": "- git: {local-name: z, uri: 'https://x.org/z.git', version: humble}\n",
    ".gitmodules": '[submodule "s"]\n\tpath = third/s\n\turl = https://x.org/s.git\n',
}
_IGNORED: Final = {
    ".gitignore": "build/\n*.pyc\n!keep\n/q/config/*.yaml\n**/x/**\n[a-c]?.txt\n\\#a\n",
    "q/.gitignore": "launch\n",
    "q/COLCON_IGNORE.off": "",
    "q/config/a.yaml": "a: 1\n",
}
_SETTINGS: Final = """distro = "jazzy"
select = ["default", "ROS2"]
ignore = ["unused-dependency"]
exclude = ["build_*", "**/old"]
fail-on = "error"
jobs = 1
rule-url = "https://x.org/{rule}"
[severity]
unused-dependency = "error"
[per-path-ignores]
"q/*" = ["all"]
"""
_BASELINE: Final = """{
  "folders": ["."],
  "known": [
    {"rule": "undeclared-dependency", "package": "q", "subject": "std_msgs", "count": 1, "sure": true},
    {"rule": "unused-dependency", "package": "q", "subject": "rclcpp", "count": 2, "sure": false}
  ]
}
"""
_ROBOT: Final = """<?xml version="1.0"?>
<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="p" value="${2 * pi}"/>
  <xacro:include filename="$(find q)/urdf/b.xacro"/>
  <xacro:macro name="m" params="a b:=1 *c"><link name="${a}"><visual><geometry>
    <mesh filename="package://q/meshes/a.stl"/></geometry></visual></link></xacro:macro>
  <xacro:m a="x"><origin/></xacro:m>
  <gazebo><plugin filename="libgazebo_ros2_control.so" name="c"><parameters>$(find q)/config/c.yaml</parameters></plugin></gazebo>
</robot>
"""
_SUPPRESSED: Final = {
    "q/src/n.cpp": "// ros-lint: ignore[undeclared-dependency] why\n#include <nav_msgs/msg/odometry.hpp>  // ros-lint: ignore\n",
    "q/package.xml": _PACKAGE["q/package.xml"].replace(
        "  <depend>", "  <!-- ros-lint: ignore-file[manifest-schema, ROS204]: because -->\n  <depend>", 1
    ),
    "q/CMakeLists.txt": _PACKAGE["q/CMakeLists.txt"].replace(
        "add_", "# ros-lint: ignore-next-line[uninstalled-executable]\n# NOLINT\nadd_", 1
    ),
    "r/r/n.py": "import numpy  # ros-lint: ignore[undeclared-dependency]\nimport x  # noqa\n",
}

TARGETS: Final = (
    Target("manifest", r"(^|/)package\.xml$", "depend exec_depend test_depend condition $ROS_VERSION member_of_group version_gte"),
    Target(
        "cmake",
        r"(^|/)CMakeLists\.txt$|\.cmake(\.in)?$",
        "foreach endforeach macro function if elseif while include add_subdirectory file GLOB math EXPR string REGEX REPLACE list "
        "APPEND cmake_parse_arguments ${ARGN} MATCHES VERSION_LESS IN LISTS return break PARENT_SCOPE cmake_language EVAL CODE",
    ),
    Target(
        "setup.py",
        r"(^|/)(setup\.py|setup\.cfg|pyproject\.toml)$",
        "glob os.walk lambda yield for while import open read exec eval package_name **kwargs __file__ sorted zip sum format",
        _PYTHON,
    ),
    Target("python", r"(?<!launch)(?<!setup)\.py$", "import from try except lambda async match case class def yield global", _PYTHON),
    Target(
        "launch.py",
        r"launch\.py$",
        "LaunchConfiguration PythonExpression OpaqueFunction IncludeLaunchDescription GroupAction for while lambda yield open "
        "yaml.safe_load FindPackageShare Command TextSubstitution EqualsSubstitution IfCondition str repr eval getattr sum range",
    ),
    Target("launch.xml", r"\.launch(\.xml)?$|launch/[^/]*\.xml$", "node include arg let group if unless param remap $(var $(eval $(env"),
    Target("launch.yaml", r"launch\.ya?ml$", "node include arg let group if unless param remap", {"q/launch/a.launch.yaml": _LAUNCH_YAML}),
    Target("c++", r"\.(cpp|hpp|h|cc|c)$", "#include #define #if R\"( __has_include RCLCPP_COMPONENTS_REGISTER_NODE namespace"),
    Target("interfaces", r"\.(msg|srv|action|idl)$", "string wstring bool[] float64[<=3] <=10 --- module struct sequence @default"),
    Target(
        "parameters",
        r"(?<!launch)\.ya?ml$",
        "ros__parameters /** plugin use_sim_time .inf !!binary <<",
        {"q/config/p.yaml": "/**:\n  n:\n    ros__parameters: {plugin: 'a::B', use_sim_time: true, l: [1, 2.0]}\n"},
    ),
    Target(
        "robots",
        r"\.(urdf|xacro|sdf|srdf|world|rviz)$",
        "xacro:include xacro:if xacro:macro $(find package:// model:// file:// ${ $(arg",
        {"q/urdf/a.urdf.xacro": _ROBOT, "q/rviz/a.rviz": "Panels:\n  - Class: rviz_common/Displays\n    Name: x\n"},
    ),
    Target("repositories", r"\.(repos|rosinstall)$|(^|/)\.gitmodules$", "git svn tar version url path", _REPOSITORIES),
    Target("colcon", r"(^|/)(colcon\.pkg|colcon\.meta|defaults\.yaml|colcon_defaults\.yaml)$", "name type dependencies names", _COLCON),
    Target("ignore files", r"(^|/)(\.gitignore|(COLCON|AMENT|CATKIN)_IGNORE(\.off)?)$", "** * ? [!a-z] \\ !", _IGNORED),
    Target("settings", r"(^|/)(ros-lint\.toml|pyproject\.toml)$", "true false 1 [] {} select exclude distro", {"ros-lint.toml": _SETTINGS}),
    Target(BASELINE, r"(^|/)known\.json$", "null true 1e999 -1 {} []", {"known.json": _BASELINE, "ros-lint.toml": 'baseline = "known.json"\n'}),
    Target("suppressions", r"\.(cpp|py|xml|txt)$", "ros-lint: ignore ignore-file ignore-next-line all ROS204 NOLINT noqa", _SUPPRESSED),
    Target("resources", r"(^|/)(plugins?\w*|\w*plugins?)\.xml$|/resource/", "library path class type base_class_type", {
        "q/plugins.xml": '<library path="n"><class type="q::N" base_class_type="r::B" name="n"><description>d</description></class></library>\n',
    }),
    Target("other languages", r"\.(java|rs|m)$|(^|/)(Cargo\.toml|build\.gradle)$|/scripts/\w+$", "import use extern crate", {
        "q/src/A.java": "import org.ros2.rcljava.RCLJava;\nimport std_msgs.msg.String;\n",
        "q/src/a.rs": "use std_msgs::msg::{String, Bool};\nextern crate rclrs;\n",
        "q/Cargo.toml": '[package]\nname = "q"\n[dependencies]\nrclrs = "*"\n',
        "q/a.m": "n = ros2node('/a'); m = ros2message('std_msgs/String');\n",
        "q/scripts/run": "#!/usr/bin/env python3\nimport rclpy\n",
    }),
    Target(CACHE, r"$^", ""),
    Target(WHOLE, r".", "q r / .. build install share"),
)  # fmt: skip
BY_NAME: Final = {target.name: target for target in TARGETS}


class Source:
    """Makes inputs of a target from seeds."""

    def __init__(self, target: Target, seeds: Sequence[Seed]) -> None:
        self.target = target
        self._matches = re.compile(target.pattern).search
        fitting = [seed for seed in seeds if target.name in (WHOLE, CACHE) or any(map(self._matches, seed.files))]
        frame = {path: text.encode() for path, text in {**_PACKAGE, **target.made}.items()}
        self._seeds = [*fitting, *[Seed("made", frame)] * max(1, len(fitting) // 4 if target.made else 0)]
        self._frame = frame if target.made else {}
        contents = {content for seed in self._seeds for path, content in _regular(seed.files) if self._matches(path)}
        self._material = Material(sorted(contents), target.words.encode().split())

    def make(self, random: Random) -> Files:
        """Return a mutated workspace."""
        seed = random.choice(self._seeds)
        files: dict[str, bytes | Other] = {**self._frame, **seed.files} if seed.files else {}
        own = [path for path, _ in _regular(files) if self._matches(path)]
        for path in random.sample(own, min(len(own), random.choice((1, 1, 1, 2, 4)))):
            content = files[path]
            assert isinstance(content, bytes)
            files[path] = mutate(random, content, self._material)
        return trees.mutate(random, files) if self.target.name == WHOLE else files


def _regular(files: Files) -> Iterator[tuple[str, bytes]]:
    return ((path, content) for path, content in files.items() if isinstance(content, bytes))
