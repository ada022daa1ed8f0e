from __future__ import annotations

import pickle

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.syntax import BRACKET, CLOSE, LITERAL, OPEN, PLAIN, QUOTED, UNQUOTED, Command, parse


def commands(text: str) -> tuple[Command, ...]:
    parsed = parse(Text("CMakeLists.txt", text))
    assert not parsed.problems
    return parsed.commands


def arguments(text: str) -> list[tuple[str, int]]:
    (command,) = commands(f"f({text})")
    return [(value, kind) for value, kind, _, _ in command.args]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a b", [("a", PLAIN), ("b", PLAIN)]),
        ("a;b ${c}", [("a;b", UNQUOTED), ("${c}", UNQUOTED)]),
        ('"a b" "${c}"', [("a b", LITERAL), ("${c}", QUOTED)]),
        (r'"a\"b"', [(r"a\"b", QUOTED)]),
        ('"a\nb"', [("a\nb", LITERAL)]),
        ("[[a]]", [("a", BRACKET)]),
        ("[==[\na]]]=]b]==]", [("a]]]=]b", BRACKET)]),
        ("a[1] [b", [("a[1]", UNQUOTED), ("[b", UNQUOTED)]),
        ("(a (b))", [("(", OPEN), ("a", PLAIN), ("(", OPEN), ("b", PLAIN), (")", CLOSE), (")", CLOSE)]),
        ('-Da="b c"d e', [('-Da="b c"d', UNQUOTED), ("e", PLAIN)]),
        (r"a\ b a\(b a\#b", [(r"a\ b", UNQUOTED), (r"a\(b", UNQUOTED), (r"a\#b", UNQUOTED)]),
        ("$(A) a$(B)c", [("$(A)", UNQUOTED), ("a$(B)c", UNQUOTED)]),
        ("a # ) comment\n b", [("a", PLAIN), ("b", PLAIN)]),
        ("a #[[ ) \n ]] b #[=[ ]] ]=]", [("a", PLAIN), ("b", PLAIN)]),
        ("a#b\nc", [("a", PLAIN), ("c", PLAIN)]),
        ("=a [=a", [("=a", PLAIN), ("[=a", UNQUOTED)]),
        ("$<IF:$<CONFIG:Debug>,a,b>", [("$<IF:$<CONFIG:Debug>,a,b>", UNQUOTED)]),
    ],
)
def test_arguments_are_classified_by_kind(text: str, expected: list[tuple[str, int]]) -> None:
    assert arguments(text) == expected


def test_command_names_are_case_insensitive() -> None:
    (command,) = commands("Find_Package (rclcpp)")
    assert (command.name, command.written) == ("find_package", "Find_Package")


def test_spans_equal_those_of_the_text() -> None:
    source = Text("CMakeLists.txt", '# café\n  set(a\n    "b\n c" d)\r\nf( [[x\ny]] )\n')
    for newline in ("\n", "\r\n"):
        text = Text(source.path, source.text.replace("\r\n", "\n").replace("\n", newline))
        for command in parse(text).commands:
            assert text.slice(command.place(text.path)) == command.written
            assert command.span(text.path, command.start, command.end) == text.span(command.start, command.end)
            for _, _, start, end in command.args:
                assert command.span(text.path, start, end) == text.span(start, end)


@pytest.mark.parametrize(
    ("text", "message", "place"),
    [
        ("f(a", "')' is missing at the end of f()", "f"),
        ('f("a)', "a string is not closed", '"'),
        ("f([[a])", "a bracket argument is not closed", "["),
        ("f(a))", "a command is expected here", ")"),
        ("f", "'(' is missing after 'f'", "f"),
        ("f\n(a)", "'(' is missing after 'f'", "f"),
        ("f(a) g(b)", "a command must start on a new line", "g"),
        ("f(a)\n<<<<<<< HEAD\n", "'<<<<<<<' is not a valid command name", "<<<<<<<"),
        ('f(a)\n"b"', "a command is expected here", '"b"'),
        ("f(a[[b]])", None, ""),
        ('f("a"[[b]])', "a space is missing between two arguments", "[[b]]"),
        ("f([[a]]b)", "a space is missing between two arguments", "b"),
        ("f(\na) g(b)", "a command must start on a new line", "g"),
        ("f(\0)", "'\\x00' is not allowed here", "\0"),
        ("#[[", "a comment is not closed", "#"),
        ('# see a(b)\n"c', "a string is not closed", '"'),
        ("f #[[a]] # b\n(c)", "'(' is missing after 'f'", "f"),
    ],
)
def test_syntax_errors_are_reported_at_their_place(text: str, message: str | None, place: str) -> None:
    source = Text("CMakeLists.txt", text)
    parsed = parse(source)
    problems = [(problem.message, source.slice(problem.span)) for problem in parsed.problems]
    assert problems == ([(message, place)] if message else [])
    assert [command.name for command in parsed.commands] == (["f"] if text.startswith(("f(a)", "f(\na)")) or not message else [])


def test_templates_may_contain_placeholders() -> None:
    assert parse(Text("a.cmake.in", "@PACKAGE_INIT@\nset(a @b@)\n")).problems == ()
    assert parse(Text("a.in.cmake", "@PACKAGE_INIT@\nset(a @b@)\n")).problems == ()
    assert parse(Text("a.cmake", "@PACKAGE_INIT@\n")).problems


def test_marks_of_unknown_values_are_removed_from_files() -> None:
    (command,) = commands("f(\1a \2)")
    assert [value for value, *_ in command.args] == ["\ufffda", "\ufffd"]


def test_parsed_files_can_be_cached() -> None:
    parsed = parse(Text("CMakeLists.txt", "set(a b)\n("))
    assert pickle.loads(pickle.dumps(parsed)) == parsed
