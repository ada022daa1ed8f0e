"""
## What it finds

- An include that does not give an argument which the included launch file requires, or that gives one which neither this
  file nor any that it includes declares or uses.
- A launch configuration that is asked for, while nothing declares or sets it, or before it is declared: what stands in a
  launch file is done in order.
- An argument whose default is none of its choices, or one that makes an expression fail: with `false` or `fast` for
  `$(var x)`, `$(eval 'not $(var x)')` and `$(eval '$(var x) == 0')` are no Python that can be evaluated.
- An argument that is declared and never used.
- A configuration that is asked for with a default, while an argument of nearly the same name is declared.

## Why it matters

Without a required argument, and with a default that is no choice, the launch file stops: `Included launch description
missing required argument`. So it does when a configuration is asked for that nobody set: `launch configuration 'x' does
not exist`; only `LaunchConfigurationEquals` goes on, and never holds. An argument that nobody takes does nothing, silently:
it was renamed or removed, and what it used to change has its default again. So it is with one that is asked for by another
name than it is declared by: the default there counts.

## How to fix it

Give the argument, or give it a default where it is declared; correct the name, or take the argument out.

## Limitations

- Which file is included, or which arguments it gets, is not known from the launch files alone; so it is with one that is
  passed only if something holds of which nothing is known, such as what a function finds out about the included file.
- A file that is included further down is not in the workspace: it may take the argument, or declare it.
- Arguments that are declared under a condition or in a group are not required.
- A file asks for arguments by names that it computes.
- A file asks for several configurations that nobody declares: it is a part of others. With one or two the confidence is
  medium, unless a declared one is nearly the same.
- A Python launch file imports modules that may ask for its arguments, or parameters are filled in from launch
  configurations (`allow_substs`): whoever gives another file of parameters may use any argument there. Of an argument that
  an include gives the confidence is medium then.
- An expression fails only under a condition, or files of the workspace that include this one give the argument: then the
  confidence is medium.
- A file of the workspace cannot be read: it may include this one and give it anything. What is asked for and declared
  nowhere, and what is declared and never used, is not told of then, and of an expression that fails the confidence is medium.
- A file has nothing but arguments: it sets them for whoever includes it.
- What is asked for with a default, and looks like an argument, is set or passed on by any launch file of the workspace, or the
  two differ in a number. If the argument is used, too, the confidence is medium.
- What is asked for before it is declared is declared or set by a file that includes this one, or perhaps by one that it
  includes before. Where it is asked for under a condition, or the file requires other arguments, so that it is a part of
  others, the confidence is medium.
- An argument that an include gives is left set, up to the end of a group with a scope around it: what stands further down
  there may ask for it, or include what takes it, such as a launch file that is not in the workspace. So may what stands
  further down in a file of the workspace that includes this one: then the confidence is medium, unless it resembles an
  argument that is not given.
- An argument that does nothing is empty by default, and another launch file of the folder requires it: this one may be put
  in the place of the other, and takes what that one takes.

What does nothing is an info; it is a warning if it resembles an argument that is not given.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from ros_lint.api import (
    STANDARD_LIBRARY,
    Broken,
    Confidence,
    Families,
    Finding,
    Include,
    LaunchAction,
    LaunchFile,
    Left,
    Links,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    asked_at,
    broken_expressions,
    configurations,
    did_you_mean,
    everything,
    includes,
    is_plain,
    launchable,
    needed,
    several,
    similar,
    texts_of,
)

_MOST_MISSING = 2
"""A file that asks for more than these is a part of one that sets them."""

_QUIET = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml", "ament_index_python", "nav2_common", "xacro", "yaml"})
"""Modules of launch files besides those of Python."""


_DIGITS = re.compile(r"\d+")


def check(workspace: Workspace) -> Iterator[Finding]:
    links = workspace.links
    files = [file for package in workspace.packages for file in package.launch]
    families, left = Families(files, links), Left(files, links)
    filled = frozenset(name for package in workspace.packages for file in package.parameter_files for name in file.asks)
    whole = not workspace.unread()
    for package in workspace.packages:
        required: dict[str, set[str]] = {}
        for file in package.launch:
            required.setdefault(_folder(file), set()).update(links.takes(file).required)
        for launch in launchable(package):
            beside = required[_folder(launch.file)]
            for finding in _of_file(launch.file, links, families, left, filled, beside, whole=whole):
                yield finding._replace(package=package.name)


def _folder(file: LaunchFile) -> str:
    return file.path.rpartition("/")[0]


def _of_file(
    file: LaunchFile,
    links: Links,
    families: Families,
    left: Left,
    filled: frozenset[str],
    beside: Collection[str],
    *,
    whole: bool,
) -> Iterator[Finding]:
    """``whole``: all files can be read, and with them whoever includes this one; ``beside``: what those of its folder require."""
    for include in includes(file):
        yield from _of_include(include, file, links, families, left, filled)
    for action in everything(file.actions):
        if action.kind == "argument":
            yield from _of_choices(action)
    names, takes, above = families.names(file), links.takes(file), families.above(file)
    given = {name for one in above for name in one.made}
    if whole:
        yield from _too_early(file, links, given.union(*(one.declared for one in above)))
    yield from (_failing(broken, sure=whole and broken.argument not in given) for broken in broken_expressions(file))
    if not (whole and names.whole and takes.complete):
        return
    there = {*names.declared, *names.made}.union(*([*one.declared, *one.made] for one in above))
    inside = _known_inside(file, links)
    strange = names.asked - there - inside
    missing = needed(file, strange) if strange else {}
    for name, span in missing.items() if len(missing) <= _MOST_MISSING else ():
        yield _undeclared(name, span, sorted(names.declared), sure=not above)
    unused = names.declared.keys() - names.asked.union(inside, *(one.asked for one in above))
    slips = dict(_slips(file, strange - missing.keys() - families.made, names.declared))
    for name, (meant, span) in slips.items():
        yield Finding(
            f"{name} is asked for, and nothing declares it; {meant} is declared{', and not used' if meant in unused else ''}: "
            f"write {meant}, or else the default here counts whatever is given",
            span,
            name,
            (Related("declared here", names.declared[meant]),),
            confidence=Confidence.HIGH if meant in unused else Confidence.MEDIUM,
        )
    if file.language == "python" and not (file.imports and all(_is_of_launch(name) for name, _ in file.imports)):
        return
    if families.fill(file) or all(action.kind in ("argument", "set") for action in file.actions):
        return
    taken = {name for name in _empty(file) if name in beside}.union(meant for meant, _ in slips.values())
    for name, span in names.declared.items():
        if name in unused and name not in taken:
            yield Finding(
                f"the argument {name} is declared and never used: it does nothing; use it, or take it out",
                span,
                name,
                severity=Severity.INFO,
            )


def _slips(file: LaunchFile, names: frozenset[str], declared: Mapping[str, Span]) -> Iterator[tuple[str, tuple[str, Span]]]:
    """Yield those of some names that are asked for with a default, each with what is declared and looks like it."""
    for (name, has_default), span in asked_at(file, names).items() if names else ():
        digits = _DIGITS.findall(name)
        near = similar(name, [each for each in declared if _DIGITS.findall(each) == digits], 1, 0.85)
        if has_default and near:
            yield name, (near[0], span)


def _too_early(file: LaunchFile, links: Links, above: Collection[str]) -> Iterator[Finding]:
    """Yield the arguments that are asked for before they are declared: what a launch file does, it does in order.

    ``above`` are those that files which include this one declare or set.
    """
    declared: dict[str, tuple[int, Span]] = {}
    for index, action in enumerate(file.actions):
        if action.kind == "argument" and action.target is not None:
            for name in action.target.texts:
                declared.setdefault(name, (index, action.span))
    places: dict[tuple[str, bool | None], list[tuple[Span, bool]]] = {}
    for early in _asked_early(file, links, {name: at for name, (at, _) in declared.items()}, above):
        places.setdefault((early.name, early.holds), []).append((early.span, early.sure))
    for (name, holds), found in places.items():
        (first, _), *others = found
        yield Finding(
            f"{name} is asked for before it is declared, so {_OUTCOMES[holds]} where nobody gives it; declare it further up",
            first,
            name,
            several(
                [
                    Related("declared only here", declared[name][1]),
                    *(Related("asked for here, too", span) for span, _ in others),
                ]
            ),
            confidence=Confidence.HIGH if any(sure for _, sure in found) else Confidence.MEDIUM,
            severity=Severity.ERROR,
        )


class _Early(NamedTuple):
    """A launch configuration that is asked for before it is declared."""

    name: str
    span: Span
    sure: bool
    """Whether it is surely asked for there."""
    holds: bool | None
    """What a condition comes to that compares a configuration which is not there; None where launch stops instead."""


_OUTCOMES = {None: "the launch file stops", False: "the condition never holds", True: "the condition always holds"}


def _asked_early(file: LaunchFile, links: Links, declared: Mapping[str, int], above: Collection[str]) -> Iterator[_Early]:
    """Yield what is asked for before its number in ``declared`` comes."""
    there = set(above)
    part = bool(links.takes(file).required)
    for index, action in enumerate(file.actions):
        late = [name for name, at in declared.items() if at > index and name not in there]
        if not late:
            return
        for text, span, conditional, holds in _questions(action) if action.kind != "later" else ():
            for name, has_default, _ in configurations(text):
                if name in late and not has_default:
                    late.remove(name)
                    yield _Early(name, span, not part and not conditional, holds)
        for inner in everything((action,)):
            if inner.kind == "include" and (target := links.target(inner.target, file)) is not None:
                there |= links.takes(target.file).known
            elif inner.kind == "include":
                return  # what is included may declare anything
            there.update(name for name, _ in inner.arguments)
            if inner.kind in ("argument", "set") and inner.target is not None:
                there.update(inner.target.texts)


def _questions(action: LaunchAction) -> Iterator[tuple[str, Span, bool, bool | None]]:
    """Yield what launch evaluates of an action, where, whether under a condition, and what a comparison with nothing comes to.

    A condition is asked for whatever comes of it, and one that compares a configuration goes on where there is none.
    """
    asking = {text for condition in action.conditions if condition.equals is None for text in condition.texts}
    comparing = [condition for condition in action.conditions if condition.equals is not None]
    for text, span in texts_of(action):
        if text in asking or not any(text in condition.texts for condition in comparing):
            yield text, span, bool(action.conditions) and text not in asking, None
    for condition in comparing:
        for text in condition.texts:
            yield text, action.span, False, not condition.wanted


def _empty(file: LaunchFile) -> Iterator[str]:
    """Yield the arguments that have the empty text for their default."""
    for action in everything(file.actions):
        if action.kind == "argument" and action.target is not None and action.value is not None and action.value.texts == ("",):
            yield from action.target.texts


def _is_of_launch(module: str) -> bool:
    """Whether a module surely asks for no launch configurations of its own."""
    top = module.partition(".")[0]
    return top in _QUIET or top in STANDARD_LIBRARY


def _known_inside(file: LaunchFile, links: Links) -> frozenset[str]:
    """Return every name that the included files know."""
    return frozenset().union(*(links.takes(inner).known for inner in links.includes(file)))


def _undeclared(name: str, span: Span, declared: list[str], *, sure: bool) -> Finding:
    near = similar(name, declared, 1, 0.85)
    return Finding(
        f"no launch argument {name} is declared, and nothing sets it{did_you_mean(near)}",
        span,
        name,
        confidence=Confidence.HIGH if near and sure else Confidence.MEDIUM,
        severity=Severity.ERROR,
    )


def _of_choices(action: LaunchAction) -> Iterator[Finding]:
    value = action.value
    if value is None or not action.choices or not all(map(is_plain, (*action.choices, *value.texts))):
        return
    if len(value.texts) == 1 and value.texts[0] not in action.choices:
        name = action.target.texts[0] if action.target is not None else ""
        choices = ", ".join(action.choices)
        yield Finding(
            f"the default of {name} is {value.texts[0] or 'the empty text'}, which is none of its choices: {choices}",
            value.span,
            name,
            severity=Severity.ERROR,
        )


def _failing(broken: Broken, *, sure: bool) -> Finding:
    why = f"Python knows no {broken.name}" if broken.name else "that is no Python"
    if broken.name:
        why += f", say {broken.name.capitalize()}" if broken.name in ("true", "false") else ", put it into quotes"
    return Finding(
        f"with the default of {broken.argument} this expression becomes {broken.expression}; {why}",
        broken.span,
        broken.argument,
        confidence=Confidence.HIGH if sure and not broken.conditional else Confidence.MEDIUM,
        severity=Severity.ERROR,
    )


def _of_include(
    include: Include,
    source: LaunchFile,
    links: Links,
    families: Families,
    left: Left,
    filled: frozenset[str],
) -> Iterator[Finding]:
    action = include.action
    target = links.target(action.target, source)
    places = action.argument_spans or [value.span for _, value in action.arguments]
    given = {name: place for (name, _), place in zip(action.arguments, places, strict=True) if name}
    if target is None or not all(is_plain(name) for name in given):
        return
    takes = links.takes(target.file)
    file = f"{target.package.name}/{target.path}"
    span = action.target.span if action.target is not None else action.span
    for name, declared in takes.required.items():
        if name not in given:
            yield Finding(
                f"{file} requires the argument {name}, which is not given here",
                span,
                f"{file}:{name}",
                (Related("declared here, without default", declared),),
                severity=Severity.ERROR,
            )
    open_to = takes.known - given.keys()
    sure = not families.fill(target.file)
    for name, place in given.items() if takes.complete else ():
        if name in takes.known or name in action.perhaps or (name in filled and not sure):
            continue
        if not left.is_taken_later(name, include, source):
            alone = not left.is_taken_above(name, include, source)
            yield _useless(file, name, place, open_to, sure=sure, alone=alone)


def _useless(file: str, name: str, place: Span, open_to: frozenset[str], *, sure: bool, alone: bool) -> Finding:
    """Return the finding for an argument that nobody takes. One that resembles an argument not given was renamed.

    ``alone``: no file includes the one that gives it, and goes on with what may take it.
    """
    near = similar(name, open_to, 1, 0.85)
    return Finding(
        f"{file} takes no argument {name}: it does nothing there{did_you_mean(near) or '; take it out'}",
        place,
        f"{file}:{name}",
        confidence=Confidence.HIGH if sure and (near or alone) else Confidence.MEDIUM,
        severity=None if near else Severity.INFO,
    )


RULE = Rule(
    name="launch-argument",
    code="ROS507",
    summary="an include must give the arguments that the included file takes",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
