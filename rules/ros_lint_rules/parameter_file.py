"""
## What it finds

- A YAML file that a launch file passes to nodes as a parameter file, although it has no parameters for any of these nodes: it
  has no `ros__parameters` at all, or only those of other nodes.
- A parameter file that rcl refuses: aliases (`*name`), parameters without a value, lists with elements of several types, values
  outside of `ros__parameters`, invalid node names, and text that is no YAML.
- A parameter whose type differs from the type that the node declares, as `rate: 10` for `declare_parameter("rate", 10.0)`.
- With medium confidence: a parameter that the node does not declare, and parameters of a node that no launch file and no
  program of the workspace names.

## Why it matters

A file without `ros__parameters`, a file that rcl refuses and a value of a wrong type stop the node: `Cannot have a value before
ros__parameters`, `parameter 'rate' has invalid type`. With the name of another node, without the namespace, or with an
undeclared parameter, the node starts with its default values and prints no warning.

## How to fix it

Write the full name of the node, `ros__parameters`, and then the parameters; `/**` matches any node:

    /robot/driver:
      ros__parameters:
        rate: 10.0

## Limitations

Not reported:

- File names and node names that the launch file does not determine, even with the defaults of its arguments.
- Files that no package of the workspace installs, and files that are rewritten, as by `RewrittenYaml`.
- A file with parameters for one of the nodes to which the launch file passes it.
- A file with parameters of other nodes, if the node also receives a file with its own: the process may have several nodes.
- A file that the launch file also passes to an included launch file, because that file may pass it to the right node.
- A file with parameters of several nodes, if another launch file passes it to one of them.
- A file with parameters of other nodes, if a file of the workspace cannot be read: that file may pass it to the right node.
- Containers, because their components read the parameters. Components also accept a file without `ros__parameters`.
- A name that matches without a namespace, if a launch file that includes this one may set the namespace.
- Launch files of tests and examples.
- Types: declarations in libraries that the node links, declarations with a computed name or default, declarations in code with
  `dynamic_typing`, and values that the launch file, another name in the file or a later parameter file may override.
- Undeclared parameters and unknown nodes: nodes whose code is not in the workspace, uses libraries that may declare parameters,
  or computes names of parameters.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Span, Workspace, first_related, launch, names


def check(workspace: Workspace) -> Iterator[Finding]:
    unmatched: list[tuple[Package, list[launch.NodeParameterFile]]] = []
    used: set[str] = set()
    unchanged: dict[str, list[launch.NodeParameterFile]] = {}
    all_uses: dict[str, list[launch.NodeParameterFile]] = {}
    for package in workspace.packages:
        for launch_file in launch.package_launch_files(package):
            rewrites = any(_rewrites(name) for name, _ in launch_file.file.imports)
            by_file: dict[str, list[launch.NodeParameterFile]] = {}
            served: set[Span] = set()
            for passed in launch.given_parameter_files(launch_file.file, workspace):
                by_file.setdefault(passed.file.path, []).append(passed)
                if passed.file.nodes and _may_be_of(passed, rewrites):
                    served.add(passed.action.span)
            passed_on = launch.parameter_files_passed_on(launch_file.file, workspace) if by_file else frozenset()
            for path, uses in by_file.items():
                all_uses.setdefault(path, []).extend(uses)
                if not rewrites:
                    unchanged.setdefault(path, []).extend(use for use in uses if not use.value.changes)
                if uses[0].file.nodes and (any(passed.action.span in served for passed in uses) or path in passed_on):
                    used.add(path)
                else:
                    unmatched.append((package, uses))
    for package, uses in unmatched:
        file = uses[0].file
        if not file.nodes:
            yield from (finding._replace(package=package.name) for finding in _flat(uses))
        elif not workspace.unread() and (file.path not in used or len({name for name, _ in file.nodes}) == 1):
            yield _of_others(uses)._replace(package=package.name)
    for path, uses in unchanged.items():
        containing = workspace.owner(path)
        owner = containing.name if containing is not None else ""
        for finding in (*_refused(uses), *_of_wrong_type(uses, workspace)):
            yield finding._replace(package=owner)
        if not workspace.unread() and len(uses) == len(all_uses[path]):
            for finding in (*_undeclared(uses, workspace), *_without_node(uses, workspace)):
                yield finding._replace(package=owner)


def _refused(uses: list[launch.NodeParameterFile]) -> Iterator[Finding]:
    """Yield the first reason why rcl refuses a file. Components read it with another library."""
    nodes = [passed for passed in uses if passed.action.kind == "node"]
    if nodes and nodes[0].file.nodes and (refusals := nodes[0].file.refusals):
        first = refusals[0]
        yield Finding(
            f"{first.message}, so the node that reads this file stops{_REMEDIES[first.kind]}",
            first.span,
            nodes[0].file.path,
            (Related("a launch file passes the file to a node here", nodes[0].value.span),),
            severity=Severity.ERROR,
        )


_REMEDIES = {
    "alias": "; repeat the value in place of the alias, because rcl supports no aliases",
    "bad-name": "; correct the name",
    "mixed-list": "; write all elements with the same type",
    "no-value": "; add it, or remove the name",
    "syntax": "",
    "value-outside": "; move it below a node name and ros__parameters",
}
"""The ends of messages by the kind of a refusal (``collectors.resources.parameter_values``)."""


def _of_wrong_type(uses: list[launch.NodeParameterFile], workspace: Workspace) -> Iterator[Finding]:
    seen: set[Span] = set()
    for wrong in launch.wrong_types(uses, workspace):
        if wrong.parameter.span in seen:
            continue
        seen.add(wrong.parameter.span)
        yield Finding(
            f"'{wrong.parameter.name}' is {_with_article(wrong.parameter.type)} here, but the node '{wrong.node}' declares it as "
            f"{_with_article(wrong.declared.type)}, so the node stops; write a value of this type",
            wrong.parameter.span,
            wrong.parameter.name,
            (
                Related("the parameter is declared here", wrong.declared.span),
                Related("a launch file passes the file to the node here", wrong.passed.value.span),
            ),
            severity=Severity.ERROR,
        )


def _with_article(kind: str) -> str:
    noun = kind.replace("_array", " array").replace("bool", "boolean")
    return f"an {noun}" if noun.startswith("i") else f"a {noun}"


def _undeclared(uses: list[launch.NodeParameterFile], workspace: Workspace) -> Iterator[Finding]:
    for found in launch.undeclared(uses, workspace):
        hint = f"; did you mean '{found.meant}'?" if found.meant else ", so it has no effect; remove or correct it"
        yield Finding(
            f"the node '{found.node}' declares no parameter '{found.parameter.name}'{hint}",
            found.parameter.span,
            found.parameter.name,
            (Related("a launch file passes the file to the node here", found.passed.value.span),),
            confidence=Confidence.MEDIUM,
        )


def _without_node(uses: list[launch.NodeParameterFile], workspace: Workspace) -> Iterator[Finding]:
    places = dict(uses[0].file.nodes)
    for name in launch.unmatched_nodes(uses, workspace):
        yield Finding(
            f"no node of the workspace is called '{name}', so these parameters have no effect; remove them, or correct the name",
            places[name],
            name,
            confidence=Confidence.MEDIUM,
        )


def _rewrites(module: str) -> bool:
    """Return whether a Python module provides RewrittenYaml (nav2_common), a class that adds a namespace to parameter files."""
    return module.startswith("nav2_common") or module.rpartition(".")[2] == "rewritten_yaml"


def _flat(uses: list[launch.NodeParameterFile]) -> Iterator[Finding]:
    nodes = [passed for passed in uses if passed.action.kind == "node"]
    if nodes:
        yield Finding(
            f"'{_name(nodes[0])}' has no ros__parameters, so the node stops; write the parameters below the node name and "
            "ros__parameters",
            nodes[0].value.span,
            nodes[0].file.path,
            (Related(f"the parameter file '{_name(nodes[0])}'", nodes[0].file.first), *_more(nodes)),
            severity=Severity.ERROR,
        )


def _of_others(uses: list[launch.NodeParameterFile]) -> Finding:
    first = uses[0]
    all_names = names.shorten_list(dict.fromkeys(name for name, _ in first.file.nodes))
    return Finding(
        f"'{_name(first)}' has parameters for {all_names}, but none for the node '{_full_name(first)}', which receives it here; "
        "correct the name of the node in the file, or write /** instead",
        first.value.span,
        first.file.path,
        (Related(f"the parameter file '{_name(first)}'", first.file.nodes[0][1]), *_more(uses)),
    )


def _more(uses: list[launch.NodeParameterFile]) -> tuple[Related, ...]:
    return first_related(Related(f"'{_name(passed)}' is also passed here", passed.value.span) for passed in uses[1:])


def _name(passed: launch.NodeParameterFile) -> str:
    return passed.file.path.rpartition("/")[2]


def _full_name(passed: launch.NodeParameterFile) -> str:
    namespace = passed.namespaces[0].strip("/")
    return f"/{namespace}/{passed.names[0]}" if namespace else f"/{passed.names[0]}"


def _may_be_of(passed: launch.NodeParameterFile, rewrites: bool) -> bool:
    """Return whether a file may have parameters for the node that receives it (``rclcpp::parameter_map_from``).

    ``rewrites`` is True if the launch file imports a module that may change the contents of parameter files.
    """
    words = (text for _, value in passed.action.arguments for text in value.texts)
    if passed.action.children or _is_container(passed) or any(map(launch.is_node_renaming, words)):
        return True
    if len(passed.names) != 1 or not passed.names[0] or not launch.is_plain(passed.names[0]):
        return True
    same = [name for name, _ in passed.file.nodes if name.rpartition("/")[2] in (passed.names[0], "*", "**")]
    if not same:
        return False
    if (
        rewrites
        or len(passed.namespaces) != 1
        or not launch.is_plain(passed.namespaces[0])
        or not passed.namespaces[0].strip("/")
    ):
        return True
    # A name without a namespace never matches a node in one; a name with a namespace or "*" may.
    return any("*" in name or name.count("/") > 1 for name in same)


def _is_container(passed: launch.NodeParameterFile) -> bool:
    """Return whether a node is a component container, whose parameter files apply to all components that it loads."""
    package = passed.action.package
    return package is not None and "rclcpp_components" in package.texts


RULE = Rule(
    name="parameter-file",
    code="ROS511",
    summary="parameter files fit the nodes that receive them",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
