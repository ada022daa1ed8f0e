"""
## What it finds

A variable that nothing sets, although it is a whole argument (`${sources}`) of a CMake command. These commands are checked:

- `ament_export_dependencies()` and the other `ament_export_*()` commands;
- `ament_target_dependencies()` and `target_link_libraries()`;
- `install()`;
- `add_executable()`, `add_library()`, `target_sources()` and the like;
- `rosidl_generate_interfaces()`.

## Why it matters

CMake replaces such a reference by nothing, without a warning. `ament_export_dependencies(${dependencies})` then exports nothing,
and packages that find this one do not find its dependencies. Mostly the variable was renamed, or its name is misspelled.

## How to fix it

Write the name of the variable that is set, or set the variable before the command. If nothing is missing, remove the reference.
If exactly one variable of the package has a similar name and contents that may fit the command, the fix writes this name. The
fix is unsafe, because the command then has an effect.

Findings that are probably consequences are hidden as long as this one is shown: for example, findings of
`unexported-dependency` if the variable is an argument of `ament_export_dependencies()`.

## Limitations

Not reported:

- Variables whose name is an argument of any command of the package: `set(x ...)`, `option(x ...)`, `if(x)`, `foreach(x ...)`,
  `find_library(x ...)`, or an own function that sets the variable for its caller. The name may also be computed:
  `set(${prefix}_files ...)`.
- Scripts that include files or call commands that cannot be read, because these may set any variable.
- Variables that packages set when they are found: `x_LIBRARIES`, `x_INCLUDE_DIRS`, `x_TARGETS` and the like, and all names that
  begin with the name of a package that the script searches.
- Variables of CMake and of build tools: `CMAKE_...`, `PROJECT_...`, `BUILD_...`, `CATKIN_...`.
- Commands in functions, macros and conditions, except conditions for tests.
- References within a longer argument: `${folder}/launch`.

Reported with medium confidence: no variable with a similar name has contents that are known to fit the command, such as targets
for `target_link_libraries()`, and the script finds a package that may provide CMake code. The names of such packages contain
`build`, `cmake`, `common`, `config`, `macros`, `modules` or `tools`. Packages of interfaces, such as `common_msgs`, provide
none.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Sequence
from functools import cache

from ros_lint.api import (
    Confidence,
    Consequence,
    Edit,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    UnsetVariable,
    Workspace,
    dependencies,
    first_related,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    references: dict[str, list[UnsetVariable]] = {}
    for reference in script.cmake.unset_variables:
        references.setdefault(reference.name, []).append(reference)
    if not references:
        return
    searched = dependencies.names_searched(package, script)
    certain = not any(_PROVIDES_CODE.search(name) and not _WITHOUT_VARIABLES.match(name) for name in searched)
    products = script.products
    has_exports = products.targets or products.interfaces or any(file.path.startswith("include/") for file in products.installs)
    variables = _Variables(package, workspace)
    for name, places in references.items():
        similar, fits = variables.similar(name, places)
        finding = _finding(name, places, similar, certain or fits)
        harmless = not has_exports and all(reference.command.startswith("ament_export_") for reference in places)
        yield finding._replace(severity=Severity.INFO) if harmless else finding


_PROVIDES_CODE = re.compile("build|cmake|common|config|macros|modules|tools")
_WITHOUT_VARIABLES = re.compile(
    r"ament_|rosidl_|python_cmake_module|eigen3_cmake_module|tinyxml2?_|generate_parameter_library|\w+_(?:msgs|srvs|actions|interfaces)\Z"
)


def _finding(name: str, places: Sequence[UnsetVariable], similar: Sequence[str], certain: bool) -> Finding:
    first, *others = places
    advice = names.did_you_mean(similar) or f"; set it, or remove ${{{name}}}"
    fix = [Edit(reference.span, similar[0]) for reference in places] if len(similar) == 1 else []
    return Finding(
        f"the variable '{name}' is never set, so {first.command}() {_effect(first.command)} for it{advice}",
        first.span,
        name,
        first_related(Related(f"'{name}' is also read here", reference.span) for reference in others),
        Fix.of(f"write '{similar[0]}'", *fix, safe=False) if fix else None,
        Confidence.HIGH if certain else Confidence.MEDIUM,
        explains=tuple(map(Consequence, dict.fromkeys(rule for reference in places for rule in _explained(reference.command)))),
    )


def _effect(command: str) -> str:
    """Return the part of the message that says what a command does with an unset variable: ``links nothing``."""
    return next(effect for prefix, effect in _EFFECTS.items() if command.startswith(prefix))


_EFFECTS = {
    "ament_export_": "exports nothing",
    "ament_target_": "links nothing",
    "target_link_": "links nothing",
    "install": "installs nothing",
    "rosidl_": "generates nothing",
    "rclcpp_": "registers nothing",
    "": "adds no source",
}
"""The effect of an empty argument, as text for a message, by the beginning of the name of the command."""


def _explained(command: str) -> tuple[str, ...]:
    """Return the names of the rules whose findings may be consequences of an empty argument of the command; () if none."""
    return next((rules for prefix, rules in _CONSEQUENCES.items() if command.startswith(prefix)), ())


_CONSEQUENCES = {
    "ament_export_": ("unexported-dependency", "unexported-headers"),
    "ament_target_": ("unlinked-dependency", "unexported-dependency"),
    "target_link_": ("unlinked-dependency",),
    "install": (
        "uninstalled-component", "uninstalled-executable", "uninstalled-headers", "uninstalled-launch", "uninstalled-library",
        "uninstalled-resource", "uninstalled-script",
    ),
    "rosidl_": ("ungenerated-interface",),
}  # fmt: skip


class _Variables:
    """The variables that the CMake files of a package set, for suggestions."""

    def __init__(self, package: Package, workspace: Workspace) -> None:
        contents: dict[str, dict[str, None]] = {}
        for command, index in _SETTING.items():
            for call in package.calls(command, anywhere=True):
                if len(call.args) > index and _NAME.fullmatch(call.texts[index]):
                    words = call.texts[index + 1 :] if command in _LISTING else ()
                    contents.setdefault(call.texts[index], {}).update(dict.fromkeys(words))
        targets = frozenset(target.name for target in package.built.products.targets)
        files = frozenset(package.files)

        @cache
        def kinds(word: str) -> frozenset[str]:
            return _kinds(word, targets, files, workspace)

        self._kinds = {name: frozenset(filter(None, map(kinds, words))) for name, words in contents.items()}
        self._by_lower: dict[str, list[str]] = {}
        for name in contents:
            self._by_lower.setdefault(name.lower(), []).append(name)
        self._fitting: dict[frozenset[frozenset[str]], dict[str, bool]] = {}

    def similar(self, name: str, places: Sequence[UnsetVariable]) -> tuple[Sequence[str], bool]:
        """Return the variables whose names resemble ``name``, the most similar first.

        Variables with contents that the commands at ``places`` cannot use are left out. The second result is True if the contents
        of all returned variables are known to fit, and there is such a variable.
        """
        fits = self._fit(frozenset(kinds for reference in places if (kinds := _allowed(reference.command))))
        by_case = [candidate for candidate in self._by_lower.get(name.lower(), ()) if candidate in fits]
        similar = by_case[:1] or names.similar_names(name, fits, 2, 0.75)
        return similar, bool(similar) and all(fits[candidate] for candidate in similar)

    def _fit(self, allowed: frozenset[frozenset[str]]) -> dict[str, bool]:
        """Return the variables whose contents may be of the allowed kinds, each with whether the contents are known."""
        fits = self._fitting.get(allowed)
        if fits is None:
            fits = {
                name: bool(known)
                for name, known in self._kinds.items()
                if all(kinds & wanted for kinds in known for wanted in allowed)
            }
            self._fitting[allowed] = fits
        return fits


_SETTING = {
    "set": 0, "list": 1, "file": 1, "find_library": 0, "find_path": 0,
    "qt5_add_resources": 0, "qt5_wrap_cpp": 0, "qt5_wrap_ui": 0, "qt6_add_resources": 0, "qt6_wrap_cpp": 0, "qt6_wrap_ui": 0,
    "qt_add_resources": 0, "qt_wrap_cpp": 0, "qt_wrap_ui": 0,
}  # fmt: skip
"""Commands that set a variable, with the index of its name."""
_LISTING = frozenset({"set", "list"})
"""Commands whose further arguments are the contents of the variable."""


def _allowed(command: str) -> frozenset[str]:
    """Return the kinds of arguments (:func:`_kinds`) that a command can use; empty if it can use any."""
    return next((kinds for prefix, kinds in _ALLOWED.items() if command.startswith(prefix)), frozenset())


_ALLOWED = {
    "ament_export_dependencies": frozenset({"package"}),
    "ament_target_dependencies": frozenset({"package"}),
    "target_link_": frozenset({"target", "file"}),
    "add_": frozenset({"file"}),
    "ament_add_": frozenset({"file"}),
    "ament_auto_add_": frozenset({"file"}),
    "rosidl_": frozenset({"file"}),
    "target_sources": frozenset({"file"}),
}
"""The kinds of arguments that commands can use, by the beginnings of their names."""


def _kinds(word: str, targets: Container[str], files: Container[str], workspace: Workspace) -> frozenset[str]:
    """Return what an argument may be: "package", "target" or "file"; empty if that is unknown, as for ``${name}``."""
    if "$" in word or not _WORD.fullmatch(word):
        return frozenset()
    kinds = {
        "target": "::" in word or word in targets,
        "file": "/" in word or word in files,
        "package": workspace.world.is_package(word),
    }
    return frozenset(kind for kind, applies in kinds.items() if applies)


_WORD = re.compile(r"[\w:./+-]+")
_NAME = re.compile(r"[A-Za-z_]\w*")


RULE = Rule(
    name="unset-variable",
    code="ROS322",
    summary="variables that decide what is built, linked, installed or exported are set",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
