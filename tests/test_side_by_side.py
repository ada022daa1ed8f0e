"""Workspaces side by side in one repository: look-ups prefer packages of the own workspace."""

from collections.abc import Mapping

import pytest

from ros_lint.engine import registry
from ros_lint.engine.run import run_rules
from ros_lint.workspace.side_by_side import hidden_namesakes, workspace_of
from tests.one_package import loaded
from tests.packages import manifest_text

TOOL = "<buildtool_depend>ament_cmake</buildtool_depend>"
BEGIN = "cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
DRIVER = BEGIN + "add_executable({node} node.cpp)\ninstall(TARGETS {node} DESTINATION lib/${{PROJECT_NAME}})\nament_package()\n"
LAUNCH = "install(DIRECTORY launch DESTINATION share/${{PROJECT_NAME}})\nament_package()\n"


def package(path: str, script: str, *depends: str, **values: str) -> dict[str, str]:
    name = path.rpartition("/")[2]
    return {
        f"{path}/package.xml": manifest_text(name, [TOOL, *depends]),
        f"{path}/CMakeLists.txt": script.format(name=name, **values),
        f"{path}/node.cpp": "int main() {}\n",
    }


def start(path: str, executable: str, owner: str = "driver") -> dict[str, str]:
    node = f"Node(package='{owner}', executable='{executable}')"
    launch = f"from launch_ros.actions import Node\ndef generate_launch_description():\n    return [{node}]\n"
    depends = (f"<exec_depend>{owner}</exec_depend>", "<exec_depend>launch_ros</exec_depend>")
    return {**package(path, BEGIN + LAUNCH, *depends), f"{path}/launch/a.launch.py": launch}


def findings(files: Mapping[str, str], *rules: str) -> list[tuple[str, str]]:
    issues, crashes = run_rules(loaded(files), [rule for rule in registry.load() if rule.name in rules])
    assert crashes == ()
    return [(issue.finding.span.path, issue.finding.subject) for issue in issues]


TWO_DRIVERS = {
    **package("arm_ws/src/driver", DRIVER, node="arm_node"),
    **package("car_ws/src/driver", DRIVER, node="car_node"),
}


def test_executables_are_looked_up_in_the_own_workspace() -> None:
    files = {**TWO_DRIVERS, **start("arm_ws/src/arm", "arm_node"), **start("car_ws/src/car", "arm_node")}
    assert findings(files, "launch-unknown-executable") == [("car_ws/src/car/launch/a.launch.py", "arm_node")]


def test_a_package_of_another_workspace_is_found_if_the_own_one_has_none_of_that_name() -> None:
    files = {**TWO_DRIVERS, **start("tool_ws/src/tool", "arm_node"), **start("tool_ws/src/kit", "car_node")}
    assert findings(files, "launch-unknown-executable", "launch-unknown-package") == []


def test_dependencies_come_from_the_own_workspace() -> None:
    needs = "<depend>rclpy</depend>"
    files = {
        **package("arm_ws/src/base", DRIVER, needs, node="base_node"),
        **package("car_ws/src/base", DRIVER, node="base_node"),
    }
    use = BEGIN + "find_package(rclpy REQUIRED)\nament_package()\n"
    for workspace in ("arm_ws", "car_ws"):
        files |= package(f"{workspace}/src/user", use, "<depend>base</depend>")
    assert findings(files, "transitive-dependency") == [("arm_ws/src/user/CMakeLists.txt", "rclpy")]
    assert findings(files, "undeclared-dependency") == [("car_ws/src/user/CMakeLists.txt", "rclpy")]


def test_cmake_code_of_the_own_workspace_runs_in_dependents() -> None:
    files: dict[str, str] = {}
    for workspace, node in (("arm_ws", "arm_node"), ("car_ws", "car_node")):
        extras = "macro(add_driver)\n  add_executable({node} node.cpp)\n  install(TARGETS {node} DESTINATION lib/p)\nendmacro()\n"
        tools = f"{workspace}/src/tools"
        files |= package(tools, BEGIN + 'ament_package(CONFIG_EXTRAS "extras.cmake")\n')
        files |= {f"{tools}/extras.cmake": extras.format(node=node)}
        user = BEGIN + "find_package(tools REQUIRED)\nadd_driver()\nament_package()\n"
        files |= package(f"{workspace}/src/user", user, "<depend>tools</depend>")
    packages = loaded(files).packages
    assert {package.path for package in packages if package.script is None} == set()
    made = {package.path: [target.name for target in package.built.products.targets] for package in packages}
    assert made["arm_ws/src/user"] == ["arm_node"]
    assert made["car_ws/src/user"] == ["car_node"]


@pytest.mark.parametrize(
    ("path", "workspace"),
    [
        ("", ""),
        ("arm", ""),
        ("src/arm", ""),
        ("arm_ws/src/a/src/b", "arm_ws"),
        ("arm_ws/arm", "arm_ws"),
        ("labs/lab 3/arm", "labs/lab 3"),
    ],
)
def test_the_workspace_of_a_package_follows_from_its_path(path: str, workspace: str) -> None:
    assert workspace_of(path) == workspace


def test_namesakes_are_hidden_only_in_workspaces_that_contain_the_name() -> None:
    places = [("a", "x_ws/src/a"), ("a", "y_ws/src/a"), ("a", "y_ws/src/old/a"), ("b", "y_ws/src/b"), ("c", "z_ws/src/c")]
    assert hidden_namesakes(places) == {
        "x_ws": frozenset({"y_ws/src/a", "y_ws/src/old/a"}),
        "y_ws": frozenset({"x_ws/src/a"}),
    }
