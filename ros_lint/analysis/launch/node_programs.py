"""The code of the programs and components that launch files start, to compare it with parameter files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ros_lint.analysis.build.commands import evaluated_name
from ros_lint.analysis.build.targets import stem
from ros_lint.analysis.launch.described_parameters import described_parameters
from ros_lint.analysis.memo import cached_by_package
from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.launch import LaunchAction
from ros_lint.facts.sources import DeclaredParameter, NodeCode
from ros_lint.workspace.model import Package, Workspace


class NodeProgram(NamedTuple):
    """A program or component of the workspace."""

    package: Package
    """The package that builds it."""
    code: tuple[NodeCode, ...]
    """Its own files that contain nodes or parameters: its sources and their headers, without linked libraries."""

    @property
    def name(self) -> str:
        """The name that the code gives to its node, "" if there is none or if there are several."""
        names = {name for code in self.code for name in code.names}
        return next(iter(names)) if len(names) == 1 else ""

    @property
    def declared(self) -> Mapping[str, DeclaredParameter]:
        """The parameters that the code declares, by name. Parameters with different types are left out."""
        result: dict[str, DeclaredParameter] = {}
        refused: set[str] = set()
        for parameter in (parameter for code in self.code for parameter in code.declared):
            if result.setdefault(parameter.name, parameter).type != parameter.type:
                refused.add(parameter.name)
        return {name: parameter for name, parameter in result.items() if name not in refused}


def started_program(action: LaunchAction, workspace: Workspace) -> NodeProgram | None:
    """Return the program or component that an action starts.

    The result is None if it is unknown, is not in the workspace, or does not create exactly one node with a literal name.
    """
    package, target = action.package, action.target
    if package is None or target is None or len(package.texts) != 1 or len(target.texts) != 1:
        return None
    program = node_program(workspace, package.texts[0], target.texts[0])
    return program if program is not None and program.name else None


def node_program(workspace: Workspace, package: str, target: str) -> NodeProgram | None:
    """Return the program or component ``target`` of a package, None if it or its code is not in the workspace.

    ``target`` is the name of an executable, or of a class.
    """
    owners = workspace.by_name.get(package, ())
    return _programs(owners[0], workspace).get(target) if len(owners) == 1 else None


def node_name(workspace: Workspace, package: str, target: str) -> str:
    """Return the name that a program or component of the workspace gives to its node, "" if it is unknown.

    If the sources of a program name no node, a library of the same package that it links may name exactly one.
    """
    owners = workspace.by_name.get(package, ())
    if len(owners) != 1:
        return ""
    program = _programs(owners[0], workspace).get(target)
    if program is not None and any(code.names for code in program.code):
        return program.name
    return _names_in_libraries(owners[0], workspace).get(target, "")


@cached_by_package
def _names_in_libraries(package: Package, _: Workspace) -> Mapping[str, str]:
    """Return the node names in the libraries of a package, by the programs that link them. A program has one node name."""
    names = {package.relative(code.path): code.names for code in package.node_code if code.names}
    products = package.built.products
    targets = {target.name: target for target in products.targets}
    result: dict[str, str] = {}
    for provided in products.installs if names else ():
        program = provided.path.removeprefix(f"lib/{package.name}/")
        target = targets.get(provided.target)
        if program == provided.path or "/" in program or target is None:
            continue
        libraries = [targets[name] for name, _ in target.links if name in targets]
        found = {name for library in libraries for source in library.sources for name in names.get(source, ())}
        if len(found) == 1:
            result[program] = next(iter(found))
    return result


@cached_by_package
def _programs(package: Package, workspace: Workspace) -> Mapping[str, NodeProgram]:
    """Return the programs and components of a package by name."""
    if not package.node_code:
        return {}
    by_path = {package.relative(code.path): code for code in package.node_code}
    result: dict[str, NodeProgram] = {}
    described = described_parameters(package, workspace)
    for name, sources in _sources(package):
        stems = {stem(source) for source in sources}
        headers = [path for path in by_path if path.endswith(HEADERS) and stem(path) in stems]
        files = [*sources, *headers, *described.of_sources(sources)]
        code = tuple([by_path[path] for path in dict.fromkeys(files) if path in by_path])
        if code:
            result.setdefault(name, NodeProgram(package, code))
    for name, component in _component_programs(package):
        if component in result:
            result[name] = result[component]
    return result


def _sources(package: Package) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the programs and component classes of a package with their source files, relative to the package."""
    products = package.built.products
    targets = {target.name: target for target in products.targets if target.kind == "executable"}
    for provided in products.installs:
        name = provided.path.removeprefix(f"lib/{package.name}/")
        if name == provided.path or "/" in name:
            continue
        if provided.target in targets and targets[provided.target].sources_known:
            yield name, targets[provided.target].sources
        elif provided.source.endswith(".py"):
            yield name, (provided.source,)
    modules = {module.name: module.path for module in package.built.python.entry_point_modules}
    for entry in products.entry_points:
        if entry.group == "console_scripts" and entry.module in modules:
            yield entry.name, (modules[entry.module],)
    for registration in package.registrations:
        if registration.kind == "component":
            yield registration.name, (package.relative(registration.span.path),)


def _component_programs(package: Package) -> Iterator[tuple[str, str]]:
    """Yield each executable that runs one component, with the class (``rclcpp_components_register_node``)."""
    for call in package.calls("rclcpp_components_register_node", anywhere=True):
        options = dict(zip(call.texts, call.texts[1:], strict=False))
        plugin, name = (evaluated_name(package, options.get(option, "")) for option in ("PLUGIN", "EXECUTABLE"))
        if plugin and name:
            yield name, plugin.removeprefix("::")


@cached_by_package
def is_closed(package: Package, workspace: Workspace) -> bool:
    """Return whether all code that declares parameters in the nodes of a package is known."""
    packages = _with_used(package, workspace)
    return (
        all(described_parameters(owner, workspace).known for owner in packages)
        and all(code.complete for owner in packages for code in owner.node_code)
        and all(
            _is_passive(use.package) or use.package in workspace.by_name
            for owner in packages
            for use in owner.uses
            if use.via in ("include", "import", "symbol")
        )
    )


@cached_by_package
def words_of(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return the string literals in the code of a package and of the packages of the workspace that it uses."""
    return frozenset(word for owner in _with_used(package, workspace) for code in owner.node_code for word in code.words)


@cached_by_package
def topics_of(package: Package, workspace: Workspace) -> frozenset[str] | None:
    """Return the topics, services and actions that the code of a package creates, with those of packages that it uses.

    The result is None if they are not all known.
    """
    if not is_closed(package, workspace):
        return None
    codes = [code for owner in _with_used(package, workspace) for code in owner.node_code]
    known = [code.topics for code in codes if code.topics is not None]
    return frozenset(topic for topics in known for topic in topics) if len(known) == len(codes) else None


@cached_by_package
def _with_used(package: Package, workspace: Workspace) -> tuple[Package, ...]:
    """Return a package and the packages of the workspace that its code uses, directly or not."""
    seen: dict[str, tuple[Package, ...]] = {package.name: (package,)}
    waiting = [package]
    while waiting:
        for name in {use.package: None for use in waiting.pop().uses}:
            if name not in seen:
                seen[name] = workspace.by_name.get(name, ())
                waiting += seen[name]
    return tuple([other for packages in seen.values() for other in packages])


_PASSIVE = frozenset({
    "ament_index_cpp", "ament_index_python", "angles", "builtin_interfaces", "cv_bridge", "eigen", "eigen3_cmake_module",
    "generate_parameter_library", "generate_parameter_library_py", "geometry_msgs", "image_geometry", "kdl_parser", "launch",
    "launch_ros", "libopencv-dev", "message_filters", "orocos_kdl",
    "pcl_conversions", "python3-numpy", "python3-opencv", "rclcpp", "rclcpp_action", "rclcpp_components", "rclcpp_lifecycle",
    "rclpy", "rcl_interfaces", "rcpputils", "rcutils", "rosidl_runtime_cpp", "tf2", "tf2_eigen", "tf2_geometry_msgs", "tf2_kdl",
    "tf2_ros", "tf2_sensor_msgs", "tf_transformations", "urdf", "yaml_cpp_vendor", "yaml-cpp",
})  # fmt: skip
"""Released packages and rosdep keys that declare no parameters in the nodes that use them."""
_PASSIVE_ENDINGS = ("_msgs", "_srvs", "_interfaces", "_actions", "_msg", "_srv", "_action")


def _is_passive(name: str) -> bool:
    return name in _PASSIVE or name.endswith(_PASSIVE_ENDINGS) or name.startswith(("python3-", "lib"))
