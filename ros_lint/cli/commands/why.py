"""``ros-lint why A B``: print the paths by which package A depends on B, with the manifest line of each edge, or as JSON."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.analysis.dependencies.explain import used_in
from ros_lint.analysis.graph.dependency_graph import dependency_graph
from ros_lint.base.graph_paths import GraphPaths, paths
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.commands.output import document, where
from ros_lint.facts.manifest import DEPENDENCY_KINDS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.analysis.graph.dependency_graph import Reason
    from ros_lint.base.text import Span
    from ros_lint.workspace.model import Declared, Package, Workspace

_TAGS = {tag: DEPENDENCY_KINDS[tag].letters for tag in ("build_export_depend", "buildtool_export_depend", "exec_depend")}
"""Letters of the tags whose dependencies a released package passes on to its dependents."""

_MOST_USES = 2


class _EdgeReason(NamedTuple):
    """A dependency tag because of which one package depends on another."""

    tag: str
    place: str
    condition: str = ""


def run(workspace: Workspace, start: str, end: str, form: str = "text", most: int = 10) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code. ``form`` is the output format, "text" or "json".

    These dependencies are followed:

    - of the package ``start``: all that affect the build order,
    - of other packages of the workspace: all that affect the build order, except for test dependencies,
    - of packages outside of the workspace: run-time dependencies.

    At most ``most`` paths are printed, the shortest first. The code is 0 if there is a path, 1 if there is none, 2 if a
    name is unknown. Raises KnowledgeError.
    """
    unknown = [name for name in (start, end) if not _is_known(workspace, name)]
    if unknown:
        return "", "".join(_no_such(workspace, name) for name in unknown), 2
    model = _DependencyModel(workspace, start)
    result = paths(model.needs, start, end, most)
    code = 0 if result.paths else 1
    if form == "json":
        return _json(model, result, start, end), "", code
    lines = _path_lines(model, result, start, end) if result.paths else _no_path(workspace, start, end)
    return "".join(f"{line}\n" for line in lines), "", code


def _no_path(workspace: Workspace, start: str, end: str) -> Iterator[str]:
    """Yield the lines for a package ``start`` that does not depend on ``end``."""
    depends_back = bool(paths(_DependencyModel(workspace, end).needs, end, start, 1).paths)
    back = f"'{end}' depends on '{start}': see 'ros-lint why {end} {start}'" if depends_back else ""
    uses = [use for package in workspace.called(start) for use in package.uses if end in use.providers]
    if uses:
        hint = f" ({back})" if back else ""
        yield f"'{start}' uses '{end}', but declares neither it nor anything that depends on it{hint}:"
        yield from (f"   {line}" for line in used_in(uses))
    else:
        yield f"'{start}' does not depend on '{end}'{f'; but {back}' if back else ''}"


def _json(model: _DependencyModel, result: GraphPaths, start: str, end: str) -> str:
    """Return the JSON format. ``uses`` are the places in the sources of ``start`` that use ``end``."""
    return document(
        {
            "distro": model.workspace.target.distro,
            "package": start,
            "dependency": end,
            "paths": [[_json_edge(model, *edge) for edge in pairwise(path)] for path in result.paths],
            "more_paths": result.more,
            "uses": _json_uses(model, start, end),
        }
    )


def _json_edge(model: _DependencyModel, name: str, dependency: str) -> dict[str, Any]:
    reasons = [
        {"tag": reason.tag, "condition": reason.condition, "place": reason.place} for reason in model.reasons(name, dependency)
    ]
    return {"package": name, "dependency": dependency, "reasons": reasons, "uses": _json_uses(model, name, dependency)}


def _json_uses(model: _DependencyModel, name: str, dependency: str) -> list[dict[str, Any]]:
    return [{"what": what, **where(span)} for what, span in model.uses(name, dependency)]


class _DependencyModel:
    """The dependencies of packages in the workspace and outside of it. Test dependencies count only for the package ``start``."""

    def __init__(self, workspace: Workspace, start: str) -> None:
        self._start = start
        self.workspace = workspace
        self._needs: dict[str, tuple[str, ...]] = {}

    def needs(self, name: str) -> tuple[str, ...]:
        """Return the names that a package depends on directly, sorted."""
        if name not in self._needs:
            needs = dependency_graph(self.workspace).needs.get(name, {})
            names = {dependency for dependency, reasons in needs.items() if any(self._counts(name, entry) for entry in reasons)}
            names.update(declared.name for declared in self._declared(name))
            if not self._packages(name):
                names.update(self.workspace.world.depends(name, _TAGS.values()) or ())
            self._needs[name] = tuple(sorted(names))
        return self._needs[name]

    def reasons(self, name: str, dependency: str) -> Iterator[_EdgeReason]:
        """Yield the dependency tags because of which ``name`` depends directly on ``dependency``."""
        graph = dependency_graph(self.workspace)
        if dependency in graph.needs.get(name, ()):
            for reason in graph.reasons((name, dependency)):
                if self._counts(name, reason):
                    yield _EdgeReason(reason.tag, str(reason.span), "" if reason.certain else "if its condition is true")
            return
        for declared in self._declared(name):
            if declared.name == dependency:
                condition = "" if declared.certain else f"if {declared.depend.condition}"
                yield _EdgeReason(declared.depend.tag, str(declared.depend.span), condition)
        if not self._packages(name):
            world = self.workspace.world
            tags = [tag for tag, kind in _TAGS.items() if dependency in (world.depends(name, kind) or ())]
            layer = world.layer(name)
            place = f"as released in {self.workspace.target.distro}" if layer == "index" else f"in the {layer}"
            yield from (_EdgeReason(tag, place) for tag in tags)

    def uses(self, name: str, dependency: str) -> list[tuple[str, Span]]:
        """Return the uses of ``dependency`` in the sources of the package ``name``, each as quotation and place, sorted."""
        places = {use.span: use.what for package in self._packages(name) for use in package.uses if dependency in use.providers}
        return [(places[span], span) for span in sorted(places)]

    def _counts(self, name: str, reason: Reason) -> bool:
        """Return whether a dependency of the package ``name`` can be part of a path.

        A test dependency can only be the first edge of a path.
        """
        return name == self._start or reason.categories != ("test",)

    def _declared(self, name: str) -> Iterator[Declared]:
        for package in self._packages(name):
            if package.type.startswith("ros."):  # colcon ignores the manifest of other types
                for declared in package.declared:
                    if name == self._start or declared.depend.tag != "test_depend":
                        yield declared

    def _packages(self, name: str) -> Sequence[Package]:
        return self.workspace.called(name)


def _path_lines(model: _DependencyModel, result: GraphPaths, start: str, end: str) -> Iterator[str]:
    count = f"{'at least ' if result.more else ''}{len(result.paths)} path{'s' if len(result.paths) > 1 else ''}"
    yield f"'{start}' depends on '{end}' through {count}{'; shortest first' if len(result.paths) > 1 else ''}:"
    printed: set[tuple[str, str]] = set()
    for number, path in enumerate(result.paths, 1):
        yield ""
        yield f"{number}. {' -> '.join(path)}"
        for edge in pairwise(path):
            yield from _edge_lines(model, edge, again=edge in printed)
            printed.add(edge)


def _edge_lines(model: _DependencyModel, edge: tuple[str, str], *, again: bool) -> Iterator[str]:
    name, dependency = edge
    for line in model.reasons(name, dependency):
        condition = f" {line.condition}" if line.condition else ""
        yield f"   {name} -> {dependency}: {_tag(line.tag)}{condition} {line.place}"
    uses = [] if again else model.uses(name, dependency)
    for what, span in uses[:_MOST_USES]:
        yield f"      because of {what} {span}"
    if len(uses) > _MOST_USES:
        yield f"      and {len(uses) - _MOST_USES} more"


def _tag(tag: str) -> str:
    return tag if "." in tag else f"<{tag}>"


def _is_known(workspace: Workspace, name: str) -> bool:
    if workspace.called(name) or workspace.world.is_package(name) or workspace.world.is_key(name):
        return True
    return any(package.tags(name) for package in workspace.packages)


def _no_such(workspace: Workspace, name: str) -> str:
    near = [*similar_names(name, workspace.by_name, 2, 0.75), *workspace.world.suggest(name)]
    return f"ros-lint: unknown package or rosdep key '{name}'{did_you_mean(list(dict.fromkeys(near[:3])))}\n"
