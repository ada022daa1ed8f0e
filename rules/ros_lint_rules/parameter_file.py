"""
## What it finds

A YAML file that a launch file gives to nodes as parameters, although it has none for any of them: it has no
`ros__parameters` at all, or only those of other nodes.

## Why it matters

Without `ros__parameters` the node stops: `Cannot have a value before ros__parameters`. With the name of another node, or
without the namespace, the node starts and has its defaults, silently.

## How to fix it

A parameter file has the full name of the node, `ros__parameters`, and then the parameters; `/**` stands for any node:

    /robot/driver:
      ros__parameters:
        rate: 10.0

## Limitations

- Which file is given, or what the node is called, is not known from the launch file, even with the defaults of its arguments.
- The file is installed by no package of the workspace, or rewritten before it is given.
- One of several nodes that the launch file gives it to is among those in the file; or the file has parameters of several
  nodes, and another launch file gives it to one of them.
- A file of the workspace cannot be read, and this one has parameters of other nodes: who gets it may stand there.
- Containers, whose components take what is for them. A component also takes a file that has nothing but its parameters.
- The name fits, and the namespace may come from a launch file that includes this one.
- Launch files of tests and examples.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Finding,
    Given,
    Package,
    ParameterFiles,
    Related,
    Rule,
    Severity,
    Workspace,
    few,
    is_plain,
    launchable,
    renames,
    several,
)


def check(workspace: Workspace) -> Iterator[Finding]:
    files = ParameterFiles(workspace)
    places: list[tuple[Package, list[Given]]] = []
    taken: set[str] = set()
    for package in workspace.packages:
        for launch in launchable(package):
            rewrites = any(_rewrites(name) for name, _ in launch.file.imports)
            by_file: dict[str, list[Given]] = {}
            for given in files.given(launch.file):
                by_file.setdefault(given.file.path, []).append(given)
            for path, together in by_file.items():
                if together[0].file.nodes and any(_may_be_of(given, rewrites) for given in together):
                    taken.add(path)
                else:
                    places.append((package, together))
    for package, together in places:
        file = together[0].file
        if not file.nodes:
            yield from (one._replace(package=package.name) for one in _flat(together))
        elif not workspace.unread() and (file.path not in taken or len({name for name, _ in file.nodes}) == 1):
            yield _of_others(together)._replace(package=package.name)


def _rewrites(module: str) -> bool:
    """Whether a module can put a file below the namespace of its nodes: that of nav2_common, or a copy of it."""
    return module.startswith("nav2_common") or module.rpartition(".")[2] == "rewritten_yaml"


def _flat(together: list[Given]) -> Iterator[Finding]:
    nodes = [given for given in together if given.action.kind == "node"]
    if nodes:
        yield Finding(
            f"{_name(nodes[0])} is no parameter file, since it has no ros__parameters: the node stops; put them below that word",
            nodes[0].value.span,
            nodes[0].file.path,
            (Related("the file", nodes[0].file.first), *_more(nodes)),
            severity=Severity.ERROR,
        )


def _of_others(together: list[Given]) -> Finding:
    first = together[0]
    names = few(dict.fromkeys(name for name, _ in first.file.nodes))
    return Finding(
        f"{_name(first)} has parameters of {names}, and none of {_full_name(first)}, which gets it here; "
        "correct the name, or write /**",
        first.value.span,
        first.file.path,
        (Related("the file", first.file.nodes[0][1]), *_more(together)),
    )


def _more(together: list[Given]) -> tuple[Related, ...]:
    return several(Related("given again here", given.value.span) for given in together[1:])


def _name(given: Given) -> str:
    return given.file.path.rpartition("/")[2]


def _full_name(given: Given) -> str:
    namespace = given.namespaces[0].strip("/")
    return f"/{namespace}/{given.names[0]}" if namespace else f"/{given.names[0]}"


def _may_be_of(given: Given, rewrites: bool) -> bool:
    """Whether a file may have parameters of the node that it is given to (``rclcpp::parameter_map_from``)."""
    words = (text for _, value in given.action.arguments for text in value.texts)
    if given.action.children or _is_container(given) or any(map(renames, words)):
        return True
    if len(given.names) != 1 or not given.names[0] or not is_plain(given.names[0]):
        return True
    same = [name for name, _ in given.file.nodes if name.rpartition("/")[2] in (given.names[0], "*", "**")]
    if not same:
        return False
    if rewrites or len(given.namespaces) != 1 or not is_plain(given.namespaces[0]) or not given.namespaces[0].strip("/"):
        return True
    # Only a name without any namespace is surely that of another node.
    return any("*" in name or name.count("/") > 1 for name in same)


def _is_container(given: Given) -> bool:
    """Whether a node is a container: what it is given on its command line holds for all components that it loads."""
    package = given.action.package
    return package is not None and "rclcpp_components" in package.texts


RULE = Rule(
    name="parameter-file",
    code="ROS511",
    summary="a parameter file must have parameters of the node that it is given to",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
