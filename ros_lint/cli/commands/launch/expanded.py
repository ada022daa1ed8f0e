"""An evaluated launch file, and the words that describe its actions in all output formats."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.symbolic_text import UNKNOWN, readable

if TYPE_CHECKING:
    from ros_lint.cli.commands.launch.lookup import LaunchFileLookup
    from ros_lint.cli.commands.launch.marks import Marks
    from ros_lint.collectors.launch.expansion import Expansion, Started
    from ros_lint.facts.launch import LaunchCondition, LaunchFile
    from ros_lint.workspace.target import TargetDistro


class ExpandedFile(NamedTuple):
    """An evaluated launch file, with the data that the output formats need."""

    file: LaunchFile
    expansion: Expansion
    lookup: LaunchFileLookup
    marks: Marks
    target: TargetDistro
    lists_parameters: bool = False
    """True to list the final parameters of each node in the tree format, not only their number."""


def shown(texts: Iterable[str]) -> str:
    """Return alternatives for people: ``a | b``."""
    return " | ".join(readable(text) for text in texts)


def full_names(started: Started) -> tuple[str, ...]:
    """Return the possible names of a node with its namespace, () if they are unknown.

    "..." replaces a name that the program of the node sets.
    """
    spaces = [f"/{space.strip('/')}".rstrip("/") for space in started.namespace or ("",)]
    if not started.name:
        return tuple(dict.fromkeys([f"{space}/..." for space in spaces if space]))
    return tuple(dict.fromkeys([f"{space}/{name or '...'}" for space in spaces for name in started.name]))


def container_names(started: Started) -> tuple[str, ...]:
    """Return the possible full names of the container of a component, () for any other action."""
    return tuple([name if name.startswith("/") else f"/{name}" for name in started.container])


def below_containers(started: Sequence[Started]) -> list[Started]:
    """Return actions with each component after its container, one level deeper, if exactly one action starts the container."""
    names = Counter(name for action in started if action.kind == "node" for name in full_names(action))
    inside: dict[str, list[Started]] = {}
    others: list[Started] = []
    for action in started:
        container = container_names(action)
        is_started = len(container) == 1 and names[container[0]] == 1
        (inside.setdefault(container[0], []) if is_started else others).append(action)
    result: list[Started] = []
    for action in others:
        result.append(action)
        for name in full_names(action) if action.kind == "node" else ():
            result += [part._replace(depth=action.depth + 1, container=()) for part in inside.pop(name, ())]
    return result


Detail = tuple[str | tuple[str, ...], ...]
"""A line about an action: words, and possible values as tuples."""


def details(started: Started) -> Iterator[Detail]:
    """Yield a line for each setting of an action: its container, parameters, remappings, environment and arguments."""
    if started.container:
        yield "in container ", container_names(started)
    if started.words:
        spaced = [piece for texts in started.words for piece in (" ", texts)]
        yield "arguments", *spaced
    for name, texts in started.parameters:
        if name != UNKNOWN:
            yield ("parameter ", (name,), " = ", texts) if name else ("parameters ", texts)
    if any(name == UNKNOWN for name, _ in started.parameters):
        yield ("unknown parameters",)
    for before, after in started.remappings:
        yield ("unknown remappings",) if before == after == (UNKNOWN,) else ("remap ", before, " to ", after)
    for name, texts in started.environment:
        yield "environment ", (name,), " = ", texts
    for name, texts in started.arguments:
        yield "argument " if started.kind == "include" else "", (name,), " = ", texts


def has_more_parameters(started: Started) -> bool:
    """Return whether the lines of :func:`details` do not contain all parameters with which a node starts."""
    return started.final is not None and any(not name for name, _ in started.parameters)


def final_parameters(started: Started) -> Iterator[Detail]:
    """Yield a line for each parameter with which a node starts, with its place, and for each reason why there may be more."""
    if started.final is None:
        return
    for parameter in started.final.parameters:
        place = f"  ({parameter.span.path}:{parameter.span.line})" if parameter.span is not None else ""
        yield (parameter.name,), " = ", parameter.texts, place if parameter.certain else f"{place} perhaps"
    for reason in started.final.unknown:
        yield (f"perhaps more: {reason}",)


def condition_text(condition: LaunchCondition) -> str:
    """Return a condition as text, such as "if $(var use_sim_time)"; "" if the text of the condition is unknown."""
    if all(text.rstrip("0123456789") == UNKNOWN for text in condition.texts):
        return ""
    text = shown(condition.texts)
    if condition.equals is None:
        return f"{'if' if condition.wanted else 'unless'} {text}"
    return f"if {text} {'==' if condition.wanted else '!='} {condition.equals or repr('')}"


def later_text(started: Started) -> str:
    """Return what starts an action that is not started at once: `` (later: OnProcessExit)``; "" for any other action."""
    trigger = shown(started.trigger)
    return f" (later: {trigger})" if trigger else " (later)" if started.later else ""


def why_not_followed(started: Started, lookup: LaunchFileLookup) -> str:
    """Return the reason why the file of an include was not read."""
    if len(started.target) != 1 or UNKNOWN in started.target[0]:
        return _UNKNOWN_PATH
    absent = lookup.absent(started.target[0])
    return absent.reason if absent is not None else _UNKNOWN_PATH


_UNKNOWN_PATH = "the path of the file is unknown"
