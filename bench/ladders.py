"""Small workspaces with a number of elements of one kind, for measurements of how ros-lint grows with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

Files = Mapping[str, str]


def lines(count: int, *pattern: str) -> str:
    """Return the lines of a pattern, once for each number."""
    return words(count, "\n".join(pattern) + "\n", "")


def words(count: int, pattern: str, separator: str = " ") -> str:
    """Return a pattern once for each number. %d is the number, %e the next and %f the previous number."""
    return separator.join(
        pattern.replace("%d", str(number)).replace("%e", str(number + 1)).replace("%f", str(number - 1))
        for number in range(count)
    )


def manifest(kind: str, tags: str = "") -> str:
    return f"""<package format="3">
  <name>a</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>MIT</license>
{tags}  <export><build_type>{kind}</build_type></export>
</package>
"""


def cmake(body: str, tags: str = "", files: Files | None = None) -> Files:
    script = f"cmake_minimum_required(VERSION 3.8)\nproject(a)\nfind_package(ament_cmake REQUIRED)\n{body}ament_package()\n"
    return {"package.xml": manifest("ament_cmake", tags), "CMakeLists.txt": script, **(files or {})}


def setup(options: str, before: str = "") -> Files:
    script = f"from setuptools import setup\n{before}setup(name='a', version='0.1.0', packages=['a'], {options})\n"
    return {"package.xml": manifest("ament_python"), "setup.py": script, "a/__init__.py": "", "resource/a": ""}


def installed(name: str, text: str) -> Files:
    return cmake("install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\n", files={f"launch/{name}": text})


_IMPORTS = """from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import Node
"""


def launch(body: str, before: str = "", result: str = "LaunchDescription(x)") -> Files:
    inner = "".join(f"    {line}\n" for line in body.splitlines())
    program = f"{_IMPORTS}{before}\ndef generate_launch_description():\n    x = []\n{inner}    return {result}\n"
    return installed("a.launch.py", program)


def xml(body: str) -> Files:
    return installed("a.launch.xml", f"<launch>\n{body}</launch>\n")


def yaml(body: str) -> Files:
    return installed("a.launch.yaml", f"launch:\n{body}")


def source(name: str, text: str) -> Files:
    return cmake(f"add_executable(b src/{name})\n", files={f"src/{name}": text})


def _node(body: str) -> Files:
    """Return a package with a node, and a launch file that passes config/b.yaml to it."""
    program = (
        '#include <rclcpp/rclcpp.hpp>\nclass B : public rclcpp::Node {\npublic:\n  B() : Node("b") {\n'
        f"{body}  }}\n}};\nint main(int c, char ** v) {{ rclcpp::init(c, v); rclcpp::spin(std::make_shared<B>()); }}\n"
    )
    return cmake(
        "find_package(rclcpp REQUIRED)\nadd_executable(b src/b.cpp)\ninstall(TARGETS b DESTINATION lib/a)\n"
        "install(DIRECTORY launch config DESTINATION share/a)\n",
        "  <depend>rclcpp</depend>\n",
        {
            "src/b.cpp": program,
            "launch/a.launch.xml": '<launch><node pkg="a" exec="b" name="b">'
            '<param from="$(find-pkg-share a)/config/b.yaml"/></node></launch>',
        },
    )


_NODE = "Node(package='b', executable='c%d')"
_ARGUMENT = "DeclareLaunchArgument('a%d', default_value='b')"
_INCLUDE = "IncludeLaunchDescription(PythonLaunchDescriptionSource('a%d.launch.py'))"

LADDERS: dict[str, Callable[[int], Files]] = {
    # Python launch files
    "launch.py: nodes": lambda n: launch(lines(n, f"x.append({_NODE})")),
    "launch.py: nodes in a list": lambda n: launch(f"x = [{words(n, _NODE, ', ')}]"),
    "launch.py: arguments": lambda n: launch(lines(n, f"x.append({_ARGUMENT})")),
    "launch.py: arguments, chained": lambda n: launch(
        lines(n, "x.append(DeclareLaunchArgument('a%d', default_value=[LaunchConfiguration('a%e'), 'b']))")
    ),
    "launch.py: unknown conditions": lambda n: launch(lines(n, "if u(%d):", f"    x.append({_NODE})")),
    "launch.py: unknown conditions that assign": lambda n: launch(lines(n, "if u(%d):", "    y%d = 1", "else:", "    y%d = 2")),
    "launch.py: unknown conditions for one name": lambda n: launch(
        lines(n, "if u(%d):", "    y = '%d'") + "x = [Node(package='b', executable=y)]"
    ),
    "launch.py: unknown conditions for a text": lambda n: launch(
        "y = ''\n" + lines(n, "if u(%d):", "    y += '%d'") + "x = [Node(package='b', executable=y)]"
    ),
    "launch.py: unknown conditions for keys": lambda n: launch(
        "y = {}\n" + lines(n, "if u(%d):", "    y['b%d'] = %d") + "x = [Node(package='b', executable='c', parameters=[y])]"
    ),
    "launch.py: early returns": lambda n: launch(lines(n, "if u(%d):", f"    return LaunchDescription([{_NODE}])")),
    "launch.py: early returns of a helper": lambda n: launch(
        "x = [f()]", "def f():\n" + lines(n, "    if u(%d):", f"        return {_NODE}")
    ),
    "launch.py: conditions of arguments": lambda n: launch(
        "y = LaunchConfiguration('y')\n" + lines(n, "x.append(Node(package='b', executable='c%d', condition=IfCondition(y)))")
    ),
    "launch.py: expressions": lambda n: launch(
        lines(n, "x.append(Node(package='b', executable=PythonExpression([\"'c\", LaunchConfiguration('a%d'), \"'\"])))")
    ),
    "launch.py: helpers in a row": lambda n: launch("x = f0()", lines(n, "def f%d():", f"    return [{_NODE}, f%d]")),
    "launch.py: calls of one helper": lambda n: launch(
        lines(n, "x += f('c%d', u(%d))"),
        "def f(a, b):\n    if b:\n        return [Node(package='b', executable=a)]\n    return []\n",
    ),
    "launch.py: nested helpers": lambda n: launch("x = f0(u())", lines(n, "def f%d(y):", f"    return [{_NODE}, *f%e(y)]")),
    "launch.py: loops over the unknown": lambda n: launch(
        lines(n, "for y%d in u(%d):", "    x.append(Node(package='b', executable=y%d))")
    ),
    "launch.py: a loop over a list": lambda n: launch(
        f"for y in [{words(n, '%d', ', ')}]:\n    x.append(Node(package='b', executable=f'c{{y}}'))"
    ),
    "launch.py: what a call gets": lambda n: launch(f"y = [{words(n, _NODE, ', ')}]\n" + lines(n, "u(y)")),
    "launch.py: includes": lambda n: launch(lines(n, f"x.append({_INCLUDE})")),
    "launch.py: functions at launch": lambda n: launch(
        lines(n, "x.append(OpaqueFunction(function=f%d))"), lines(n, "def f%d(context):", f"    return [{_NODE}]")
    ),
    "launch.py: entries of a dictionary": lambda n: launch(
        f"y = {{{words(n, chr(39) + 'b%d' + chr(39) + ': %d', ', ')}}}\nx = [Node(package='b', executable='c', parameters=[y])]"
    ),
    "launch.py: remappings": lambda n: launch(
        f"x = [Node(package='b', executable='c', remappings=[{words(n, '(' + repr('a%d') + ', ' + repr('b%d') + ')', ', ')}])]"
    ),
    "launch.py: nodes in groups": lambda n: launch(lines(n, f"x.append(GroupAction([PushRosNamespace('b%d'), {_NODE}]))")),
    "launch.py: try statements": lambda n: launch(
        lines(n, "try:", "    y = u(%d)", "except KeyError:", "    y = %d", f"x.append({_NODE})")
    ),
    "launch.py: methods": lambda n: launch(
        "y = B()\n" + lines(n, "x.append(y.f%d())"), "class B:\n" + lines(n, "    def f%d(self):", f"        return {_NODE}")
    ),
    "launch.py: environment": lambda n: launch(
        lines(n, "os.environ['B%d'] = 'b'", "x.append(Node(package='b', executable=os.environ['B%d']))"), "import os\n"
    ),
    "launch.py: files that are tested": lambda n: launch(
        lines(n, "if os.path.exists('b%d'):", f"    x.append({_NODE})"), "import os\n"
    ),
    "launch.py: packages": lambda n: launch(
        lines(n, "y = get_package_share_directory('b%d')"), "from ament_index_python import *\n"
    ),
    # XML and YAML launch files
    "launch.xml: nodes": lambda n: xml(lines(n, '<node pkg="b" exec="c%d" name="d%d"/>')),
    "launch.xml: arguments": lambda n: xml(lines(n, '<arg name="a%d" default="b"/>')),
    "launch.xml: arguments, chained": lambda n: xml(
        '<arg name="a-1" default="b"/>\n' + lines(n, '<arg name="a%d" default="$(var a%f)"/>')
    ),
    "launch.xml: variables": lambda n: xml(
        lines(n, '<let name="a" value="b%d" if="$(var u%d)"/>') + '<node pkg="b" exec="$(var a)"/>'
    ),
    "launch.xml: conditions": lambda n: xml(lines(n, '<node pkg="b" exec="c%d" if="$(var u%d)"/>')),
    "launch.xml: includes": lambda n: xml(lines(n, '<include file="$(find-pkg-share a)/launch/b%d.launch.xml"/>')),
    "launch.xml: includes of one file": lambda n: {
        **xml(lines(n, '<include file="$(find-pkg-share a)/launch/b.launch.xml"><arg name="c" value="%d"/></include>')),
        "launch/b.launch.xml": '<launch><arg name="c"/><node pkg="b" exec="$(var c)"/></launch>',
    },
    "launch.xml: files in a row": lambda n: {
        **xml('<include file="$(dirname)/b0.launch.xml"/>'),
        **{
            f"launch/b{i}.launch.xml": f'<launch><include file="$(dirname)/b{i + 1}.launch.xml"/></launch>'
            for i in range(n // 10)
        },
    },
    "launch.xml: groups": lambda n: xml(
        lines(n, '<group><push-ros-namespace namespace="b%d"/><node pkg="b" exec="c%d"/></group>')
    ),
    "launch.xml: parameters": lambda n: xml(
        f'<node pkg="b" exec="c">\n{lines(n, "<param name=%qb%d%q value=%q%d%q/>".replace("%q", chr(34)))}</node>\n'
    ),
    "launch.xml: substitutions": lambda n: xml(f'<arg name="b" default="c"/><node pkg="b" exec="{words(n, "$(var b)", "")}"/>\n'),
    "launch.yaml: nodes": lambda n: yaml(lines(n, "- node: {pkg: b, exec: c%d, name: d%d}")),
    "launch.yaml: arguments, chained": lambda n: yaml(
        "- arg: {name: a-1, default: b}\n" + lines(n, "- arg: {name: a%d, default: $(var a%f)}")
    ),
    "launch.yaml: includes": lambda n: yaml(lines(n, "- include: {file: $(find-pkg-share a)/launch/b%d.launch.xml}")),
    "launch.yaml: groups": lambda n: yaml(
        lines(n, "- group: [{push-ros-namespace: {namespace: b%d}}, {node: {pkg: b, exec: c}}]")
    ),
    "launch.yaml: parameters": lambda n: yaml(
        "- node:\n    pkg: b\n    exec: c\n    param:\n" + lines(n, "    - {name: b%d, value: %d}")
    ),
    "launch.yaml: conditions": lambda n: yaml(lines(n, "- node: {pkg: b, exec: c%d, if: $(var u%d)}")),
    # CMake
    "CMake: variables": lambda n: cmake(lines(n, "set(a%d b)")),
    "CMake: a list": lambda n: cmake(lines(n, "list(APPEND a b%d)")),
    "CMake: a list, written again": lambda n: cmake(lines(n, "set(a ${a} b%d)")),
    "CMake: unknown conditions": lambda n: cmake(lines(n, "if(U%d)", "  set(a%d b)", "endif()")),
    "CMake: unknown conditions of a list": lambda n: cmake(
        lines(n, "if(U%d)", "  list(APPEND a b%d)", "endif()") + "install(FILES ${a} DESTINATION share/a)\n"
    ),
    "CMake: unknown conditions of a text": lambda n: cmake(
        "find_package(b)\n"
        + lines(n, "if(${b_%d})", '  set(a "${a}c%d")', "endif()")
        + "install(FILES ${a} DESTINATION share/a)\n"
    ),
    "CMake: unknown conditions that may return": lambda n: cmake(
        "find_package(b)\n" + lines(n, "if(${b_%d})", "  return()", "endif()")
    ),
    "CMake: elseif": lambda n: cmake("find_package(b)\nif(${b_A})\n" + lines(n, "elseif(${b_%d})", "  set(a %d)") + "endif()\n"),
    "CMake: packages": lambda n: cmake(lines(n, "find_package(b%d REQUIRED)")),
    "CMake: targets": lambda n: cmake(lines(n, "add_executable(b%d src/b%d.cpp)"), files={"src/b0.cpp": ""}),
    "CMake: targets in a chain": lambda n: cmake(
        lines(n, "add_library(b%d src/b.cpp)", "target_link_libraries(b%d b%f)"), files={"src/b.cpp": ""}
    ),
    "CMake: targets in a ring": lambda n: cmake(
        lines(n, "add_library(b%d src/b.cpp)", "target_link_libraries(b%d b%f)") + f"target_link_libraries(b0 b{n - 1})\n",
        files={"src/b.cpp": ""},
    ),
    "CMake: targets of one target": lambda n: cmake(
        "add_library(b src/b.cpp)\n" + f"target_link_libraries(b {words(n, 'c%d')})\n", files={"src/b.cpp": ""}
    ),
    "CMake: installed files": lambda n: cmake(f"install(FILES {words(n, 'c%d.yaml')} DESTINATION share/a)\n"),
    "setup.cfg: requirements": lambda n: {**setup(""), "setup.cfg": "[options]\ninstall_requires =\n" + lines(n, "  b%d")},
    "setup.cfg: wrong lines": lambda n: {**setup(""), "setup.cfg": "[options]\n" + lines(n, "b%d")},
    "CMake: installed files of a list": lambda n: cmake(
        f'set(a "{words(n, "c%d.yaml", ";")}")\ninstall(FILES ${{a}} DESTINATION share/a)\n'
    ),
    "CMake: install commands": lambda n: cmake(lines(n, "install(FILES c%d.yaml DESTINATION share/a)")),
    "CMake: installed folders": lambda n: cmake(lines(n, "install(DIRECTORY c%d DESTINATION share/a)")),
    "CMake: functions": lambda n: cmake(lines(n, "function(f%d)", "  set(a b)", "endfunction()", "f%d()")),
    "CMake: nested functions": lambda n: cmake(
        "function(f-1)\nendfunction()\n" + lines(n, "function(f%d)", "  f%f()", "endfunction()") + f"f{n - 1}()\n"
    ),
    "CMake: calls of a macro": lambda n: cmake("macro(m x)\n  set(${x} b)\nendmacro()\n" + lines(n, "m(a%d)")),
    "CMake: a loop": lambda n: cmake(f"foreach(i RANGE {n})\n  set(a${{i}} b)\nendforeach()\n"),
    "CMake: a loop over a list": lambda n: cmake(f"foreach(i {words(n, 'b%d')})\n  set(a${{i}} b)\nendforeach()\n"),
    "CMake: exported dependencies": lambda n: cmake(f"ament_export_dependencies({words(n, 'b%d')})\n"),
    "CMake: messages": lambda n: cmake(f"rosidl_generate_interfaces(a {words(n, 'msg/B%d.msg')})\n"),
    "CMake: comments": lambda n: cmake(lines(n, "# %d")),
    "CMake: tests": lambda n: cmake("find_package(ament_cmake_gtest)\n" + lines(n, "ament_add_gtest(t%d test/t%d.cpp)")),
    "CMake: subdirectories": lambda n: cmake(lines(n, "add_subdirectory(b%d)")),
    "CMake: properties": lambda n: cmake(lines(n, "set_property(GLOBAL APPEND PROPERTY p b%d)")),
    "CMake: replacements": lambda n: cmake(
        f'string(REPEAT "ab;" {n} a)\nstring(REPLACE ";" " " b "${{a}}")\nstring(REGEX REPLACE "a+" "c" b "${{a}}")\n'
    ),
    "CMake: stars": lambda n: cmake(f'if("{"x" * n}" MATCHES "x*x*x*x*y")\n  set(a b)\nendif()\n'),
    "CMake: alternatives": lambda n: cmake(f'if("{"a" * n}" MATCHES "(a|aa)+b")\n  set(a b)\nendif()\n'),
    # names that resemble others
    "similar names: launch arguments": lambda n: xml(
        lines(n, '<arg name="argument_%d" default="b"/>', '<node pkg="b" exec="$(var argumnet_%d)"/>')
    ),
    "similar names: arguments of an include": lambda n: {
        **xml(
            '<include file="$(find-pkg-share a)/launch/b.launch.xml">\n'
            + lines(n, '<arg name="argumnet_%d" value="c"/>')
            + "</include>\n"
        ),
        "launch/b.launch.xml": f"<launch>{lines(n, '<arg name=%qargument_%d%q default=%qb%q/>'.replace('%q', chr(34)))}</launch>",
    },
    "similar names: launch files": lambda n: {
        **xml(lines(n // 10, '<include file="$(find-pkg-share a)/launch/inclde_%d.launch.xml"/>')),
        **{f"launch/include_{i}.launch.xml": "<launch/>" for i in range(n // 10)},
    },
    "similar names: variables": lambda n: cmake(
        lines(n, "set(variable_%d b)") + f"install(FILES {words(n, '${varaible_%d}')} DESTINATION share/a)\n"
    ),
    "similar names: targets": lambda n: cmake(
        lines(n, "add_library(library_%d src/b.cpp)", "install(TARGETS libary_%d DESTINATION lib)"), files={"src/b.cpp": ""}
    ),
    "similar names: files": lambda n: cmake(
        lines(n // 10, "install(FILES config/fiel_%d.yaml DESTINATION share/a)"),
        files={f"config/file_{i}.yaml": "" for i in range(n // 10)},
    ),
    "similar names: parameters": lambda n: {
        **_node(lines(n, 'declare_parameter("parameter_%d", 1);')),
        "config/b.yaml": "b:\n  ros__parameters:\n" + lines(n, "    paramter_%d: 1"),
    },
    "similar names: components": lambda n: {
        **source("b.cpp", lines(n, "RCLCPP_COMPONENTS_REGISTER_NODE(b::Component%d)")),
        "launch/a.launch.py": f"{_IMPORTS}from launch_ros.actions import ComposableNodeContainer\n"
        "from launch_ros.descriptions import ComposableNode\ndef generate_launch_description():\n"
        "    return LaunchDescription([ComposableNodeContainer(package='rclcpp_components', executable='c', name='c', namespace='',\n"
        f"        composable_node_descriptions=[{words(n, 'ComposableNode(package=%qa%q, plugin=%qb::Componnet%d%q)', ', ')}])])\n".replace(
            "%q", "'"
        ),
    },
    "similar names: entry points": lambda n: {
        **setup(f"entry_points={{'console_scripts': [{words(n, repr('b%d = a.b:functoin_%d'), ', ')}]}}"),
        "a/b.py": lines(n, "def function_%d():", "    pass"),
    },
    "similar names: messages": lambda n: cmake(
        f"rosidl_generate_interfaces(a {words(n // 10, 'msg/Message%d.msg')} msg/B.msg)\n",
        files={
            **{f"msg/Message{i}.msg": "" for i in range(n // 10)},
            "msg/B.msg": lines(n // 10, "Messgae%d b%d"),
        },
    ),
    "similar names: dependencies": lambda n: cmake("", lines(n, "  <depend>rclcpp_%dcomponents</depend>")),
    "similar names: settings": lambda n: {**cmake(""), "ros-lint.toml": lines(n, "ignore%d = 1")},
    # setup.py
    "setup.py: entry points": lambda n: setup(
        f"entry_points={{'console_scripts': [{words(n, repr('b%d = a.b%d:main'), ', ')}]}}"
    ),
    "setup.py: data files": lambda n: setup(
        f"data_files=[{words(n, '(' + repr('share/a/%d') + ', [' + repr('c%d.yaml') + '])', ', ')}]"
    ),
    "setup.py: files of one folder": lambda n: setup(f"data_files=[('share/a', [{words(n, repr('c%d.yaml'), ', ')}])]"),
    "setup.py: packages": lambda n: setup(f"install_requires=[{words(n, repr('b%d'), ', ')}]"),
    "setup.py: unknown conditions": lambda n: setup(
        "data_files=x", "import os\nx = []\n" + lines(n, "if os.environ['B%d']:", "    x.append(('share/a', ['c%d.yaml']))")
    ),
    "setup.py: unknown conditions that assign": lambda n: setup(
        "data_files=[]", "import os\n" + lines(n, "if os.environ['B%d']:", "    y%d = 1", "else:", "    y%d = 2")
    ),
    "setup.py: calls of one helper": lambda n: setup(
        "data_files=x", "x = []\ndef f(a):\n    return ('share/a', [a])\n" + lines(n, "x.append(f('c%d'))")
    ),
    "setup.cfg: entry points": lambda n: {
        **setup(""),
        "setup.cfg": "[options.entry_points]\nconsole_scripts =\n" + lines(n, "    b%d = a.b%d:main"),
    },
    "setup.cfg: options": lambda n: {**setup(""), "setup.cfg": "[metadata]\n" + lines(n, "b%d = c")},
    "setup.cfg: sections": lambda n: {**setup(""), "setup.cfg": lines(n, "[b%d]", "c = d")},
    # package.xml
    "package.xml: unknown depends": lambda n: cmake("", lines(n, "  <depend>b%d</depend>")),
    "package.xml: the same depends": lambda n: cmake("", lines(n, "  <depend>b</depend>")),
    "package.xml: unused depends": lambda n: cmake("", lines(n, "  <depend>rclcpp</depend>")),
    "package.xml: fixes of the same depends": lambda n: cmake("", lines(n, "  <depend>rclcpp</depend>")),
    "package.xml: unknown attributes, as text": lambda n: cmake("", "  <depend " + words(n, "b%d=''") + ">rclcpp</depend>\n"),
    "package.xml: groups": lambda n: cmake("", lines(n, "  <member_of_group>b%d</member_of_group>")),
    "package.xml: authors": lambda n: cmake("", lines(n, '  <author email="a@b.org">B%d</author>')),
    "package.xml: attributes": lambda n: cmake("", f"  <depend {words(n, 'b%d=' + chr(34) * 2)}>b</depend>\n"),
    "package.xml: conditions": lambda n: cmake("", lines(n, '  <depend condition="$ROS_DISTRO == b%d">c%d</depend>')),
    # sources
    "C++: includes": lambda n: source("b.cpp", lines(n, "#include <b%d/c.hpp>")),
    "C++: includes on one line": lambda n: source("b.cpp", "#include <" * n),
    "C++: look-ups": lambda n: source("b.cpp", "auto x = " + words(n, 'get_package_share_directory("b%d")', " + ") + ";\n"),
    "C++: components": lambda n: source("b.cpp", lines(n, "RCLCPP_COMPONENTS_REGISTER_NODE(b::C%d)")),
    "C++: suppressions": lambda n: source("b.cpp", lines(n, "// ros-lint: ignore[x]")),
    "C++: comments": lambda n: source("b.cpp", "/* */" * n),
    "Python: imports": lambda n: {**setup(""), "a/b.py": lines(n, "import b%d")},
    "Python: imports in try": lambda n: {
        **setup(""),
        "a/b.py": lines(n, "try:", "    import b%d", "except ImportError:", "    b%d = None"),
    },
    "Python: look-ups": lambda n: {**setup(""), "a/b.py": lines(n, "get_package_share_directory('b%d')")},
    "Python: punycode": lambda n: {**setup(""), "a/b.py": "# coding: punycode\n" + "a" * 10 * n},
    "messages: fields": lambda n: cmake("rosidl_generate_interfaces(a msg/B.msg)\n", files={"msg/B.msg": lines(n, "b%d/C c%d")}),
    "messages: constants": lambda n: cmake(
        "rosidl_generate_interfaces(a msg/B.msg)\n", files={"msg/B.msg": lines(n, "int32 C%d = %d  # d")}
    ),
    "messages: structures in IDL": lambda n: cmake(
        "rosidl_generate_interfaces(a msg/B.idl)\n",
        files={"msg/B.idl": "module a {\nmodule msg {\n" + lines(n, "struct B%d { c::msg::D%d e; };") + "};\n};\n"},
    ),
    "services: parts": lambda n: cmake("rosidl_generate_interfaces(a srv/B.srv)\n", files={"srv/B.srv": "---\n" * n}),
    "parameters: nodes": lambda n: cmake(
        "install(DIRECTORY config DESTINATION share/a)\n",
        files={"config/b.yaml": lines(n, "b%d:", "  ros__parameters:", "    c: %d")},
    ),
    "parameters: names": lambda n: cmake(
        "install(DIRECTORY config DESTINATION share/a)\n",
        files={"config/b.yaml": "b:\n  ros__parameters:\n" + lines(n, "    c%d: %d")},
    ),
    "parameters: blanks": lambda n: cmake(
        "install(DIRECTORY config DESTINATION share/a)\n", files={"config/b.yaml": "  .1" + " " * 10 * n}
    ),
    "xacro: joints": lambda n: cmake(
        "install(DIRECTORY urdf DESTINATION share/a)\n",
        files={
            "urdf/b.xacro": "<robot>"
            + lines(n, '<link name="b%d"><visual><geometry><mesh filename="package://b%d/c.stl"/></geometry></visual></link>')
            + "</robot>"
        },
    ),
    "xacro: properties": lambda n: cmake(
        "install(DIRECTORY urdf DESTINATION share/a)\n",
        files={
            "urdf/b.xacro": '<robot xmlns:xacro="x">'
            + lines(n, '<xacro:property name="b%d" value="${b%f}"/><xacro:include filename="$(find b%d)/${b%d}"/>')
            + "</robot>"
        },
    ),
    ".repos: repositories": lambda n: {
        **cmake(""),
        "a.repos": "repositories:\n" + lines(n, "  b%d: {type: git, url: 'https://x.org/b%d.git', version: main}"),
    },
    ".gitignore: patterns": lambda n: {
        **cmake("install(DIRECTORY c DESTINATION share/a)\n"),
        ".gitignore": lines(n, "b%d/*"),
        "c/d": "",
    },
    "xacro: arguments": lambda n: cmake(
        "install(DIRECTORY urdf DESTINATION share/a)\n",
        files={
            "urdf/b.xacro": '<robot xmlns:xacro="x">'
            + lines(n, '<xacro:arg name="b%d" default="c"/><xacro:include filename="$(find d%d)/$(arg b%d)"/>')
            + "</robot>"
        },
    ),
    "colcon.meta: packages": lambda n: {**cmake(""), "colcon.meta": f"{{names: {{{words(n, 'b%d: {cmake-args: [c]}', ', ')}}}}}"},
    "colcon.pkg: dependencies": lambda n: {
        **cmake(""),
        "colcon.pkg": "{" + f'"name": "a", "dependencies": [{words(n, chr(34) + "b%d" + chr(34), ", ")}]' + "}",
    },
    "CMake without a manifest": lambda n: {"CMakeLists.txt": "project(a)\nfind_package(Q" + " " * 10 * n},
    # what becomes of findings
    "findings": lambda n: source("b.cpp", lines(n, 'auto a%d = "/home/b/c%d";')),
    "findings on one line": lambda n: source("b.cpp", words(n, 'auto a%d = "/home/b/c%d";')),
    "findings, suppressed": lambda n: source("b.cpp", lines(n, 'auto a%d = "/home/b/c%d";  // ros-lint: ignore[machine-path]')),
    "findings, suppressed on one line": lambda n: source(
        "b.cpp", words(n, '/* ros-lint: ignore[machine-path] */ auto a%d = "/home/b/c%d";')
    ),
    # whole workspaces
    "packages": lambda n: {
        f"{folder}/{path}": text.replace("<name>a<", f"<name>p{i}<").replace("project(a)", f"project(p{i})")
        for i in range(n // 10)
        for folder in [f"p{i}"]
        for path, text in cmake("", f"  <depend>p{i - 1}</depend>\n" if i else "").items()
    },
    "files": lambda n: {**cmake("install(DIRECTORY c DESTINATION share/a)\n"), **{f"c/b{i}.yaml": "" for i in range(n // 10)}},
}
"""Workspaces by name, as functions of the number of elements."""

OPTIONS: Mapping[str, tuple[str, ...]] = {
    "package.xml: fixes of the same depends": ("--diff", "--unsafe-fixes"),
    "package.xml: unknown attributes, as text": ("--format", "text"),
}
"""The options of the ladders that are not checked with a report in JSON."""
