"""Reads ``setup.cfg`` with the syntax of ``configparser``, and records the span of each option."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.facts.setup_py import WrittenText
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.base.text import Span, Text


class Line(NamedTuple):
    """A line of the value of an option, without surrounding white space."""

    text: str
    span: Span


class Option(NamedTuple):
    """An option in a section of setup.cfg, with the lines of its value."""

    section: str
    key: str
    """The key with underscores instead of dashes, because distutils treats both as the same key."""
    lines: tuple[Line, ...]
    """Lines of the value that are neither empty nor comments."""
    span: Span
    """The span of the key."""

    @property
    def value(self) -> str:
        return "\n".join(line.text for line in self.lines)


class SetupCfg(NamedTuple):
    """The options that could be read from a ``setup.cfg``, and the problems of the file."""

    options: tuple[Option, ...]
    problems: tuple[Problem, ...]
    texts: tuple[WrittenText, ...] = ()
    """Places where a fix can add or change options."""

    def section(self, name: str) -> dict[str, Option]:
        """Return the options of the section ``name``, by key; {} if there is no such section."""
        return {option.key: option for option in self.options if option.section == name}


_SECTION = re.compile(r"\[(.+)\]")
_OPTION = re.compile(r"(.*?)\s*[=:]\s*(.*)$")
# Sections with options of setuptools or distutils. In any other section, a dash is part of the key.
_DASHED = frozenset({"develop", "install", "metadata", "options"})

_MOST_WRONG_LINES = 10


def collect(source: Text) -> SetupCfg:
    """Return the options and problems of a ``setup.cfg``.

    Problems have the kinds ``setup-cfg-syntax`` (setuptools stops with an error) and ``dashed-key`` (a key with a dash,
    which setuptools rejects or warns about, depending on its version). Of the wrong lines, only the first ten are reported.
    """
    options: list[Option] = []
    problems: list[Problem] = []
    wrong: list[Problem] = []
    continuations: list[Line] = []
    texts: list[WrittenText] = []
    section = ""
    end = 0
    indent: int | None = None  # of the current option; lines that are indented more continue it
    for number in range(1, source.line_count + 1):
        line = source.line(number)
        text = line.strip()
        if not text or text[0] in "#;":
            continue
        width = len(line) - len(line.lstrip())
        start = source.offset(number, 1) + width
        end = start + len(text)
        if indent is not None and width > indent:
            continuations.append(Line(text, source.span(start, end)))
            continue
        _extend(options, continuations)
        indent = None
        header, given = _SECTION.match(text), _OPTION.match(text)
        if header:
            section = header[1]
            texts.append(WrittenText("section", section, source.span(end, end)))
        elif given is None or not section or not given[1]:
            if len(wrong) < _MOST_WRONG_LINES:
                message = "this line is in no section" if not section else "this line is neither a section nor an option"
                wrong.append(Problem("setup-cfg-syntax", message, source.span(start, end)))
        else:
            indent = width
            at = start + given.start(2)
            lines = (Line(given[2], source.span(at, at + len(given[2]))),) if given[2] else ()
            option = Option(section, given[1].replace("-", "_"), lines, source.span(start, start + len(given[1])))
            options.append(option)
            if "-" in given[1] and section in _DASHED:
                message = f"{given[1]} with a dash; write {option.key}"
                problems.append(Problem("dashed-key", message, option.span, subject=given[1]))
    _extend(options, continuations)
    texts += [WrittenText("option", f"{option.section}.{option.key}", option.lines[0].span) for option in options if option.lines]
    texts.append(WrittenText("section", "", source.span(end, end)))
    return SetupCfg(tuple(options), (*wrong, *problems), tuple(texts))


def _extend(options: list[Option], continuations: list[Line]) -> None:
    """Move the lines that continue the last option from ``continuations`` to the option."""
    if continuations:
        options[-1] = options[-1]._replace(lines=(*options[-1].lines, *continuations))
        continuations.clear()
