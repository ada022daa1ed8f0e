"""``ros-lint launch --format html``: what a launch file starts, as one page whose arguments can be changed.

The launch file is evaluated with open arguments: their values are chosen in the page. For a condition that only compares
an argument, the script of the page decides. For an expression with arguments, the page has a table of results.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.html_page import fill, resource
from ros_lint.base.json_text import for_html
from ros_lint.cli.commands.launch.expanded import (
    Detail,
    below_containers,
    condition_text,
    details,
    final_parameters,
    full_names,
    has_more_parameters,
    later_text,
    why_not_followed,
)
from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.symbolic_text import (
    UNKNOWN,
    has_open_expression,
    is_settled,
    open_argument,
    open_arguments,
    open_pieces,
    readable,
    with_open_arguments,
)

if TYPE_CHECKING:
    from ros_lint.cli.commands.launch.expanded import ExpandedFile
    from ros_lint.collectors.launch.expansion import Argument, Expansion, Started
    from ros_lint.facts.launch import LaunchCondition

_MOST_RESULTS = 256
"""Maximum number of results of one expression in the page."""
_QUOTED = re.compile(r"'([^'\n]{0,200})'")


class Control(NamedTuple):
    """A launch argument whose value can be changed in the page."""

    name: str
    value: str
    """The value when the page is opened; "" for a required argument."""
    values: tuple[str, ...]
    """All values that the argument can have; () for a text of any kind."""
    description: str


def controls(expansion: Expansion) -> tuple[Control, ...]:
    """Return the controls for the arguments of a launch file, given its expansion with their values or defaults.

    Left out are arguments of included files, and those whose defaults are computed, for example from other arguments.
    """
    result: dict[str, Control] = {}
    for argument in expansion.arguments:
        if argument.depth == 0 and argument.name not in result and (control := _control(argument)):
            result[argument.name] = control
    return tuple(result.values())


def _control(argument: Argument) -> Control | None:
    if argument.required and not argument.given:
        return Control(argument.name, "", argument.choices, argument.description)
    if len(argument.texts) != 1 or not is_settled(argument.texts[0]) or argument.computed:
        return None
    value = readable(argument.texts[0])
    values = argument.choices or _SWITCHES.get(value, ())
    return Control(argument.name, value, values, argument.description)


_SWITCHES = {word: pair for pair in (("true", "false"), ("True", "False")) for word in pair}
"""The values of an argument that is a switch, by its value."""


def names_in_paths(expansion: Expansion) -> frozenset[str]:
    """Return the open arguments in the paths of included files. Their values must be fixed, so that the files can be read."""
    paths = [text for started in expansion.started if started.kind == "include" for text in started.target]
    return frozenset([name for path in paths for name in open_arguments(path)])


def open_values(changeable: Iterable[Control]) -> dict[str, str]:
    """Return the values, by name, that make the arguments open in an evaluation."""
    return {control.name: open_argument(control.name) for control in changeable}


def render(expanded: ExpandedFile, changeable: Sequence[Control]) -> str:
    """Return the page of a launch file that was evaluated with the open arguments of ``changeable``."""
    page = _Page(expanded, {control.name: control for control in changeable})
    target = expanded.target
    origin = target.source if target.explicit else "assumed; set with --distro"
    tree = "".join(page.items(below_containers(expanded.expansion.started), 0))
    return fill(
        resource(__name__, "page.html"),
        {
            "TITLE": html.escape(expanded.file.path),
            "ABOUT": html.escape(f"for {target.distro} ({origin})"),
            "STYLE": resource(__name__, "page.css"),
            "SCRIPT": resource(__name__, "page.js"),
            "CONTROLS": "".join(map(_control_html, changeable)) or "<p>The launch file has no arguments that can be changed.</p>",
            "FIXED": page.fixed(),
            "TREE": tree or "<li>The launch file starts nothing.</li>",
            "DATA": for_html(page.conditions),
        },
    )


def _control_html(control: Control) -> str:
    name, value = html.escape(control.name), html.escape(control.value)
    described = f' aria-describedby="about-{name}"' if control.description else ""
    if control.values:
        values = control.values if control.value in control.values else (control.value, *control.values)
        options = "".join(_option(text, selected=text == control.value) for text in values)
        field = f'<select name="{name}"{described}>{options}</select>'
    else:
        field = f'<input name="{name}" value="{value}" autocomplete="off"{described}>'
    about = f'<small id="about-{name}">{html.escape(control.description.strip())}</small>' if control.description else ""
    return f"<p><label>{name} {field}</label>{about}</p>\n"


def _pieces(text: str) -> list[str]:
    """Return the literals of a text, and at odd places the names of open arguments."""
    return [piece if number % 2 else readable(piece) for number, piece in enumerate(open_pieces(text))]


def _option(text: str, *, selected: bool) -> str:
    return f'<option value="{html.escape(text)}"{" selected" if selected else ""}>{html.escape(text or "(not set)")}</option>'


class _Page:
    """The parts of a page. ``conditions`` collects the conditions of all items, for the script."""

    def __init__(self, expanded: ExpandedFile, changeable: Mapping[str, Control]) -> None:
        self._expanded = expanded
        self._controls = changeable
        self._numbers: dict[LaunchCondition, int] = {}
        self.conditions: list[dict[str, Any]] = []

    def fixed(self) -> str:
        """Return the arguments that cannot be changed in the page, as list items."""
        arguments = [argument for argument in self._expanded.expansion.arguments if argument.depth == 0]
        fixed = {argument.name: argument for argument in arguments if argument.name not in self._controls}
        return "".join(f"<li>{html.escape(name)} = {self._texts(argument.texts)}</li>" for name, argument in fixed.items())

    def items(self, started: Sequence[Started], depth: int) -> Iterator[str]:
        """Yield the list items of actions in the same file. ``depth`` is the number of includes above them."""
        at = 0
        while at < len(started):
            action, end = started[at], at + 1
            while end < len(started) and started[end].depth > depth:
                end += 1
            inner = "".join(self.items(started[at + 1 : end], depth + 1))
            yield self._item(action, f"<ul>{inner}</ul>" if inner else "")
            at = end

    def _item(self, action: Started, inner: str) -> str:
        numbers = [self._number(condition) for condition in dict.fromkeys(action.when)]
        problems = "".join(f'<p class="error">{html.escape(text)}</p>' for text in self._expanded.marks.get(action.span, ()))
        details = "".join(f"<li>{line}</li>" for line in self._details(action))
        place = f"{action.span.path}:{action.span.line}"
        summary = f'<span class="kind">{action.kind}</span> {self._head(action)} <span class="state"></span>'
        return (
            f'<li class="item {action.kind}" data-when="{" ".join(map(str, numbers))}" data-certain="{int(action.certain)}">'
            f"<details><summary>{summary}</summary>"
            f'<ul class="details">{details}<li class="place">{html.escape(place)}</li></ul></details>{problems}{inner}</li>\n'
        )

    def _head(self, action: Started) -> str:
        later = html.escape(later_text(action))
        if action.kind in ("include", "process"):
            return f"<code>{self._texts(action.target)}</code>{later}"
        program = f"{self._texts(action.package)} {self._texts(action.target)}" if action.package else self._texts(action.target)
        names = full_names(action)
        if not names:
            return f"<code>{program}</code>{later}"
        pieces = html.escape(json.dumps([_pieces(name) for name in names], ensure_ascii=False))
        return f'<b class="name" data-names="{pieces}">{self._texts(names)}</b> <code>{program}</code>{later}'

    def _details(self, action: Started) -> Iterator[str]:
        for condition in dict.fromkeys(action.when):
            number = self._number(condition)
            text = html.escape(condition_text(condition) or "an unknown condition")
            yield f'<span class="condition" data-condition="{number}">{text} <span class="truth"></span></span>'
        yield from (f"open because {html.escape(reason)}" for reason in action.why)
        if not action.certain and not action.when:
            yield "conditional: the condition is unknown"
        for detail in details(action):
            yield self._line(detail)
        if has_more_parameters(action):
            lines = "".join(f"<li>{self._line(detail)}</li>" for detail in final_parameters(action))
            number = len(action.final.parameters) if action.final is not None else 0
            yield f'<details class="final"><summary>final parameters: {number}</summary><ul>{lines}</ul></details>'
        if action.kind == "include" and not action.file:
            yield f"not followed: {html.escape(why_not_followed(action, self._expanded.lookup))}"
        yield from (f"unknown: {html.escape(reason)}" for reason in action.unknown)

    def _line(self, detail: Detail) -> str:
        return "".join(html.escape(piece) if isinstance(piece, str) else self._texts(piece) or "''" for piece in detail)

    def _texts(self, texts: Iterable[str]) -> str:
        """Return alternatives as HTML. Each open argument is an element whose text the script replaces."""
        return " | ".join(self._text(text) for text in texts)

    def _text(self, text: str) -> str:
        if has_open_expression(text):
            return html.escape(readable(text))
        return "".join(self._open(piece) if number % 2 else html.escape(piece) for number, piece in enumerate(_pieces(text)))

    def _open(self, name: str) -> str:
        value = self._controls[name].value if name in self._controls else ""
        return f'<span class="open" data-argument="{html.escape(name)}">{html.escape(value)}</span>'

    def _number(self, condition: LaunchCondition) -> int:
        """Return the index of a condition in ``conditions``."""
        if condition not in self._numbers:
            self._numbers[condition] = len(self.conditions)
            results = [self._results(text, condition) for text in condition.texts]
            self.conditions.append({"texts": results, "equals": condition.equals, "wanted": condition.wanted})
        return self._numbers[condition]

    def _results(self, text: str, condition: LaunchCondition) -> dict[str, Any] | None:
        """Return how the script computes a text of a condition, None if the text is unknown.

        ``pieces`` are literals and, at odd places, names of arguments. ``table`` has the text for each combination of values of
        ``arguments``, by the values as JSON.
        """
        if not has_open_expression(text):
            known = all(map(is_settled, open_pieces(text)))
            return {"pieces": _pieces(text)} if known else None
        names = open_arguments(text)
        values = [self._values(name, text, condition) for name in names]
        if prod(map(len, values)) > _MOST_RESULTS:
            return None
        table: dict[str, str] = {}
        for combination in product(*values):
            result = with_open_arguments(text, dict(zip(names, combination, strict=True)), evaluate)
            if result != UNKNOWN:
                table[json.dumps(combination, ensure_ascii=False, separators=(",", ":"))] = result
        return {"arguments": names, "table": table}

    def _values(self, name: str, text: str, condition: LaunchCondition) -> list[str]:
        """Return the values of an argument for which an expression is evaluated: its choices, or those that matter."""
        control = self._controls[name]
        if control.values:
            return list(dict.fromkeys([control.value, *control.values]))
        compared = [word for word in _QUOTED.findall(text) if is_settled(word)]
        if condition.equals is not None:
            compared.append(condition.equals)
        return list(dict.fromkeys([control.value, *_SWITCHES, *compared]))
