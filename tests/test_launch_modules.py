"""Launch files are interpreted again with the modules and files of the workspace that they read."""

from __future__ import annotations

from ros_lint.base.text import Span, Text
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.launch import detect as launch
from ros_lint.collectors.launch.collect import collect
from ros_lint.collectors.symbolic_text import share
from ros_lint.facts.build import BuildProducts, BuildScript, InstalledFile
from ros_lint.facts.launch import LaunchFile
from ros_lint.workspace import launch_modules

HELPER = """
from launch_ros.actions import Node

def start(name):
    return Node(package="driver", executable=name)
"""


def _package(
    name: str, files: dict[str, str], provides: dict[str, str], modules: tuple[str, ...] = ()
) -> launch_modules.LaunchPackage:
    span = Span(f"{name}/CMakeLists.txt", 1, 1, 1, 1)
    installs = tuple(InstalledFile(path, source, False, False, span) for path, source in provides.items())
    script = BuildScript(f"{name}/CMakeLists.txt", products=BuildProducts(installs=installs, python_packages=modules))
    launch_files = []
    for path, text in files.items():
        language = launch.is_launch_file(path, text)
        if language:
            launch_files.append(collect(Text(f"{name}/{path}", text), language))
    return launch_modules.LaunchPackage(name, name, tuple(files), script, tuple(launch_files))


def _completed(*packages: tuple[launch_modules.LaunchPackage, dict[str, str]]) -> dict[str, LaunchFile]:
    tree = MemoryTree({f"{package.name}/{path}": text for package, files in packages for path, text in files.items()})
    resolved = launch_modules.LaunchModules(tree).resolve([package for package, _ in packages])
    return {file.path: file for files in resolved for file in files}


def _named(file: LaunchFile) -> set[tuple[str, str]]:
    return {(reference.package, reference.name) for reference in file.references if reference.kind != "package"}


def test_a_module_that_is_imported_with_its_package_is_interpreted() -> None:
    files = {
        "app/parts/helpers.py": HELPER,
        "app/parts/__init__.py": "",
        "app/__init__.py": "",
        "launch/a.launch.py": """
from launch import LaunchDescription
import app.parts.helpers

def generate_launch_description():
    return LaunchDescription([app.parts.helpers.start("camera")])
""",
    }
    modules = ("app", "app.parts", "app.parts.helpers")
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, modules)
    resolved = _completed((package, files))["app/launch/a.launch.py"]
    assert ("driver", "camera") in _named(resolved)
    assert not resolved.opaque


def test_a_module_counts_if_it_adds_actions_and_further_unknown_places() -> None:
    files = {
        "app/helpers.py": HELPER
        + """
from launch.actions import GroupAction

def start_all():
    return [GroupAction([start("camera"), *input()]), start("lidar"), *input()]
""",
        "launch/a.launch.py": """
from launch import LaunchDescription
from app.helpers import start_all

def generate_launch_description():
    return LaunchDescription(start_all())
""",
    }
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, ("app", "app.helpers"))
    file = _completed((package, files))["app/launch/a.launch.py"]
    assert {("driver", "camera"), ("driver", "lidar")} <= _named(file)
    assert file.opaque


def test_a_helper_module_of_the_same_package_is_interpreted() -> None:
    files = {
        "app/helpers.py": HELPER,
        "app/__init__.py": "",
        "launch/a.launch.py": """
from launch import LaunchDescription
from app.helpers import start

def generate_launch_description():
    return LaunchDescription([start("camera")])
""",
    }
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, ("app", "app.helpers"))
    (unresolved,) = [file for file in package.launch if not file.helper]
    assert unresolved.opaque
    assert unresolved.missing_inputs == ("app.helpers", "app.helpers.start")
    resolved_file = _completed((package, files))["app/launch/a.launch.py"]
    assert not resolved_file.opaque
    assert _named(resolved_file) == {("driver", "camera")}


def test_references_in_a_module_of_another_package_belong_to_that_package() -> None:
    library = {"tools/__init__.py": "", "tools/helpers.py": HELPER}
    files = {
        "launch/a.launch.py": """
from launch import LaunchDescription
from tools import helpers

def generate_launch_description():
    return LaunchDescription([helpers.start("camera")])
""",
    }
    resolved_file = _completed(
        (_package("tools", library, {}, ("tools", "tools.helpers")), library), (_package("app", files, {}), files)
    )["app/launch/a.launch.py"]
    assert not resolved_file.opaque
    assert resolved_file.references == ()
    assert [action.target and action.target.texts for action in resolved_file.actions] == [("camera",)]


def test_launch_libraries_are_modelled_even_if_the_workspace_has_their_sources() -> None:
    library = {
        "launch/__init__.py": "from .launch_description import LaunchDescription\n",
        "launch/launch_description.py": "class LaunchDescription:\n    def __init__(self, entities=None):\n        pass\n",
        "launch_testing/__init__.py": "",
        "launch_testing/actions.py": "class ReadyToTest:\n    pass\n",
    }
    files = {
        "app/helpers.py": HELPER,
        "app/__init__.py": "",
        "launch/a.launch.py": """
from launch import LaunchDescription
from launch_testing.actions import ReadyToTest
from app.helpers import start

def generate_launch_description():
    return LaunchDescription([start("camera"), ReadyToTest()])
""",
    }
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, ("app", "app.helpers"))
    sources = _package("launch", library, {}, ("launch", "launch_testing"))
    without_sources = _completed((package, files))
    launch_files = _completed((package, files), (sources, library))["app/launch/a.launch.py"]
    assert launch_files == without_sources["app/launch/a.launch.py"]
    assert _named(launch_files) == {("driver", "camera")}
    assert not launch_files.opaque


def test_the_source_of_a_helper_in_the_workspace_replaces_its_model() -> None:
    files = {
        "launch/a.launch.py": """
from launch import LaunchDescription
from controller_manager.launch_utils import generate_load_controller_launch_description

def generate_launch_description():
    return LaunchDescription([generate_load_controller_launch_description("arm")])
""",
    }
    library = {
        "controller_manager/__init__.py": "",
        "controller_manager/launch_utils.py": HELPER.replace("start", "generate_load_controller_launch_description"),
    }
    package = _package("app", files, {})
    modules = ("controller_manager", "controller_manager.launch_utils")
    without_sources = _completed((package, files))["app/launch/a.launch.py"]
    assert _named(without_sources) == {("controller_manager", "spawner")}
    neighbour = _completed((package, files), (_package("controller_manager", library, {}, modules), library))
    (action,) = neighbour["app/launch/a.launch.py"].actions
    assert action.package is not None
    assert action.package.texts == ("driver",)


def test_a_module_in_the_folder_of_another_package_is_interpreted() -> None:
    text = """
import sys
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
sys.path.append(get_package_share_directory("bringup") + "/launch")
from agent import AgentLaunchDescription

def generate_launch_description():
    return AgentLaunchDescription("camera")
"""
    files = {"launch/a.launch.py": text}
    library = {
        "launch/names.py": "DRIVER = 'driver'\n",
        "launch/agent.py": "from names import DRIVER\n"
        + HELPER.replace("start", "AgentLaunchDescription").replace('"driver"', "DRIVER"),
    }
    without_sources = _completed((_package("app", files, {}), files))["app/launch/a.launch.py"]
    assert [opaque.reason for opaque in without_sources.opaque] == [
        "the launched actions are not known: AgentLaunchDescription() cannot be followed"
    ]
    packages = [(_package("app", files, {}), files), (_package("bringup", library, {}), library)]
    resolved_file = _completed(*packages)["app/launch/a.launch.py"]
    assert not resolved_file.opaque
    assert [
        (action.package and action.package.texts, action.target and action.target.texts) for action in resolved_file.actions
    ] == [(("driver",), ("camera",))]
    other_package = (_package("other", library, {}), library)
    assert _completed(packages[0], other_package)["app/launch/a.launch.py"].opaque, "nothing says that it is looked for there"


def test_a_sibling_module_found_by_a_changed_path_is_interpreted() -> None:
    files = {
        "launch/common.py": HELPER,
        "launch/a.launch.py": """
import os, sys
from launch import LaunchDescription
sys.path.append(os.path.dirname(__file__))
from common import start

def generate_launch_description():
    return LaunchDescription([start("camera")])
""",
    }
    assert _named(_completed((_package("app", files, {}), files))["app/launch/a.launch.py"]) == {("driver", "camera")}


def test_a_yaml_file_is_read_by_its_install_path() -> None:
    files = {
        "config/setup.yaml": "nodes: [left, right]\n",
        "launch/a.launch.py": """
import os, yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    with open(os.path.join(get_package_share_directory("app"), "conf", "setup.yaml")) as file:
        names = yaml.safe_load(file)["nodes"]
    return LaunchDescription([Node(package="driver", executable=name) for name in names])
""",
    }
    package = _package("app", files, {"share/app/conf/setup.yaml": "config/setup.yaml"})
    resolved_file = _completed((package, files))["app/launch/a.launch.py"]
    assert _named(resolved_file) == {("app", "conf/setup.yaml"), ("driver", "left"), ("driver", "right")}
    assert not resolved_file.opaque


def test_a_file_named_by_an_argument_is_read_as_its_default_only() -> None:
    files = {
        "config/setup.yaml": "executable: left\n",
        "launch/a.launch.py": """
import yaml
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

def setup(context):
    with open(LaunchConfiguration("file").perform(context)) as file:
        name = yaml.safe_load(file)["executable"]
    return [Node(package="driver", executable=name)]

def generate_launch_description():
    default = PathJoinSubstitution([FindPackageShare("app"), "config", "setup.yaml"])
    return LaunchDescription([DeclareLaunchArgument("file", default_value=default), OpaqueFunction(function=setup)])
""",
    }
    package = _package("app", files, {"share/app/config/setup.yaml": "config/setup.yaml"})
    resolved_file = _completed((package, files))["app/launch/a.launch.py"]
    nodes = [reference for reference in resolved_file.references if reference.kind == "node"]
    assert [(node.name, node.conditional) for node in nodes] == [("left", True)]


def test_items_of_a_list_file_named_by_an_argument_are_counted() -> None:
    files = {
        "config/setup.yaml": "names: [left, right]\n",
        "launch/a.launch.py": """
import os, yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def setup(context):
    with open(LaunchConfiguration("file").perform(context)) as file:
        names = yaml.safe_load(file)["names"]
    return [Node(package="driver", executable=names[i]) for i in range(len(names))]

def generate_launch_description():
    default = os.path.join(get_package_share_directory("app"), "config", "setup.yaml")
    return LaunchDescription([DeclareLaunchArgument("file", default_value=default), OpaqueFunction(function=setup)])
""",
    }
    package = _package("app", files, {"share/app/config/setup.yaml": "config/setup.yaml"})
    resolved_file = _completed((package, files))["app/launch/a.launch.py"]
    nodes = [action for action in resolved_file.actions if action.kind == "node"]
    assert [{"left", "right"} & set(node.target.texts) for node in nodes if node.target][:2] == [{"left"}, {"right"}]


def test_resolved_launch_files_are_not_interpreted_again() -> None:
    files = {
        "launch/a.launch.py": """
import rclpy
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([Node(package="driver", executable="camera")])
""",
    }
    package = _package("app", files, {})
    assert launch_modules.LaunchModules(MemoryTree({})).resolve([package]) == [package.launch]


def test_parameter_files_named_by_a_module_are_found() -> None:
    files = {
        "app/places.py": "import os\nfrom ament_index_python import get_package_share_directory\n"
        "CONFIG = os.path.join(get_package_share_directory('app'), 'config')\n",
        "app/__init__.py": "",
        "launch/a.launch.py": """
from launch import LaunchDescription
from launch_ros.actions import Node
from app.places import CONFIG

def generate_launch_description():
    return LaunchDescription([Node(package="driver", executable="a", parameters=[f"{CONFIG}/a.yaml"])])
""",
    }
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, ("app", "app.places"))
    resolved = _completed((package, files))
    (node,) = [action for action in resolved["app/launch/a.launch.py"].actions if action.kind == "node"]
    assert [(name, value.texts) for name, value in node.parameters] == [("", (share("app") + "/config/a.yaml",))]


def test_a_default_of_an_argument_from_a_module_is_determined() -> None:
    files = {
        "app/names.py": "file = 'robot.yaml'\n",
        "app/__init__.py": "",
        "launch/a.launch.py": """
from app.names import file
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument

def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("config", default_value=file)])
""",
    }
    package = _package("app", files, {"share/app/launch/a.launch.py": "launch/a.launch.py"}, ("app",))
    (argument,) = _completed((package, files))["app/launch/a.launch.py"].actions
    assert argument.value is not None
    assert argument.value.texts == ("robot.yaml",)
