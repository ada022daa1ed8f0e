"""``ros-lint explain-package P``: print the names that package P declares, uses, provides and installs."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.commands.output import document, where
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Facet

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.base.text import Span
    from ros_lint.workspace.model import Package, Workspace

_MOST_PLACES = 2


class _Row(NamedTuple):
    """A line of a section of the output: a name, a remark and a place."""

    name: str
    note: str
    span: Span


def run(workspace: Workspace, name: str, form: str = "text") -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code, which is 2 if the workspace has no package ``name``, else 0.

    ``form`` is the output format, "text" or "json".
    """
    packages = workspace.called(name)
    if not packages:
        return "", _no_such(workspace, name), 2
    if form == "json":
        return _json(workspace, packages), "", 0
    return "\n".join(_text(package) for package in packages), "", 0


_HEADINGS = {"not_analysed": "could not be analysed"}
"""Headings of the text format that differ from the keys of the JSON format."""


def _text(package: Package) -> str:
    renamed = f", {package.renamed} to colcon" if package.renamed else ""
    lines = [f"{package.name} ({package.type}{renamed}), {package.path or '.'}"]
    for title, rows in _sections(package, _MOST_PLACES):
        if not rows:
            continue
        lines += ["", f"{_HEADINGS.get(title, title)}:"]
        width = min(max(len(row.name) for row in rows), 60)
        note = max(len(row.note) for row in rows)
        lines += [f"  {row.name.ljust(width)}  {row.note.ljust(note)}  {row.span}" for row in rows]
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _sections(package: Package, most: int) -> Iterator[tuple[str, list[_Row]]]:
    """Yield the title and the rows of each section. For each used package, at most ``most`` uses are listed."""
    yield "declares", list(_declares(package))
    yield "uses", list(_uses(package, most))
    yield "provides", list(dict.fromkeys(_provides(package)))  # a script can be evaluated twice, in two folders
    yield "installs", list(_installs(package))
    yield "not_analysed", list(_hidden(package))


def _declares(package: Package) -> Iterator[_Row]:
    for declared in package.declared:
        condition = "" if declared.certain else f" if {declared.depend.condition}"
        yield _Row(declared.name, f"<{declared.depend.tag}>{condition}", declared.depend.span)
    for group in package.group_depends:
        yield _Row(group.name, "<group_depend>", group.depend.span)


def _uses(package: Package, most: int) -> Iterator[_Row]:
    """Yield a row for each of the first ``most`` uses of every used package, and a row with the number of further uses."""
    places: dict[str, list[_Row]] = {}
    for use in package.uses:
        note = f"{use.what} ({_roles(use.role)}{', optional' if use.optional else ''})"
        places.setdefault(use.package, []).append(_Row(use.package, note, use.span))
    for name in sorted(places):
        rows = places[name]
        yield from rows[:most]
        if len(rows) > most:
            yield _Row("", f"and {len(rows) - most} more, e.g.", rows[most].span)


_ROLES = ((Role.TOOL, "tool"), (Role.BUILD, "build"), (Role.EXPORT, "export"), (Role.EXEC, "run"), (Role.TEST, "test"))


def _roles(role: Role) -> str:
    return ", ".join(word for flag, word in _ROLES if role & flag)


def _provides(package: Package) -> Iterator[_Row]:
    script = package.script
    if script is None:
        return
    for target in script.products.targets:
        yield _Row(target.name, f"{target.kind} target{', test only' if target.test else ''}", target.span)
    for component in script.products.components:
        yield _Row(component.name, f"component{_conditional(component.conditional)}", component.span)
    for plugin in script.files.plugin_files:
        for library in plugin.libraries:
            for plugin_class in library.classes:
                yield _Row(plugin_class.name, f"plugin for {plugin_class.base}", plugin_class.span)
    for entry in script.products.entry_points:
        yield _Row(entry.name, f"{entry.group}: {entry.target}", entry.span)
    start = script.project.name_span or package.span
    yield from (_Row(interface, "interface", start) for interface in script.products.interfaces)
    yield from (_Row(module, "Python module", start) for module in script.products.python_packages)


def _installs(package: Package) -> Iterator[_Row]:
    for provided in sorted(package.built.products.installs, key=lambda provided: provided.path):
        built = f"built as {provided.target}" if provided.target else "generated"
        source = f"from {provided.source}" if provided.source else built
        program = ", executable" if provided.program else ""
        yield _Row(provided.path, f"{source}{program}{_conditional(provided.conditional)}", provided.span)


def _conditional(conditional: bool) -> str:
    return ", conditional" if conditional else ""


def _hidden(package: Package) -> Iterator[_Row]:
    for opaque in package.opaque:
        yield _Row(opaque.reason, f"may affect {', '.join(_facets(opaque.hides))}", opaque.span)


def _facets(flags: Facet) -> list[str]:
    return [str(facet.name).lower() for facet in Facet if flags & facet]


def _json(workspace: Workspace, packages: Iterable[Package]) -> str:
    documents = [
        {
            "name": package.name,
            "path": package.path,
            "type": package.type,
            **{
                title: [{"name": row.name, "note": row.note, **where(row.span)} for row in rows]
                for title, rows in _sections(package, len(package.uses))
            },
        }
        for package in packages
    ]
    return document({"distro": workspace.target.distro, "packages": documents})


def _no_such(workspace: Workspace, name: str) -> str:
    return f"ros-lint: the workspace has no package '{name}'{did_you_mean(similar_names(name, workspace.by_name, 2, 0.75))}\n"
