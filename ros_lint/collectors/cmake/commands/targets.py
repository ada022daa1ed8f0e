"""Commands for targets, their sources and their properties, such as add_executable()."""

from __future__ import annotations

from typing import Final, Literal

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.commands.include_directories import are_in_flags, visible_headers
from ros_lint.collectors.cmake.commands.ros2_run import note_started_programs
from ros_lint.collectors.cmake.commands.target_headers import file_sets
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.state import Properties
from ros_lint.collectors.cmake.evaluator.truth import is_off
from ros_lint.collectors.cmake.evaluator.values import HOLE, elements, is_fixed, is_known, join, strip_mark
from ros_lint.facts.cmake import BuildTarget
from ros_lint.facts.visibility import Facet

_LIBRARY_TYPES: Final = ("STATIC", "SHARED", "MODULE", "OBJECT", "INTERFACE", "UNKNOWN")


SOURCES: Final = (".c", ".C", ".c++", ".cc", ".cpp", ".cxx", ".cu", ".m", ".mm", ".h", ".hh", ".hpp", ".hxx", ".in", ".txx")
"""Suffixes of source files.

If a source file does not exist, CMake tries its name with each suffix appended (policy CMP0115)."""


def _add_executable(run: Run, args: list[str]) -> None:
    _add(run, args, "executable", ("WIN32", "MACOSX_BUNDLE", "EXCLUDE_FROM_ALL", "IMPORTED", "GLOBAL"))


def _add_library(run: Run, args: list[str]) -> None:
    word = next(iter([word for word in args[1:3] if word in _LIBRARY_TYPES]), "")
    kind = word.lower()
    shared: str | None = ""
    if not kind:
        shared = run.get("BUILD_SHARED_LIBS")
        kind = "static" if shared is None or is_off(shared) else "shared"
    _add(run, args, kind, (*_LIBRARY_TYPES, "EXCLUDE_FROM_ALL", "IMPORTED", "GLOBAL"))
    if shared and not is_known(shared) and (target := run.targets.get(args[0])) is not None and target["KIND"] == kind:
        target["PERHAPS"] = "static"
        target["TYPE"] = HOLE


def _add(run: Run, args: list[str], kind: str, keywords: tuple[str, ...]) -> None:
    if not args or not is_known(args[0]):
        if not run.testing:
            run.hide(Facet.LIBRARIES, "the name of a target is unknown")
        elif args:  # for example, a name with the RMW implementation in it
            name = "".join([letter for letter in args[0] if letter.isprintable()])
            _build(run, name, Properties(KIND=kind), args, keywords)
        return
    name = args[0]
    if "ALIAS" in args[1:2]:
        run.put(run.targets, name, Properties(KIND="alias", ALIASED=args[2] if len(args) > 2 else HOLE))
        return
    target = Properties(KIND=kind, NAME=name, TYPE="EXECUTABLE" if kind == "executable" else f"{kind.upper()}_LIBRARY")
    if "IMPORTED" in args[1:4]:
        target["KIND"] = "imported"
    run.put(run.targets, name, target)
    _build(run, name, target, args, keywords)


def _build(run: Run, name: str, target: Properties, args: list[str], keywords: tuple[str, ...]) -> None:
    """Record that the build makes a target, given the arguments of a command such as add_executable().

    The first argument is the name of the target. All others, except ``keywords``, are sources. ``name`` is the known part of
    the target's name.
    """
    target["SOURCES"] = ""
    if run.conditional:
        target["CONDITIONAL"] = "1"
    if run.testing:
        target["TEST"] = "1"
    run.results.targets.append((name, target, run.place_of(args[0])))
    _add_sources(run, target, [arg for arg in args[1:] if arg not in keywords])


def _add_sources(run: Run, target: Properties, sources: list[str]) -> None:
    if not sources:
        return
    sources_so_far = elements(target.get("SOURCES", ""))
    for source in sources:
        plain, certain = strip_mark(source)
        path = run.paths.source(plain)
        if run.paths.is_outside_source(plain):
            run.results.compiles_outside_package = True
        if path in run.paths.files:
            sources_so_far.append(path if certain else source[0] + path)
        elif path is not None and "$<" not in plain:
            path = next((f"{path}{suffix}" for suffix in SOURCES if f"{path}{suffix}" in run.paths.files), path)
            sources_so_far.append(path if certain else source[0] + path)
            if run.paths.is_unlisted(path):
                run.hide(Facet.USES, f"'{path}' is in a folder whose files are not read", run.place_of(source))
            if certain and path not in run.paths.files:
                run.results.missing_files.append((path, run.place_of(source), bool(run.muted or run.uncertain_conditions)))
        elif HOLE in plain:
            sources_so_far.append(HOLE)
    run.put(target, "SOURCES", join(sources_so_far))


def _target_sources(run: Run, args: list[str]) -> None:
    if not args or args[0] not in run.targets:
        return
    target = run.targets[args[0]]
    _add_sources(run, target, file_sets(run, target, args[1:]))


def _set_target_properties(run: Run, args: list[str]) -> None:
    if "PROPERTIES" not in args:
        return
    at = args.index("PROPERTIES")
    for name in args[:at]:
        _set_properties(run, name, args[at + 1 :])


def _set_properties(run: Run, name: str, pairs: list[str]) -> None:
    target = run.targets.get(name)
    if target is None:
        return
    for index in range(0, len(pairs) - 1, 2):
        run.put(target, pairs[index], pairs[index + 1])


def _set_property(run: Run, args: list[str]) -> None:
    if "PROPERTY" not in args[1:]:
        return
    at = args.index("PROPERTY")
    name, values = args[at + 1] if at + 1 < len(args) else "", args[at + 2 :]
    modes = {"APPEND", "APPEND_STRING"}.intersection(args[:at])
    holders: list[Properties] = []
    if args[0] == "GLOBAL":
        holders = [run.globals]
    elif args[0] == "TARGET":
        holders = [run.targets[target] for target in args[1:at] if target in run.targets]
    elif args[0] == "CACHE":
        for entry in args[1:at]:
            if name == "VALUE" and entry in run.cache:
                run.put(run.cache, entry, join(values))
        return
    for holder in holders:
        value = holder.get(name, "")
        if "APPEND" in modes:
            run.put(holder, name, join([*([value] if value else []), *values]))
        elif modes:
            run.put(holder, name, value + join(values))
        else:
            run.put(holder, name, join(values))


def _get_property(run: Run, args: list[str]) -> None:
    """Run ``get_property(variable GLOBAL|TARGET t|... PROPERTY name [SET|DEFINED])``: assign a property to a variable."""
    if len(args) < 4 or "PROPERTY" not in args[:-1] or HOLE in args[0]:
        return
    name = args[args.index("PROPERTY") + 1]
    value: str | None = HOLE
    if args[-1] not in ("SET", "DEFINED", "BRIEF_DOCS", "FULL_DOCS"):
        if args[1] == "GLOBAL":
            value = run.globals.get(name, HOLE if run.open_world or name.isupper() else "")
        elif args[1] == "TARGET":
            value = _property(run, args[2], name, "")
    run.set(args[0], value)


def _get_target_property(run: Run, args: list[str]) -> None:
    if len(args) >= 3 and HOLE not in args[0]:
        run.set(args[0], _property(run, args[1], args[2], f"{args[0]}-NOTFOUND"))


def _property(run: Run, name: str, property_name: str, default: str) -> str:
    target = run.targets.get(name)
    if target is None or not is_fixed(property_name):
        return HOLE
    if target["KIND"] == "alias":
        return _property(run, target["ALIASED"], property_name, default) if target["ALIASED"] in run.targets else HOLE
    if property_name in ("NAME", "OUTPUT_NAME") or (property_name in target and property_name != "SOURCES"):
        return target.get(property_name, default)
    return HOLE


def _custom_command(run: Run, args: list[str], *, optional: bool = False) -> None:
    """Run ``add_custom_command()``: record its outputs as generated files, and the programs that it starts.

    ``optional`` is True for the command of a custom target that is not built by default.
    """
    note_started_programs(run, args, optional=optional)
    outputs = False
    for arg in args:
        if arg in ("OUTPUT", "BYPRODUCTS"):
            outputs = True
        elif arg.isupper() and len(arg) > 4 and "/" not in arg:
            outputs = False
        elif outputs:
            note_generated(run, arg)


def note_generated(run: Run, path: str, *, folder: bool = False) -> None:
    """Record that the build generates a file, or a folder with unknown files if ``folder`` is true."""
    place = run.paths.source(path)
    if place is not None:
        run.paths.generated.add(f"{place}/" if folder else place)


def _custom_target(run: Run, args: list[str]) -> None:
    if args and is_known(args[0]):
        run.put(run.targets, args[0], Properties(KIND="other", NAME=args[0], TYPE="UTILITY"))
        _custom_command(run, args, optional=args[1:2] != ["ALL"])


def output_name(target: Properties) -> str | None:
    """Return the name of the file that a target builds, None if the name is unknown or the target builds no file."""
    kind = target["KIND"]
    specific = {"executable": "RUNTIME", "shared": "LIBRARY", "module": "LIBRARY", "static": "ARCHIVE"}.get(kind)
    if specific is None:
        return None
    name = target.get(f"{specific}_OUTPUT_NAME", target.get("OUTPUT_NAME", target["NAME"]))
    prefix = target.get("PREFIX", "" if kind == "executable" else "lib")
    suffix = target.get("SUFFIX", {"executable": "", "static": ".a"}.get(kind, ".so"))
    file_name = f"{prefix}{name}{suffix}"
    return file_name if is_known(file_name) and "$<" not in file_name else None


def targets(run: Run) -> tuple[BuildTarget, ...]:
    """Return the targets that the package builds, in the order of their definition."""
    result = []
    any_headers = are_in_flags(run)
    for name, target, span in run.results.targets:
        kind = target["KIND"]
        if kind == "imported":
            continue
        elements_of_sources = elements(target["SOURCES"])
        paths = [strip_mark(path) for path in elements_of_sources if HOLE not in path]
        sources = tuple(dict.fromkeys([path for path, _ in paths]))
        always = frozenset() if "CONDITIONAL" in target else {path for path, certain in paths if certain}
        optional = tuple([path for path in sources if path not in always])
        links = _links(run, name) if name in run.results.links else ()
        all_known = len(paths) == len(elements_of_sources)
        headers = None if any_headers or not sources or "TEST" in target else visible_headers(run, name, run.targets)
        result.append(
            BuildTarget(name, _KINDS.get(kind, "library"), sources, "TEST" in target, span, links, optional, all_known, headers)
        )
    return tuple(dict.fromkeys(result)) if len(result) > 1 else tuple(result)


_KINDS: Final[dict[str, Literal["executable", "interface"]]] = {"executable": "executable", "interface": "interface"}


def _links(run: Run, name: str) -> tuple[tuple[str, Span], ...]:
    """Return the targets of the package to which the target ``name`` is linked, each with the place of the link command.

    An alias is replaced by its target.
    """
    links: dict[str, Span] = {}
    for library, span in run.results.links[name].items():
        target = real_target(run, library)
        if target is not None and target.get("KIND") != "imported" and "NAME" in target:
            links.setdefault(target["NAME"], span)
    return tuple(links.items())


def real_target(run: Run, name: str) -> Properties | None:
    """Return the properties of the target ``name``; None if there is no such target.

    If ``name`` is an alias, these are the properties of the aliased target.
    """
    target = run.targets.get(name)
    if target is not None and target["KIND"] == "alias":
        return run.targets.get(target["ALIASED"])
    return target


COMMANDS: Final[dict[str, Handler]] = {
    "add_executable": _add_executable,
    "add_library": _add_library,
    "target_sources": _target_sources,
    "set_target_properties": _set_target_properties,
    "set_property": _set_property,
    "get_property": _get_property,
    "get_target_property": _get_target_property,
    "add_custom_command": _custom_command,
    "add_custom_target": _custom_target,
}
