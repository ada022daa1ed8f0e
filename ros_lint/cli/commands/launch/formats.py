"""The output formats of ``ros-lint launch``: for people (tree, mermaid) and for programs (json).

The JSON has ``schema_version`` 1, ``file``, and

- ``arguments``: those of the launch file and of included files, each with ``name``, ``values``, ``given`` (true if the
  command line sets it), ``included`` (true if an included file declares it), ``description``, ``choices``, ``required``
  (true if there is no default), ``path``, ``line`` and ``column``;
- ``starts``: in order, each with ``kind`` (node, component, process, include), ``package``, ``target`` (executable,
  class, command or file), ``name``, ``namespace``, ``container``, ``parameters``, ``remappings``, ``environment``,
  ``arguments``, ``words`` (the command-line arguments of a node), ``later`` (true if a timer or an event starts it),
  ``trigger`` (the event handler, or the time of the timer), ``why`` (reasons why the conditions are unknown),
  ``certain``, ``when`` (the conditions), ``unknown`` (reasons why something is unknown), ``problems`` (messages about a
  missing package, executable or class), ``path``, ``line`` and ``column``; for an include also ``follows`` (the file that
  was read, or null) and ``starts``;
  For a node and a component, ``final`` has the parameters with which it starts, after all files and overrides: each with
  ``name``, ``values``, ``certain`` (false if it is perhaps not set or overridden), ``path``, ``line`` and ``column`` of its
  place, which are null for a place that is not known; ``final_unknown`` has the reasons why there may be further parameters;
- ``variables``: the environment variables without default that these files read;
- ``unknown``: places in these files that could not be analysed, each with ``reason``, ``path``, ``line`` and ``column``;
- ``complete``: false if the evaluation stopped early, because includes are cyclic or a limit was exceeded.

Texts are lists of alternatives, in the syntax of XML launch files, with ``?`` for unknown parts. The alternative "" of
``name`` means that the program of the node sets its name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros_lint.cli.commands.launch.expanded import (
    Detail,
    below_containers,
    condition_text,
    container_names,
    details,
    final_parameters,
    full_names,
    has_more_parameters,
    later_text,
    shown,
    why_not_followed,
)
from ros_lint.cli.commands.output import document, label, where
from ros_lint.collectors.launch.final_parameters import FinalParameters
from ros_lint.collectors.launch.python.import_checks import ACTIONS
from ros_lint.collectors.symbolic_text import readable
from ros_lint.facts.launch import walk_actions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from ros_lint.base.text import Span
    from ros_lint.cli.commands.launch.expanded import ExpandedFile
    from ros_lint.cli.commands.launch.marks import Marks
    from ros_lint.collectors.launch.expansion import Argument, Expansion, Started

_MOST_UNKNOWN = 20


# --- words ---------------------------------------------------------------------------------------------------------


def _value(texts: Iterable[str]) -> str:
    return shown(texts) or "''"


def _when(started: Started) -> list[str]:
    return [text for condition in dict.fromkeys(started.when) if (text := condition_text(condition))]


def _head(started: Started) -> str:
    target = shown(started.target) or "?"
    if started.kind == "process":
        return f"process {target}{later_text(started)}"
    if started.kind == "include":
        return f"include {target}"
    name = shown(full_names(started))
    package = f"{shown(started.package)} " if started.package else ""
    return f"{started.kind} {package}{target}{f' as {name}' if name else ''}{later_text(started)}"


def _unknown(expanded: ExpandedFile) -> list[tuple[str, Span]]:
    files = (expanded.file, *expanded.lookup.followed)
    places = [(opaque.reason, opaque.span) for file in files for opaque in file.opaque]
    actions = walk_actions(action for file in files for action in file.actions)
    names = ((action.name.texts[0], action.span) for action in actions if action.kind == "other" and action.name is not None)
    calls = ((name if name.startswith("<") else f"{name}()", span) for name, span in names if name not in ACTIONS)
    places += [(f"what {call} starts is not known", span) for call, span in calls]
    return list(dict.fromkeys(places))


# --- tree ----------------------------------------------------------------------------------------------------------


def tree(expanded: ExpandedFile) -> str:
    """Return the tree format: an indented line for each started node, component, process or include, and a summary."""
    expansion = expanded.expansion
    lines = [expanded.file.path]
    lines += [f"  {_argument(argument)}" for argument in expansion.arguments if argument.depth == 0]
    for started in below_containers(expansion.started):
        indent = "  " * (started.depth + 1)
        lines.append(f"{indent}{_head(started)}")
        lines += [f"{indent}  {detail}" for detail in _details(started, expanded)]
    unknown = _unknown(expanded)
    if unknown:
        lines += ["", "not analysed:"]
        lines += [f"  {span}: {reason}" for reason, span in unknown[:_MOST_UNKNOWN]]
        lines += [f"  and {len(unknown) - _MOST_UNKNOWN} more"] if len(unknown) > _MOST_UNKNOWN else []
    if expansion.variables:
        lines += ["", f"needed environment variables: {', '.join(expansion.variables)}"]
    origin = expanded.target.source if expanded.target.explicit else "assumed; set with --distro"
    lines += ["", f"{_summary(expansion)} for {expanded.target.distro} ({origin})"]
    return "".join(f"{line}\n" for line in lines)


def show_args(expanded: ExpandedFile) -> str:
    """Return a text of the launch arguments with their descriptions and choices. Arguments of included files come last."""
    arguments: dict[str, Argument] = {}
    for argument in sorted(expanded.expansion.arguments, key=lambda argument: argument.depth > 0):
        arguments.setdefault(argument.name, argument)
    lines = [] if arguments else ["The launch file has no arguments."]
    for argument in arguments.values():
        lines += [f"'{readable(argument.name)}'{' (of an included file)' if argument.depth else ''}:"]
        lines += [f"    {line.strip()}" for line in argument.description.splitlines() if line.strip()]
        if argument.choices:
            lines.append(f"    one of: {', '.join(map(readable, argument.choices))}")
        value = "given" if argument.given else "default"
        known = f"({value}: {_value(argument.texts)})"
        lines.append(f"    {'(required)' if argument.required and not argument.given else known}")
    return "".join(f"{line}\n" for line in lines)


def names_of(started: Started) -> frozenset[str]:
    """Return the names by which ``--node`` selects a node or component: its name, full name, executable and class."""
    return frozenset([*started.name, *full_names(started), *started.target])


def _argument(argument: Argument) -> str:
    return f"argument {readable(argument.name)} = {_value(argument.texts)}{' (given)' if argument.given else ''}"


def _details(started: Started, expanded: ExpandedFile) -> Iterator[str]:
    yield from (f"error: {message}" for message in expanded.marks.get(started.span, ()))
    if not started.certain:
        yield " and ".join(_when(started)) or "conditional: the condition is unknown"
        yield from (f"open because {reason}" for reason in started.why)
    for detail in details(started):
        yield _line(detail)
    if has_more_parameters(started):
        lines = [_line(detail) for detail in final_parameters(started)]
        yield f"{_count(started)}{':' if expanded.lists_parameters and lines else ''}"
        yield from (f"  {line}" for line in (lines if expanded.lists_parameters else ()))
    if started.kind == "include" and not started.file:
        yield f"not followed: {why_not_followed(started, expanded.lookup)}"
    yield from (f"? {reason}" for reason in started.unknown)


def _line(detail: Detail) -> str:
    return "".join(piece if isinstance(piece, str) else _value(piece) for piece in detail)


def _count(started: Started) -> str:
    final = started.final or FinalParameters()
    number = len(final.parameters)
    return f"{number} final parameter{'' if number == 1 else 's'}{', perhaps more' if final.unknown else ''}"


def _summary(expansion: Expansion) -> str:
    counts: dict[str, int] = {}
    for started in expansion.started:
        counts[started.kind] = counts.get(started.kind, 0) + 1
    plural = {"process": "processes"}
    parts = [
        f"{counts[kind]} {kind if counts[kind] == 1 else plural.get(kind, kind + 's')}"
        for kind in ("node", "component", "process", "include")
        if kind in counts
    ]
    conditional = sum(not started.certain for started in expansion.started)
    suffix = "" if expansion.complete else "; incomplete"
    return f"{', '.join(parts) or 'starts nothing'}{f' ({conditional} conditional)' if conditional else ''}{suffix}"


# --- json ----------------------------------------------------------------------------------------------------------


def json(expanded: ExpandedFile) -> str:
    """Return the JSON format; see the module for its keys."""
    expansion = expanded.expansion
    content = {
        "file": expanded.file.path,
        "arguments": [
            {
                **_named([(argument.name, argument.texts)])[0],
                "given": argument.given,
                "included": argument.depth > 0,
                "description": argument.description,
                "choices": _list(argument.choices),
                "required": argument.required,
                **where(argument.span),
            }
            for argument in expansion.arguments
        ],
        "starts": _nested(expansion.started, 0, expanded),
        "variables": list(expansion.variables),
        "unknown": [{"reason": reason, **where(span)} for reason, span in _unknown(expanded)],
        "complete": expansion.complete,
    }
    return document(content)


def _nested(started: Sequence[Started], depth: int, expanded: ExpandedFile) -> list[dict[str, Any]]:
    items: list[dict[str, Any]] = []
    at = 0
    while at < len(started):
        entry = started[at]
        end = at + 1
        while end < len(started) and started[end].depth > depth:
            end += 1
        item = _item(entry, expanded.marks)
        if entry.kind == "include":
            item["follows"] = entry.file or None
            if not entry.file:
                item["unknown"].append(why_not_followed(entry, expanded.lookup))
            item["starts"] = _nested(started[at + 1 : end], depth + 1, expanded)
        items.append(item)
        at = end
    return items


def _item(started: Started, marks: Marks) -> dict[str, Any]:
    return {
        "kind": started.kind,
        "package": _list(started.package),
        "target": _list(started.target),
        "name": _list(started.name),
        "namespace": [f"/{space.strip('/')}" for space in _list(started.namespace)],
        "container": _list(container_names(started)),
        "words": [_list(texts) for texts in started.words],
        "later": started.later,
        "trigger": _list(started.trigger),
        "parameters": _named(started.parameters),
        "remappings": [{"from": _list(before), "to": _list(after)} for before, after in started.remappings],
        "environment": _named(started.environment),
        "arguments": _named(started.arguments),
        "certain": started.certain,
        "when": _when(started),
        "why": list(started.why),
        "unknown": list(started.unknown),
        "problems": list(marks.get(started.span, ())),
        **(_final(started.final) if started.final is not None else {}),
        **where(started.span),
    }


def _final(final: FinalParameters) -> dict[str, Any]:
    return {
        "final": [
            {
                **_named([(parameter.name, parameter.texts)])[0],
                "certain": parameter.certain,
                **(where(parameter.span) if parameter.span is not None else {"path": None, "line": None, "column": None}),
            }
            for parameter in final.parameters
        ],
        "final_unknown": list(final.unknown),
    }


def _named(pairs: Iterable[tuple[str, Iterable[str]]]) -> list[dict[str, Any]]:
    return [{"name": readable(name), "values": _list(texts)} for name, texts in pairs]


def _list(texts: Iterable[str]) -> list[str]:
    return [readable(text) for text in texts]


# --- mermaid -------------------------------------------------------------------------------------------------------


def mermaid(expanded: ExpandedFile) -> str:
    """Return a Mermaid flow chart of what the launch file starts. Arrows to conditional actions are dotted."""
    lines = ["flowchart LR", f'  n0["{label(expanded.file.path.rpartition("/")[2])}"]']
    above = ["n0"]
    for number, started in enumerate(expanded.expansion.started, 1):
        del above[started.depth + 1 :]
        name = f"n{number}"
        opening, closing = _NODE_SHAPES[started.kind]
        lines.append(f'  {name}{opening}"{_label(started)}"{closing}')
        conditions = " and ".join(_when(started))
        arrow = "-->" if started.certain else f'-.->|"{label(conditions)}"|' if conditions else "-.->"
        lines.append(f"  {above[started.depth]} {arrow} {name}")
        if started.span in expanded.marks:
            lines.append(f"  style {name} stroke:red")
        if started.kind == "include":
            above.append(name)
    return "".join(f"{line}\n" for line in lines)


_NODE_SHAPES = {"node": ("(", ")"), "component": ("([", "])"), "process": ("{{", "}}"), "include": ("[", "]")}


def _label(started: Started) -> str:
    target = shown(started.target) or "?"
    if started.kind == "include":
        return label(target.rpartition("/")[2])
    lines = [f"{shown(started.package)} {target}".strip(), shown(full_names(started))]
    return "<br/>".join(label(line) for line in lines if line)


FORMATS: Mapping[str, Callable[[ExpandedFile], str]] = {"tree": tree, "json": json, "mermaid": mermaid}
