"""``ros-lint launch FILE [name:=value ...]``: print what a launch file would start, without starting it.

``ros-lint launch PACKAGE`` lists the launch files that a package installs.

The exit code is:

- 0 if launching would succeed, or if its failure cannot be determined,
- 1 if launching would fail, with the reasons on standard error,
- 2 for an invalid request: an unknown file, package or argument, or a file that is not a launch file.
"""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.commands.launch import formats
from ros_lint.cli.commands.launch.expanded import ExpandedFile
from ros_lint.cli.commands.launch.lookup import LaunchFileLookup
from ros_lint.cli.commands.launch.marks import Marks, marks_of
from ros_lint.cli.commands.query import CommandOutput, current_workspace, enclosing_workspace, run_query
from ros_lint.cli.messages import show
from ros_lint.cli.session import Session, UsageError
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.symbolic_text import readable
from ros_lint.facts.launch import ACCEPTED_PROBLEMS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from ros_lint.collectors.launch.expansion import Expansion, Started
    from ros_lint.facts.launch import LaunchFile
    from ros_lint.workspace.model import Workspace


class LaunchRequest(NamedTuple):
    """The launch file and the launch arguments that the command line names."""

    package: str
    """Name of the package that installs the launch file, "" if ``file`` is a path."""
    file: str
    """File name of a launch file that the package installs, or a path; "" to list the launch files of the package."""
    arguments: Mapping[str, str]


class LaunchOptions(NamedTuple):
    """The options of the command that decide what is printed."""

    form: str = "tree"
    """The output format: a key of ``formats.FORMATS``, or "html"."""
    show_args: bool = False
    """True to print the launch arguments only."""
    depth: int | None = None
    """Maximum number of includes above a printed action, None for no limit."""
    node: str = ""
    """Name, executable or class of the nodes and components to print, "" for all."""


def run(options: Mapping[str, Any]) -> int:
    """Run ``ros-lint launch``, print its output and return the exit code."""
    try:
        request = parse_launch_request(options["words"], os.path.isfile)
        paths = options.get("paths") or [current_workspace() if request.package else enclosing_workspace(request.file)]
    except UsageError as error:
        show(str(error))
        return 2

    def answer_request(session: Session, workspace: Workspace) -> CommandOutput:
        path = "" if request.package else os.path.relpath(os.path.realpath(request.file), session.base).replace(os.sep, "/")
        shown = LaunchOptions(options["format"], options.get("show-args", False), options.get("depth"), options.get("node") or "")
        return answer(workspace, LaunchFileLookup(workspace, session.loader.tree), request, path, shown)

    return run_query({**options, "paths": paths}, answer_request)


def parse_launch_request(words: Sequence[str], is_file: Callable[[str], bool]) -> LaunchRequest:
    """Return the launch file and arguments that the words of the command line name, in the syntax of ``ros2 launch``.

    The words are FILE or PACKAGE FILE, and arguments ``name:=value`` at any position. ``is_file`` returns whether a path
    is an existing file. Raises UsageError.
    """
    places = [word for word in words if ":=" not in word]
    arguments: dict[str, str] = {}
    for word in words:
        name, mark, value = word.partition(":=")
        if mark and not name:
            raise UsageError(f"argument without a name: '{word}'; write name:=value")
        if mark:
            arguments[name] = value
    if not places:
        raise UsageError("no launch file given; use 'ros-lint launch FILE' or 'ros-lint launch PACKAGE FILE'")
    if len(places) > 2 or (len(places) == 2 and is_file(places[0])):
        raise UsageError(f"unexpected '{places[-1]}'; launch arguments are written as name:=value")
    if len(places) == 2:
        return LaunchRequest(places[0], places[1], arguments)
    if not is_file(places[0]):
        if _PACKAGE.fullmatch(places[0]):
            return LaunchRequest(places[0], "", arguments)
        raise UsageError(f"{places[0]}: no such file; for an installed launch file use 'ros-lint launch PACKAGE FILE'")
    return LaunchRequest("", places[0], arguments)


_PACKAGE = re.compile(r"[A-Za-z][\w-]*")
"""Pattern of a package name."""


def answer(
    workspace: Workspace, lookup: LaunchFileLookup, request: LaunchRequest, path: str, options: LaunchOptions
) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code: 1 if launching would fail, else 0.

    ``path`` is the path of the file relative to the base folder; it is ignored if the request names a package. Raises
    UsageError.
    """
    if request.package and not request.file:
        files = lookup.installed_files(request.package)
        return "".join(f"{name}  {place}\n" for name, place in files), "", 0
    if request.package:
        file, place = lookup.installed_file(request.package, request.file)
    else:
        file, place = lookup.source_file(path), path
    expansion = _expand(file, place, request.arguments, lookup, workspace.target.distro)
    warnings = list(_argument_warnings(file, lookup, expansion, request.arguments))
    marks = marks_of(workspace, (file, *lookup.followed))
    problems = list(dict.fromkeys(_problems(file, lookup, expansion, marks)))
    err = "".join(f"ros-lint: {line}\n" for line in (*warnings, *problems))
    content = ExpandedFile(file, expansion, lookup, marks, workspace.target)
    return _output(content, place, request.arguments, options), err, 1 if problems else 0


def _expand(file: LaunchFile, place: str, passed: Mapping[str, str], lookup: LaunchFileLookup, distro: str) -> Expansion:
    """Return what a launch file at the path ``place`` starts, with the final parameters of its nodes."""
    placed = file._replace(path=place)
    return expand(placed, passed, lookup.included, distro, contents=lookup.parameters, node_name=lookup.node_name)


def _output(content: ExpandedFile, place: str, arguments: Mapping[str, str], options: LaunchOptions) -> str:
    """Return the output. ``place`` is the path of the launch file for look-ups, and ``arguments`` are the given ones."""
    if options.show_args:
        return formats.show_args(content)
    if options.form != "html":
        started = _shown(content.expansion.started, options)
        selected = content._replace(expansion=content.expansion._replace(started=started), lists_parameters=bool(options.node))
        return formats.FORMATS[options.form](selected)
    from ros_lint.cli.commands.launch import page  # noqa: PLC0415

    changeable = page.controls(content.expansion)
    while True:
        passed = {**arguments, **page.open_values(changeable)}
        expansion = _expand(content.file, place, passed, content.lookup, content.target.distro)
        if not (fixed := page.names_in_paths(expansion)):
            break
        changeable = tuple([control for control in changeable if control.name not in fixed])
    shown = expansion._replace(started=_shown(expansion.started, options))
    return page.render(content._replace(expansion=shown), changeable)


def _shown(started: Sequence[Started], options: LaunchOptions) -> tuple[Started, ...]:
    """Return the actions that the options select: up to ``depth`` includes deep, and with ``node`` the node and its includes."""
    kept = [action for action in started if options.depth is None or action.depth <= options.depth]
    if not options.node:
        return tuple(kept)
    result: list[Started] = []
    includes: list[Started] = []
    for action in kept:
        del includes[action.depth :]
        if action.kind == "include":
            includes.append(action)
        elif action.kind in ("node", "component") and options.node in formats.names_of(action):
            result += [include for include in includes if include not in result]
            result.append(action)
    return tuple(result)


def _argument_warnings(
    file: LaunchFile, lookup: LaunchFileLookup, expansion: Expansion, arguments: Mapping[str, str]
) -> Iterator[str]:
    """Yield a warning for each given launch argument that no readable launch file uses.

    Raises UsageError for such an argument if all files are readable, or if a declared argument has a similar name.
    """
    accepted = lookup.accepted_arguments(file)
    declared = list(dict.fromkeys(argument.name for argument in expansion.arguments))
    accepted_names = {*accepted.known, *declared, *lookup.used(file)}
    for name in arguments:
        if name in accepted_names:
            continue
        near = similar_names(name, declared, 1, 0.75)
        hint = did_you_mean(near) or (f"; available: {', '.join(declared)}" if declared else "; it declares none")
        if accepted.complete or near:
            raise UsageError(f"{file.path} has no argument '{name}'{hint}")
        yield f"no launch file that can be read uses the argument '{name}'{hint}"


def _problems(file: LaunchFile, lookup: LaunchFileLookup, expansion: Expansion, marks: Marks) -> Iterator[str]:
    """Yield a message with a place for each reason why launching would fail."""
    for launch_file in (file, *lookup.followed):
        for problem in launch_file.problems:
            if problem.kind not in ACCEPTED_PROBLEMS:
                yield f"{problem.span}: {problem.message}"
    for missing in expansion.missing:
        if missing.include is None:
            yield f"{missing.span}: the argument '{missing.name}' has no default; pass {missing.name}:=VALUE"
        else:
            yield f"{missing.include}: the argument '{missing.name}' is not passed here and has no default at {missing.span}"
    for unset in expansion.unset:
        yield f"{unset.span}: the launch configuration '{unset.name}' is not set here; pass {unset.name}:=VALUE, or declare it"
    for invalid in expansion.refused:
        choices = ", ".join(invalid.choices)
        yield f"{invalid.span}: '{invalid.value}' is not a valid choice for the argument '{invalid.name}'; use one of {choices}"
    for raised in expansion.raised:
        yield f"{raised.span}: the launch file raises an exception here{f': {raised.message}' if raised.message else ''}"
    for opened in expansion.opened:
        reason = lookup.missing(opened.path)
        if reason:
            yield f"{opened.span}: {readable(opened.path)}: {reason}"
    for opened in expansion.opened:
        reason = lookup.missing(opened.path)
        if reason:
            yield f"{opened.span}: {readable(opened.path)}: {reason}"
    for cycle in expansion.circles:
        yield f"{cycle.span}: this include leads back to {cycle.path}, so launching never ends"
    for started in expansion.started:
        if started.kind == "node" and started.certain and not started.later:  # a container survives a missing component
            yield from (f"{started.span}: {message}" for message in marks.get(started.span, ()))
        if started.kind == "include" and started.certain and not started.file and len(started.target) == 1:
            absent = lookup.absent(started.target[0])
            if absent is not None and absent.certain:
                yield f"{started.span}: {readable(started.target[0])}: {absent.reason}"
