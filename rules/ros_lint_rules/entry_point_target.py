"""
## What it finds

Entry points that cannot work: the module does not exist in the package, it has no such function, the target ends with `()`,
it has no `:function`, or two entries are glued to one because a comma is missing between them. And two programs of one name.

## Why it matters

The build succeeds. The program is installed and stops when it is started, with ModuleNotFoundError or ImportError; of two
glued entries neither is there. For two programs of one name setuptools stops the build: "Duplicate entry point".

## How to fix it

Write `name = package.module:function` with names that exist. Where one module or function has nearly the same name, or the
file has one that Python cannot import (`my-node.py`), the message says so. The fix takes away the `()`, and writes the
missing comma.

## Limitations

- For modules of other packages, but where this package has just that module under its own name, and where one of the
  workspace that has that name for sure has no such module.
- For modules that import `*`, define `__getattr__`, or cannot be read: they may have any name.
- For modules that are made during the build, and for those that are not there where a file of the package cannot be read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from ros_lint.api import (
    BuildScript,
    Edit,
    EntryPoint,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    is_meant,
    place_of,
    similar,
)

_GLUED = re.compile(r"[:=].*=")
_TARGET = re.compile(r"\s*([\w.]+)\s*(?::\s*([\w.]+)\s*)?(?:\[.*\])?\s*\Z")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None:
        return
    for entry in script.entry_points:
        target = _TARGET.match(entry.target)
        if target is None:
            yield _malformed(script, entry)
        else:
            yield from _lacking(package, script, entry, target[1], target[2], workspace)
    yield from _doubled(script)
    for problem in script.problems:
        if problem.kind == "entry-point-form":
            yield Finding(problem.message, problem.span, problem.subject)


def _doubled(script: BuildScript) -> Iterator[Finding]:
    """Speak of programs that are there twice in every build."""
    always = {(p.path.rpartition("/")[2], p.span) for p in script.provides if p.program and not p.conditional}
    first: dict[tuple[str, str], EntryPoint] = {}
    for entry in script.entry_points:
        if (entry.name, entry.span) not in always:
            continue
        other = first.setdefault((entry.group, entry.name), entry)
        if other.span != entry.span:
            way_out = "take one out" if other.target == entry.target else "give one another name"
            message = f"there is {entry.name} = {other.target} already, and setuptools stops at a second {entry.name}: {way_out}"
            yield Finding(message, entry.span, entry.name, (Related("the other one", other.span),))


def _malformed(script: BuildScript, entry: EntryPoint) -> Finding:
    if _GLUED.search(entry.target):
        message = f"two entries are glued to one: {entry.name} = {entry.target}; is a comma missing between them?"
        gaps = [Edit(text.span, ",") for text in script.texts if text.kind == "gap" and entry.span.covers(text.span)]
        return Finding(message, entry.span, entry.name, fix=Fix.of("write a comma between them", *gaps))
    if entry.target.rstrip().endswith("()"):
        message = f"the target of {entry.name} ends with (); write {entry.target.rstrip()[:-2]}"
        return Finding(message, entry.span, entry.name, fix=_without_call(entry))
    return Finding(f"{entry.name} = {entry.target} is not of the form name = module:function", entry.span, entry.name)


def _lacking(
    package: Package, script: BuildScript, entry: EntryPoint, name: str, attribute: str | None, workspace: Workspace
) -> Iterator[Finding]:
    """Speak of the module of an entry, by its ``name``, and of the ``attribute`` in it, if one of them is not there."""
    runs = entry.group in ("console_scripts", "gui_scripts")
    module = next((module for module in script.modules if module.name == name), None)
    if attribute is None:
        missing = list(_no_module(package, entry, name, "main", workspace)) if runs and module is None else []
        if missing:
            yield missing[0]._replace(fix=None)  # a module that exists is not all that the entry lacks
        elif runs:
            way_out = f"write {name}:main"
            if module is not None and not module.open and "main" not in module.names:
                way_out = f"{module.path} has no main, so define one there and {way_out}, or take the entry point out"
            yield Finding(f"{entry.name} names a module and no function; {way_out}", entry.span, entry.name)
        return
    if module is None:
        yield from _no_module(package, entry, name, attribute, workspace)
        return
    first = attribute.partition(".")[0]
    if not module.open and first not in module.names and f"{name}.{first}" not in script.python_packages:
        near = similar(first, module.names, 1, 0.7)
        hint = is_meant(near) or "; define it, or take the entry point out"
        yield Finding(
            f"{entry.name}: {module.path} has no {first}{hint}",
            entry.span,
            entry.name,
            (Related("this module", place_of(package, module.path)),),
        )


def _no_module(package: Package, entry: EntryPoint, name: str, function: str, workspace: Workspace) -> Iterator[Finding]:
    """Speak of a module that is not in the sources, if it must be one of the package's own."""
    script = package.script
    if script is None or name in script.python_packages or package.hidden(Facet.PYTHON) or workspace.unread(package):
        return
    tops = {module.partition(".")[0] for module in script.python_packages}
    own = name.partition(".")[0]
    hint = "; add it, or take the entry point out"
    taken = {other.target for other in script.entry_points}  # no two programs are the same one
    files = [file for file in package.files if file.endswith(".py") and file.partition("/")[0] in tops]
    strange = [file for file in files if not all(map(str.isidentifier, file[:-3].split("/")))]
    named = {file[:-3].replace("/", ".") for file in files if file not in strange}
    known = sorted(named.union(script.python_packages))  # whether they are installed is told of each folder
    modules = [module for module in known if "." in module and taken.isdisjoint((module, f"{module}:{function}"))]
    # What lies in a folder that is no Python package is put aside: setup.py never installs it.
    modules = [module for module in modules if _is_in_package(module, name, script, package.files)]
    near = [module for module in similar(name, modules, 3, 0.9) if _is_slip(name, module)][:1]
    if own not in tops and own != package.name and not similar(own, [*tops, package.name], 1, 0.85):
        # The name of a package that was copied, before a module that is here.
        near = [module for module in modules if module.partition(".")[2] == name.partition(".")[2]]
        if not _lacks(workspace, own, name) and (not near or workspace.world.by_import(own).known):
            return
    if near:
        hint = is_meant(near)
    elif unusable := similar(f"{name.replace('.', '/')}.py", strange, 1, 0.9):
        hint = f"; Python cannot import {unusable[0]} by its name: call it {name.rpartition('.')[2]}.py"
    yield Finding(
        f"{entry.name}: there is no module {name}{hint}", entry.span, entry.name, fix=_fix(entry, name, near[0] if near else "")
    )


def _is_slip(name: str, module: str) -> bool:
    """Whether a name like that of a module may be a slip for it, and does not say another thing of the same: _old, not _slow."""
    said, there = (set(_WORDS.split(each)) for each in (name, module))
    strange, instead = " ".join(sorted(said - there)), " ".join(sorted(there - said))
    return not strange or not instead or bool(similar(strange, [instead]))


_WORDS = re.compile(r"[._]")


def _is_in_package(module: str, wanted: str, script: BuildScript, files: Sequence[str]) -> bool:
    """Whether a module lies where the one that is wanted would lie, or else in a Python package."""
    above = module.rpartition(".")[0]
    if above == wanted.rpartition(".")[0] or above in script.python_packages:
        return True
    return f"{above.replace('.', '/')}/__init__.py" in files


def _lacks(workspace: Workspace, top: str, name: str) -> bool:
    """Whether a package of the workspace that is all in sight has the modules of some name, and not this one."""
    owners = [one for one in workspace.packages if one.name == top and top in one.built.python_packages]
    path = name.replace(".", "/")
    return bool(owners) and not any(
        one.hidden(Facet.PYTHON)
        or workspace.unread(one)
        or name in one.built.python_packages
        or any(f"/{file}".endswith((f"/{path}.py", f"/{path}/__init__.py")) for file in one.files)
        for one in owners
    )


def _without_call(entry: EntryPoint) -> Fix | None:
    """Take away the () at the end, where the entry is a text of its own on one line."""
    span = entry.span
    spare = span.end_column - span.column - len(entry.name) - len(entry.target) - len("'='")
    if span.line != span.end_line or not 0 <= spare <= 2:  # blanks around the sign
        return None
    place = span._replace(column=span.end_column - 3, end_column=span.end_column - 1)
    return Fix("take away the ()", (Edit(place, ""),))


def _fix(entry: EntryPoint, wrong: str, right: str) -> Fix | None:
    """Write another module name, where the entry is written out on one line."""
    inner = entry.span.inner(f"{entry.name} = {entry.target}")
    if not right or inner is None:
        return None
    start = inner.column + len(f"{entry.name} = ")
    return Fix(f"write {right}", (Edit(inner._replace(column=start, end_column=start + len(wrong)), right),), safe=False)


RULE = Rule(
    name="entry-point-target",
    code="ROS406",
    summary="an entry point must name a function that exists",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
