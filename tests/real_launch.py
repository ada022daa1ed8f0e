"""Run launch files with the real launch and launch_ros, and print what they start. No process is started.

A script: ``python real_launch.py PACKAGES FILE...``, where launch and launch_ros can be imported and PACKAGES is a JSON object
with the folder of each package. Packages that launch needs from ROS are replaced by modules that this script makes.
It prints a JSON object: for each file the list of what it starts, or a text with the error.
"""

from __future__ import annotations

import json
import os
import sys
import types
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any


def stand_in(name: str, **attributes: object) -> None:
    """Make a module that ``import`` finds under a dotted name, and its parents."""
    module = sys.modules.setdefault(name, types.ModuleType(name))
    module.__path__ = []
    for attribute, value in attributes.items():
        setattr(module, attribute, value)
    parent, _, last = name.rpartition(".")
    if parent:
        stand_in(parent)
        setattr(sys.modules[parent], last, module)


def grammar_folder() -> str:
    """Return the share folder of the package launch, in a source tree or below an install prefix."""
    import launch

    above = Path(launch.__file__).parents
    return str(next(folder / "share" / "launch" for folder in above if (folder / "share/launch/frontend").is_dir()))


class AnyAttribute(type):
    """The type of a class that has every attribute."""

    def __getattr__(cls, name: str) -> Any:
        return AnyType()


class AnyType(metaclass=AnyAttribute):
    """A type of rclpy or of messages: it takes and has everything."""

    def __init__(self, *args: object, **keywords: object) -> None:
        """Take anything."""

    def __getattr__(self, name: str) -> Any:
        return AnyType()


def make_ros(packages: Mapping[str, str]) -> None:
    """Make the modules of ROS that launch_ros imports."""
    errors = type("PackageNotFoundError", (KeyError,), {})

    def share(package: str, print_warning: bool = True) -> str:
        if package == "launch":
            return grammar_folder()
        if package not in packages:
            raise errors(package)
        return packages[package]

    index = {
        "PackageNotFoundError": errors,
        "get_package_share_directory": share,
        "get_package_prefix": share,
        "get_package_share_path": lambda package: Path(share(package)),
    }
    stand_in("ament_index_python", **index)
    stand_in("ament_index_python.packages", **index)
    stand_in("rclpy", init=AnyType, create_node=AnyType, Context=AnyType)
    stand_in("rclpy.validate_namespace", validate_namespace=lambda name: None)
    stand_in("rclpy.validate_node_name", validate_node_name=lambda name: None)
    stand_in("rclpy.parameter", Parameter=AnyType)
    stand_in("rclpy.logging", get_logging_directory=lambda: "/tmp")
    stand_in("rclpy.executors", SingleThreadedExecutor=AnyType)
    stand_in("rclpy.node", Node=AnyType)
    stand_in("composition_interfaces.srv", LoadNode=AnyType)
    stand_in("lifecycle_msgs.msg", Transition=AnyType, TransitionEvent=AnyType, State=AnyType)
    stand_in("lifecycle_msgs.srv", ChangeState=AnyType, GetState=AnyType)


def run(path: str) -> list[dict[str, object]]:
    """Return what a launch file starts with the defaults of its arguments, in order. Events happen before timers end."""
    import launch_xml
    import launch_yaml
    from launch import LaunchContext
    from launch.actions import ExecuteLocal, IncludeLaunchDescription, RegisterEventHandler, TimerAction
    from launch.frontend import Parser
    from launch.launch_description_sources import AnyLaunchDescriptionSource
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
    from launch.utilities.type_utils import perform_typed_substitution
    from launch_ros.actions import LoadComposableNodes, Node

    # As the entry points of launch_xml, launch_yaml and launch_ros do, which packages that are not installed do not have.
    Parser.frontend_parsers = {"xml": launch_xml.Parser, "yaml": launch_yaml.Parser}
    Parser.load_launch_extensions = classmethod(lambda parsers: None)
    started: list[dict[str, object]] = []
    context = LaunchContext()

    def text(value: object) -> str:
        return perform_substitutions(context, normalize_to_list_of_substitutions(value))

    def namespace_of(value: str) -> str:
        return "/" if value in ("", "<node_namespace_unspecified>") else value

    def name_of(value: str) -> str:
        return "" if value in ("", "<node_name_unspecified>") else value.rpartition("/")[2]

    def remappings(pairs: Iterable[tuple[Any, Any]] | None) -> list[list[str]]:
        return [[side if isinstance(side, str) else text(side) for side in pair] for pair in pairs or ()]

    def local(action: Any, context: Any) -> None:
        if isinstance(action, Node):
            started.append(
                {
                    "kind": "node",
                    "package": text(action.node_package),
                    "target": text(action.node_executable),
                    "name": name_of(action._Node__expanded_node_name),
                    "namespace": namespace_of(action.expanded_node_namespace),
                    "remappings": remappings(action.expanded_remapping_rules),
                }
            )
        else:
            started.append({"kind": "process", "words": [text(word) for word in action.process_description.cmd]})

    def load(action: Any, context: Any) -> None:
        target = action._LoadComposableNodes__target_container
        container = target.node_name if isinstance(target, Node) else text(target)
        for node in action._LoadComposableNodes__composable_node_descriptions:
            if node.condition() is not None and not node.condition().evaluate(context):
                continue
            started.append(
                {
                    "kind": "component",
                    "package": text(node.package),
                    "target": text(node.node_plugin),
                    "name": text(node.node_name) if node.node_name else "",
                    "container": container,
                }
            )

    ExecuteLocal.execute = local
    LoadComposableNodes.execute = load
    delayed: list[tuple[float, Callable[[], Iterable[Any]]]] = []
    now = 0.0

    def start_timer(action: Any, context: Any) -> None:
        action._TimerAction__context_locals = dict(context.get_locals_as_dict())
        action._TimerAction__context_environment = dict(context.environment)
        action._TimerAction__context_launch_configuration = dict(context.launch_configurations)
        delayed.append((now + perform_typed_substitution(context, action.period, float), lambda: action.handle(context)))

    def register(action: Any, context: Any) -> None:
        delayed.append((now, lambda: action.event_handler.describe()[1]))

    TimerAction.execute = start_timer
    RegisterEventHandler.execute = register

    def walk(entity: Any) -> None:
        for child in entity.visit(context) or ():
            walk(child)

    walk(IncludeLaunchDescription(AnyLaunchDescriptionSource(path)))
    while delayed:
        delayed.sort(key=lambda pair: pair[0])
        now, entities = delayed.pop(0)
        for entity in entities():
            walk(entity)
    return started


def main(packages: Mapping[str, str], paths: Iterable[str]) -> None:
    """Run launch files, each in a process of its own, and print what they start."""
    make_ros(packages)
    print(json.dumps({path: _apart(lambda path=path: run(path)) for path in paths}, indent=1))


def _apart(work: Callable[[], object]) -> object:
    """Return what a function returns in a process of its own, or a text with its error."""
    reader, writer = os.pipe()
    process = os.fork()
    if not process:
        try:
            answer: object = work()
        except BaseException as error:  # a launch file may raise anything
            answer = f"{type(error).__name__}: {error}"
        with open(writer, "w", encoding="utf-8") as stream:
            json.dump(answer, stream)
        os._exit(0)
    os.close(writer)
    with open(reader, encoding="utf-8") as stream:
        answer = json.load(stream)
    os.waitpid(process, 0)
    return answer


if __name__ == "__main__":
    main(json.loads(sys.argv[1]), sys.argv[2:])
