"""
## What it finds

- An include that does not pass an argument which the included launch file requires.
- An include that passes an argument which neither the included file nor any file included from there declares or uses.
- A launch configuration that is read although nothing declares or sets it, or before it is declared. A launch file is processed
  in order.
- An argument whose default is not one of its choices.
- An argument whose default makes an expression fail: with `false` or `fast` for `$(var x)`, `$(eval 'not $(var x)')` and
  `$(eval '$(var x) == 0')` are not valid Python expressions.
- An argument that is declared but never used.
- A configuration that is read with a default, while an argument of nearly the same name is declared.

## Why it matters

The launch file stops without a required argument, and with a default that is not a choice: `Included launch description missing
required argument`. It also stops if a configuration is read that is not set: `launch configuration 'x' does not exist`. Only
`LaunchConfigurationEquals` continues, and is never true.

An argument that is not used has no effect, without a message. It was renamed or removed, so the default applies again. The
default also applies if a configuration is read under another name than that of its declaration.

## How to fix it

Pass the argument, or declare a default for it. Correct the name, or remove the argument.

## Limitations

Not reported:

- Includes whose file or arguments cannot be determined from the launch files alone, and arguments that are passed under an
  unknown condition, such as what a function finds out about the included file.
- Arguments passed to a file that includes a launch file from outside the workspace, because that file may use or declare them.
- Required arguments that are declared under a condition or in a group.
- Undeclared or unused arguments of a file that computes the names of the configurations it reads.
- Undeclared configurations of a file with more than two of them, because it is a part of other launch files.
- Unused arguments of a Python launch file that imports modules which may read them.
- Unused arguments of a file that fills in parameters from launch configurations (`allow_substs`), because users may choose
  another parameter file, which may use any argument.
- Undeclared and unused arguments, if a file of the workspace cannot be read, because it may include this file.
- Unused arguments of a file that only contains arguments, because it sets them for files that include it.
- Configurations read with a default, if any launch file of the workspace sets or passes them, or if the name differs from the
  declared one in a number.
- Configurations read before their declaration, if a file that includes this one, or perhaps one that is included earlier,
  declares or sets them.
- Arguments passed to an include, if something later in the same scope may read them, such as a launch file from outside the
  workspace. A passed argument stays set until the end of the enclosing scoped group.
- Unused arguments with an empty default that another launch file of the same folder requires, because this file may replace the
  other one.

Reported with medium confidence:

- One or two undeclared configurations, unless the name is nearly that of a declared argument.
- Passed arguments, if the included file fills in parameters from launch configurations, or if something later in a file that
  includes this one may read them. The confidence stays high in the second case if the name resembles an argument that is not
  passed.
- Failing expressions under a condition, expressions with an argument that files of the workspace pass, and all of them if a
  file of the workspace cannot be read.
- Configurations read with a default, if the declared argument is used as well.
- Configurations read before their declaration, if they are read under a condition, or if the file requires other arguments, so
  that it is a part of other launch files.

Arguments without effect have severity info, or warning if the name resembles an argument that is not passed.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from ros_lint.api import (
    STANDARD_LIBRARY,
    Confidence,
    Finding,
    LaunchAction,
    LaunchFile,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    first_related,
    launch,
    names,
)

_MOST_MISSING = 2
"""A file that reads more undeclared configurations is assumed to be a part of a file that sets them."""

_QUIET = launch.LAUNCH_RUNTIME | {"nav2_common", "xacro", "yaml"}
"""Modules that read no launch configurations, in addition to the Python standard library."""

_DIGITS = re.compile(r"\d+")


def check(workspace: Workspace) -> Iterator[Finding]:
    links = launch.include_resolver(workspace)
    files = [file for package in workspace.packages for file in package.launch]
    families, left = launch.IncludeTree(files, links), launch.ScopeLeaks(files, links)
    filled = frozenset(
        name for package in workspace.packages for file in package.parameter_files for name in file.configurations_read
    )
    whole = not workspace.unread()
    for package in workspace.packages:
        required: dict[str, set[str]] = {}
        for file in package.launch:
            required.setdefault(_folder(file), set()).update(links.takes(file).required)
        for launch_file in launch.package_launch_files(package):
            siblings = required[_folder(launch_file.file)]
            for finding in _of_file(launch_file.file, links, families, left, filled, siblings, whole=whole):
                yield finding._replace(package=package.name)


def _folder(file: LaunchFile) -> str:
    return file.path.rpartition("/")[0]


def _of_file(
    file: LaunchFile,
    links: launch.IncludeResolver,
    families: launch.IncludeTree,
    left: launch.ScopeLeaks,
    filled: frozenset[str],
    siblings: Collection[str],
    *,
    whole: bool,
) -> Iterator[Finding]:
    """Yield the findings of a file.

    ``whole``: all files that may include this one were read. ``siblings``: required arguments of the files of its folder.
    """
    for include in launch.includes(file):
        yield from _of_include(include, file, links, families, left, filled)
    for action in launch.walk_actions(file.actions):
        if action.kind == "argument":
            yield from _of_choices(action)
    all_names, takes, above = families.names(file), links.takes(file), families.above(file)
    passed = {name for configuration in above for name in configuration.made}
    if whole:
        yield from _too_early(file, links, passed.union(*(configuration.declared for configuration in above)))
    yield from (_failing(broken, sure=whole and broken.argument not in passed) for broken in launch.failing_expressions(file))
    if not (whole and all_names.whole and takes.complete):
        return
    known = {*all_names.declared, *all_names.made}.union(
        *([*configuration.declared, *configuration.made] for configuration in above)
    )
    inside = _known_inside(file, links)
    unknown = all_names.asked - known - inside
    missing = launch.required_configurations(file, unknown) if unknown else {}
    for name, span in missing.items() if len(missing) <= _MOST_MISSING else ():
        yield _undeclared(name, span, sorted(all_names.declared), sure=not above)
    unused = all_names.declared.keys() - all_names.asked.union(inside, *(configuration.asked for configuration in above))
    slips = dict(_slips(file, unknown - missing.keys() - families.made, all_names.declared))
    for name, (meant, span) in slips.items():
        yield Finding(
            f"launch configuration '{name}' is read but never declared, so the default here always applies; "
            f"did you mean '{meant}', which is declared{' but not used' if meant in unused else ''}?",
            span,
            name,
            (Related("declared here", all_names.declared[meant]),),
            confidence=Confidence.HIGH if meant in unused else Confidence.MEDIUM,
        )
    if file.language == "python" and not (file.imports and all(_is_of_launch(name) for name, _ in file.imports)):
        return
    if families.fill(file) or all(action.kind in ("argument", "set") for action in file.actions):
        return
    excused = {name for name in _empty(file) if name in siblings}.union(meant for meant, _ in slips.values())
    for name, span in all_names.declared.items():
        if name in unused and name not in excused:
            yield Finding(
                f"launch argument '{name}' is declared but never used; use it or remove it",
                span,
                name,
                severity=Severity.INFO,
            )


def _slips(file: LaunchFile, all_names: frozenset[str], declared: Mapping[str, Span]) -> Iterator[tuple[str, tuple[str, Span]]]:
    """Yield the names that are read with a default, each with the declared argument of a similar name and its place."""
    for (name, has_default), span in launch.read_sites(file, all_names).items() if all_names else ():
        digits = _DIGITS.findall(name)
        near = names.similar_names(name, [argument for argument in declared if _DIGITS.findall(argument) == digits], 1, 0.85)
        if has_default and near:
            yield name, (near[0], span)


def _too_early(file: LaunchFile, links: launch.IncludeResolver, above: Collection[str]) -> Iterator[Finding]:
    """Yield the arguments that are read before they are declared, because a launch file is processed in order.

    ``above``: names that files which include this one declare or set.
    """
    declared: dict[str, tuple[int, Span]] = {}
    for index, action in enumerate(file.actions):
        if action.kind == "argument" and action.target is not None:
            for name in action.target.texts:
                declared.setdefault(name, (index, action.span))
    places: dict[tuple[str, bool | None], list[tuple[Span, bool]]] = {}
    for early in _asked_early(file, links, {name: at for name, (at, _) in declared.items()}, above):
        places.setdefault((early.name, early.holds), []).append((early.span, early.sure))
    for (name, holds), reads in places.items():
        (first, _), *others = reads
        yield Finding(
            f"launch argument '{name}' is read before it is declared, so {_OUTCOMES[holds]} unless it is passed; "
            "declare it earlier",
            first,
            name,
            first_related(
                [
                    Related("declared here", declared[name][1]),
                    *(Related("also read here", span) for span, _ in others),
                ]
            ),
            confidence=Confidence.HIGH if any(sure for _, sure in reads) else Confidence.MEDIUM,
            severity=Severity.ERROR,
        )


class _Early(NamedTuple):
    """A launch configuration that is read before it is declared."""

    name: str
    span: Span
    sure: bool
    """True if it is certainly read there."""
    holds: bool | None
    """The result of a condition that compares the missing configuration; None if launch stops instead."""


_OUTCOMES = {None: "the launch file stops", False: "the condition is never true", True: "the condition is always true"}


def _asked_early(
    file: LaunchFile, links: launch.IncludeResolver, declared: Mapping[str, int], above: Collection[str]
) -> Iterator[_Early]:
    """Yield the configurations that are read before their declaration; ``declared``: the index of the declaring action."""
    known = set(above)
    part = bool(links.takes(file).required)
    for index, action in enumerate(file.actions):
        late = [name for name, at in declared.items() if at > index and name not in known]
        if not late:
            return
        for text, span, conditional, holds in _questions(action) if action.kind != "later" else ():
            for name, has_default, _ in launch.configurations(text):
                if name in late and not has_default:
                    late.remove(name)
                    yield _Early(name, span, not part and not conditional, holds)
        for inner in launch.walk_actions((action,)):
            if inner.kind == "include" and (target := links.target(inner.target, file)) is not None:
                known |= links.takes(target.file).known
            elif inner.kind == "include":
                return  # the included file may declare anything
            known.update(name for name, _ in inner.arguments)
            if inner.kind in ("argument", "set") and inner.target is not None:
                known.update(inner.target.texts)


def _questions(action: LaunchAction) -> Iterator[tuple[str, Span, bool, bool | None]]:
    """Yield the texts of an action that launch evaluates, with place, whether under a condition, and outcome (see ``_Early``).

    Conditions are always evaluated. Those that compare a configuration continue if it is missing.
    """
    asking = {text for condition in action.conditions if condition.equals is None for text in condition.texts}
    comparing = [condition for condition in action.conditions if condition.equals is not None]
    for text, span in launch.values_of_action(action):
        if text in asking or not any(text in condition.texts for condition in comparing):
            yield text, span, bool(action.conditions) and text not in asking, None
    for condition in comparing:
        for text in condition.texts:
            yield text, action.span, False, not condition.wanted


def _empty(file: LaunchFile) -> Iterator[str]:
    """Yield the arguments with an empty default."""
    for action in launch.walk_actions(file.actions):
        if action.kind == "argument" and action.target is not None and action.value is not None and action.value.texts == ("",):
            yield from action.target.texts


def _is_of_launch(module: str) -> bool:
    """Return whether a module certainly reads no launch configurations."""
    top = module.partition(".")[0]
    return top in _QUIET or top in STANDARD_LIBRARY


def _known_inside(file: LaunchFile, links: launch.IncludeResolver) -> frozenset[str]:
    """Return the names that the included files declare, set or read."""
    return frozenset().union(*(links.takes(inner).known for inner in links.includes(file)))


def _undeclared(name: str, span: Span, declared: list[str], *, sure: bool) -> Finding:
    near = names.similar_names(name, declared, 1, 0.85)
    return Finding(
        f"launch configuration '{name}' is read, but nothing declares or sets it{names.did_you_mean(near)}",
        span,
        name,
        confidence=Confidence.HIGH if near and sure else Confidence.MEDIUM,
        severity=Severity.ERROR,
    )


def _of_choices(action: LaunchAction) -> Iterator[Finding]:
    value = action.value
    if value is None or not action.choices or not all(map(launch.is_plain, (*action.choices, *value.texts))):
        return
    if len(value.texts) == 1 and value.texts[0] not in action.choices:
        name = action.target.texts[0] if action.target is not None else ""
        choices = ", ".join(f"'{choice}'" for choice in action.choices)
        yield Finding(
            f"the default '{value.texts[0]}' of launch argument '{name}' is not one of its choices {choices}",
            value.span,
            name,
            severity=Severity.ERROR,
        )


def _failing(broken: launch.FailingExpression, *, sure: bool) -> Finding:
    reason = "not a valid Python expression"
    if broken.name:
        remedy = f"write {broken.name.capitalize()}" if broken.name in ("true", "false") else "put it in quotes"
        reason = f"but Python has no name '{broken.name}'; {remedy}"
    return Finding(
        f"with the default of '{broken.argument}' this expression becomes `{broken.expression}`, {reason}",
        broken.span,
        broken.argument,
        confidence=Confidence.HIGH if sure and not broken.conditional else Confidence.MEDIUM,
        severity=Severity.ERROR,
    )


def _of_include(
    include: launch.PlacedInclude,
    source: LaunchFile,
    links: launch.IncludeResolver,
    families: launch.IncludeTree,
    left: launch.ScopeLeaks,
    filled: frozenset[str],
) -> Iterator[Finding]:
    action = include.action
    target = links.target(action.target, source)
    places = action.argument_spans or [value.span for _, value in action.arguments]
    passed = {name: place for (name, _), place in zip(action.arguments, places, strict=True) if name}
    if target is None or not all(launch.is_plain(name) for name in passed):
        return
    takes = links.takes(target.file)
    file = f"{target.package.name}/{target.path}"
    span = action.target.span if action.target is not None else action.span
    for name, declared in takes.required.items():
        if name not in passed:
            yield Finding(
                f"'{file}' requires the argument '{name}', which is not passed here",
                span,
                f"{file}:{name}",
                (Related("declared here without a default", declared),),
                severity=Severity.ERROR,
            )
    not_passed = takes.known - passed.keys()
    sure = not families.fill(target.file)
    for name, place in passed.items() if takes.complete else ():
        if name in takes.known or name in action.conditional_arguments or (name in filled and not sure):
            continue
        if not left.is_taken_later(name, include, source):
            alone = not left.is_taken_above(name, include, source)
            yield _useless(file, name, place, not_passed, sure=sure, alone=alone)


def _useless(file: str, name: str, place: Span, not_passed: frozenset[str], *, sure: bool, alone: bool) -> Finding:
    """Return the finding for an argument without effect. If it resembles an argument that is not passed, it was renamed.

    ``alone``: no file includes the passing file and later contains something that may read the argument.
    """
    near = names.similar_names(name, not_passed, 1, 0.85)
    return Finding(
        f"'{file}' does not use the argument '{name}', so it has no effect{names.did_you_mean(near) or '; remove it'}",
        place,
        f"{file}:{name}",
        confidence=Confidence.HIGH if sure and (near or alone) else Confidence.MEDIUM,
        severity=None if near else Severity.INFO,
    )


RULE = Rule(
    name="launch-argument",
    code="ROS507",
    summary="launch arguments are declared, passed and used consistently",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
